// The npm package in Node, beside the native program: node --test tests/web/package_test.mjs, with OCTAFRONT_PACKAGE (its
// folder), OCTAFRONT_PROGRAM and OCTAFRONT_SAMPLES in the environment, as scripts/web.sh sets them.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join, resolve } from "node:path";
import { after, test } from "node:test";
import { pathToFileURL } from "node:url";

const { OCTAFRONT_PACKAGE, OCTAFRONT_PROGRAM, OCTAFRONT_SAMPLES } = process.env;
const { OctafrontError, info, open } = await import(pathToFileURL(join(resolve(OCTAFRONT_PACKAGE), "octafront.js")));
const scratch = mkdtempSync(join(tmpdir(), "octafront-web-"));
after(() => rmSync(scratch, { recursive: true }));

const sample = (name) => ({ name, data: readFileSync(join(OCTAFRONT_SAMPLES, name)) });
function native(...given) {
  const run = spawnSync(OCTAFRONT_PROGRAM, given, { encoding: "utf8", maxBuffer: 1 << 28 });
  assert.equal(run.status, 0, run.stderr);
  return run.stdout;
}
const flags = (options) => Object.entries(options).flatMap(([name, value]) => ["--" + name.replaceAll("_", "-"), ...(value === true ? [] : [String(value)])]);
const nativeReport = (names, options) =>
  JSON.parse(native("mesh", ...names.map((name) => join(OCTAFRONT_SAMPLES, name)), ...flags(options), "-q", "--json", "-", "-o", "/dev/null", "--format", "vtu"));

const CASES = [
  [["bracket.stl"], {}],
  [["bracket.stl"], { patches: true, size: 3 }],
  [["gear.obj"], { order: 2, size: 2 }],
  [["torus_knot.ply"], { elements: 20000 }],
  [["gyroid.ply"], { elements: 20000, improve: "best" }],
  [["shell.off"], { keep_surface: true }],
  [["bracket.stl"], { method: "octree" }],
  [["bracket.stl"], { method: "recover", keep_surface: true }],
  [["bracket.stl", "gear.obj"], { size: 4 }],
  [["head_labels.nii.gz"], { size: 8 }],
  [["bracket.stl"], { layers: 3, first: 0.1, size: 3 }],
];
for (const [names, options] of CASES) {
  test(`the same mesh as the native program: ${names} ${JSON.stringify(options)}`, async () => {
    const part = await open(names.map(sample), {}, { options }), mesh = await part.mesh(options);
    const expected = nativeReport(names, options);
    assert.equal(mesh.report.hash, expected.hash);
    assert.equal(mesh.report.tets, expected.tets);
    assert.equal((await mesh.array("tets")).length, 4 * expected.tets);
    mesh.close();
    part.close();
  });
}

test("arrays are the mesh: volumes add up to the input's", async () => {
  const part = await open(sample("bracket.stl")), mesh = await part.mesh({ size: 3 });
  const [points, tets] = [await mesh.array("points"), await mesh.array("tets")];
  let volume = 0;
  for (let t = 0; t < tets.length; t += 4) {
    const [a, b, c, d] = [0, 1, 2, 3].map((i) => points.subarray(3 * tets[t + i], 3 * tets[t + i] + 3));
    const [u, v, w] = [b, c, d].map((p) => p.map((x, i) => x - a[i]));
    const det = u[0] * (v[1] * w[2] - v[2] * w[1]) - u[1] * (v[0] * w[2] - v[2] * w[0]) + u[2] * (v[0] * w[1] - v[1] * w[0]);
    assert.ok(det > 0);
    volume += det / 6;
  }
  assert.ok(Math.abs(volume / mesh.report.volume - 1) < 1e-9);
  await assert.rejects(mesh.array("nonsense"), OctafrontError);
  mesh.close();
  await assert.rejects(mesh.array("points"), /closed/);
  part.close();
});

test("arrays and names that the types promise are there", async () => {
  const types = readFileSync(join(OCTAFRONT_PACKAGE, "octafront.d.ts"), "utf8");
  const part = await open(sample("bracket.stl")), mesh = await part.mesh({ size: 6, order: 2 });
  for (const [kind, thing] of [["Part", part], ["Mesh", mesh]]) {
    const declared = types.match(new RegExp(`export interface ${kind} {[^}]*(?:{[^}]*}[^}]*)*\n}`))[0];
    for (const [, list, type] of declared.matchAll(/array\(\s*name: ([^)]*?),?\s*\): Promise<(\w+)>/g)) {
      for (const [, name] of list.matchAll(/"(\w+)"/g)) assert.equal((await thing.array(name)).constructor.name, type, `${kind}: ${name}`);
    }
    const lists = [...declared.match(/names\(list: ([^)]*)\)/)[1].matchAll(/"(\w+)"/g)];
    assert.ok(lists.length >= 2);
    for (const [, list] of lists) assert.ok(Array.isArray(await thing.names(list)), `${kind}: ${list}`);
    thing.close();
  }
});

test("every format that can be written is, byte for byte as by the native program, and read again by it where it reads it", async () => {
  const { formats } = await info();
  const part = await open(sample("bracket.stl")), mesh = await part.mesh({ size: 6 });
  const writable = formats.filter((format) => format.writes_mesh);
  assert.ok(writable.length >= 12);
  for (const format of writable) {
    const ending = format.name === "msh22" ? ".msh" : format.endings.split(" ")[0];
    const { files } = await mesh.write("part" + ending, { format: format.name });
    assert.ok(files.length > 0 && files.every((file) => file.data.length > 0), format.name);
    const folder = join(scratch, format.name);
    for (const file of files) {
      mkdirSync(dirname(join(folder, file.name)), { recursive: true });
      writeFileSync(join(folder, file.name), file.data);
    }
    mkdirSync(join(folder, "native"));
    native("mesh", join(OCTAFRONT_SAMPLES, "bracket.stl"), "--size", "6", "-q", "--format", format.name, "-o", join(folder, "native", "part" + ending));
    for (const file of files) assert.ok(readFileSync(join(folder, "native", file.name)).equals(Buffer.from(file.data)), `${format.name}: ${file.name}`);
    if (!format.reads_mesh) continue;
    const target = join(folder, "again.vtu");
    const main = files.find((file) => file.name === "part" + ending) ?? files[0];
    native("convert", join(folder, main.name), "-o", target, "-q");
    assert.match(native("info", target), new RegExp(String(mesh.report.tets).replace(/(?=(...)+$)/g, "[ ,\u202f']?")), format.name);
  }
  mesh.close();
  part.close();
});

test("tells of stages as they go on", async () => {
  const told = [];
  const part = await open(sample("torus_knot.ply")), mesh = await part.mesh({ elements: 20000 }, { progress: (...now) => told.push(now) });
  const stages = new Set(told.map(([stage]) => stage));
  assert.ok(stages.size >= 4, [...stages].join());
  assert.ok(told.some(([, fraction]) => fraction > 0 && fraction < 1));
  assert.ok(told.every(([, fraction]) => fraction === null || (fraction >= 0 && fraction <= 1)));
  mesh.close();
  part.close();
});

test("a run can be cancelled at once, and the part meshed afterwards", async () => {
  const part = await open(sample("torus_knot.ply")), stop = new AbortController();
  let cancelled = 0;
  const run = part.mesh({ elements: 2000000 }, {
    signal: stop.signal,
    progress: () => {
      if (cancelled) return;
      cancelled = performance.now();
      stop.abort();
    },
  });
  await assert.rejects(run, { name: "AbortError" });
  assert.ok(performance.now() - cancelled < 1000);
  await assert.rejects(part.mesh({}, { signal: AbortSignal.abort() }), { name: "AbortError" });
  const mesh = await part.mesh({ elements: 20000 });
  assert.equal(mesh.report.hash, nativeReport(["torus_knot.ply"], { elements: 20000 }).hash);
  mesh.close();
  part.close();
});

test("what is wrong is said, and nothing is broken by it", async () => {
  await assert.rejects(open({ name: "part.stl", data: new TextEncoder().encode("nothing of the kind") }), (error) => error instanceof OctafrontError && error.status === 3 && /part\.stl/.test(error.message));
  await assert.rejects(open([]), OctafrontError);
  await assert.rejects(open("part.stl"), TypeError);
  const part = await open(sample("bracket.stl"));
  await assert.rejects(part.mesh({ sise: 3 }), (error) => error instanceof OctafrontError && error.status === 2 && /sise/.test(error.message));
  await assert.rejects(part.mesh({ size: -1 }), (error) => error.status === 2);
  const mesh = await part.mesh({ size: 6 });
  assert.equal(mesh.report.hash, nativeReport(["bracket.stl"], { size: 6 }).hash);
  mesh.close();
  part.close();
  await assert.rejects(part.mesh(), /closed/);
});

test("several parts and meshes at a time, each for itself", async () => {
  const [a, b] = await Promise.all([open(sample("bracket.stl")), open(sample("gear.obj"))]);
  const meshes = await Promise.all([a.mesh({ size: 6 }), a.mesh({ size: 5 }), b.mesh({ size: 6 })]);
  assert.equal(meshes[0].report.hash, nativeReport(["bracket.stl"], { size: 6 }).hash);
  assert.equal(meshes[1].report.hash, nativeReport(["bracket.stl"], { size: 5 }).hash);
  assert.equal(meshes[2].report.hash, nativeReport(["gear.obj"], { size: 6 }).hash);
  for (const thing of [...meshes, a, b]) thing.close();
});

test("sizes are foreseen, and the report page is a page", async () => {
  const part = await open(sample("bracket.stl"));
  const foreseen = await part.estimate({ elements: 30000 });
  assert.ok(Math.abs(foreseen.expected_tets / 30000 - 1) < 0.15);
  const mesh = await part.mesh({ size: 6 });
  const page = new TextDecoder().decode(await mesh.page({ command_line: "</script><b>" }));
  assert.match(page, /^<!DOCTYPE html>/);
  assert.ok(page.includes("bracket.stl") && !page.includes("</script><b>"));
  mesh.close();
  part.close();
});
