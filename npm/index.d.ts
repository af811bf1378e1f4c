// SPDX-License-Identifier: GPL-3.0-or-later
/**
 * Hierarchical radiosity in the plane, as `hr2d solve` has it.
 *
 * Lengths are in the unit of the scene.  B, H and emissions have one unit, that of the emissions
 * in the scene; with temperatures it is W/m².  Errors are relative, temperatures are in kelvin.
 * A patch runs from its first point to its second, and its front is on the left.  A number is
 * `null` where it is not known or not finite.
 */

/** Compiles the library.  May be called again for another one, with memory of its own. */
export function load(from?: ModuleSource): Promise<Library>;

/** The place of `hr2d.wasm`, its bytes, or a compiled module; by default that of the package. */
export type ModuleSource = URL | string | ArrayBuffer | ArrayBufferView | WebAssembly.Module;

export interface Library {
  /**
   * Solves a scene.
   *
   * It returns when it is done; in a page that should stay alive, call it in a worker.  A
   * solution that misses its target is returned, too: its `status` is "inaccurate", and
   * `target.reason` tells why.
   *
   * @param scene  GeoJSON as an object, or the text or the bytes of a file, which may be of
   *               View2D, too
   * @throws Hr2dError  if there is no solution
   */
  solve<O extends SolveOptions>(
    scene: object | string | ArrayBuffer | ArrayBufferView,
    options?: O,
  ): O extends { grid: Grid } ? GridSolution : Solution;
}

/** A failure. Its message is the sentence of the library or of the program `hr2d`. */
export class Hr2dError extends Error {
  name: "Hr2dError";
  status: Status;
  /** About the scene that was refused: maybe its reason. */
  warnings: Warning[];
}

/** hr2d_status of the library. */
export type Status =
  | "HR2D_STOPPED"
  | "HR2D_ENOMEM"
  | "HR2D_EINVAL"
  | "HR2D_ESTATE"
  | "HR2D_ERANGE"
  | "HR2D_EIO"
  | "HR2D_ESYNTAX"
  | "HR2D_ESCENE"
  | "HR2D_EUNSUPPORTED"
  | "HR2D_ECALLBACK"
  | "HR2D_EMAX_ELEMENTS"
  | "HR2D_EMAX_LINKS"
  | "HR2D_EMAX_BYTES"
  | "HR2D_ENO_SOLUTION"
  | "HR2D_ENOT_CONVERGED"
  | "HR2D_EACCURACY";

/** A patch by its index or its name. */
export type PatchName = number | string;

/**
 * The options of `hr2d solve`, `--target-error` as `targetError`.  A flag is `true`.  Without
 * any of the first two groups the target is 1e-6; the program itself has `eps` 0.1 then.
 */
export interface SolveOptions {
  /** Solves until averages of B and of H are known to this relative error. */
  targetError?: number;
  /** The best solution that is ready after so many seconds. */
  timeBudget?: number;

  /** The paper's algorithm: links are accepted whose estimated error is at most this; 0.1. */
  eps?: number;
  /** Estimates the error of a link; "size" by default.  The values depend on `eps`. */
  oracle?: "size" | "size2" | "bf" | "l1" | "l1-grid" | "bounds";
  /** What a refusal splits; "original" by default. */
  variant?: "original" | "modified";
  /** Legendre coefficients of each element, 1 to 32; 1. */
  order?: number;
  /** Elements on this level are not subdivided; 24. */
  maxLevel?: number;
  /** Rows of the kernel stay as coarse links make them. */
  noClosure?: boolean;
  /** One radiosity for each patch, as enclosure codes have. */
  enclosure?: boolean;

  /** With a target: of averages, or with "sup" at all points. */
  norm?: "average" | "sup";
  /** With a target: only averages of these patches matter. */
  importance?: PatchName[];
  /** Averages below this part of the largest count as this part of it; 1e-6. */
  floor?: number;
  /** Encloses averages from below and above, so far apart at most. */
  enclose?: number;
  /** Measures the error; without a target the default for up to 200 patches. */
  error?: boolean;
  /** Does not measure it. */
  noError?: boolean;
  /** Gives up beyond so many links. */
  maxLinks?: number;
  /** Gives up beyond so many elements. */
  maxElements?: number;
  /** Cuts patches where they cross each other. */
  splitCrossings?: boolean;
  /** Joins what is nearer than this length: ends, feet of walls. */
  snap?: number;

  /** B and H at points, each a patch and the fraction t of it, from 0 to 1. */
  at?: [patch: PatchName, t: number][];
  /** The light between the patches, as {@link GridSolution.field}. */
  grid?: Grid;
  /** The name of the scene in the result; "scene". */
  name?: string;
  /**
   * Is called now and then with the phase and the part of it that is done.  `false` stops the
   * solve with the status HR2D_STOPPED.  So does what the function throws, which is thrown again.
   */
  progress?: (phase: string, fraction: number) => boolean | void;
}

/** Nodes of a grid, row by row from `low` to `high`. */
export interface Grid {
  /** The first node of the first row. */
  low: [x: number, y: number];
  /** The last node of the last row. */
  high: [x: number, y: number];
  /** Nodes in a row. */
  columns: number;
  /** Rows; 1. */
  rows?: number;
  /** The error that interpolation may add, a part of the range of values; 0: none is made. */
  tolerance?: number;
}

export interface Field {
  columns: number;
  rows: number;
  /**
   * The mean radiosity over all directions, rows × columns × bands: band b of node (column, row)
   * is number (row · columns + column) · bands + b.  NaN outside.
   */
  mean: Float64Array;
  /** Of each node: 0 between the patches, 1 on a patch, 2 outside, where no light can be. */
  place: Uint8Array;
}

/** The document of `hr2d solve --json`; `hr2d schema solve` describes it. */
export interface Solution {
  scene: string;
  provenance: Provenance;
  /** Crossings that were cut. */
  cuts: number;
  patches: Patch[];
  /** Of the option `at`, in its order. */
  at: Point[];
  /** N */
  elements: number;
  /** Elements without children. */
  leaves: number;
  /** L */
  links: number;
  limited_links: number;
  levels: number;
  order: number;
  epsilon: number | null;
  oracle: string;
  variant: string | null;
  target: Target | null;
  effects: Effects;
  work: Work;
  seconds: Seconds;
  /** The memory of the module, which never shrinks. */
  peak_bytes: number;
  /** One for each band. */
  power: Power[];
  /** One for each band; only of a scene with gas. */
  gas?: Gas[];
  residual: number | null;
  /** Relative, of B; null where it was not measured. */
  error: Errors & {
    /** Of H. */
    irradiance: Errors;
    /** What the bounds assume. */
    assumes?: string;
  };
  /** Of the option `enclose`. */
  enclosed?: Enclosed | null;
  warnings: Warning[];
  status: "ok" | "inaccurate";
}

export interface GridSolution extends Solution {
  field: Field;
}

export interface PatchId {
  index: number;
  name: string;
  length: number | null;
}

/** Values are one for each band. */
export interface Patch extends PatchId {
  /** Mean radiosity B. */
  average: Values;
  /** Mean H. */
  irradiance: Values;
  /** B - H */
  net_flux: Values;
  /** B - H over the length of the patch. */
  net_power: Values;
  /** The part of H that comes straight from the sun; only of a scene with a sun. */
  sunlight?: Values;
  /** In kelvin; this and what follows only of a scene with temperatures or fluxes. */
  temperature?: number | null;
  temperature_error?: ErrorRange;
  temperature_state?: "none" | "given" | "found" | "impossible" | "unlit";
  /** That leaves, in W per unit of length. */
  heat?: number | null;
  heat_error?: ErrorRange;
}

export interface Point {
  /** The index of the patch. */
  patch: number;
  t: number;
  /** B */
  value: Values;
  /** H */
  irradiance: Values;
  sunlight?: Values;
  /** In kelvin. */
  temperature?: number | null;
}

export type Values = (number | null)[];

export interface ErrorRange {
  estimate: number | null;
  bound: number | null;
}

/** Of averages, and as `sup` of values at points. */
export interface Errors extends ErrorRange {
  sup_estimate: number | null;
  sup_bound: number | null;
}

export interface Provenance {
  program: "hr2d" | "hr2d-mpi";
  version: string;
  command: "solve";
  /** As words of a command line. */
  options: string[];
  /** SHA-256 of the bytes of the scene. */
  sha256: string;
}

export interface Target {
  error: number | null;
  norm: "average" | "sup";
  seconds: number | null;
  importance: number[] | null;
  floor: number | null;
  /** Why the target was not reached; "" if it was. */
  reason: string;
}

export interface Effects {
  occlusion: boolean;
  interreflection: boolean;
  emission: boolean;
  bands: boolean;
  "two-sided": boolean;
  facing: boolean;
  background: boolean;
  corner: boolean;
  panes: boolean;
  medium: boolean;
}

export interface Work {
  oracle_calls: number;
  facing_tests: number;
  visibility_tests: number;
  exchange_areas: number;
  partial_links: number;
  blocked_pairs: number;
  dark_pairs: number;
  rounds: number;
  sweeps: number;
  iterations: number;
  row_sums: number;
  background_rows: number;
  kernels: number;
}

/** Wall time. */
export interface Seconds {
  refine: number | null;
  coefficients: number | null;
  solve: number | null;
  error: number | null;
  total: number | null;
}

/** Per unit of depth: values of B times lengths. */
export interface Power {
  emitted: number | null;
  /** From the surroundings. */
  received: number | null;
  absorbed: number | null;
  escaped: number | null;
  /** Of the balance of these. */
  relative_error: number | null;
  cut_off?: number | null;
  sunlight_cut_off?: number | null;
}

export interface Gas {
  /** Its number, in the order of the file, from 0. */
  gas: number;
  band: number;
  /** Per unit of length. */
  absorption: number | null;
  /** Of a black body as hot as the gas. */
  emission: number | null;
  /** That it gives to patches and to other gases. */
  heat: number | null;
}

/** Ends of averages by patch and band. */
export interface Ends {
  error: number | null;
  lower: Values[];
  upper: Values[];
}

export interface Enclosed extends Ends {
  /** Of H. */
  irradiance: Ends;
  gap: number | null;
  links: number;
  seconds: number | null;
  reason: string;
}

/** What is valid in a drawing but maybe not meant. */
export interface Warning {
  code: string;
  patches: PatchId[];
  at: [x: number, y: number] | null;
  gap: number | null;
  text: string;
}
