"""Netgen's STL mesher alone, without the volume: python3 -m peers.netgen_surface SURFACE.off OUT.off SIZE"""
import ctypes
import sys

from . import surfaces
from .netgen import Parameters, function, load


def main(surface, out, size):
    points, triangles = surfaces.read_off(surface)
    library, pointer = load(), ctypes.c_void_p
    function(library, "7Ng_InitEv", None)()
    geometry = function(library, "18Ng_STL_NewGeometryEv", pointer)()
    add = function(library, "18Ng_STL_AddTriangleEPPvPdS2_S2_S2_", None, pointer, pointer, pointer, pointer, pointer)
    for triangle in triangles:
        add(geometry, *((ctypes.c_double * 3)(*points[corner]) for corner in triangle), None)
    parameters = Parameters()
    function(library, "21Ng_Meshing_ParametersC1Ev", None, pointer)(ctypes.byref(parameters))
    parameters.maxh = size
    mesh = function(library, "10Ng_NewMeshEv", pointer)()
    for name, arguments in (("22Ng_STL_InitSTLGeometryEPPv", (geometry,)),
                            ("16Ng_STL_MakeEdgesEPPvS1_PNS_21Ng_Meshing_ParametersE",
                             (geometry, mesh, ctypes.byref(parameters))),
                            ("26Ng_STL_GenerateSurfaceMeshEPPvS1_PNS_21Ng_Meshing_ParametersE",
                             (geometry, mesh, ctypes.byref(parameters)))):
        status = function(library, name, ctypes.c_int, *[pointer] * len(arguments))(*arguments)
        if status not in (0, 1):  # InitSTLGeometry returns 1 for success
            sys.exit(f"error: {name} returned {status}")
    count = lambda name: function(library, name, ctypes.c_int, pointer)(mesh)
    point = function(library, "11Ng_GetPointEPPviPd", None, pointer, ctypes.c_int, pointer)
    face = function(library, "20Ng_GetSurfaceElementEPPviPi", ctypes.c_int, pointer, ctypes.c_int, pointer)
    xyz, corners = (ctypes.c_double * 3)(), (ctypes.c_int * 8)()
    with open(out, "w") as file:
        vertices, faces = count("8Ng_GetNPEPPv"), count("9Ng_GetNSEEPPv")
        file.write(f"OFF\n{vertices} {faces} 0\n")
        for i in range(1, vertices + 1):
            point(mesh, i, xyz)
            file.write("%.17g %.17g %.17g\n" % tuple(xyz))
        for i in range(1, faces + 1):
            face(mesh, i, corners)
            file.write("3 %d %d %d\n" % tuple(c - 1 for c in corners[:3]))


main(sys.argv[1], sys.argv[2], float(sys.argv[3]))
