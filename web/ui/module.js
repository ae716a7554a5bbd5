// --- module.js: the engine of the page alone: the program's commands as a WebAssembly module, which the page carries. Each run
// is a worker of its own, as it is a process of its own to the server: so it can be ended at any time.

/** Text in the page that web/ui/assemble.py packed: base64 of gzip. */
async function unpacked(id) {
  if (typeof DecompressionStream === "undefined") throw new Error("this page needs a browser of 2023 or later");
  const element = document.getElementById(id), bytes = Uint8Array.from(atob(element.textContent.trim()), (c) => c.charCodeAt(0));
  element.textContent = "";
  return new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"))).blob();
}
const once = (make) => {
  let made = null;
  return () => (made ??= make());
};
const compiled = once(async () => WebAssembly.compile(await (await unpacked("packed-module")).arrayBuffer()));
const workerAddress = once(async () => URL.createObjectURL(new Blob([await unpacked("packed-worker")], { type: "text/javascript" })));

/** What one worker answers to one call; it is ended with that, or by the signal. */
async function inWorker(call, given, how = {}) {
  const module = await compiled(), room = new Room(browserWorker(new Worker(await workerAddress())));
  try {
    return await room.call(call, { compiled: module, ...given }, how);
  } finally {
    room.close();
  }
}

/** What was opened, and what runs have left: Blobs by their paths. */
const files = new Map();
let runs = 0;
const isNamed = (path, text) => text.includes(JSON.stringify(path).slice(1, -1));

const engine = {
  takes: "STL, OBJ, NIfTI, a mesh …",
  where: "in this page: nothing leaves it. The program is faster, and reads CAD: octafront ui.",
  samples: [...document.querySelectorAll("[id^=packed-sample-]")].map(({ id, dataset }) => ({ title: dataset.title, file: once(async () => new File([await unpacked(id)], dataset.file)) })),

  about: () => inWorker("about"),
  async upload(file) {
    const path = "/files-of-page/" + file.name; // as cli/workbench_module.cpp has it
    files.set(path, new Blob([await file.arrayBuffer()])); // as it is now: the one on the disk may change
    return { name: file.name, path, bytes: file.size };
  },
  async run(tool, given, how = {}) {
    const number = String(++runs), text = JSON.stringify({ tool, arguments: given });
    const needed = [...files].filter(([path]) => isNamed(path, text)).map(([path, blob]) => ({ path, blob }));
    const { told, blobs } = await inWorker("run", { text, number, files: needed }, how);
    if (told.error) throw new RunError(told.error, told);
    told.files.forEach(({ path }, i) => files.set(path, blobs[i]));
    return told;
  },
  made: async (run, name) => new Response(files.get(`/made/${run}/${name}`)),
  stay() {},
};
