"""Gmsh (Debian: gmsh): HXT, Delaunay and Frontal, on a kept discrete surface, on one triangulated anew, in a cube. $GMSH_NEWEST names the
program of a newer Gmsh, to be shown beside that of Debian."""
import os
import pathlib
import re

from bench.off import read_off
from bench.peers import surfaces
from bench.process import finish, run_measured

SCRIPT = """Merge "in.msh";
Surface Loop(1) = {{1}};
Volume(1) = {{1}};
Mesh.Algorithm3D = {algorithm};
Mesh.Optimize = {optimize};
Mesh.MeshSizeExtendFromBoundary = 1;
{held}General.NumThreads = {threads};
Mesh.MaxNumThreads3D = {threads};
Mesh.Binary = 1;
Mesh.SaveAll = 1;
"""
HXT, DELAUNAY, FRONTAL = 10, 1, 4
PROGRAM, NEWEST = "gmsh", os.environ.get("GMSH_NEWEST")

# As in Gmsh's own tutorial 13: patches between sharp edges, parametrised, are meshed anew.
REMESH_SCRIPT = """Merge "in.stl";
ClassifySurfaces{{40 * Pi / 180, 1, 1, Pi}};
CreateGeometry;
Surface Loop(1) = Surface{{:}};
Volume(1) = {{1}};
Mesh.Algorithm3D = {algorithm};
Mesh.Optimize = {optimize};
Mesh.MeshSizeMin = {size:.9g};
Mesh.MeshSizeMax = {size:.9g};
Mesh.MeshSizeExtendFromBoundary = 0;
General.NumThreads = {threads};
Mesh.MaxNumThreads3D = {threads};
Mesh.Binary = 1;
Mesh.SaveAll = 1;
"""

CUBE_SCRIPT = """Point(1) = {{0, 0, 0}};
Extrude {{1, 0, 0}} {{ Point{{1}}; }}
Extrude {{0, 1, 0}} {{ Curve{{1}}; }}
Extrude {{0, 0, 1}} {{ Surface{{5}}; }}
Mesh.Algorithm3D = {algorithm};
Mesh.MeshSizeMin = {size:.9g};
Mesh.MeshSizeMax = {size:.9g};
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.Binary = 1;
"""


def cube(folder, timeout, size, algorithm, threads=1, program=PROGRAM):
    """The unit cube at one size, from its geometry on. The mesh is binary MSH 4.1."""
    folder = pathlib.Path(folder)
    (folder / "in.geo").write_text(CUBE_SCRIPT.format(algorithm=algorithm, size=size))
    return run(folder, timeout, threads, program)


def fill(surface, folder, timeout, algorithm, optimize, threads, held=True, program=PROGRAM):
    """Keeps the triangles of `surface` (OFF). Sizes are extended from them; `held`: and nowhere larger than their mean
    edge. The mesh is binary MSH 4.1."""
    folder = pathlib.Path(folder)
    points, triangles = read_off(surface)
    surfaces.write_msh(folder / "in.msh", points, triangles)
    held = f"Mesh.MeshSizeMax = {surfaces.mean_edge(points, triangles):.9g};\n" if held else ""
    (folder / "in.geo").write_text(SCRIPT.format(algorithm=algorithm, optimize=int(optimize), threads=threads, held=held))
    return run(folder, timeout, threads, program)


def remesh(surface, folder, timeout, size, algorithm, optimize=True, threads=1):
    """Triangulates `surface` (OFF) anew to `size` and fills it. The mesh is binary MSH 4.1."""
    folder = pathlib.Path(folder)
    surfaces.write_stl(folder / "in.stl", *read_off(surface))
    (folder / "in.geo").write_text(REMESH_SCRIPT.format(algorithm=algorithm, optimize=int(optimize), threads=threads,
                                                        size=size))
    return run(folder, timeout, threads)


def run(folder, timeout, threads, program=PROGRAM):
    outcome = run_measured([program, "-3", "in.geo", "-o", "out.msh", "-format", "msh41", "-bin", "-v", "4", "-nt",
                            str(threads)], folder, timeout)
    stage = re.search(r"Done meshing 3D \(Wall [\d.e+-]+s, CPU ([\d.e+-]+)s\)", outcome.log)
    improved = re.search(r"Done optimizing mesh \(Wall [\d.e+-]+s, CPU ([\d.e+-]+)s\)", outcome.log)
    if stage:
        outcome.stage_seconds = float(stage[1]) + (float(improved[1]) if improved else 0.0)
    failed = re.search(r"Error\s*: (.*)", outcome.log)
    if failed:
        outcome.error = failed[1][:120]
    return finish(outcome, folder / "out.msh")


def fill_hxt(surface, folder, timeout, optimize=True, threads=1, held=True, program=PROGRAM):
    return fill(surface, folder, timeout, HXT, optimize, threads, held, program)


def fill_delaunay(surface, folder, timeout, optimize=True, threads=1, held=True, program=PROGRAM):
    return fill(surface, folder, timeout, DELAUNAY, optimize, threads, held, program)


def fill_frontal(surface, folder, timeout, optimize=True, threads=1):
    return fill(surface, folder, timeout, FRONTAL, optimize, threads)
