// SPDX-License-Identifier: GPL-3.0-or-later
// The library in a thread of its own.  Receives {module} first, then jobs {id, task, …}; posts
// {id, part, …} for each part of an answer, the last of them "done" or "failed".

import { Library, LibraryError } from "./library.js";

const MOST_LINKS_SHOWN = 4e6; // more than an answer may have
const STUDY = Array.from({ length: 17 }, (_, k) => 2 ** (1 - k / 2)); // ε from 2 to 1/128
const STUDY_MILLISECONDS = 1500;
const ERROR_SECONDS = 5;
const PROGRESS_MILLISECONDS = 100;
const LEAST_CELLS = 300;
const MOST_CELLS = 12000;
const COARSE = 3; // times wider cells of the first field of an exact answer

let library = null;

// Of a sketch: elements of a 32nd of a wall at the least, whose light is cheap to add up in the
// field, and an ε above that of an answer which nobody could tell from a better one.
const ROUGH = 1e-4;
const SKETCH = { levels: 5, tolerance: ROUGH };
const FINEST = 0.35;

// What fits into the time while walls are dragged: learned from one answer to the next.
const pace = { epsilon: 0.5, cells: 1500 };

/** Asks the library to stop at a time, and tells the page how far it is. */
function watch(id, deadline = Infinity) {
  let next = performance.now() + PROGRESS_MILLISECONDS;
  library.goOn = (phase, fraction) => {
    const now = performance.now();
    if (now > next) {
      next = now + PROGRESS_MILLISECONDS;
      postMessage({ id, part: "progress", phase, fraction });
    }
    return now < deadline;
  };
}

function solution(links) {
  return {
    account: library.account(),
    averages: library.averages(),
    elements: library.elements(),
    links: links ? library.links(MOST_LINKS_SHOWN) : new Uint32Array(0),
    exchange: links ? library.exchangeAreas(MOST_LINKS_SHOWN) : new Float64Array(0),
  };
}

/** A grid of about so many cells over a rectangle. */
function grid({ low, high }, cells, tolerance) {
  const width = high[0] - low[0];
  const height = high[1] - low[1];
  const columns = Math.max(8, Math.round(Math.sqrt((cells * width) / height)));
  const rows = Math.max(8, Math.round(cells / columns));
  return { low, high, columns, rows, tolerance };
}

function field(area, cells, tolerance) {
  const nodes = grid(area, cells, tolerance);
  return { ...nodes, ...library.field(nodes) };
}

/** Learns from what a step took, and from what it should take. */
function learn(took, allowed, value, power) {
  const factor = (allowed / Math.max(took, 0.1)) ** power;
  return value * Math.min(1.5, Math.max(0.4, factor));
}

/** A coarse solution that is ready within a third of the budget or so; its ε. */
function solveWithin(id, budget) {
  for (;;) {
    const start = performance.now();
    watch(id, start + 2 * budget);
    try {
      library.solveEpsilon("size", pace.epsilon, SKETCH);
      const epsilon = pace.epsilon;
      const took = performance.now() - start;
      // Time grows like L, which grows like ε⁻¹ here.
      pace.epsilon = Math.min(
        4,
        Math.max(FINEST, pace.epsilon / learn(took, budget / 3, 1, 0.5)),
      );
      return epsilon;
    } catch (error) {
      if (!error.stopped || pace.epsilon > 1e3) throw error;
      pace.epsilon *= 2;
    }
  }
}

/** What the program would be asked.  The error of the paper's algorithm comes after its picture. */
function optionsOf({ error, epsilon, oracle, mostLinks }) {
  // A value at a point is what makes the program measure the error at points.
  if (!epsilon) return [`--target-error=${error}`, "--at=0:0.5"];
  return [`--eps=${epsilon}`, `--oracle=${oracle}`, `--max-links=${mostLinks}`, "--no-error"];
}

const tasks = {
  /** The walls of a file.  Where patches cross they are cut, and the answer says so. */
  open({ id, text }) {
    let cuts = 0;
    watch(id);
    try {
      library.open(text);
    } catch (error) {
      cuts = library.open(text, true);
      if (!cuts) throw error;
    }
    return { ...library.scene(), cuts };
  },

  /** While a wall is dragged: an answer and its field within the budget, without its error. */
  sketch({ id, text, area, budget }) {
    const start = performance.now();
    watch(id);
    library.open(text);
    const epsilon = solveWithin(id, budget);
    const middle = performance.now();
    const answer = { ...solution(false), epsilon, images: library.images() };
    watch(id);
    answer.field = field(area, pace.cells, 0.05);
    const left = budget - (middle - start);
    pace.cells = learn(performance.now() - middle, Math.max(left, budget / 3), pace.cells, 0.7);
    pace.cells = Math.min(MOST_CELLS, Math.max(LEAST_CELLS, pace.cells));
    return answer;
  },

  /** While ε slides: N and L of this ε, and its links. */
  slide({ id, text, oracle, epsilon, budget }) {
    watch(id);
    library.open(text);
    watch(id, performance.now() + budget);
    library.solveEpsilon(oracle, epsilon, { tolerance: ROUGH });
    return solution(true);
  },

  /** The answer with its error, then its field, and the study of L against N. */
  exact({ id, text, method, area, cells }) {
    const start = performance.now();
    const post = (part, value) => postMessage({ id, part, ...value });
    watch(id);
    const document = library.solve(text, optionsOf(method));
    const measured = !method.epsilon;
    post("solution", {
      ...solution(true),
      document,
      scene: library.scene(),
      measured,
      seconds: (performance.now() - start) / 1000,
    });
    post("field", { field: field(area, cells / COARSE ** 2, 0.02) });
    post("field", { field: field(area, cells, 0.01) });
    if (method.epsilon) {
      library.measureError(1e-6, ERROR_SECONDS);
      post("account", { account: library.account() });
    }
    post("answered", {});
    watch(id, performance.now() + STUDY_MILLISECONDS);
    return library.study(method.oracle, STUDY);
  },
};

function fail(id, error) {
  const { message, stopped, unsupported } = error;
  // After any other error nobody knows what is in the memory of the library.
  const broken = !(error instanceof LibraryError);
  postMessage({ id, part: "failed", message, stopped, unsupported, broken });
}

onmessage = async ({ data }) => {
  if (data.module) {
    library = await Library.create(data.module);
    postMessage({ part: "ready" });
    return;
  }
  try {
    const answer = tasks[data.task](data);
    postMessage({ id: data.id, part: "done", ...answer });
  } catch (error) {
    fail(data.id, error);
  }
};
