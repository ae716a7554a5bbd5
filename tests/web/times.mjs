// Prints docs/use/web.md's table: the package in Node beside the native program on one thread, in CPU seconds, which a busy machine
// changes least; the environment as of package_test.mjs.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { readFileSync } from "node:fs";
import { join, resolve } from "node:path";
import { pathToFileURL } from "node:url";

const { OCTAFRONT_PACKAGE, OCTAFRONT_PROGRAM, OCTAFRONT_SAMPLES } = process.env;
const { open } = await import(pathToFileURL(join(resolve(OCTAFRONT_PACKAGE), "octafront.js")));
const file = join(OCTAFRONT_SAMPLES, "torus_knot.ply");
const shown = (n) => n.toLocaleString("en-US", { maximumFractionDigits: n < 10 ? 2 : 0 });

console.log("| elements | native, one thread, CPU s | WebAssembly, CPU s | ratio | memory native, MB | memory of the module, MB |");
console.log("| --- | --- | --- | --- | --- | --- |");
for (const elements of process.argv.length > 2 ? process.argv.slice(2).map(Number) : [10000, 100000, 1000000]) {
  const run = spawnSync(OCTAFRONT_PROGRAM, ["mesh", file, "--elements", String(elements), "--threads", "1", "-q", "--json", "-", "-o", "/dev/null", "--format", "vtu"], { encoding: "utf8", maxBuffer: 1 << 28 });
  assert.equal(run.status, 0, run.stderr);
  const native = JSON.parse(run.stdout);
  const part = await open({ name: "torus_knot.ply", data: readFileSync(file) });
  const before = process.cpuUsage();
  const mesh = await part.mesh({ elements });
  const spent = process.cpuUsage(before), seconds = (spent.user + spent.system) / 1e6;
  assert.equal(mesh.report.hash, native.hash);
  console.log(`| ${shown(mesh.report.tets)} | ${shown(native.cpu_seconds)} | ${shown(seconds)} | ${(seconds / native.cpu_seconds).toFixed(2)} | ${shown(native.peak_memory_bytes / 1e6)} | ${shown((await mesh.memory()) / 1e6)} |`);
  mesh.close();
  part.close();
}
