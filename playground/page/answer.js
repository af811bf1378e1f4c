// SPDX-License-Identifier: GPL-3.0-or-later
// An answer of the library: its elements as trees, and the links of one of them.

import { foot } from "./geojson.js";

export class Answer {
  /** @param parts  what worker.js posts as a solution */
  constructor(parts, bands) {
    Object.assign(this, parts);
    this.bands = bands;
    this.stride = 6 + bands;
    this.count = this.elements.length / this.stride;
    this.patches = this.averages.length / (2 * bands);
    this.findParents();
  }

  findParents() {
    this.parent = new Uint32Array(this.count).map((_, k) => k);
    for (let k = 0; k < this.count; k++) {
      const child = this.child(k);
      if (child) this.parent[child] = this.parent[child + 1] = k;
    }
  }

  child(element) {
    return this.elements[element * this.stride + 5];
  }

  patch(element) {
    return this.elements[element * this.stride + 4];
  }

  /** B of an element in a band. */
  value(element, band) {
    return this.elements[element * this.stride + 6 + band];
  }

  /** B or H of a patch: which is 0 or 1. */
  average(patch, band, which = 0) {
    return this.averages[2 * (patch * this.bands + band) + which];
  }

  segment(element) {
    const at = element * this.stride;
    const e = this.elements;
    return { a: [e[at], e[at + 1]], b: [e[at + 2], e[at + 3]] };
  }

  length(element) {
    const { a, b } = this.segment(element);
    return Math.hypot(b[0] - a[0], b[1] - a[1]);
  }

  /** The leaf next to a point, within a distance, or -1; of two back to back the one in front. */
  leafAt(point, within) {
    let best = -1;
    let least = within;
    for (let k = 0; k < this.count; k++) {
      if (this.child(k)) continue;
      const s = this.segment(k);
      const p = foot(s, point);
      const d = Math.hypot(p[0] - point[0], p[1] - point[1]);
      const front =
        (s.b[0] - s.a[0]) * (point[1] - s.a[1]) - (s.b[1] - s.a[1]) * (point[0] - s.a[0]);
      if (d < least || (d === least && front > 0)) [best, least] = [k, d];
    }
    return best;
  }

  /** All elements without children. */
  leaves() {
    return Array.from({ length: this.count }, (_, k) => k).filter((k) => !this.child(k));
  }

  /** The leaves of a patch from its start to its end. */
  leavesOf(patch) {
    const leaves = [];
    const stack = [patch];
    while (stack.length) {
      const k = stack.pop();
      const child = this.child(k);
      if (child) stack.push(child + 1, child);
      else leaves.push(k);
    }
    return leaves;
  }

  /** An element and all that it is a part of. */
  path(element) {
    const path = [element];
    while (this.parent[path.at(-1)] !== path.at(-1)) path.push(this.parent[path.at(-1)]);
    return path;
  }

  /** The links over which light comes to an element, as [near, far]. */
  linksOf(path) {
    const on = new Set(path);
    const found = [];
    for (let k = 0; k < this.links.length; k += 2) {
      if (on.has(this.links[k])) found.push([this.links[k], this.links[k + 1]]);
      else if (on.has(this.links[k + 1])) found.push([this.links[k + 1], this.links[k]]);
    }
    return found;
  }
}
