// SPDX-License-Identifier: GPL-3.0-or-later
// The WebAssembly module: what it imports, and texts and arrays to and from its memory.  The page
// and the package of npm begin here.

const decoder = new TextDecoder();
const encoder = new TextEncoder();
const STOPPED = 1; // hr2d_status
const OUT_OF_MEMORY = 2;
const UNSUPPORTED = 9;
const MOST_BYTES = 2 ** 31 - 1; // an address and a size have 32 bits

/** A call that failed, with the sentence of the library. */
export class LibraryError extends Error {
  constructor(status, message) {
    super(message);
    this.status = status;
    this.stopped = status === STOPPED;
    this.unsupported = status === UNSUPPORTED;
  }
}

export class Module {
  /** Whether to go on; called with the phase and the part of it that is done. */
  goOn = () => true;

  begin(instance) {
    this.calls = instance.exports;
    this.calls._initialize();
  }

  /** What the module imports.  There are no files, so that nothing is written anywhere. */
  imports() {
    const clock = (id, precision, out) => {
      this.view().setBigUint64(out, BigInt(Math.round(performance.now() * 1e6)), true);
      return 0;
    };
    const no_file = () => 8; // EBADF of WASI
    const empty_environment = (count, size) => {
      this.view().setUint32(count, 0, true);
      this.view().setUint32(size, 0, true);
      return 0;
    };
    return {
      env: {
        go_on: (phase, fraction) => (this.goOn(this.text(phase), fraction) ? 1 : 0),
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

  view() {
    return new DataView(this.calls.memory.buffer);
  }

  text(at) {
    const bytes = new Uint8Array(this.calls.memory.buffer);
    return decoder.decode(bytes.slice(at, bytes.indexOf(0, at)));
  }

  /** Calls use(address) with memory of so many bytes, and frees it. */
  lend(bytes, use) {
    const at = bytes <= MOST_BYTES ? this.calls.play_allocate(bytes) : 0;
    if (!at) throw new LibraryError(OUT_OF_MEMORY, "out of memory");
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

  /** Calls use(address, size) with bytes that a zero ends, which does not count. */
  lendBytes(bytes, use) {
    return this.lend(bytes.length + 1, (at) => {
      const memory = new Uint8Array(this.calls.memory.buffer);
      memory.set(bytes, at);
      memory[at + bytes.length] = 0;
      return use(at, bytes.length);
    });
  }

  lendText(text, use) {
    return this.lendBytes(encoder.encode(text), use);
  }
}
