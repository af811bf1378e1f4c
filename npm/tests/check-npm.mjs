// SPDX-License-Identifier: GPL-3.0-or-later
// Installs the package in an empty folder and tests it: check-npm.mjs TARBALL HR2D SRCDIR.
//
// HR2D is the native program, whose digits are expected, and SRCDIR the top of the sources.
import assert from "node:assert/strict";
import { execFileSync, spawnSync } from "node:child_process";
import { cpSync, mkdtempSync, readFileSync, readdirSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { pathToFileURL } from "node:url";

const [TARBALL, HR2D, SRCDIR] = process.argv.slice(2).map((path) => resolve(path));
const SCENES = join(SRCDIR, "examples", "scenes");
const ERROR = 1e-6;
// Relative differences of averages, of B and of H.  The expansions of clusters, from 256 patches
// on, stand at nodes that come from cos(), whose last bit is not the same in all C libraries.
const SAME = 1e-15;
const SAME_WITH_CLUSTERS = 1e-13;
const CLUSTERS = 256;
const SOLVES = 200;

const folder = mkdtempSync(join(tmpdir(), "hr2d-npm-"));
process.on("exit", () => rmSync(folder, { recursive: true, force: true }));
const tests = [];
const test = (title, run) => tests.push({ title, run });
const lit = readFileSync(join(SCENES, "lit-room.geojson"), "utf8");
let hr2d, solve;

/** What the program has, or null if it solves no such scene. */
function native(path, ...how) {
  const words = ["solve", path, ...how, "--quiet", "--json", "-"];
  const { stdout } = spawnSync(HR2D, words, { encoding: "utf8", maxBuffer: 2 ** 28 });
  return stdout ? JSON.parse(stdout) : null;
}

/** All numbers of averages. */
function averages({ patches }) {
  return patches.flatMap((patch) => [...patch.average, ...patch.irradiance]);
}

/** The largest relative difference; infinite if there are not as many values. */
function difference(found, expected) {
  if (found.length !== expected.length) return Infinity;
  const each = found.map((f, k) => Math.abs(f - expected[k]) / (Math.abs(expected[k]) || 1));
  return Math.max(...each);
}

/** The names of all members, of arrays those of their first item. */
function shape(value) {
  if (Array.isArray(value)) return value.length ? [shape(value[0])] : [];
  if (typeof value !== "object" || value === null) return null;
  return Object.fromEntries(Object.keys(value).map((key) => [key, shape(value[key])]));
}

/** The error that a call throws. */
function thrown(scene, options) {
  try {
    solve(scene, options);
  } catch (error) {
    return error;
  }
  return assert.fail(`nothing was thrown with ${JSON.stringify(options)}`);
}

function refuses(status, message, scene, options) {
  const error = thrown(scene, options);
  assert.ok(error instanceof hr2d.Hr2dError, `${error}`);
  assert.equal(error.status, status, error.message);
  assert.match(error.message, message);
  return error;
}

function works() {
  assert.equal(solve(lit, { targetError: 1e-3 }).status, "ok");
}

test("the tarball is installed without a network", async () => {
  writeFileSync(join(folder, "package.json"), '{"name": "empty", "private": true}');
  const words = [
    "install",
    "--offline",
    "--no-audit",
    "--no-fund",
    "--no-update-notifier",
    TARBALL,
  ];
  execFileSync("npm", [...words, `--cache=${join(folder, "cache")}`], {
    cwd: folder,
    stdio: "pipe",
  });
  const at = join(folder, "node_modules", "hr2d");
  assert.deepEqual(
    readdirSync(join(folder, "node_modules")).filter((name) => name[0] !== "."),
    ["hr2d"],
  );
  assert.deepEqual(readFileSync(join(at, "COPYING")), readFileSync(join(SRCDIR, "COPYING")));
  const own = JSON.parse(readFileSync(join(at, "package.json"), "utf8"));
  assert.equal(own.dependencies, undefined);
  hr2d = await import(pathToFileURL(join(at, own.exports["."].default)));
  ({ solve } = await hr2d.load());
  assert.equal(solve(lit).provenance.version, own.version);
});

test("every example has the digits and the members of the program", () => {
  const names = readdirSync(SCENES).filter((name) => name.endsWith(".geojson"));
  let solved = 0;
  let same = 0;
  for (const name of names) {
    const bytes = readFileSync(join(SCENES, name));
    const expected = native(join(SCENES, name), "--target-error", `${ERROR}`);
    if (!expected) {
      thrown(bytes, { targetError: ERROR });
      continue;
    }
    const result = solve(bytes, { targetError: ERROR, name });
    const off = difference(averages(result), averages(expected));
    if (off) console.log(`    ${name}: ${off.toExponential(1)}`);
    same += off === 0;
    assert.ok(
      off <= (expected.patches.length < CLUSTERS ? SAME : SAME_WITH_CLUSTERS),
      `${name}: ${off}`,
    );
    assert.deepEqual(shape(result), shape(expected), name);
    for (const key of ["elements", "links", "order", "levels", "status", "effects", "warnings"])
      assert.deepEqual(result[key], expected[key], `${name}: ${key}`);
    assert.equal(result.provenance.sha256, expected.provenance.sha256);
    solved++;
  }
  console.log(`    ${solved} of ${names.length} scenes, ${same} of them bit for bit`);
  assert.ok(solved >= 20);
});

test("the comparison would notice another scene and another target", () => {
  const expected = averages(
    native(join(SCENES, "lit-room.geojson"), "--target-error", `${ERROR}`),
  );
  const other = JSON.parse(lit);
  const feature = other.features.find(({ properties }) => properties.reflectance);
  feature.properties.reflectance = []
    .concat(feature.properties.reflectance)
    .map((r) => r * (1 - 1e-9));
  const off = difference(averages(solve(other, { targetError: ERROR })), expected);
  assert.ok(off > SAME && off < 1e-6, `${off}`);
  assert.ok(difference(averages(solve(lit, { targetError: 1e-2 })), expected) > SAME);
});

test("other options have the digits of the program, too", () => {
  const path = join(SCENES, "screened-room.geojson");
  const text = readFileSync(path, "utf8");
  const name = JSON.parse(text).features[0].properties.name;
  const cases = [
    [["--eps", "0.25"], { eps: 0.25 }],
    [
      ["--eps", "0.01", "--oracle", "l1", "--variant", "modified"],
      { eps: 0.01, oracle: "l1", variant: "modified" },
    ],
    [["--eps", "0.2", "--order", "4", "--no-error"], { eps: 0.2, order: 4, noError: true }],
    [["--enclosure"], { enclosure: true }],
    [["--target-error", "1e-4", "--norm", "sup"], { targetError: 1e-4, norm: "sup" }],
    [
      ["--target-error", "1e-4", "--importance", "0", "--importance", "1"],
      { targetError: 1e-4, importance: [0, 1] },
    ],
    [["--target-error", "1e-4", "--enclose", "0.1"], { targetError: 1e-4, enclose: 0.1 }],
    [
      ["--target-error", "1e-4", "--at", `${name}:0.25`, "--at", "1:0.5"],
      {
        targetError: 1e-4,
        at: [
          [name, 0.25],
          [1, 0.5],
        ],
      },
    ],
  ];
  for (const [words, options] of cases) {
    const expected = native(path, ...words);
    const result = solve(text, options);
    const off = difference(averages(result), averages(expected));
    assert.ok(off <= SAME, `${words}: ${off}`);
    assert.deepEqual(shape(result), shape(expected), `${words}`);
    const values = (s) => s.at.flatMap((p) => [...p.value, ...p.irradiance]);
    assert.ok(
      !expected.at.length || difference(values(result), values(expected)) <= SAME,
      `${words}`,
    );
    assert.equal(result.error.bound === null, expected.error.bound === null);
  }
});

test("an enclosure is as wide as that of the program", () => {
  // Of links that are as bad, the last bit chooses the one that is refined: ends may change
  // places.
  const path = join(SCENES, "screened-room.geojson");
  const { patches, enclosed } = solve(readFileSync(path), { targetError: 1e-9, enclose: 0.1 });
  const expected = native(path, "--target-error", "1e-9", "--enclose", "0.1").enclosed;
  assert.ok(Math.abs(enclosed.gap - expected.gap) < 1e-12 && enclosed.links === expected.links);
  patches.forEach(({ average: [b] }, k) => {
    for (const { lower, upper } of [enclosed, expected])
      assert.ok(lower[k][0] <= b && b <= upper[k][0]);
  });
});

test("a budget of time is kept, and the default is a target", () => {
  const { target } = solve(lit, { timeBudget: 0.3 });
  assert.equal(target.seconds, 0.3);
  assert.equal(solve(lit).target.error, ERROR);
  assert.equal(solve(lit, { eps: undefined, noError: false }).target.error, ERROR);
});

test("a scene is text, bytes or an object, and may be of View2D", () => {
  const bytes = new TextEncoder().encode(lit);
  const expected = averages(solve(lit));
  for (const scene of [bytes, bytes.buffer, JSON.parse(lit)])
    assert.deepEqual(averages(solve(scene)), expected);
  const path = join(SCENES, "blk1.vs2");
  assert.ok(
    difference(
      averages(solve(readFileSync(path))),
      averages(native(path, "--target-error", `${ERROR}`)),
    ) <= SAME,
  );
});

test("a grid has the light that the program has", () => {
  const path = join(SCENES, "lit-room.geojson");
  const words = [
    "field",
    path,
    "--target-error",
    `${ERROR}`,
    "--grid",
    "7x5",
    "--box",
    "0.1,0.2,4.9,2.7",
  ];
  const out = execFileSync(HR2D, [...words, "--quiet", "--csv", "-"], { encoding: "utf8" });
  const rows = out
    .trim()
    .split("\n")
    .slice(1)
    .map((row) => row.split(","));
  const expected = rows.map((row) => (row[3] === "" ? NaN : Number(row[3])));
  const { field } = solve(lit, {
    grid: { low: [0.1, 0.2], high: [4.9, 2.7], columns: 7, rows: 5 },
  });
  const found = [...field.mean];
  assert.equal(found.length, expected.length);
  found.forEach((f, k) => assert.equal(Number.isNaN(f), Number.isNaN(expected[k])));
  const numbers = (list) => list.filter((x) => !Number.isNaN(x));
  assert.ok(numbers(found).length > 50);
  assert.ok(difference(numbers(found), numbers(expected)) <= 1e-11);
  assert.equal(field.place.length, 35);
});

test("warnings come back, with a solution and with a refusal", () => {
  const wall = (properties, ...coordinates) => ({
    type: "Feature",
    properties,
    geometry: { type: "LineString", coordinates },
  });
  const scene = (...features) => ({ type: "FeatureCollection", features });
  const open = scene(
    wall({ emission: 1, colour: "red" }, [0, 0], [1, 0]),
    wall({}, [1, 1], [0, 1]),
  );
  const path = join(folder, "open.geojson");
  writeFileSync(path, JSON.stringify(open));
  const expected = native(path, "--target-error", `${ERROR}`);
  assert.ok(expected.warnings.length > 0);
  assert.deepEqual(solve(open).warnings, expected.warnings);
  const crossing = scene(
    wall({ emission: 1 }, [0, 0], [1, 1]),
    wall({ colour: "red" }, [0, 1], [1, 0]),
  );
  const error = refuses("HR2D_ESCENE", /cross/, crossing);
  assert.ok(error.warnings.length > 0);
  assert.equal(solve(crossing, { splitCrossings: true }).cuts, 1);
});

test("hostile scenes are refused, and the module goes on", () => {
  const texts = [
    "",
    "no JSON",
    "{",
    "null",
    "[]",
    "{}",
    '"',
    "\0",
    `${lit}\0`,
    lit.replace("{", "{\0"),
    lit.slice(0, -20),
    lit.replace(/\[0, 0\]/, "[1e400, 0]"),
    lit.replace(/\[0, 0\]/, "[1e308, -1e308]"),
    lit.replace(/\[0, 0\]/, "[NaN, 0]"),
    "[".repeat(1e6),
    '{"a":'.repeat(1e5),
    "\ud800",
    "9".repeat(1e6),
  ];
  for (const text of texts) {
    const error = thrown(text);
    assert.ok(error instanceof hr2d.Hr2dError, `${text.slice(0, 40)}: ${error}`);
    assert.match(error.status, /^HR2D_E(SYNTAX|SCENE|RANGE|INVAL)$/, error.message);
    assert.ok(error.message.length > 5);
  }
  for (let k = 0, byte = 1; k < 300; k++) {
    const bytes = new TextEncoder().encode(lit);
    for (let n = 0; n < 3; n++)
      bytes[(byte = (byte * 48271) % 2147483647) % bytes.length] = byte & 255;
    try {
      solve(bytes, { eps: 1 });
    } catch (error) {
      assert.ok(error instanceof hr2d.Hr2dError, `${error.stack}`);
    }
  }
  for (const scene of [undefined, null, 7, true, () => 0, Symbol("scene"), 1n])
    refuses("HR2D_EINVAL", /scene/, scene);
  const circle = {};
  circle.circle = circle;
  assert.ok(thrown(circle) instanceof TypeError);
  works();
});

test("wrong options are refused with the sentence of the program", () => {
  refuses("HR2D_EINVAL", /unknown option 'target'/, lit, { target: 1 });
  refuses("HR2D_EINVAL", /unknown option 'json'/, lit, { json: "file" });
  refuses("HR2D_EINVAL", /--oracle/, lit, { oracle: "l3" });
  refuses("HR2D_EINVAL", /exclude each other/, lit, { targetError: 1e-3, eps: 0.1 });
  refuses("HR2D_EINVAL", /no patch called 'roof'/, lit, { at: [["roof", 0.5]] });
  refuses("HR2D_EINVAL", /code 0/, lit, { oracle: "size\0--json=x" });
  for (const value of [NaN, Infinity, -1, 0, "", "x", {}, [], -0])
    refuses("HR2D_EINVAL", /--eps/, lit, { eps: value });
  for (const value of [1e21, -1, 0.5, 2 ** 64])
    refuses("HR2D_EINVAL", /--max-links/, lit, { maxLinks: value });
  refuses("HR2D_EMAX_LINKS", /links/, lit, { eps: 1e-4, maxLinks: 100 });
  const grid = { low: [0, 0], high: [1, 1], columns: 3, rows: 3 };
  const wrong = [
    { columns: 0 },
    { columns: 1.5 },
    { rows: NaN },
    { columns: -1 },
    { high: [NaN, 0] },
    { tolerance: 7 },
    { low: [0] },
  ];
  for (const part of wrong) refuses("HR2D_EINVAL", /./, lit, { grid: { ...grid, ...part } });
  for (const columns of [2 ** 16, 2 ** 28, 2 ** 31])
    refuses("HR2D_ENOMEM", /memory/, lit, { grid: { ...grid, columns, rows: 2 ** 16 } });
  const impossible = solve(lit, { targetError: 1e-15 });
  assert.equal(impossible.status, "inaccurate");
  assert.ok(impossible.target.reason.length > 5);
  works();
});

test("all names of statuses are those of the header", () => {
  const header = readFileSync(join(SRCDIR, "include", "hr2d", "status.h"), "utf8");
  const names = [...header.matchAll(/^ {2}(HR2D_[A-Z_]+)/gm)].map(([, name]) => name);
  const found = names.map((_, k) => new hr2d.Hr2dError(k, "").status);
  assert.ok(names.length > 15);
  assert.deepEqual(found, names);
  const types = readFileSync(join(SRCDIR, "npm", "index.d.ts"), "utf8");
  for (const name of names.slice(1)) assert.ok(types.includes(`"${name}"`), name);
});

test("members and options in the types are those of the program", () => {
  const types = readFileSync(join(SRCDIR, "npm", "index.d.ts"), "utf8");
  const schema = JSON.parse(execFileSync(HR2D, ["schema", "solve"], { encoding: "utf8" }));
  const members = new Set();
  JSON.stringify(schema, (key, value) => {
    if (key === "properties") Object.keys(value).forEach((name) => members.add(name));
    return value;
  });
  ["if", "ranks", "count", "most_links", "most_visibility_tests", "most_bytes"].forEach(
    (name) => members.delete(name),
  );
  for (const name of members)
    assert.match(types, new RegExp(`^  ? ? ?"?${name}"?\\??:`, "m"), name);
  const part = types.slice(
    types.indexOf("interface SolveOptions"),
    types.indexOf("interface Grid"),
  );
  const options = [...part.matchAll(/^ {2}([a-zA-Z]+)\?:/gm)].map(([, name]) => name);
  const help = execFileSync(HR2D, ["solve", "--help"], { encoding: "utf8" });
  for (const name of options.filter((n) => !["grid", "name", "progress"].includes(n)))
    assert.match(
      help,
      new RegExp(`--${name.replace(/[A-Z]/g, (c) => `-${c.toLowerCase()}`)}\\b`),
      name,
    );
});

test("progress is told, stops a solve, and may throw", () => {
  const phases = new Set();
  solve(lit, { progress: (phase, fraction) => void phases.add(phase) && fraction >= 0 });
  assert.ok(phases.has("refine"), `${[...phases]}`);
  refuses("HR2D_STOPPED", /./, lit, { progress: () => false });
  const mine = new RangeError("mine");
  const throws = () => {
    throw mine;
  };
  assert.equal(thrown(lit, { progress: throws }), mine);
  let within;
  solve(lit, {
    progress: () => {
      within ??= thrown(lit);
    },
  });
  assert.equal(within.status, "HR2D_ESTATE");
  works();
});

test(`${SOLVES} solves leave no byte behind`, async () => {
  const instantiate = WebAssembly.instantiate;
  let calls;
  WebAssembly.instantiate = async (...args) => {
    const instance = await instantiate.apply(WebAssembly, args);
    calls = instance.exports;
    return instance;
  };
  const own = await hr2d.load();
  WebAssembly.instantiate = instantiate;
  const scenes = ["lit-room", "partition", "furnace-gas"].map((name) =>
    readFileSync(join(SCENES, `${name}.geojson`)),
  );
  const grid = { low: [0, 0], high: [1, 1], columns: 20, rows: 20 };
  const fails = (scene, options) => assert.throws(() => own.solve(scene, options));
  const kinds = [
    (k) => own.solve(scenes[k % 3], { targetError: 1e-4, grid }),
    (k) => own.solve(scenes[k % 2], { eps: 0.2, oracle: "size", enclose: 0.5, at: [[0, 0.5]] }),
    (k) => fails(scenes[k % 3], { eps: 1e-3, maxLinks: 2000 }),
    (k) => fails(scenes[k % 3].subarray(0, 200 + k)),
    (k) => fails(scenes[k % 3], { targetError: 1e-6, progress: (phase) => phase !== "refine" }),
    (k) => fails(scenes[k % 3], { oracle: "l3", grid }),
    (k) => fails(scenes[k % 3], { importance: ["nobody"] }),
  ];
  const round = (k) => kinds[k % kinds.length](Math.trunc(k / kinds.length));
  for (let k = 0; k < 3 * kinds.length; k++) round(k);
  const before = [calls.package_bytes(), calls.memory.buffer.byteLength];
  for (let k = 0; k < SOLVES; k++) round(k);
  const after = [calls.package_bytes(), calls.memory.buffer.byteLength];
  console.log(`    ${after[0]} bytes in use, of ${after[1]}`);
  assert.deepEqual(after, before);
  calls.play_allocate(1);
  assert.ok(calls.package_bytes() > after[0], "a leak would be seen");
});

test("after a trap the next solve has a new module", async () => {
  const bytes = readFileSync(join(folder, "node_modules", "hr2d", "hr2d.wasm"));
  const create = WebAssembly.Instance;
  const own = await hr2d.load(await WebAssembly.compile(bytes));
  const parse = JSON.parse;
  JSON.parse = () => {
    throw new WebAssembly.RuntimeError("unreachable");
  };
  assert.throws(() => own.solve(lit), WebAssembly.RuntimeError);
  JSON.parse = parse;
  let created = 0;
  WebAssembly.Instance = function instance(...args) {
    created++;
    return new create(...args);
  };
  assert.deepEqual(averages(own.solve(lit)), averages(solve(lit)));
  WebAssembly.Instance = create;
  assert.equal(created, 1);
});

test("where there is no node the files are fetched", () => {
  // The files as a server has them, in a realm that can import nothing else.
  const program = `
    import { createServer } from "node:http";
    import { readFile } from "node:fs/promises";
    import vm from "node:vm";
    const at = new URL("./node_modules/hr2d/", import.meta.url);
    const lit = await readFile(${JSON.stringify(join(SCENES, "lit-room.geojson"))}, "utf8");
    const server = createServer(async (request, reply) => reply.end(await readFile(new URL("." + request.url, at))));
    await new Promise((resolve) => server.listen(0, "127.0.0.1", resolve));
    const base = "http://127.0.0.1:" + server.address().port + "/";
    const page = vm.createContext({ WebAssembly, URL, TextEncoder, TextDecoder, performance, fetch, lit });
    const modules = {};
    const get = async (url) => modules[url] ??= new vm.SourceTextModule(await (await fetch(url)).text(), {
      identifier: url, context: page, initializeImportMeta: (meta) => { meta.url = url; },
      importModuleDynamically: (name) => { throw new Error("imports " + name); },
    });
    const entry = await get(base + "index.js");
    await entry.link((name, from) => get(new URL(name, from.identifier).href));
    await entry.evaluate();
    const { solve } = await entry.namespace.load();
    console.log(JSON.stringify(solve(lit).patches));
    server.close();
  `;
  writeFileSync(join(folder, "page.mjs"), program);
  const words = ["--experimental-vm-modules", "--no-warnings", "page.mjs"];
  const out = execFileSync(process.execPath, words, { cwd: folder, encoding: "utf8" });
  assert.deepEqual(averages({ patches: JSON.parse(out) }), averages(solve(lit)));
  for (const name of ["index.js", "module.js"]) {
    const text = readFileSync(join(folder, "node_modules", "hr2d", name), "utf8");
    assert.doesNotMatch(text, /^import [^"]*"(?!\.\/)/m, name);
    assert.doesNotMatch(text, /\b(require|process|Buffer|global)\b(?! of)/, name);
  }
});

test("the example of README.md runs", () => {
  const text = readFileSync(join(folder, "node_modules", "hr2d", "README.md"), "utf8");
  const [, program] = text.match(/```js\n([^]*?)```/);
  writeFileSync(join(folder, "example.mjs"), program);
  const out = execFileSync(process.execPath, ["example.mjs"], {
    cwd: folder,
    encoding: "utf8",
  });
  const lines = out.trim().split("\n");
  assert.equal(lines.length, 5);
  const square = native(join(SCENES, "square-room.geojson"), "--target-error", "1e-9");
  assert.equal(
    lines[0],
    `floor ${square.patches[0].average[0]} ${square.patches[0].irradiance[0]}`,
  );
  assert.ok(Number(lines[4].split(" ").at(-1)) <= 1e-9);
});

test("types are right, in the eyes of tsc", () => {
  const tsc = spawnSync("tsc", ["--version"], { encoding: "utf8" });
  if (tsc.error) return console.log("    not checked: there is no tsc");
  cpSync(join(SRCDIR, "npm", "tests", "types.ts"), join(folder, "types.mts"));
  const words = [
    "--strict",
    "--noEmit",
    "--target",
    "es2022",
    "--module",
    "nodenext",
    "--lib",
    "es2022,dom",
    "types.mts",
  ];
  const found = spawnSync("tsc", words, { cwd: folder, encoding: "utf8" });
  assert.equal(found.status, 0, found.stdout);
  console.log(`    ${tsc.stdout.trim()}`);
  return undefined;
});

let failed = 0;
for (const { title, run } of tests) {
  const start = performance.now();
  try {
    await run();
    console.log(`ok   ${title}, ${((performance.now() - start) / 1000).toFixed(1)} s`);
  } catch (error) {
    failed++;
    console.log(`FAIL ${title}: ${error.stack}`);
    if (!solve) break;
  }
}
console.log(`${tests.length - failed} passed, ${failed} failed`);
process.exitCode = failed ? 1 : 0;
