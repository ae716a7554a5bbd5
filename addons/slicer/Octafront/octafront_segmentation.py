"""From a segmentation in a file to a mesh in Slicer's coordinates. Needs VTK, and nothing of Slicer."""
import gzip
import pathlib
import tempfile

import octafront_program as program
import octafront_vtk
import vtk

# Slicer's world is RAS: x to the patient's right, y to the front, z up. What a header says, as signs of x, y and z.
TO_RAS = {"right-anterior-superior": (1, 1, 1), "ras": (1, 1, 1), "left-posterior-superior": (-1, -1, 1), "lps": (-1, -1, 1),
          "left-anterior-superior": (-1, 1, 1), "las": (-1, 1, 1)}


def space_of(file):
    """What an NRRD file says of its coordinates, in lower case; "" if it says nothing. Raises Refused for another kind of file."""
    with open(file, "rb") as stream:
        head = stream.read(2)
        stream.seek(0)
        lines = gzip.GzipFile(fileobj=stream) if head == b"\x1f\x8b" else stream
        if not lines.readline(64).startswith(b"NRRD"):
            raise program.Refused(f"{file} is no NRRD file")
        for line in lines:
            text = line.decode("latin-1").strip()
            if not text:
                break
            if text.lower().startswith("space:"):
                return text[6:].strip().lower()
    return ""


def in_ras(grid, space):
    """The grid in Slicer's coordinates. Mirrored ones would turn tetrahedra inside out: these are turned back. Raises Refused for a space that is not known."""
    if not space:
        return grid
    if space not in TO_RAS:
        raise program.Refused(f"the image is in the space {space}, which is none of {', '.join(TO_RAS)}")
    signs = TO_RAS[space]
    mirror = vtk.vtkTransform()
    mirror.Scale(*signs)
    moved = vtk.vtkTransformFilter()
    moved.SetInputData(grid)
    moved.SetTransform(mirror)
    moved.Update()
    made = moved.GetOutput()
    return with_cells_turned(made) if signs[0] * signs[1] * signs[2] < 0 else made


# Which node takes which place, so that a cell that was mirrored is right again; VTK's order, mid-side nodes behind the corners.
TURNED = {vtk.VTK_TETRA: (1, 0, 2, 3), vtk.VTK_QUADRATIC_TETRA: (1, 0, 2, 3, 4, 6, 5, 8, 7, 9), vtk.VTK_TRIANGLE: (1, 0, 2),
          vtk.VTK_QUADRATIC_TRIANGLE: (1, 0, 2, 3, 5, 4)}


def with_cells_turned(grid):
    made = vtk.vtkUnstructuredGrid()
    made.SetPoints(grid.GetPoints())
    made.Allocate(grid.GetNumberOfCells())
    for c in range(grid.GetNumberOfCells()):
        cell = grid.GetCell(c)
        nodes = [cell.GetPointId(i) for i in range(cell.GetNumberOfPoints())]
        order = TURNED.get(cell.GetCellType(), range(len(nodes)))
        made.InsertNextCell(cell.GetCellType(), len(nodes), [nodes[i] for i in order])
    made.GetCellData().ShallowCopy(grid.GetCellData())
    made.GetPointData().ShallowCopy(grid.GetPointData())
    made.GetFieldData().ShallowCopy(grid.GetFieldData())
    return made


def write_names(names, file):
    """{label: name} as lines that octafront reads."""
    pathlib.Path(file).write_text("".join(f"{label} {name}\n" for label, name in sorted(names.items())), encoding="utf-8")


class Segmentation:
    """One run: a label map, or Slicer's own .seg.nrrd, which has the names of its segments, becomes a mesh of tetrahedra with a region for each."""

    def __init__(self, file, names=None, **options):
        """names: {label: name} of a label map. options: those of octafront mesh: size=3, elements=100000, order=2, preset="head", ..."""
        self.file, self.names, self.options = pathlib.Path(file), names or {}, options

    def mesh(self, executable="", progress=None, cancelled=None):
        """(vtkUnstructuredGrid of tetrahedra in RAS, {region number: name}, report). Cell array "region" is the number. Raises Refused, Failed, Cancelled."""
        space, options = space_of(self.file), dict(self.options)
        if not self.names:
            grid, report = octafront_vtk.meshed_file(self.file, options, executable=executable, progress=progress, cancelled=cancelled)
        else:
            with tempfile.TemporaryDirectory(prefix="octafront-") as folder:
                options["labels"] = pathlib.Path(folder, "names.txt")
                write_names(self.names, options["labels"])
                grid, report = octafront_vtk.meshed_file(self.file, options, executable=executable, progress=progress, cancelled=cancelled)
        return in_ras(octafront_vtk.tetrahedra_alone(grid), space), octafront_vtk.named_numbers(grid, "region"), report
