// Parts and meshes, each in a worker of its own: so a run can be cancelled at any time, and the memory of what is closed
// is given back. Where the worker and the module come from, engine.js does not know: octafront.js does.
// The workbench alone (web/ui/module.js) has its runs in such workers.

/** What failed: `status` as of the command line (2 options, 3 input, 4 meshing, 6 memory), `report` the evidence. */
export class OctafrontError extends Error {
  constructor({ message, status, report }) {
    super(message);
    this.name = "OctafrontError";
    this.status = status;
    this.report = report;
  }
}

const aborted = (signal) => signal.reason ?? new DOMException("cancelled", "AbortError");

/** A worker and the calls that wait for it. */
export class Room {
  constructor(worker) {
    this.worker = worker;
    this.waiting = new Map();
    this.count = 0;
    worker.listen((message) => this.take(message), (error) => this.fail(error));
  }
  take({ id, result, error, progress }) {
    const call = this.waiting.get(id);
    if (!call) return;
    if (progress) return call.progress?.(progress.stage, progress.fraction < 0 ? null : progress.fraction);
    this.settle(id);
    if (error) call.reject(new OctafrontError(error));
    else call.resolve(result);
  }
  settle(id) {
    this.waiting.get(id)?.forget?.();
    this.waiting.delete(id);
    if (this.waiting.size === 0) this.worker.idle?.();
  }
  fail(error) {
    for (const [id, { reject }] of [...this.waiting]) {
      this.settle(id);
      reject(error);
    }
    this.close();
  }
  call(name, given = {}, { progress, signal, transfer = [] } = {}) {
    return new Promise((resolve, reject) => {
      if (this.closed) return reject(new Error("this part or mesh is closed"));
      if (signal?.aborted) return reject(aborted(signal));
      const id = ++this.count;
      // A worker cannot be interrupted, but ended.
      const abort = () => this.fail(aborted(signal));
      signal?.addEventListener("abort", abort);
      this.waiting.set(id, { resolve, reject, progress, forget: () => signal?.removeEventListener("abort", abort) });
      this.worker.busy?.();
      this.worker.post({ id, call: name, given }, transfer);
    });
  }
  close() {
    if (this.closed) return;
    this.closed = true;
    this.worker.end();
    for (const id of [...this.waiting.keys()]) {
      const { reject } = this.waiting.get(id);
      this.settle(id);
      reject(new Error("this part or mesh is closed"));
    }
  }
}

/** `compiled()`: a promise of the WebAssembly.Module; `start()`: a new worker, or a promise of one. */
export function createEngine({ compiled, start }) {
  let module = null, told = null;
  async function newRoom(signal) {
    module ??= compiled();
    const room = new Room(await start());
    try {
      await room.call("start", { compiled: await module }, { signal });
    } catch (error) {
      room.close();
      throw error;
    }
    return room;
  }

  class Part {
    #files;
    #intake;
    #room = null;
    constructor(files, intake, room, report) {
      this.#files = files;
      this.#intake = intake;
      this.#room = room;
      this.report = report;
    }
    /** Its worker, which a run takes for itself alone; after that, or when a cancel has ended it, a new one that reads the files again. */
    async #opened(given = {}, forItself = false) {
      if (!this.#files) throw new Error("this part is closed");
      const known = this.#room;
      if (known && !known.closed) {
        if (forItself) this.#room = null;
        return known;
      }
      const { room } = await openedRoom(this.#files, this.#intake, {}, given);
      if (!forItself) this.#keep(room);
      return room;
    }
    /** One is enough. */
    #keep(room) {
      if (this.#files && !room.closed && (!this.#room || this.#room.closed)) this.#room = room;
    }
    async array(name) {
      return (await this.#opened()).call("array", { of: "part", name });
    }
    async names(list) {
      return (await this.#opened()).call("names", { of: "part", list });
    }
    async estimate(options = {}, given = {}) {
      return (await this.#opened(given)).call("estimate", { options }, given);
    }
    /** A new mesh, which takes the worker along. */
    async mesh(options = {}, given = {}) {
      const room = await this.#opened(given, true);
      const inputs = this.#files?.map((file) => file.name) ?? [];
      let report;
      try {
        report = await room.call("generate", { options }, given);
      } catch (error) {
        this.#keep(room);
        if (this.#room !== room) room.close();
        throw error;
      }
      report.inputs = inputs;
      return new Mesh(room, report);
    }
    close() {
      this.#room?.close();
      this.#room = this.#files = null;
    }
  }

  class Mesh {
    #room;
    constructor(room, report) {
      this.#room = room;
      this.report = report;
    }
    array(name) {
      return this.#room.call("array", { of: "mesh", name });
    }
    names(list) {
      return this.#room.call("names", { of: "mesh", list });
    }
    write(name, options = {}, given = {}) {
      return this.#room.call("write", { name, options }, given);
    }
    page(report = {}, given = {}) {
      return this.#room.call("page", { report: { ...this.report, ...report } }, given);
    }
    memory() {
      return this.#room.call("memory");
    }
    close() {
      this.#room.close();
    }
  }

  async function openedRoom(files, intake, options, given) {
    const room = await newRoom(given.signal);
    try {
      return { room, report: await room.call("open", { files, intake, options }, given) };
    } catch (error) {
      room.close();
      throw error;
    }
  }

  /** {name, data} of a file of any kind. */
  async function bytesOf(file) {
    if (typeof Blob !== "undefined" && file instanceof Blob) return { name: file.name ?? "input", data: new Uint8Array(await file.arrayBuffer()) };
    const { name, data } = file ?? {};
    if (typeof name !== "string" || !(data instanceof Uint8Array || data instanceof ArrayBuffer))
      throw new TypeError("a file is a File, or {name, data: Uint8Array}");
    return { name, data: new Uint8Array(data) };
  }

  return {
    async open(files, intake = {}, given = {}) {
      const all = await Promise.all((Array.isArray(files) ? files : [files]).map(bytesOf));
      const { room, report } = await openedRoom(all, intake, given.options ?? {}, given);
      return new Part(all, intake, room, report);
    },
    info() {
      return (told ??= (async () => {
        const room = await newRoom();
        try {
          return await room.call("info");
        } finally {
          room.close();
        }
      })());
    },
  };
}

/** A browser's Worker as Room wants it. */
export function browserWorker(worker) {
  return {
    post: (message, transfer) => worker.postMessage(message, transfer),
    listen(take, fail) {
      worker.onmessage = (event) => take(event.data);
      worker.onerror = (event) => fail(new Error(event.message || "the worker could not be started"));
    },
    end: () => worker.terminate(),
  };
}
