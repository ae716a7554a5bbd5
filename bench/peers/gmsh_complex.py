"""Gmsh (Debian: python3-gmsh) on a complex of several regions. A program of its own, with Debian's Python:

    python3 -m bench.peers.gmsh_complex COMPLEX.ply OUT.mesh SIZE kept|anew ALGORITHM

Each pair of regions is a discrete surface, and each region a volume between them; sheets are embedded. For `anew` the
surfaces are classified by angle and parametrised first, as in Gmsh's tutorial 13.
"""
import math
import sys

import gmsh

from bench.peers.complexes import read_ply

ANGLE = math.radians(40)


def add_surfaces(points, triangles, sides):
    """{tag of a surface: the regions on its sides}."""
    pairs = {}
    for triangle, regions in zip(triangles, sides):
        pairs.setdefault(tuple(sorted(regions)), []).append(triangle)
    surfaces = {}
    for tag, (pair, members) in enumerate(sorted(pairs.items()), 1):
        gmsh.model.addDiscreteEntity(2, tag)
        if tag == 1:
            gmsh.model.mesh.addNodes(2, tag, range(1, len(points) + 1), [x for p in points for x in p])
        gmsh.model.mesh.addElementsByType(tag, 2, [], [v + 1 for t in members for v in t])
        surfaces[tag] = pair
    return surfaces


def classified(points, triangles, sides):
    """The surfaces that Gmsh makes of all triangles, and the regions on the sides of each."""
    regions_of = {frozenset(t): pair for t, pair in zip(triangles, sides)}
    gmsh.model.mesh.classifySurfaces(ANGLE, True, True, math.pi)
    surfaces = {}
    for _, tag in gmsh.model.getEntities(2):
        _, _, nodes = gmsh.model.mesh.getElements(2, tag)
        pairs = {tuple(sorted(regions_of[frozenset(v - 1 for v in nodes[0][k:k + 3])]))
                 for k in range(0, len(nodes[0]), 3)}
        if len(pairs) != 1:
            sys.exit(f"error: a surface of Gmsh's classification has {len(pairs)} pairs of regions")
        surfaces[tag] = pairs.pop()
    gmsh.model.mesh.createGeometry()
    return surfaces


def add_volumes(surfaces):
    for region in sorted({r for pair in surfaces.values() for r in pair} - {-1}):
        walls = [tag for tag, (a, b) in surfaces.items() if a != b and region in (a, b)]
        volume = gmsh.model.geo.addVolume([gmsh.model.geo.addSurfaceLoop(walls)], region + 1)
        sheets = [tag for tag, pair in surfaces.items() if pair == (region, region)]
        gmsh.model.geo.synchronize()
        if sheets:
            gmsh.model.mesh.embed(2, sheets, 3, volume)


def main(complex_file, out, size, surface, algorithm):
    gmsh.initialize()
    for name, value in {"Mesh.Algorithm3D": int(algorithm), "Mesh.Optimize": 1, "Mesh.SaveAll": 1, "General.Verbosity": 4,
                        "General.NumThreads": 1, "Mesh.MeshSizeMax": float(size),
                        "Mesh.MeshSizeMin": float(size) if surface == "anew" else 0.0,
                        "Mesh.MeshSizeExtendFromBoundary": int(surface == "kept")}.items():
        gmsh.option.setNumber(name, value)
    points, triangles, sides = read_ply(complex_file)
    surfaces = add_surfaces(points, triangles, sides)
    if surface == "anew":
        surfaces = classified(points, triangles, sides)
    add_volumes(surfaces)
    gmsh.model.mesh.generate(3)
    gmsh.write(out)


main(*sys.argv[1:])
