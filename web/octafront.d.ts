/** Lengths are in the units of the input. Arrays are row by row; indices count from 0. */

/** A file: the browser's own, or its name and bytes. The name's ending says what it is, where its content does not. */
export type Input = File | { name: string; data: Uint8Array | ArrayBuffer };

/** Options by name: those of `info().options` whose tasks hold "mesh", as docs/use/command-line.md describes them. */
export interface MeshOptions {
  /** Edge length. */
  size?: number;
  /** Number of tetrahedra wanted, met within 15 %. */
  elements?: number;
  /** 2: second order, with mid-side nodes on the smooth surface. */
  order?: 1 | 2;
  /** The input's triangles become the boundary, exactly. */
  keep_surface?: boolean;
  method?: "octree-aft" | "aft" | "octree" | "recover";
  [option: string]: number | string | boolean | null | undefined;
}

/** What is asked on the way in: names of `info().intake`, and the lists of octafront_open_files() in octafront_c.h. */
export interface IntakeOptions {
  [option: string]: unknown;
}

/** The report as `octafront mesh --json` writes it. */
export interface Report {
  hash?: string;
  tets?: number;
  /** Of `estimate()`. */
  expected_tets?: number;
  points?: number;
  volume?: number;
  wall_seconds?: number;
  [key: string]: unknown;
}

export interface Given {
  /** Called with the stage and its fraction, 0 to 1, null where it is unknown. */
  progress?: (stage: string, fraction: number | null) => void;
  /** Cancels, whatever is going on: the promise is rejected with the signal's reason. */
  signal?: AbortSignal;
}

export interface WriteOptions {
  /** A name of `info().formats`; else by the ending of the file's name. */
  format?: string;
  /** As text, where the format has both. */
  ascii?: boolean;
  /** Tetrahedra alone. */
  cells_only?: boolean;
  /** As polyhedra, a cell for each vertex, where the format has them. */
  polyhedral?: boolean;
}

export interface WrittenFile {
  /** With folders, where a format has some. */
  name: string;
  data: Uint8Array;
}

/** What is meshed: a surface, a complex of regions, or an image's regions. In a worker of its own until close(). */
export interface Part {
  /** What was read, found and done: format, notes, regions, repair. */
  readonly report: Report;
  array(name: "points" | "bound"): Promise<Float64Array>;
  array(name: "triangles" | "patch" | "source" | "sides"): Promise<Uint32Array>;
  names(list: "region_names" | "patch_names"): Promise<string[]>;
  /** What these options come to: sizes, and the number of elements expected. */
  estimate(options?: MeshOptions, given?: Given): Promise<Report>;
  /** May be called again, with other options. */
  mesh(options?: MeshOptions, given?: Given): Promise<Mesh>;
  close(): void;
}

/** A mesh, in a worker of its own until close(). */
export interface Mesh {
  readonly report: Report;
  array(name: "points"): Promise<Float64Array>;
  array(
    name: "tets" | "region" | "boundary" | "patch" | "source" | "interfaces" | "interface_patch" | "curve_edges" | "curve" | "mid_nodes" | "high_nodes" | "wide_cells" | "wide_faces",
  ): Promise<Uint32Array>;
  names(list: "region_names" | "patch_names" | "curve_names"): Promise<string[]>;
  /** The files of a format that writes meshes; some formats have several. */
  write(name: string, options?: WriteOptions, given?: Given): Promise<{ files: WrittenFile[]; notes: string[] }>;
  /** The report page, a web page by itself, as UTF-8; `report` adds to or replaces what the page tells. */
  page(report?: object, given?: Given): Promise<Uint8Array>;
  /** Bytes that its worker holds. */
  memory(): Promise<number>;
  close(): void;
}

export interface Info {
  version: string;
  formats: { name: string; title: string; endings: string; reads_surface: boolean; writes_surface: boolean; reads_mesh: boolean; writes_mesh: boolean; carries: string }[];
  options: { name: string; group: string; tasks: string; kind: "number" | "whole" | "flag" | "choice" | "text"; choices: string[]; default: number | string | boolean | null; without: string; range: string; is_length: boolean; help: string }[];
  intake: Info["options"];
  units: { name: string; metres: number; words: string[] }[];
}

/** What failed: 2 options, 3 the input, 4 meshing, 5 writing, 6 memory, 1 a bug; `report` has the evidence. */
export class OctafrontError extends Error {
  readonly status: number;
  readonly report: Report;
}

/** Reads surfaces (STL, OBJ, OFF, PLY, ...), images (NIfTI, NRRD, ...) and meshes; of several each is a region. Defects are mended. `options`: what
 *  it will be meshed with; sizes say where bodies that nearly touch come together. */
export function open(files: Input | Input[], intake?: IntakeOptions, given?: Given & { options?: MeshOptions }): Promise<Part>;
export function info(): Promise<Info>;
