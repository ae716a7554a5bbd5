"""Meshes of tetrahedra for VTK's pipelines, by the program octafront: ParaView's Programmable Filter, 3D Slicer, scripts.

    from octafront_vtk import tetrahedra
    grid = tetrahedra(polydata, size=2)          # a vtkUnstructuredGrid

Options are those of `octafront mesh`, with underscores: size=2, elements=100000, order=2, size_near=["0,0,0=1:10"], patches=True.
"""
import pathlib
import tempfile

import octafront_program as program
import vtk

OWN = {"output", "json", "format", "help", "quiet"}  # options that are given here


def arguments_of(options):
    """As a command line has them. Raises Refused for those that are given here."""
    words = []
    for name, value in options.items():
        name = name.replace("_", "-")
        if name in OWN:
            raise program.Refused(f"{name} is given here")
        if value is True:
            words.append(f"--{name}")
        elif value is not None and value is not False:
            words += [f"--{name}={one}" for one in (value if isinstance(value, (list, tuple)) else [value])]
    return words


def read_grid(file):
    reader = vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(file))
    reader.Update()
    return reader.GetOutput()


def meshed_file(file, options=None, *, executable="", progress=None, cancelled=None):
    """A file of any kind that octafront meshes: (vtkUnstructuredGrid, report). Arrays of cells: "region", "patch", ...; what is called how is in the field
    data ("region NAME" holds a number). Raises program.Refused, Failed, Cancelled."""
    with tempfile.TemporaryDirectory(prefix="octafront-") as folder:
        made, report = pathlib.Path(folder, "mesh.vtu"), pathlib.Path(folder, "report.json")
        command = [program.find(executable), "mesh", str(file), f"--output={made}", f"--json={report}", *arguments_of(options or {})]
        told = program.run(command, report, progress, cancelled)
        return read_grid(made), told


def write_surface(polydata, file):
    """As binary PLY: triangles alone, which is what bounds a body."""
    triangles = vtk.vtkTriangleFilter()
    triangles.SetInputData(polydata)
    triangles.PassVertsOff()
    triangles.PassLinesOff()
    triangles.Update()
    if triangles.GetOutput().GetNumberOfCells() == 0:
        raise program.Refused("there is no triangle in the surface")
    writer = vtk.vtkPLYWriter()
    writer.SetInputData(triangles.GetOutput())
    writer.SetFileName(str(file))
    writer.SetFileTypeToBinary()
    writer.Write()


def tetrahedra(polydata, executable="", progress=None, cancelled=None, **options):
    """What a surface encloses, as a vtkUnstructuredGrid. Its points are those of the input in single precision, as PLY has them. Raises as meshed_file()."""
    with tempfile.TemporaryDirectory(prefix="octafront-") as folder:
        surface = pathlib.Path(folder, "surface.ply")
        write_surface(polydata, surface)
        return meshed_file(surface, options, executable=executable, progress=progress, cancelled=cancelled)[0]


def named_numbers(grid, kind):
    """{number: name} of the regions or patches of a grid; `kind`: "region", "patch" or "curve"."""
    fields, found = grid.GetFieldData(), {}
    for i in range(fields.GetNumberOfArrays()):
        array = fields.GetAbstractArray(i)
        if array.GetName().startswith(kind + " "):
            found[int(array.GetVariantValue(0).ToInt())] = array.GetName()[len(kind) + 1:]
    return found


def tetrahedra_alone(grid):
    """Without the triangles and lines of patches and curves, which a grid of octafront has, too."""
    kept = vtk.vtkThreshold()
    kinds = vtk.vtkUnsignedCharArray()
    kinds.SetName("is solid")
    for cell in range(grid.GetNumberOfCells()):
        kinds.InsertNextValue(1 if grid.GetCell(cell).GetCellDimension() == 3 else 0)
    with_kinds = vtk.vtkUnstructuredGrid()
    with_kinds.ShallowCopy(grid)
    with_kinds.GetCellData().AddArray(kinds)
    kept.SetInputData(with_kinds)
    kept.SetInputArrayToProcess(0, 0, 0, vtk.vtkDataObject.FIELD_ASSOCIATION_CELLS, "is solid")
    kept.SetUpperThreshold(0.5)
    kept.SetThresholdFunction(vtk.vtkThreshold.THRESHOLD_UPPER)
    kept.Update()
    solid = kept.GetOutput()
    solid.GetCellData().RemoveArray("is solid")
    solid.GetFieldData().ShallowCopy(grid.GetFieldData())
    return solid
