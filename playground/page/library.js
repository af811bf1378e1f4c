// SPDX-License-Identifier: GPL-3.0-or-later
// The library as an object with methods: glue.c, called through WebAssembly.

const decoder = new TextDecoder();
const encoder = new TextEncoder();
const STOPPED = 1; // hr2d_status
const MOST_STUDY_LINKS = 4e6;

/** A call that failed, with the sentence of the library. */
export class LibraryError extends Error {
  constructor(status, message) {
    super(message);
    this.status = status;
    this.stopped = status === STOPPED;
  }
}

/** What the module imports.  There are no files, so that nothing is written anywhere. */
function imports(library) {
  const clock = (id, precision, out) => {
    library.view().setBigUint64(out, BigInt(Math.round(performance.now() * 1e6)), true);
    return 0;
  };
  const no_file = () => 8; // EBADF of WASI
  const empty_environment = (count, size) => {
    library.view().setUint32(count, 0, true);
    library.view().setUint32(size, 0, true);
    return 0;
  };
  return {
    env: {
      go_on: (phase, fraction) => (library.goOn(library.text(phase), fraction) ? 1 : 0),
      emscripten_notify_memory_growth: () => {},
    },
    wasi_snapshot_preview1: {
      clock_time_get: clock,
      environ_get: () => 0,
      environ_sizes_get: empty_environment,
      fd_close: no_file,
      fd_seek: no_file,
      fd_write: no_file,
      proc_exit: (code) => {
        throw new Error(`the library ended with ${code}`);
      },
    },
  };
}

export class Library {
  /** @param module  a compiled WebAssembly.Module */
  static async create(module) {
    const library = new Library();
    const instance = await WebAssembly.instantiate(module, imports(library));
    library.calls = instance.exports;
    library.calls._initialize();
    library.play = library.calls.play_create();
    library.goOn = () => true;
    return library;
  }

  view() {
    return new DataView(this.calls.memory.buffer);
  }

  text(at) {
    const bytes = new Uint8Array(this.calls.memory.buffer);
    return decoder.decode(bytes.slice(at, bytes.indexOf(0, at)));
  }

  /** Calls use(address) with memory of so many bytes, and frees it. */
  lend(bytes, use) {
    const at = this.calls.play_allocate(bytes);
    if (!at) throw new LibraryError(2, "out of memory");
    try {
      return use(at);
    } finally {
      this.calls.play_release(at);
    }
  }

  /** The `count` numbers that write(address) writes, copied. */
  numbers(count, write) {
    return this.lend(8 * count, (at) => {
      write(at);
      return new Float64Array(this.calls.memory.buffer, at, count).slice();
    });
  }

  lendText(text, use) {
    const bytes = encoder.encode(text + "\0");
    return this.lend(bytes.length, (at) => {
      new Uint8Array(this.calls.memory.buffer).set(bytes, at);
      return use(at, bytes.length - 1);
    });
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

  /** The patches as {name, a, b, emission, reflectance, transmittance}, and the background. */
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
    return { patches, bands, background };
  }

  solveTo(error) {
    this.check(this.calls.play_solve_to(this.play, error));
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
