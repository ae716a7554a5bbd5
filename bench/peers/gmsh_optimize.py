"""Gmsh's own optimiser on any mesh, through its library: python3 -m bench.peers.gmsh_optimize IN.msh OUT.msh

The .geo command OptimizeMesh leaves meshes alone that have no geometry; the library can be told to take them.
"""
import ctypes
import sys

from bench.process import load_library

LIBRARIES = ["libgmsh.so.4.8", "libgmsh.so.4.11", "libgmsh.so"]


def main():
    library, error = load_library(LIBRARIES, "gmsh"), ctypes.c_int(0)
    status = ctypes.byref(error)
    library.gmshInitialize(0, None, 0, status)
    library.gmshOpen(sys.argv[1].encode(), status)
    library.gmshModelMeshOptimize(b"", 1, 1, None, ctypes.c_size_t(0), status)
    if error.value:
        sys.exit(f"error: gmsh returned {error.value}")
    library.gmshOptionSetNumber(b"Mesh.SaveAll", ctypes.c_double(1), status)
    library.gmshWrite(sys.argv[2].encode(), status)


main()
