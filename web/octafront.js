// The package as an ES module, for browsers and Node: finds the module and the worker beside itself.
import { OctafrontError, browserWorker, createEngine } from "./engine.js";

const isNode = typeof process !== "undefined" && process.versions?.node !== undefined && typeof window === "undefined";

async function compiled() {
  const address = new URL("./octafront.wasm", import.meta.url);
  if (isNode) {
    const { readFile } = await import("node:fs/promises");
    return WebAssembly.compile(await readFile(address));
  }
  const answer = await fetch(address);
  if (!answer.ok) throw new Error(`${address} cannot be loaded: ${answer.status}`);
  return WebAssembly.compile(await answer.arrayBuffer());
}

/** One that lets the process end while nothing waits for it. */
async function nodeWorker() {
  const { Worker } = await import("node:worker_threads");
  const worker = new Worker(new URL("./octafront-worker.js", import.meta.url));
  worker.unref();
  return {
    post: (message, transfer) => worker.postMessage(message, transfer),
    listen(take, fail) {
      worker.on("message", take);
      worker.on("error", fail);
    },
    end: () => void worker.terminate(),
    busy: () => worker.ref(),
    idle: () => worker.unref(),
  };
}

const engine = createEngine({
  compiled,
  start: () => (isNode ? nodeWorker() : browserWorker(new Worker(new URL("./octafront-worker.js", import.meta.url)))),
});

export const open = engine.open;
export const info = engine.info;
export { OctafrontError };
