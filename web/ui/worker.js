// The worker of the page alone: one run of the program's commands (cli/workbench_module.h), then it is ended. Follows the script
// of the module in one file.

/* global createOctafrontWorkbench */
(() => {
  "use strict";
  const MOST_SAID = 1 << 16, PAUSE = 40; // characters; milliseconds between two words on how far it is
  let module = null, listening = 0, errors = "", told = { stage: "", at: 0 };

  /** A line of standard error: progress, as OCTAFRONT_PROGRESS=lines has it, or a complaint. */
  function hear(line) {
    if (!line.startsWith("\x1f")) return errors.length < MOST_SAID && (errors += line + "\n");
    const [stage, fraction] = line.slice(1).split("\t"), now = performance.now();
    if (stage === told.stage && now - told.at < PAUSE) return;
    told = { stage, at: now };
    self.postMessage({ id: listening, progress: { stage, fraction: Number(fraction) } });
  }
  const asked = (name, ...texts) => JSON.parse(module.ccall("octafront_workbench_" + name, "string", texts.map(() => "string"), texts).replaceAll("/files-of-page/", ""));

  async function start(compiled) {
    module = await createOctafrontWorkbench({
      instantiateWasm(imports, done) {
        WebAssembly.instantiate(compiled, imports).then((instance) => done(instance));
        return {};
      },
      print: () => {},
      printErr: hear,
    });
  }
  async function put({ path, blob }) {
    const data = new Uint8Array(await blob.arrayBuffer());
    module.FS.mkdirTree(path.slice(0, path.lastIndexOf("/")));
    module.FS.writeFile(path, data);
  }
  function runLines(count) {
    for (let i = 0; i < count; ++i) {
      errors = "";
      if (module.ccall("octafront_workbench_line", "number", [], []) !== 0) return;
    }
  }

  const calls = {
    about: () => asked("about"),
    async run({ text, number, files }) {
      for (const file of files) await put(file);
      const begun = asked("begin", text, number);
      if (begun.error) return { told: begun };
      runLines(begun.lines);
      const ended = asked("end", errors);
      return { told: ended, blobs: ended.files.map(({ path }) => new Blob([module.FS.readFile(path)])) };
    },
  };

  /** What went wrong in words that can be sent; what is no failure of the program is one of the machine or a bug. */
  function described(error) {
    const isMemory = error instanceof RangeError || /memory|allocat/i.test(String(error?.message));
    return { message: isMemory ? "out of memory; ask for fewer elements (`elements`, `size`)" : `unexpected error, which is a bug of ours: ${error?.message ?? error}` };
  }

  self.onmessage = async ({ data: { id, call, given } }) => {
    listening = id;
    try {
      await start(given.compiled);
      self.postMessage({ id, result: await calls[call](given) });
    } catch (error) {
      self.postMessage({ id, error: described(error) });
    }
  };
})();
