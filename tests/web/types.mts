// The package's types, used as README.md of the package says; scripts/web.sh has the compiler of TypeScript read it. What is
// marked @ts-expect-error must be refused.
import { Input, Mesh, OctafrontError, Part, info, open } from "octafront";

export async function meshes(file: File, bytes: Uint8Array): Promise<number> {
  const inputs: Input[] = [file, { name: "part.stl", data: bytes }, { name: "part.stl", data: bytes.buffer as ArrayBuffer }];
  const controller = new AbortController();
  const part: Part = await open(inputs, { overlap: "later", tolerance: 0.1 }, { signal: controller.signal, options: { size: 2 } });
  const foreseen: number | undefined = (await part.estimate({ elements: 50000 })).expected_tets;
  const told: [string, number | null][] = [];
  const mesh: Mesh = await part.mesh({ elements: 50000, order: 2, keep_surface: true, first: "0.1" }, { progress: (stage, share) => void told.push([stage, share]) });
  const points: Float64Array = await mesh.array("points");
  const tets: Uint32Array = await mesh.array("tets");
  const names: string[] = [...(await mesh.names("curve_names")), ...(await part.names("patch_names"))];
  const { files, notes } = await mesh.write("part.msh", { format: "msh22", ascii: true, cells_only: true });
  const page: Uint8Array = await mesh.page({ input: "part.stl" });
  const held: number = await mesh.memory();
  mesh.close();
  part.close();
  return (foreseen ?? 0) + points.length + tets.length + names.length + files[0].data.length + files[0].name.length + notes.length + page.length + held;
}

export async function known(): Promise<string[]> {
  const { formats, options, intake, units, version } = await info();
  const kinds: ("number" | "whole" | "flag" | "choice" | "text")[] = [...options, ...intake].map((option) => option.kind);
  return [version, ...kinds, ...formats.filter((format) => format.writes_mesh).map((format) => format.title), ...units.flatMap((unit) => unit.words)];
}

export async function refusals(part: Part, mesh: Mesh): Promise<void> {
  try {
    // @ts-expect-error: not an order
    await part.mesh({ order: 3 });
    // @ts-expect-error: an option is no list
    await part.mesh({ size: [1, 2] });
    // @ts-expect-error: of a mesh, not of a part
    await part.array("tets");
    // @ts-expect-error: indices are whole numbers
    const tets: Float64Array = await mesh.array("tets");
    // @ts-expect-error: files have names
    await open(tets);
    // @ts-expect-error: reports are read
    mesh.report = {};
  } catch (error) {
    if (error instanceof OctafrontError) console.log(error.status, error.message, error.report.hash);
  }
}
