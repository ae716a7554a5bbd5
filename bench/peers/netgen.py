"""Netgen (Debian: netgen), through its library: its front on a kept surface, and its STL mesher, which triangulates anew.

As a program of its own, which these run:  python3 -m bench.peers.netgen SURFACE.off|CAD MESH.mesh [SIZE [--vol] [--second-order]]
"""
import ctypes
import pathlib
import re
import resource
import sys

from bench.off import read_off
from bench.peers import surfaces
from bench.process import finish, load_library, run_measured

ROOT = pathlib.Path(__file__).resolve().parents[2]

LIBRARIES = ["/usr/lib/x86_64-linux-gnu/netgen/libnglib.so.6.2", "libnglib.so"]


def fill(surface, folder, timeout, optimize=True):
    """Keeps the triangles of `surface` (OFF). The mesh is MEDIT."""
    return run(surface, folder, timeout, *([] if optimize else ["--no-optimization"]))


def remesh(surface, folder, timeout, size):
    """Triangulates `surface` (OFF) anew to `size` and fills it. The mesh is MEDIT."""
    return run(surface, folder, timeout, size)


def mesh_cad(file, folder, timeout, size, own_format=False):
    """Meshes a STEP, IGES or BREP file. The mesh is MEDIT; with `own_format` out.vol, which has names, lies beside it."""
    return run(file, folder, timeout, size, *(["--vol"] if own_format else []))


def mesh_cad_for_solver(file, folder, timeout, size, order):
    """Meshes a STEP file with Netgen's own sizes, none larger than `size`, as out.msh (Gmsh 2.2): tetrahedra of 4 nodes or of 10."""
    outcome = run(file, folder, timeout, size, "--msh", *(["--second-order"] if order == 2 else []))
    return finish(outcome, pathlib.Path(folder) / "out.msh")


def run(surface, folder, timeout, *more):
    out = pathlib.Path(folder).resolve() / "out.mesh"
    outcome = run_measured([sys.executable, "-m", "bench.peers.netgen", pathlib.Path(surface).resolve(), out,
                            *more], ROOT, timeout)
    stage = re.search(r"filling CPU seconds: ([\d.]+)", outcome.log)
    if stage:
        outcome.stage_seconds = float(stage[1])
    return finish(outcome, out)


TET10 = 4  # NG_TET10 of nglib.h


class Parameters(ctypes.Structure):
    """The beginning of nglib::Ng_Meshing_Parameters; the constructor fills in the rest."""
    _fields_ = [("uselocalh", ctypes.c_int), ("maxh", ctypes.c_double), ("minh", ctypes.c_double),
                ("fineness", ctypes.c_double), ("grading", ctypes.c_double), ("elementsperedge", ctypes.c_double),
                ("elementspercurve", ctypes.c_double), ("closeedgeenable", ctypes.c_int),
                ("closeedgefact", ctypes.c_double), ("minedgelenenable", ctypes.c_int), ("minedgelen", ctypes.c_double),
                ("second_order", ctypes.c_int), ("quad_dominated", ctypes.c_int),
                ("meshsize_filename", ctypes.c_char_p), ("optsurfmeshenable", ctypes.c_int),
                ("optvolmeshenable", ctypes.c_int), ("optsteps_3d", ctypes.c_int), ("rest", ctypes.c_char * 2048)]


def load():
    return load_library(LIBRARIES, "netgen")


def function(library, mangled, result, *arguments):
    f = getattr(library, "_ZN5nglib" + mangled)
    f.restype, f.argtypes = result, arguments
    return f


def fill_in_process(surface, out, optimize):
    points, triangles = read_off(surface)
    library, pointer = load(), ctypes.c_void_p
    function(library, "7Ng_InitEv", None)()
    mesh = function(library, "10Ng_NewMeshEv", pointer)()
    add_point = function(library, "11Ng_AddPointEPPvPd", None, pointer, pointer)
    add_triangle = function(library, "20Ng_AddSurfaceElementEPPvNS_23Ng_Surface_Element_TypeEPi", None, pointer,
                            ctypes.c_int, pointer)
    for p in points:
        add_point(mesh, (ctypes.c_double * 3)(*p))
    for a, b, c in triangles:
        add_triangle(mesh, 1, (ctypes.c_int * 3)(a + 1, b + 1, c + 1))
    parameters = Parameters()
    function(library, "21Ng_Meshing_ParametersC1Ev", None, pointer)(ctypes.byref(parameters))
    parameters.maxh = surfaces.mean_edge(points, triangles)
    if not optimize:
        parameters.optvolmeshenable = parameters.optsteps_3d = 0
    fill_mesh(library, mesh, parameters)
    save(library, mesh, triangles, out)


def fill_mesh(library, mesh, parameters, start=None):
    pointer = ctypes.c_void_p
    start = start or resource.getrusage(resource.RUSAGE_SELF)
    status = function(library, "21Ng_GenerateVolumeMeshEPPvPNS_21Ng_Meshing_ParametersE", ctypes.c_int, pointer,
                      pointer)(mesh, ctypes.byref(parameters))
    end = resource.getrusage(resource.RUSAGE_SELF)
    print(f"filling CPU seconds: {end.ru_utime + end.ru_stime - start.ru_utime - start.ru_stime:.3f}")
    if status != 0:
        sys.exit(f"error: netgen returned {status}")


def mesh_stl_surface(library, surface, size):
    """Netgen's STL mesher on the surface: (mesh, parameters, resources used when it began)."""
    points, triangles = read_off(surface)
    pointer = ctypes.c_void_p
    function(library, "7Ng_InitEv", None)()
    geometry = function(library, "18Ng_STL_NewGeometryEv", pointer)()
    add = function(library, "18Ng_STL_AddTriangleEPPvPdS2_S2_S2_", None, pointer, pointer, pointer, pointer, pointer)
    for triangle in triangles:
        add(geometry, *((ctypes.c_double * 3)(*points[corner]) for corner in triangle), None)
    parameters = Parameters()
    function(library, "21Ng_Meshing_ParametersC1Ev", None, pointer)(ctypes.byref(parameters))
    parameters.maxh = size
    start = resource.getrusage(resource.RUSAGE_SELF)
    mesh = function(library, "10Ng_NewMeshEv", pointer)()
    for name, arguments in (("22Ng_STL_InitSTLGeometryEPPv", (geometry,)),
                            ("16Ng_STL_MakeEdgesEPPvS1_PNS_21Ng_Meshing_ParametersE",
                             (geometry, mesh, ctypes.byref(parameters))),
                            ("26Ng_STL_GenerateSurfaceMeshEPPvS1_PNS_21Ng_Meshing_ParametersE",
                             (geometry, mesh, ctypes.byref(parameters)))):
        status = function(library, name, ctypes.c_int, *[pointer] * len(arguments))(*arguments)
        if status not in (0, 1):  # InitSTLGeometry returns 1 for success
            sys.exit(f"error: netgen's {name[2:].split('EPP')[0]} returned {status}")
    parameters.geometry = geometry
    return mesh, parameters, start


CAD_READERS = {".stp": "16Ng_OCC_Load_STEPEPKc", ".step": "16Ng_OCC_Load_STEPEPKc", ".igs": "16Ng_OCC_Load_IGESEPKc",
               ".iges": "16Ng_OCC_Load_IGESEPKc", ".brep": "16Ng_OCC_Load_BREPEPKc"}


def mesh_cad_surface(library, file, size):
    """Netgen's OpenCASCADE mesher: (mesh, parameters, resources used when it began)."""
    pointer = ctypes.c_void_p
    function(library, "7Ng_InitEv", None)()
    start = resource.getrusage(resource.RUSAGE_SELF)
    geometry = function(library, CAD_READERS[pathlib.Path(file).suffix.lower()], pointer, ctypes.c_char_p)(str(file).encode())
    if not geometry:
        sys.exit("error: netgen cannot read it")
    parameters = Parameters()
    function(library, "21Ng_Meshing_ParametersC1Ev", None, pointer)(ctypes.byref(parameters))
    parameters.maxh = size
    mesh = function(library, "10Ng_NewMeshEv", pointer)()
    for name in ("23Ng_OCC_SetLocalMeshSizeEPPvS1_PNS_21Ng_Meshing_ParametersE", "23Ng_OCC_GenerateEdgeMeshEPPvS1_PNS_21Ng_Meshing_ParametersE",
                 "26Ng_OCC_GenerateSurfaceMeshEPPvS1_PNS_21Ng_Meshing_ParametersE"):
        status = function(library, name, ctypes.c_int, pointer, pointer, pointer)(geometry, mesh, ctypes.byref(parameters))
        if status != 0:
            sys.exit(f"error: netgen's {name[2:].split('EPP')[0]} returned {status}")
    parameters.geometry = geometry
    return mesh, parameters, start


def surface_triangles(library, mesh):
    pointer = ctypes.c_void_p
    get = function(library, "20Ng_GetSurfaceElementEPPviPi", ctypes.c_int, pointer, ctypes.c_int, pointer)
    corners, made = (ctypes.c_int * 8)(), []
    for i in range(1, function(library, "9Ng_GetNSEEPPv", ctypes.c_int, pointer)(mesh) + 1):
        get(mesh, i, corners)
        made.append(tuple(c - 1 for c in corners[:3]))
    return made


def remesh_in_process(surface, out, size):
    library = load()
    by = mesh_cad_surface if pathlib.Path(surface).suffix.lower() in CAD_READERS else mesh_stl_surface
    mesh, parameters, start = by(library, surface, size)
    fill_mesh(library, mesh, parameters, start)
    if "--second-order" in sys.argv:
        function(library, "27Ng_OCC_Generate_SecondOrderEPPvS1_", None, ctypes.c_void_p, ctypes.c_void_p)(parameters.geometry, mesh)
    if "--msh" in sys.argv:
        save_tets(library, mesh, pathlib.Path(out).with_suffix(".msh"))
    made = surface_triangles(library, mesh)
    save(library, mesh, made, out)
    if "--vol" in sys.argv:
        vol = str(pathlib.Path(out).with_suffix(".vol"))
        function(library, "11Ng_SaveMeshEPPvPKc", None, ctypes.c_void_p, ctypes.c_char_p)(mesh, vol.encode())


def points_and_tets(library, mesh):
    """Numbers of nodes count from 0; of second order there are ten."""
    pointer = ctypes.c_void_p
    count = lambda name: function(library, name, ctypes.c_int, pointer)(mesh)
    get_point = function(library, "11Ng_GetPointEPPviPd", None, pointer, ctypes.c_int, pointer)
    get_tet = function(library, "19Ng_GetVolumeElementEPPviPi", ctypes.c_int, pointer, ctypes.c_int, pointer)
    xyz, corners = (ctypes.c_double * 3)(), (ctypes.c_int * 10)()
    points, tets = [], []
    for i in range(1, count("8Ng_GetNPEPPv") + 1):
        get_point(mesh, i, xyz)
        points.append(tuple(xyz))
    for i in range(1, count("8Ng_GetNEEPPv") + 1):
        kind = get_tet(mesh, i, corners)
        tets.append(tuple(c - 1 for c in corners[:10 if kind == TET10 else 4]))
    return points, tets


def save(library, mesh, triangles, out):
    points, tets = points_and_tets(library, mesh)
    surfaces.write_medit(out, points, triangles, [tet[:4] for tet in tets])


def save_tets(library, mesh, out):
    """As Gmsh 2.2, whose mid-side nodes come in another order."""
    points, tets = points_and_tets(library, mesh)
    with open(out, "w", encoding="utf-8") as f:
        f.write(f"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{len(points)}\n")
        f.writelines(f"{i} {x!r} {y!r} {z!r}\n" for i, (x, y, z) in enumerate(points, 1))
        f.write(f"$EndNodes\n$Elements\n{len(tets)}\n")
        for i, tet in enumerate(tets, 1):
            order = range(4) if len(tet) == 4 else (0, 1, 2, 3, 4, 7, 5, 6, 9, 8)
            f.write(f"{i} {4 if len(tet) == 4 else 11} 2 1 1 {' '.join(str(tet[k] + 1) for k in order)}\n")
        f.write("$EndElements\n")


if __name__ == "__main__":
    if "--no-optimization" in sys.argv:
        fill_in_process(sys.argv[1], sys.argv[2], False)
    elif len(sys.argv) > 3:
        remesh_in_process(sys.argv[1], sys.argv[2], float(sys.argv[3]))
    else:
        fill_in_process(sys.argv[1], sys.argv[2], True)
