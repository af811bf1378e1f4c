// SPDX-License-Identifier: GPL-3.0-or-later
// What TypeScript has to accept, and, where it says so, to refuse.
import { load, Hr2dError, type Library, type Solution, type SolveOptions } from "hr2d";

const library: Library = await load();
await load(new URL("https://example.org/hr2d.wasm"));
await load(new Uint8Array(8));

const how: SolveOptions = { targetError: 1e-6, importance: [0, "floor"], at: [["floor", 0.5]] };
const solution: Solution = library.solve({ type: "FeatureCollection", features: [] }, how);
const average: number | null = solution.patches[0].average[0];
const bound: number | null = solution.error.irradiance.bound;
const kelvin: number | null | undefined = solution.patches[0].temperature;

const grid = { low: [0, 0], high: [1, 1], columns: 2, rows: 2 } satisfies SolveOptions["grid"];
const mean: Float64Array = library.solve("{}", { grid: { ...grid, low: [0, 0], high: [1, 1] } })
  .field.mean;

library.solve("{}", { oracle: "l1", eps: 0.1, progress: (phase: string) => phase !== "solve" });
// @ts-expect-error: there is no field without a grid
library.solve("{}").field;
// @ts-expect-error: no such oracle
library.solve("{}", { oracle: "l3" });
// @ts-expect-error: no such option
library.solve("{}", { target: 1e-6 });
// @ts-expect-error: a scene is no number
library.solve(7);

try {
  library.solve("{}");
} catch (error) {
  if (error instanceof Hr2dError && error.status === "HR2D_ESCENE") error.warnings.length;
}
export { average, bound, kelvin, mean };
