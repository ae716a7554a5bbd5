"""Netgen's curved elements of any order (Debian: netgen), of CAD or of an STL surface, as Gmsh 2.2.

As a program of its own, which mesh() runs:  python3 -m bench.peers.netgen_high_order SURFACE.off|CAD OUT.msh SIZE ORDER
Netgen keeps polynomials of its edges and faces, not nodes: it is asked where the places of Gmsh's nodes are. Its interface for this works on a
global mesh, which is set to the one of nglib.
"""
import ctypes
import pathlib
import sys

from bench.peers import netgen
from bench.peers.netgen import ROOT, load_library
from bench.process import finish, run_measured

KINDS = {1: 4, 2: 11, 3: 29, 4: 30}  # Gmsh's, by order
PLACES = "/usr/lib/x86_64-linux-gnu/netgen/lib{}.so.6.2"
POINTER = ctypes.c_void_p


def mesh(source, folder, timeout, size, order):
    """`source`: OFF, or a CAD file. The mesh is Gmsh 2.2."""
    out = pathlib.Path(folder).resolve() / "netgen.msh"
    return finish(run_measured([sys.executable, "-m", "bench.peers.netgen_high_order", pathlib.Path(source).resolve(), out, size, order], ROOT, timeout), out)


def refinement_of(parameters, is_cad):
    """How its geometry says where curves and faces are."""
    name, symbol = ("occ", "_ZNK6netgen11OCCGeometry13GetRefinementEv") if is_cad else ("stl", "_ZNK6netgen11STLGeometry13GetRefinementEv")
    get = getattr(load_library([PLACES.format(name)], "netgen"), symbol)
    get.restype, get.argtypes = POINTER, [POINTER]
    return get(parameters.geometry)


def curve(made, refinement, order):
    """The function that says where a place of an element is, counted from 0."""
    meshing, interface = (load_library([PLACES.format(name)], "netgen") for name in ("mesh", "interface"))
    build = meshing._ZN6netgen4Mesh19BuildCurvedElementsEPKNS_10RefinementEib
    build.restype, build.argtypes = None, [POINTER, POINTER, ctypes.c_int, ctypes.c_bool]
    build(made, refinement, order, False)
    its = (POINTER * 2).in_dll(meshing, "_ZN6netgen4meshE")
    its[0], its[1] = made, None
    at, x, jacobian = (ctypes.c_double * 3)(), (ctypes.c_double * 3)(), (ctypes.c_double * 9)()

    def place(element, weights):
        at[:] = weights[:3]  # its corners are at (1 0 0), (0 1 0), (0 0 1) and the origin
        interface.Ng_GetElementTransformation(element + 1, at, x, jacobian)
        return tuple(x)
    return place


def lattice(order):
    """The weights of Gmsh's nodes."""
    import gmsh
    gmsh.initialize()
    local = gmsh.model.mesh.getElementProperties(KINDS[order])[4].reshape(-1, 3)
    gmsh.finalize()
    return [tuple(round(order * c) for c in (1 - sum(xyz), *xyz)) for xyz in local]


def nodes_of(tets, place, order):
    """Each node once, and those of each element in Gmsh's order; an element whose corners run the other way is turned."""
    numbers, points, elements = {}, [], []
    weights = lattice(order)
    for t, corners in enumerate(tets):
        element = []
        for w in weights:
            w = (w[0], w[1], w[3], w[2])
            key = tuple(sorted((v, k) for v, k in zip(corners, w) if k))
            if key not in numbers:
                numbers[key] = len(points)
                points.append(place(t, [k / order for k in w]))
            element.append(numbers[key])
        elements.append(element)
    return points, elements


def write(out, points, elements, order):
    with open(out, "w", encoding="utf-8") as f:
        f.write(f"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{len(points)}\n")
        f.writelines(f"{i} {x!r} {y!r} {z!r}\n" for i, (x, y, z) in enumerate(points, 1))
        f.write(f"$EndNodes\n$Elements\n{len(elements)}\n")
        f.writelines(f"{i} {KINDS[order]} 2 1 1 {' '.join(str(v + 1) for v in element)}\n" for i, element in enumerate(elements, 1))
        f.write("$EndElements\n")


def main():
    source, out, size, order = pathlib.Path(sys.argv[1]), sys.argv[2], float(sys.argv[3]), int(sys.argv[4])
    library = netgen.load()
    is_cad = source.suffix.lower() in netgen.CAD_READERS
    made, parameters, start = (netgen.mesh_cad_surface if is_cad else netgen.mesh_stl_surface)(library, source, size)
    netgen.fill_mesh(library, made, parameters, start)
    place = curve(made, refinement_of(parameters, is_cad), order)
    write(out, *nodes_of(netgen.points_and_tets(library, made)[1], place, order), order)


if __name__ == "__main__":
    main()
