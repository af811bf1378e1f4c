// SPDX-License-Identifier: GPL-3.0-or-later
// Two workers.  One answers fast while something moves: of the sketches that wait for it only the
// last one counts.  The other one computes exact answers, and is replaced when nobody wants its
// answer any more: a call of the library cannot hear a message before it ends.

/** A worker and the one job that it has. */
class Thread {
  constructor(module) {
    this.module = module;
    this.ids = 0;
    this.start();
  }

  start() {
    this.worker = new Worker(new URL("./worker.js", import.meta.url), { type: "module" });
    this.worker.postMessage({ module: this.module });
    this.worker.onmessage = ({ data }) => this.receive(data);
    this.worker.onerror = (event) => {
      if (this.job) this.receive({ id: this.job.id, part: "failed", message: event.message });
    };
    this.job = null;
  }

  /** Sends a job; `receive` gets each part of the answer. */
  send(message, receive) {
    this.job = { id: ++this.ids, receive };
    this.worker.postMessage({ ...message, id: this.job.id });
  }

  receive(data) {
    if (!this.job || data.id !== this.job.id) return;
    const { receive } = this.job;
    if (data.part === "done" || data.part === "failed") this.job = null;
    if (data.broken) {
      this.worker.terminate();
      this.start();
    }
    receive(data);
  }

  cancel() {
    if (!this.job) return;
    this.worker.terminate();
    this.start();
  }
}

export class Engine {
  /** @param url  of the WebAssembly module */
  static async create(url) {
    const answer = await fetch(url);
    if (!answer.ok) throw new Error(`${url}: ${answer.status} ${answer.statusText}`);
    const engine = new Engine();
    const module = await WebAssembly.compile(await answer.arrayBuffer());
    engine.fast = new Thread(module);
    engine.slow = new Thread(module);
    engine.asked = [];
    engine.waiting = null;
    return engine;
  }

  /** The answer of a fast job that is never forgotten. */
  ask(message) {
    return new Promise((resolve, reject) => {
      const receive = (data) => {
        if (data.part === "done") resolve(data);
        if (data.part === "failed") reject(new Error(data.message));
      };
      this.asked.push({ message, receive, lasting: true });
      this.next();
    });
  }

  /** A fast job; one that has not begun when the next one comes is forgotten. */
  sketch(message, receive) {
    this.waiting = { message, receive };
    this.next();
  }

  next() {
    if (this.fast.job) return;
    const job = this.asked.shift() ?? this.waiting;
    if (!job) return;
    if (job === this.waiting) this.waiting = null;
    this.current = job;
    this.fast.send(job.message, (data) => {
      job.receive(data);
      if (!this.fast.job) this.next();
    });
  }

  /** Forgets the sketches, which would come after something better. */
  settle() {
    this.waiting = null;
    if (this.fast.job && !this.current.lasting) this.current.receive = () => {};
  }

  /** An exact job, in the place of the one that may be running. */
  exact(message, receive) {
    this.slow.cancel();
    this.slow.send(message, receive);
  }

  stop() {
    this.slow.cancel();
  }
}
