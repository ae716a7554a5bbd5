#!/usr/bin/python3
"""What others make of meshes in parts: the files of write_samples in the folders FOLDER/NAME_parts and NAME_split, five
parts each, beside the whole mesh in FOLDER/NAME.

    parts_judges.py FOLDER [pvtu|vtkhdf|msh|openfoam ...]

Judges: VTK (pvtu, vtkhdf), Gmsh (msh, split too), checkMesh -parallel and reconstructParMesh (openfoam), and a reader of
our own for the addressing of OpenFOAM. What is not installed is skipped, and said. Exit status 1 if there is a difference.
"""
import importlib.util
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parent))
sys.path.append("/usr/lib/python3/dist-packages")
import judges
import second_readers
from judges import Difference, near, same

PARTS = 5


def installed(module):
    if importlib.util.find_spec(module) is None:
        print(f"  {module} is not installed: skipped")
        return False
    return True


class Grid:
    """What VTK read: types, numbers and volumes of cells, arrays of points and cells."""

    def __init__(self, reader, file):
        import vtk
        from vtk.util.numpy_support import vtk_to_numpy
        reader.SetFileName(str(file))
        reader.Update()
        self.grid = reader.GetOutput()
        sizes = vtk.vtkCellSizeFilter()
        sizes.SetInputData(self.grid)
        sizes.Update()
        self.sizes = {name: vtk_to_numpy(sizes.GetOutput().GetCellData().GetArray(name)) for name in ("Volume", "Area", "Length")}
        arrays = lambda data: {data.GetArrayName(i): vtk_to_numpy(data.GetArray(i)) for i in range(data.GetNumberOfArrays())}
        self.cells, self.points = arrays(self.grid.GetCellData()), arrays(self.grid.GetPointData())
        self.at = vtk_to_numpy(self.grid.GetPoints().GetData())
        self.nodes = vtk_to_numpy(self.grid.GetCells().GetConnectivityArray())
        self.ends = vtk_to_numpy(self.grid.GetCells().GetOffsetsArray())


def seam(grid, value):
    """Area of the contour of x through all cells that are somebody's own, and how many edges of it have one triangle only."""
    import vtk
    from vtk.util.numpy_support import numpy_to_vtk
    x = numpy_to_vtk(np.ascontiguousarray(grid.at @ np.array([1.0, 0.31, 0.17])), deep=1)
    x.SetName("x")
    own = vtk.vtkUnstructuredGrid()
    own.DeepCopy(grid.grid)
    own.GetPointData().SetScalars(x)
    if own.GetCellData().HasArray("vtkGhostType"):
        own.RemoveGhostCells()
    contour = vtk.vtkContourFilter()
    contour.SetInputData(own)
    contour.SetValue(0, value)
    clean = vtk.vtkCleanPolyData()
    clean.SetInputConnection(contour.GetOutputPort())
    clean.SetTolerance(1e-9)
    triangles = vtk.vtkTriangleFilter()
    triangles.SetInputConnection(clean.GetOutputPort())
    triangles.PassLinesOff()
    triangles.PassVertsOff()
    edges = vtk.vtkFeatureEdges()
    edges.SetInputConnection(triangles.GetOutputPort())
    edges.FeatureEdgesOff()
    edges.NonManifoldEdgesOff()
    edges.ManifoldEdgesOff()
    edges.Update()
    mass = vtk.vtkMassProperties()
    mass.SetInputConnection(triangles.GetOutputPort())
    mass.Update()
    return mass.GetSurfaceArea(), edges.GetOutput().GetNumberOfCells()


def judge_vtk(whole, parts):
    """Each cell, point and value of the whole is somebody's own, ghosts are the same things, and contours have no seams."""
    own = parts.cells["vtkGhostType"] == 0
    ids, of_points = parts.cells["GlobalCellIds"], parts.points["GlobalPointIds"]
    n = whole.grid.GetNumberOfCells()
    same("own cells", own.sum(), n)
    same("numbers of own cells", sorted(ids[own]) == list(range(n)), True)
    own_points = parts.points["vtkGhostType"] == 0
    same("numbers of own points", sorted(of_points[own_points]) == list(range(whole.grid.GetNumberOfPoints())), True)
    same("places of points", np.array_equal(parts.at, whole.at[of_points]), True)
    for kind in ("Volume", "Area", "Length"):
        near(kind, parts.sizes[kind][own].sum(), whole.sizes[kind].sum(), 1e-12)
    if not (parts.cells["vtkGhostType"] != 0).any():
        raise Difference("no ghosts")
    # Nodes of each cell, ghosts too, are those of the whole.
    for c in range(len(ids)):
        mine = of_points[parts.nodes[parts.ends[c]:parts.ends[c + 1]]]
        theirs = whole.nodes[whole.ends[ids[c]]:whole.ends[ids[c] + 1]]
        if not np.array_equal(mine, theirs):
            raise Difference(f"cell {ids[c]} has other nodes in a part")
    for name, values in whole.cells.items():
        same(f"cell array {name}", np.array_equal(parts.cells[name], values[ids]), True)
    for name, values in whole.points.items():
        same(f"point array {name}", np.array_equal(parts.points[name], values[of_points]), True)
    same("parts", set(parts.cells["part"]), set(range(PARTS)))
    value = float(np.median(whole.at @ np.array([1.0, 0.31, 0.17]))) + 1e-3
    (area, rims), (expected, expected_rims) = seam(parts, value), seam(whole, value)
    near("area of a contour", area, expected, 1e-9)
    same("edges of a contour with one triangle", rims, expected_rims)


def ghost_layers(folder):
    """Per part the numbers of its ghosts, from .pvtu."""
    import vtk
    layers = []
    for k in range(PARTS):
        piece = Grid(vtk.vtkXMLUnstructuredGridReader(), folder / f"pvtu/pvtu_{k:04}.vtu")
        tets = piece.cells["patch"] < 0
        curves = piece.cells["curve"] >= 0 if "curve" in piece.cells else np.zeros(len(tets), bool)
        layers.append(set(piece.cells["GlobalCellIds"][(piece.cells["vtkGhostType"] != 0) & tets & ~curves]))
    return layers


def judge_pvtu(folder, parts):
    if not installed("vtk"):
        return
    import vtk
    whole = Grid(vtk.vtkXMLUnstructuredGridReader(), folder / "vtu.vtu")
    judge_vtk(whole, Grid(vtk.vtkXMLPUnstructuredGridReader(), parts / "pvtu.pvtu"))
    yield "VTK"


def judge_vtkhdf(folder, parts):
    if not installed("vtk") or not (parts / "vtkhdf.vtkhdf").exists():
        return
    import vtk
    whole = Grid(vtk.vtkXMLUnstructuredGridReader(), folder / "vtu.vtu")
    alone = Grid(vtk.vtkHDFReader(), folder / "vtkhdf.vtkhdf")
    same("nodes", np.array_equal(alone.nodes, whole.nodes) and np.array_equal(alone.at, whole.at), True)
    renamed = lambda name: name.replace("/", "_")
    for name, values in whole.cells.items():
        same(f"cell array {name}", np.array_equal(alone.cells[renamed(name)], values), True)
    whole.cells = {renamed(name): values for name, values in whole.cells.items()}
    whole.points = {renamed(name): values for name, values in whole.points.items()}
    judge_vtk(whole, Grid(vtk.vtkHDFReader(), parts / "vtkhdf.vtkhdf"))
    yield "VTK"


def gmsh_groups(gmsh):
    """Per physical group the number of its elements by Gmsh, those of all partitions together."""
    groups = {}
    for dimension, tag in gmsh.model.getPhysicalGroups():
        if dimension == 0:
            continue
        elements = set()
        for entity in gmsh.model.getEntitiesForPhysicalGroup(dimension, tag):
            _, tags, _ = gmsh.model.mesh.getElements(dimension, entity)
            for some in tags:
                elements.update(int(t) for t in some)
        groups[dimension, gmsh.model.getPhysicalName(dimension, tag)] = len(elements)
    return groups


def judge_msh(folder, parts):
    if not installed("gmsh"):
        return
    import gmsh
    gmsh.initialize(["gmsh"])
    gmsh.option.setNumber("General.Verbosity", 2)
    gmsh.logger.start()
    try:
        compare_msh(gmsh, folder, parts)
    finally:
        gmsh.logger.stop()
        gmsh.finalize()
    yield "Gmsh"


def compare_msh(gmsh, folder, parts):
    gmsh.open(str(folder / "msh.msh"))
    whole, nodes = gmsh_groups(gmsh), len(gmsh.model.mesh.getNodes()[0])
    layers = ghost_layers(parts) if installed("vtk") else None
    for file in (parts / "msh.msh",) + tuple((parts.with_name(folder.name + "_split") / f"msh_{k + 1}.msh") for k in range(PARTS)):
        gmsh.clear()
        gmsh.open(str(file))
        volumes = [e for e in gmsh.model.getEntities(3) if gmsh.model.getType(*e) == "Partition volume"]
        found = {int(p) - 1 for e in volumes for p in gmsh.model.getPartitions(*e)}
        number = int(file.stem.split("_")[1]) - 1 if "_" in file.stem else None
        same("partitions", found, set(range(PARTS)) if number is None else {number})
        if file == parts / "msh.msh":
            same("nodes", len(gmsh.model.mesh.getNodes()[0]), nodes)
            same("groups", gmsh_groups(gmsh), whole)
            sums = dict.fromkeys(whole, 0)
        else:
            for group, count in gmsh_groups(gmsh).items():
                sums[group] += count
        for dimension, entity in gmsh.model.getEntities(3):
            if gmsh.model.getType(dimension, entity) != "Ghost volume" or layers is None:
                continue
            part = [int(p) for p in gmsh.model.getPartitions(dimension, entity)][0] - 1
            tags, owners = gmsh.model.mesh.getGhostElements(dimension, entity)
            same(f"ghosts of part {part}", len(tags), len(layers[part]))
            same("owners of ghosts", all(owner - 1 != part for owner in owners), True)
    same("groups of all files", sums, whole)
    complaints = [line for line in gmsh.logger.get() if line.startswith(("Warning", "Error"))]
    same("complaints of Gmsh", complaints, [])


def lists_of(folder, name):
    text = (folder / name).read_text()
    body = text[text.index("\n(") + 2:text.rindex(")")]
    return np.array([int(word) for word in body.split()], dtype=np.int64)


def faces_of(folder):
    text = (folder / "faces").read_text()
    body = text[text.index("\n(") + 2:text.rindex(")")]
    return [tuple(int(w) for w in line[line.index("(") + 1:-1].split()) for line in body.split("\n") if "(" in line]


def judge_openfoam(folder, parts):
    whole = folder / "case/constant/polyMesh"
    if not whole.exists():  # linear only: compared in another folder
        return
    faces, owner = faces_of(whole), lists_of(whole, "owner")
    seen_cells, seen_faces = [], np.zeros(len(faces), dtype=int)
    for k in range(PARTS):
        piece = parts / f"case/processor{k}/constant/polyMesh"
        cells, points, labels = (lists_of(piece, name + "ProcAddressing") for name in ("cell", "point", "face"))
        seen_cells += list(cells)
        for mine, label, of in zip(faces_of(piece), labels, lists_of(piece, "owner")):
            theirs = faces[abs(label) - 1]
            theirs = theirs if label > 0 else (theirs[0],) + theirs[:0:-1]
            same("nodes of a face", tuple(points[v] for v in mine), theirs)
            if label > 0:
                same("owner of a face", cells[of], owner[label - 1])
            seen_faces[abs(label) - 1] += 1
    same("cells", sorted(seen_cells), list(range(len(seen_cells))))
    same("faces", seen_faces.min() == 1 and seen_faces.max() == 2, True)
    yield "second reader"
    if not judges.has_openfoam("checkMesh") or not shutil.which("mpirun"):
        return
    with tempfile.TemporaryDirectory() as work:
        case = judges.new_case(work)
        head = "FoamFile { version 2.0; format ascii; class dictionary; object decomposeParDict; }\n"
        (case / "system/decomposeParDict").write_text(head + f"numberOfSubdomains {PARTS}; method scotch;\n")
        for k in range(PARTS):
            shutil.copytree(parts / f"case/processor{k}", case / f"processor{k}")
        run = subprocess.run(["mpirun", "--allow-run-as-root", "--oversubscribe", "-n", str(PARTS), "checkMesh", "-parallel",
                              "-allTopology", "-case", str(case)], capture_output=True, text=True, timeout=250)
        log = run.stdout + run.stderr
        if "Mesh OK" not in log or "Coupled point location match" not in log:
            raise Difference("checkMesh -parallel: " + log[-1500:])
        same("cells of checkMesh", int(log.split("cells:")[1].split()[0]), len(seen_cells))
        yield "checkMesh -parallel"
        subprocess.run(["reconstructParMesh", "-constant", "-case", str(case)], capture_output=True, timeout=250)
        log = subprocess.run(["checkMesh", "-constant", "-allTopology", "-case", str(case)], capture_output=True, text=True,
                             timeout=250).stdout
        same("reconstructed cells", int(log.split("cells:")[1].split()[0]), len(seen_cells))
        same("reconstructed faces", int(log.split("faces:")[1].split()[0]), len(faces))
        yield "reconstructParMesh"


JUDGES = {"pvtu": judge_pvtu, "vtkhdf": judge_vtkhdf, "msh": judge_msh, "openfoam": judge_openfoam}


def main():
    root = Path(sys.argv[1])
    failed = False
    for parts in sorted(root.glob("*_parts")):
        folder = root / parts.name[:-len("_parts")]
        for name in sys.argv[2:] or JUDGES:
            try:
                for judge in JUDGES[name](folder, parts):
                    print(f"{folder.name} {name} by {judge}: as expected")
            except Difference as difference:
                print(f"{folder.name} {name}: {difference}")
                failed = True
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
