// The worker: it owns one module, in it one part and one mesh, and does one call after another. Follows the script of the
// module in one file (octafront-worker.js), which both browsers and Node run. The other side of it is engine.js.

/* global createOctafront */
(async () => {
  "use strict";
  const DONE = 0, END = 1, PROGRESS = 2, USAGE = 2, INTERNAL = 1; // octafront_c.h
  const F64 = 1, EVENT_BYTES = 72; // the latter is held by module.cpp
  const port = await openPort();
  let module = null, part = 0, mesh = 0, sizes = 0, watcher = 0, listening = 0, told = { stage: "", at: 0 };

  /** A browser's worker is its own port; Node's has one elsewhere, and lacks what the module's script asks for. */
  async function openPort() {
    if (typeof WorkerGlobalScope !== "undefined") {
      return { post: (message, transfer) => self.postMessage(message, transfer), listen: (take) => (self.onmessage = (event) => take(event.data)) };
    }
    const { parentPort } = await import("node:worker_threads");
    globalThis.self ??= globalThis;
    globalThis.location ??= { href: "" };
    return { post: (message, transfer) => parentPort.postMessage(message, transfer), listen: (take) => parentPort.on("message", take) };
  }

  class Failure extends Error {
    constructor(message, status, report = {}) {
      super(message);
      this.status = status;
      this.report = report;
    }
  }

  const api = (name, ...given) => module["_octafront_" + name](...given);
  const textAt = (pointer) => module.UTF8ToString(pointer >>> 0);
  const jsonOf = (name) => JSON.parse(textAt(api(name)));

  /** `use` with these texts in the module's memory; null stays null. */
  function withTexts(texts, use) {
    const pointers = texts.map((text) => {
      if (text === null) return 0;
      const size = module.lengthBytesUTF8(text) + 1, pointer = allocated(size);
      module.stringToUTF8(text, pointer, size);
      return pointer;
    });
    try {
      return use(...pointers);
    } finally {
      for (const pointer of pointers) module._free(pointer);
    }
  }
  function allocated(size) {
    const pointer = module._malloc(size) >>> 0;
    if (pointer === 0) throw new Failure("out of memory", 6);
    return pointer;
  }
  const view = () => new DataView(module.HEAPU8.buffer);

  // --- jobs

  function watch(data, event) {
    if (view().getInt32(event, true) !== PROGRESS) return;
    const stage = textAt(view().getUint32(event + 4, true)), now = performance.now();
    if (stage === told.stage && now - told.at < 40) return;
    told = { stage, at: now };
    port.post({ id: listening, progress: { stage, fraction: view().getFloat64(event + 8, true) } });
  }

  /** Waits for a job; what it leaves is taken by `take`. Returns its report. */
  function finish(job, take = () => {}) {
    if (!job) throw new Failure(textAt(api("last_error")), INTERNAL);
    const event = allocated(EVENT_BYTES);
    try {
      told = { stage: "", at: 0 };
      api("job_watch", job, watcher, 0);
      while (api("job_wait", job, -1, event) !== END);
      const status = api("job_status", job), report = JSON.parse(textAt(api("job_report", job)));
      if (status !== DONE) throw new Failure(textAt(api("job_message", job)), status, report);
      take(job);
      return report;
    } finally {
      module._free(event);
      api("job_free", job);
    }
  }
  function withOptions(options, use) {
    const pointer = api("options_new");
    try {
      if (withTexts([JSON.stringify(options)], (text) => api("options_set", pointer, text)) !== 0)
        throw new Failure(textAt(api("last_error")), USAGE);
      return use(pointer);
    } finally {
      api("options_free", pointer);
    }
  }

  // --- arrays and names

  /** A copy of an array: of a part or a mesh. */
  function arrayOf(kind, owner, name) {
    const out = allocated(16);
    try {
      if (withTexts([name], (text) => api(kind + "_array", owner, text, out)) !== 0) throw new Failure(textAt(api("last_error")), USAGE);
      const data = view().getUint32(out, true), rows = view().getUint32(out + 4, true), columns = view().getUint32(out + 8, true);
      const Type = view().getUint32(out + 12, true) === F64 ? Float64Array : Uint32Array;
      return new Type(module.HEAPU8.buffer, data, rows * columns).slice();
    } finally {
      module._free(out);
    }
  }
  function namesOf(kind, owner, list) {
    const length = allocated(4), names = [];
    try {
      for (;;) {
        const name = withTexts([list], (text) => api(kind + "_name", owner, text, names.length, length));
        if (!name) return names;
        names.push(textAt(name));
      }
    } finally {
      module._free(length);
    }
  }
  function need(pointer, what) {
    if (!pointer) throw new Failure(`there is no ${what}`, USAGE);
    return pointer;
  }

  // --- files, in the module's memory

  const baseOf = (name) => name.split(/[\\/]/).pop() || "input";
  function emptyFolder(folder) {
    const { FS } = module;
    if (FS.analyzePath(folder).exists) {
      for (const name of FS.readdir(folder)) {
        if (name === "." || name === "..") continue;
        const path = folder + "/" + name;
        if (FS.isDir(FS.stat(path).mode)) emptyFolder(path), FS.rmdir(path);
        else FS.unlink(path);
      }
    } else FS.mkdir(folder);
  }
  /** Each in a folder of its own, for names need not differ. */
  function putFiles(files) {
    emptyFolder("/in");
    return files.map(({ name, data }, i) => {
      module.FS.mkdir(`/in/${i}`);
      const path = `/in/${i}/${baseOf(name)}`;
      module.FS.writeFile(path, data);
      return path;
    });
  }
  function takeFiles(folder, prefix = "") {
    const { FS } = module, files = [];
    for (const name of FS.readdir(folder)) {
      if (name === "." || name === "..") continue;
      const path = folder + "/" + name;
      if (FS.isDir(FS.stat(path).mode)) files.push(...takeFiles(path, prefix + name + "/"));
      else files.push({ name: prefix + name, data: FS.readFile(path) });
    }
    return files;
  }
  const buffersOf = (files) => [...new Set(files.map((file) => file.data.buffer))];

  // --- what the other side may call: each returns its result, and what of it is handed over

  const calls = {
    async start({ compiled }) {
      module = await createOctafront({
        instantiateWasm(imports, done) {
          WebAssembly.instantiate(compiled, imports).then((instance) => done(instance));
          return {};
        },
        print: () => {},
        printErr: () => {},
      });
      watcher = module.addFunction(watch, "vii");
      return [null];
    },
    info() {
      return [{ version: textAt(api("version")), formats: jsonOf("formats"), options: jsonOf("option_table"), intake: jsonOf("intake_table"), units: jsonOf("units") }];
    },
    open({ files, intake, options }) {
      const paths = putFiles(files);
      const list = allocated(4 * paths.length);
      try {
        const report = withOptions(options, (meant) => withTexts([JSON.stringify(intake), ...paths], (text, ...pointers) => {
          pointers.forEach((pointer, i) => view().setUint32(list + 4 * i, pointer, true));
          return finish(api("open_files", list, paths.length, text, meant, 1), (job) => (part = api("job_take_surface", job)));
        }));
        return [report];
      } finally {
        module._free(list);
        emptyFolder("/in");
      }
    },
    estimate({ options }) {
      return [withOptions(options, (given) => finish(api("generate_sizes", need(part, "part"), given, 1), (job) => api("sizes_free", api("job_take_sizes", job))))];
    },
    generate({ options }) {
      const report = withOptions(options, (given) => finish(api("generate", need(part, "part"), given, 1), (job) => {
        api("mesh_free", mesh);
        api("sizes_free", sizes);
        mesh = api("job_take_mesh", job);
        sizes = api("job_take_sizes", job);
      }));
      // Its memory is for what follows.
      api("surface_free", part);
      part = 0;
      return [report];
    },
    array({ of, name }) {
      const values = arrayOf(of === "mesh" ? "mesh" : "surface", need(of === "mesh" ? mesh : part, of), name);
      return [values, [values.buffer]];
    },
    names({ of, list }) {
      return [namesOf(of === "mesh" ? "mesh" : "surface", need(of === "mesh" ? mesh : part, of), list)];
    },
    write({ name, options }) {
      emptyFolder("/out");
      const report = withTexts([`/out/${baseOf(name)}`, JSON.stringify(options)], (file, text) => finish(api("write_mesh", need(mesh, "mesh"), file, text)));
      const files = takeFiles("/out");
      emptyFolder("/out");
      return [{ files, notes: report.notes ?? [] }, buffersOf(files)];
    },
    page({ report }) {
      emptyFolder("/out");
      withTexts([JSON.stringify(report), "/out/page.html"], (text, file) => finish(api("write_page", need(mesh, "mesh"), sizes, text, file)));
      const [{ data }] = takeFiles("/out");
      emptyFolder("/out");
      return [data, [data.buffer]];
    },
    memory() {
      return [module.HEAPU8.length];
    },
  };

  /** What went wrong in words that can be sent; what is no failure of ours is one of the machine or a bug. */
  function described(error) {
    if (error instanceof Failure) return { message: error.message.replace(/\/in\/\d+\//g, ""), status: error.status, report: error.report };
    const isMemory = error instanceof RangeError || /memory|allocat/i.test(String(error?.message));
    return { message: isMemory ? "out of memory; ask for fewer elements (`elements`, `size`)" : `unexpected error, which is a bug of ours: ${error?.message ?? error}`, status: isMemory ? 6 : INTERNAL, report: {} };
  }

  let last = Promise.resolve();
  port.listen(({ id, call, given }) => {
    last = last.then(async () => {
      listening = id;
      try {
        const [result, transfer = []] = await calls[call](given);
        port.post({ id, result }, transfer);
      } catch (error) {
        port.post({ id, error: described(error) });
      }
    });
  });
})();
