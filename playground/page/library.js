// SPDX-License-Identifier: GPL-3.0-or-later
// The library as an object with methods: glue.c and package.c, called through WebAssembly.

import { LibraryError, Module } from "./module.js";

export { LibraryError };

const MOST_STUDY_LINKS = 4e6;
const MOST_IMAGES = 4000;

export class Library extends Module {
  /** @param module  a compiled WebAssembly.Module */
  static async create(module) {
    const library = new Library();
    library.begin(await WebAssembly.instantiate(module, library.imports()));
    library.play = library.calls.play_create();
    return library;
  }

  check(status) {
    if (status) throw new LibraryError(status, this.text(this.calls.play_message(this.play)));
  }

  /** Takes the text of a scene file.  Returns the number of places where patches were cut. */
  open(text, cut = false) {
    return this.lend(4, (cuts) => {
      this.lendText(text, (at, size) =>
        this.check(this.calls.play_open(this.play, at, size, cut ? 1 : 0, cuts)),
      );
      return this.view().getUint32(cuts, true);
    });
  }

  /** The patches as {name, a, b, emission, reflectance, transmittance}, the background, and the
      first of their images between mirrors and in a period. */
  scene() {
    const { calls, play } = this;
    const count = calls.play_patches(play);
    const bands = calls.play_bands(play);
    const stride = 4 + 3 * bands;
    const all = this.numbers(count * stride, (at) => calls.play_walls(play, at));
    const patches = Array.from({ length: count }, (_, k) => {
      const v = all.subarray(k * stride, (k + 1) * stride);
      return {
        name: this.text(calls.play_name(play, k)),
        a: [v[0], v[1]],
        b: [v[2], v[3]],
        emission: [...v.subarray(4, 4 + bands)],
        reflectance: [...v.subarray(4 + bands, 4 + 2 * bands)],
        transmittance: [...v.subarray(4 + 2 * bands)],
      };
    });
    const background = Array.from({ length: bands }, (_, b) => calls.play_background(play, b));
    return { patches, bands, background, images: this.images() };
  }

  images() {
    const count = Math.min(MOST_IMAGES, this.calls.play_images_count(this.play));
    return this.numbers(4 * count, (at) => this.calls.play_images(this.play, at, count));
  }

  /** `hr2d solve` with some options; returns its document. */
  solve(text, options) {
    const words = ["hr2d", "solve", ...options, "scene"];
    const { calls } = this;
    this.lendText(text, (at, size) =>
      this.lendText(words.join("\0"), (line) => {
        const status = calls.package_solve(at, size, line, words.length);
        if (status) throw new LibraryError(status, this.text(calls.package_message()));
      }),
    );
    calls.play_take(this.play);
    const document = JSON.parse(this.text(calls.package_json()));
    calls.package_end();
    return document;
  }

  /** The paper's algorithm; 0 is the default of each limit. */
  solveEpsilon(oracle, epsilon, { levels = 0, mostLinks = 0, tolerance = 0 } = {}) {
    const { calls, play } = this;
    this.lendText(oracle, (name) =>
      this.check(calls.play_solve_epsilon(play, name, epsilon, levels, mostLinks, tolerance)),
    );
  }

  measureError(least, seconds) {
    this.check(this.calls.play_measure_error(this.play, least, seconds));
  }

  account() {
    const v = this.numbers(12, (at) => this.calls.play_account(this.play, at));
    const missed = v[11] !== 0;
    return {
      elements: v[0],
      leaves: v[1],
      links: v[2],
      order: v[3],
      gathers: v[4],
      average: { estimate: v[5], bound: v[6] },
      sup: { estimate: v[7], bound: v[8] },
      irradiance: { estimate: v[9], bound: v[10] },
      missed: missed ? this.text(this.calls.play_message(this.play)) : "",
    };
  }

  /** B and H of each patch and band. */
  averages() {
    const count = this.calls.play_patches(this.play) * this.calls.play_bands(this.play);
    return this.numbers(2 * count, (at) => this.calls.play_averages(this.play, at));
  }

  /** 6 + bands numbers for each element; see glue.c. */
  elements() {
    const count = this.calls.play_elements_count(this.play);
    const stride = 6 + this.calls.play_bands(this.play);
    return this.numbers(stride * count, (at) => this.calls.play_elements(this.play, at));
  }

  /** The elements of each link, at most `most` links. */
  links(most) {
    const count = Math.min(most, this.calls.play_links_count(this.play));
    return this.lend(8 * count, (at) => {
      this.calls.play_links(this.play, at, count);
      return new Uint32Array(this.calls.memory.buffer, at, 2 * count).slice();
    });
  }

  /** The exchange area of each link, of as many. */
  exchangeAreas(most) {
    const count = Math.min(most, this.calls.play_links_count(this.play));
    return this.numbers(count, (at) => this.calls.play_exchange_areas(this.play, at, count));
  }

  /** The mean radiosity at the nodes of a grid, and the place of each. */
  field({ low, high, columns, rows, tolerance }) {
    const count = columns * rows;
    const values = count * this.calls.play_bands(this.play);
    return this.lend(count, (place) => {
      const mean = this.numbers(values, (at) =>
        this.check(
          this.calls.play_field(
            this.play,
            ...low,
            ...high,
            columns,
            rows,
            tolerance,
            at,
            place,
          ),
        ),
      );
      return { mean, place: new Uint8Array(this.calls.memory.buffer, place, count).slice() };
    });
  }

  /** N and L for each ε, as far as they fit, and the slope of log L on log N. */
  study(oracle, epsilons) {
    return this.lendText(oracle, (name) =>
      this.lend(8 * epsilons.length, (eps) => {
        new Float64Array(this.calls.memory.buffer, eps, epsilons.length).set(epsilons);
        let done = 0;
        const v = this.numbers(2 * epsilons.length + 1, (at) => {
          done = this.calls.play_study(
            this.play,
            name,
            eps,
            epsilons.length,
            MOST_STUDY_LINKS,
            at,
          );
        });
        const rows = epsilons
          .slice(0, done)
          .map((epsilon, k) => ({ epsilon, elements: v[2 * k], links: v[2 * k + 1] }));
        return { rows, slope: v[2 * epsilons.length] };
      }),
    );
  }
}
