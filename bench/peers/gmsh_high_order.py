"""Gmsh's curved elements of order 2 to 4 (Debian: python3-gmsh), its optimiser of high order on, of CAD or of an STL surface.

As a program of its own, which mesh() runs:  python3 -m bench.peers.gmsh_high_order SURFACE.off|CAD OUT.msh SIZE ORDER
"""
import math
import pathlib
import sys

from bench.off import read_off
from bench.peers import surfaces
from bench.peers.netgen import ROOT
from bench.process import finish, run_measured

ELASTIC_AND_OPTIMISED = 2  # Mesh.HighOrderOptimize


def mesh(source, folder, timeout, size, order):
    """`source`: OFF, or a CAD file. The mesh is MSH 4.1."""
    out = pathlib.Path(folder).resolve() / "gmsh.msh"
    return finish(run_measured([sys.executable, "-m", "bench.peers.gmsh_high_order", pathlib.Path(source).resolve(), out, size, order], ROOT, timeout), out)


def main():
    import gmsh
    source, out, size, order = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]), float(sys.argv[3]), int(sys.argv[4])
    gmsh.initialize()
    gmsh.option.setNumber("General.NumThreads", 1)
    if source.suffix == ".off":
        stl = out.with_suffix(".stl")
        surfaces.write_stl(stl, *read_off(source))
        gmsh.merge(str(stl))
        gmsh.model.mesh.classifySurfaces(math.radians(40), True, True, math.pi)
        gmsh.model.mesh.createGeometry()
        gmsh.model.geo.addVolume([gmsh.model.geo.addSurfaceLoop([s for _, s in gmsh.model.getEntities(2)])])
        gmsh.model.geo.synchronize()
    else:
        gmsh.model.occ.importShapes(str(source))
        gmsh.model.occ.synchronize()
    for key, value in {"Mesh.MeshSizeMax": size, "Mesh.ElementOrder": order, "Mesh.HighOrderOptimize": ELASTIC_AND_OPTIMISED}.items():
        gmsh.option.setNumber(key, value)
    gmsh.model.mesh.generate(3)
    gmsh.write(str(out))
    gmsh.finalize()


if __name__ == "__main__":
    main()
