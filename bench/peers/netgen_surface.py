"""Netgen's STL mesher alone, without the volume: python3 -m bench.peers.netgen_surface SURFACE.off OUT.off SIZE"""
import ctypes
import sys

from bench.off import write_off
from bench.peers.netgen import function, load, mesh_stl_surface, surface_triangles


def main(surface, out, size):
    library, pointer = load(), ctypes.c_void_p
    mesh, _, _ = mesh_stl_surface(library, surface, size)
    point = function(library, "11Ng_GetPointEPPviPd", None, pointer, ctypes.c_int, pointer)
    xyz, points = (ctypes.c_double * 3)(), []
    for i in range(1, function(library, "8Ng_GetNPEPPv", ctypes.c_int, pointer)(mesh) + 1):
        point(mesh, i, xyz)
        points.append(tuple(xyz))
    write_off(out, points, surface_triangles(library, mesh))


main(sys.argv[1], sys.argv[2], float(sys.argv[3]))
