// SPDX-License-Identifier: GPL-3.0-or-later
// `hr2d solve` as a function: options become the words of a command line, which the files of
// the program read in WebAssembly, and the document of --json comes back.

import { LibraryError, Module } from "./module.js";

const encoder = new TextEncoder();

// The names of hr2d_status, in its order.
const STATUS = [
  "HR2D_OK",
  "HR2D_STOPPED",
  "HR2D_ENOMEM",
  "HR2D_EINVAL",
  "HR2D_ESTATE",
  "HR2D_ERANGE",
  "HR2D_EIO",
  "HR2D_ESYNTAX",
  "HR2D_ESCENE",
  "HR2D_EUNSUPPORTED",
  "HR2D_ECALLBACK",
  "HR2D_EMAX_ELEMENTS",
  "HR2D_EMAX_LINKS",
  "HR2D_EMAX_BYTES",
  "HR2D_ENO_SOLUTION",
  "HR2D_ENOT_CONVERGED",
  "HR2D_EACCURACY",
];
const ESTATE = STATUS.indexOf("HR2D_ESTATE");
const EINVAL = STATUS.indexOf("HR2D_EINVAL");

// What chooses the way to solve; without any of these there is a target.
const METHOD = [
  "targetError",
  "timeBudget",
  "eps",
  "oracle",
  "variant",
  "order",
  "maxLevel",
  "noClosure",
  "enclosure",
];
const OPTIONS = new Set([
  ...METHOD,
  "norm",
  "importance",
  "floor",
  "enclose",
  "error",
  "noError",
  "maxLinks",
  "maxElements",
  "splitCrossings",
  "snap",
  "at",
]);
const DEFAULT_ERROR = 1e-6;

/** A solve that failed. */
export class Hr2dError extends Error {
  constructor(status, message, warnings = []) {
    super(message);
    this.name = "Hr2dError";
    this.status = STATUS[status] ?? "HR2D_EINVAL";
    this.warnings = warnings;
  }
}

function isGiven(value) {
  return value !== undefined && value !== null && value !== false;
}

/** The option as words of the command line. */
function optionWords(name, value) {
  if (!OPTIONS.has(name)) throw new Hr2dError(EINVAL, `unknown option '${name}'`);
  const word = `--${name.replace(/[A-Z]/g, (letter) => `-${letter.toLowerCase()}`)}`;
  const values = name === "at" || name === "importance" ? Array.from(value) : [value];
  return values.map((v) =>
    v === true ? word : `${word}=${name === "at" ? Array.from(v).join(":") : String(v)}`,
  );
}

function commandLine(options, name) {
  const given = Object.entries(options).filter(([, value]) => isGiven(value));
  if (!given.some(([key]) => METHOD.includes(key))) given.push(["targetError", DEFAULT_ERROR]);
  const words = given.flatMap(([key, value]) => optionWords(key, value));
  const all = ["hr2d", "solve", ...words, "--", String(name)];
  if (all.some((word) => word.includes("\0")))
    throw new Hr2dError(EINVAL, "an option has a character with the code 0");
  return all;
}

function bytesOf(scene) {
  if (typeof scene === "string") return encoder.encode(scene);
  if (ArrayBuffer.isView(scene))
    return new Uint8Array(scene.buffer, scene.byteOffset, scene.byteLength);
  if (scene instanceof ArrayBuffer) return new Uint8Array(scene);
  if (typeof scene === "object" && scene !== null) return encoder.encode(JSON.stringify(scene));
  throw new Hr2dError(EINVAL, "a scene is an object, or text or bytes of a file");
}

/** The calls of playground/package.c. */
class Package extends Module {
  check(status) {
    if (!status) return;
    const message = this.text(this.calls.package_message());
    const warnings = JSON.parse(this.text(this.calls.package_warnings()));
    throw new Hr2dError(status, message, Array.isArray(warnings) ? warnings : []);
  }

  solve(bytes, words) {
    this.lendBytes(bytes, (text, size) =>
      this.lendText(words.join("\0"), (line) =>
        this.check(this.calls.package_solve(text, size, line, words.length)),
      ),
    );
    return JSON.parse(this.text(this.calls.package_json()));
  }

  field({ low, high, columns, rows = 1, tolerance = 0 }, bands) {
    if (![columns, rows].every((n) => Number.isInteger(n) && n > 0))
      throw new Hr2dError(EINVAL, "a grid has whole numbers of columns and rows");
    const corners = [...low, ...high];
    if (corners.length !== 4) throw new Hr2dError(EINVAL, "a grid is from [x, y] to [x, y]");
    const count = columns * rows;
    return this.lend(count, (at) => {
      const mean = this.numbers(count * bands, (to) =>
        this.check(this.calls.package_field(...corners, columns, rows, tolerance, to, at)),
      );
      const place = new Uint8Array(this.calls.memory.buffer, at, count).slice();
      return { columns, rows, mean, place };
    });
  }

  end() {
    this.calls.package_end();
  }
}

/** Compiles a module from wherever it is. */
async function compile(from) {
  if (from instanceof WebAssembly.Module) return from;
  if (ArrayBuffer.isView(from) || from instanceof ArrayBuffer) return WebAssembly.compile(from);
  const url = new URL(from, import.meta.url);
  if (url.protocol === "file:") {
    const files = "node:fs/promises"; // not a constant below, for bundlers that look for it
    const { readFile } = await import(/* webpackIgnore: true */ /* @vite-ignore */ files);
    return WebAssembly.compile(await readFile(url));
  }
  const response = await fetch(url);
  if (!response.ok) throw new Error(`${url}: ${response.status} ${response.statusText}`);
  return WebAssembly.compile(await response.arrayBuffer());
}

/** What the caller's function says; what it throws is kept until the library has stopped. */
function watch(library, progress) {
  const seen = { thrown: false, error: undefined };
  library.goOn = (phase, fraction) => {
    if (!progress) return true;
    if (seen.thrown) return false;
    try {
      return progress(phase, fraction) !== false;
    } catch (error) {
      seen.thrown = true;
      seen.error = error;
      return false;
    }
  };
  return seen;
}

function start(module) {
  const library = new Package();
  library.begin(new WebAssembly.Instance(module, library.imports()));
  return library;
}

export async function load(from = new URL("./hr2d.wasm", import.meta.url)) {
  const module = await compile(from);
  let library = new Package();
  library.begin(await WebAssembly.instantiate(module, library.imports()));
  let busy = false;

  function solve(scene, options) {
    const { name = "scene", progress, grid, ...how } = options ?? {};
    if (busy) throw new Hr2dError(ESTATE, "a solve is under way, whose progress this is");
    const bytes = bytesOf(scene);
    const words = commandLine(how, name);
    library ??= start(module);
    const seen = watch(library, progress);
    busy = true;
    try {
      const result = library.solve(bytes, words);
      if (grid) result.field = library.field(grid, result.power.length);
      library.end();
      return result;
    } catch (error) {
      // After anything but a refusal the module may be in any state: the next solve has a new
      // one.
      if (error instanceof Hr2dError || error instanceof LibraryError) library.end();
      else library = null;
      if (seen.thrown) throw seen.error;
      throw error instanceof LibraryError ? new Hr2dError(error.status, error.message) : error;
    } finally {
      busy = false;
    }
  }

  return { solve };
}
