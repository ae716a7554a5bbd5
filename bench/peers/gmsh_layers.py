"""Gmsh's boundary layers (Debian: python3-gmsh): a surface drawn out along its normals, the rest filled.

    python3 -m bench.peers.gmsh_layers IN.json

IN.json: surface (OFF), flat_ends, tops (heights of the tops of the layers, negative: inward), size, far, box (two corners, or null), out.
A closed surface keeps its triangles, as a discrete surface. One that ends at planes (flat_ends) is divided and meshed anew to `size`, as in Gmsh's
demos: plane surfaces fill the rims of the tops. Writes MSH 2.2 with the patches `walls`, `far` and `ends`.
"""
import json
import math
import pathlib
import sys

import gmsh

from bench.off import read_off
from bench.peers import surfaces

FEATURE = math.radians(40)


def kept(path):
    points, triangles = read_off(path)
    gmsh.model.addDiscreteEntity(2, 1)
    gmsh.model.mesh.addNodes(2, 1, range(1, len(points) + 1), [x for p in points for x in p])
    gmsh.model.mesh.addElementsByType(1, 2, [], [v + 1 for t in triangles for v in t])
    return [1]


def meshed_anew(path, size):
    """The surface divided into parts that can be parametrised, and meshed to `size`."""
    surfaces.write_stl("in.stl", *read_off(path))
    gmsh.merge("in.stl")
    gmsh.model.mesh.classifySurfaces(FEATURE, True, True, math.pi)
    gmsh.model.mesh.createGeometry()
    gmsh.model.mesh.setSizeCallback(lambda dim, tag, x, y, z: size)
    return [tag for _, tag in gmsh.model.getEntities(2)]


def box_around(low, high, far):
    geo = gmsh.model.geo
    corner = {(i, j, k): geo.addPoint(*((low, high)[s][a] for a, s in enumerate((i, j, k))), far)
              for i in (0, 1) for j in (0, 1) for k in (0, 1)}
    lines = {}
    for a in corner:
        for axis in range(3):
            b = a[:axis] + (1,) + a[axis + 1:]
            if b != a:
                lines[a, b] = geo.addLine(corner[a], corner[b])
                lines[b, a] = -lines[a, b]

    def side(axis, at):
        turn = [(u, v)[:axis] + (at,) + (u, v)[axis:] for u, v in ((0, 0), (1, 0), (1, 1), (0, 1))]
        return geo.addPlaneSurface([geo.addCurveLoop([lines[turn[i], turn[(i + 1) % 4]] for i in range(4)])])
    return [side(axis, at) for axis in range(3) for at in (0, 1)]


def named(name, dim, tags):
    if tags:
        gmsh.model.setPhysicalName(dim, gmsh.model.addPhysicalGroup(dim, tags), name)


def drawn_out(walls, tops):
    """(volumes of layers, tops)."""
    gmsh.option.setNumber("Geometry.ExtrudeReturnLateralEntities", 0)
    made = gmsh.model.geo.extrudeBoundaryLayer([(2, s) for s in walls], [1] * len(tops), tops, True)
    gmsh.model.geo.synchronize()
    return [tag for dim, tag in made if dim == 3], [tag for dim, tag in made if dim == 2]


def main():
    asked = json.loads(pathlib.Path(sys.argv[1]).read_text())
    gmsh.initialize()
    for option, value in {"General.NumThreads": 1, "Mesh.Algorithm3D": asked["algorithm"], "Mesh.MshFileVersion": 2.2,
                          "Mesh.MeshSizeMax": asked["far"]}.items():
        gmsh.option.setNumber(option, value)
    geo = gmsh.model.geo
    walls = meshed_anew(asked["surface"], asked["size"]) if asked["flat_ends"] else kept(asked["surface"])
    layers, top = drawn_out(walls, asked["tops"])
    ends, far = [], []
    if asked["flat_ends"]:
        rims = [abs(tag) for _, tag in gmsh.model.getBoundary([(2, s) for s in top])]
        ends = [geo.addPlaneSurface([loop]) for loop in geo.addCurveLoops(rims)]
    if asked["box"]:
        far = box_around(*asked["box"], asked["far"])
    inside = geo.addVolume([geo.addSurfaceLoop(shell) for shell in (far, top + ends) if shell])
    geo.synchronize()
    for group in (("walls", 2, walls), ("far", 2, far), ("ends", 2, ends), ("layers", 3, layers), ("inside", 3, [inside])):
        named(*group)
    gmsh.model.mesh.generate(3)
    gmsh.write(asked["out"])


main()
