#!/usr/bin/env python3
"""The add-ons that stand on VTK alone: addons/vtk, the example for ParaView on its page, and the part of 3D Slicer's module that needs no Slicer.

    vtk_test.py OCTAFRONT [TEST ...]          skipped, with status 77, where VTK for Python is not installed
"""
import gzip
import os
import pathlib
import py_compile
import re
import sys
import tempfile
import unittest

try:
    import vtk
    from vtk.util.vtkAlgorithm import VTKPythonAlgorithmBase
except ImportError:
    print("skipped: VTK for Python (Debian: python3-vtk9) is not installed")
    sys.exit(77)

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "addons/slicer/Octafront")]
import octafront_program as program  # noqa: E402
import octafront_segmentation as segmentation  # noqa: E402
import octafront_vtk  # noqa: E402

os.environ["OCTAFRONT"] = str(pathlib.Path(sys.argv.pop(1)).resolve())


def ball(radius=1.0):
    source = vtk.vtkSphereSource()
    source.SetRadius(radius)
    source.SetThetaResolution(24)
    source.SetPhiResolution(16)
    source.Update()
    return source.GetOutput()


def volumes(grid, by="region"):
    """{value of a cell array: signed volume of its tetrahedra}"""
    found, values = {}, grid.GetCellData().GetArray(by)
    for c in range(grid.GetNumberOfCells()):
        cell = grid.GetCell(c)
        if cell.GetCellDimension() == 3:
            a, b, c_, d = (grid.GetPoint(cell.GetPointId(i)) for i in range(4))
            u, v, w = ([p[k] - a[k] for k in range(3)] for p in (b, c_, d))
            volume = (u[0] * (v[1] * w[2] - v[2] * w[1]) + u[1] * (v[2] * w[0] - v[0] * w[2]) + u[2] * (v[0] * w[1] - v[1] * w[0])) / 6
            assert volume > 0, "a tetrahedron is inside out"
            key = int(values.GetTuple1(c)) if values else 0
            found[key] = found.get(key, 0) + volume
    return found


class Surfaces(unittest.TestCase):
    def test_a_ball(self):
        surface, heard = ball(), []
        grid = octafront_vtk.tetrahedra(surface, size=.3, progress=lambda *now: heard.append(now))
        mass = vtk.vtkMassProperties()
        triangles = vtk.vtkTriangleFilter()
        triangles.SetInputData(surface)
        mass.SetInputConnection(triangles.GetOutputPort())
        self.assertAlmostEqual(sum(volumes(grid).values()) / mass.GetVolume(), 1, delta=.05)
        self.assertIn("volume front", {stage for stage, _ in heard})
        alone = octafront_vtk.tetrahedra_alone(grid)
        self.assertEqual({alone.GetCellType(c) for c in range(alone.GetNumberOfCells())}, {vtk.VTK_TETRA})
        self.assertLess(alone.GetNumberOfCells(), grid.GetNumberOfCells())
        self.assertIsNone(alone.GetCellData().GetArray("is solid"))
        self.assertIsNone(grid.GetCellData().GetArray("is solid"))

    def test_options_and_refusals(self):
        second = octafront_vtk.tetrahedra_alone(octafront_vtk.tetrahedra(ball(), size=.5, order=2, size_near=["0,0,1=.2:.5", "0,0,-1=.2:.5"]))
        self.assertEqual({second.GetCellType(c) for c in range(second.GetNumberOfCells())}, {vtk.VTK_QUADRATIC_TETRA})
        with self.assertRaises(program.Refused):
            octafront_vtk.tetrahedra(ball(), output="x.vtu")
        with self.assertRaises(program.Refused):
            octafront_vtk.tetrahedra(vtk.vtkPolyData())
        with self.assertRaises(program.Failed) as failed:
            octafront_vtk.tetrahedra(ball(), size=.1, max_elements=10)
        self.assertEqual(failed.exception.report["error"]["code"], "max_elements")
        asked = []
        with self.assertRaises(program.Cancelled):
            octafront_vtk.tetrahedra(ball(), size=.01, cancelled=lambda: asked.append(1) or len(asked) > 10)

    def test_the_example_of_the_page(self):
        """In a pipeline of VTK: its own vtkProgrammableFilter gives back what it takes, so a filter of Python stands for ParaView's."""
        page = (ROOT / "docs/use/vtk.md").read_text()
        block = next(text for text in re.findall(r"```python\n(.*?)```", page, re.S) if "GetPolyDataInput" in text)
        self.assertIn('"/path/to/octafront/addons/vtk"', block)
        block = block.replace("/path/to/octafront", str(ROOT))
        class Programmable(VTKPythonAlgorithmBase):
            """What ParaView's filter has that the script uses."""

            def __init__(self):
                super().__init__(inputType="vtkPolyData", outputType="vtkUnstructuredGrid")

            def RequestData(self, request, inputs, outputs):
                self.GetPolyDataInput = lambda: vtk.vtkPolyData.GetData(inputs[0])
                self.GetUnstructuredGridOutput = lambda: vtk.vtkUnstructuredGrid.GetData(outputs)
                exec(block, {"self": self})
                return 1

        source = vtk.vtkSphereSource()
        source.SetRadius(10)
        able, surface = Programmable(), vtk.vtkDataSetSurfaceFilter()
        able.SetInputConnection(source.GetOutputPort())
        surface.SetInputConnection(able.GetOutputPort())
        surface.Update()
        self.assertGreater(surface.GetOutput().GetNumberOfCells(), 50)
        few = sum(volumes(able.GetOutputDataObject(0)).values())
        source.SetThetaResolution(40), source.SetPhiResolution(40)
        surface.Update()  # what comes before changed: it runs again
        self.assertAlmostEqual(sum(volumes(able.GetOutputDataObject(0)).values()) / (4 / 3 * 3.14159 * 1000), 1, delta=.05)
        self.assertGreater(sum(volumes(able.GetOutputDataObject(0)).values()), 1.05 * few)


def write_nrrd(file, space, header="", compress=False):
    """Voxels of 1 x 1.5 x 2: a block of label 1, in it one of label 2."""
    size = (20, 16, 12)
    values = bytearray()
    for k in range(size[2]):
        for j in range(size[1]):
            for i in range(size[0]):
                inside = all(low <= n < high for n, (low, high) in zip((i, j, k), INNER))
                edge = 0 in (i, j, k) or i == size[0] - 1 or j == size[1] - 1 or k == size[2] - 1
                values.append(0 if edge else 2 if inside else 1)
    text = (f"NRRD0004\ntype: uchar\ndimension: 3\n{'space: ' + space + chr(10) if space else ''}sizes: {size[0]} {size[1]} {size[2]}\n"
            "space directions: (1,0,0) (0,1.5,0) (0,0,2)\nkinds: domain domain domain\nendian: little\n"
            f"encoding: {'gzip' if compress else 'raw'}\nspace origin: (0.5,0.75,1)\n{header}\n")
    pathlib.Path(file).write_bytes(text.encode() + (gzip.compress(bytes(values)) if compress else bytes(values)))


INNER = ((12, 18), (5, 11), (3, 7))  # voxels of label 2 along each axis
# By the map of the file.
MIDDLE = tuple(origin + step * (low + high - 1) / 2 for origin, step, (low, high) in zip((.5, .75, 1), (1, 1.5, 2), INNER))


def middle_of(grid, number):
    """Of the elements of a region, by volume."""
    total, middle = 0.0, [0.0] * 3
    values = grid.GetCellData().GetArray("region")
    for c in range(grid.GetNumberOfCells()):
        if int(values.GetTuple1(c)) == number:
            points = [grid.GetPoint(grid.GetCell(c).GetPointId(i)) for i in range(4)]
            volume = vtk.vtkTetra.ComputeVolume(*points)
            total += volume
            middle = [m + volume * sum(p[k] for p in points) / 4 for k, m in enumerate(middle)]
    return [m / total for m in middle]


class Segmentations(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.file = pathlib.Path(scratch.name) / "labels.nrrd"

    def test_a_label_map_lies_where_slicer_has_it(self):
        for space, signs in (("left-posterior-superior", (-1, -1, 1)), ("LPS", (-1, -1, 1)), ("RAS", (1, 1, 1)), ("", (1, 1, 1)),
                             ("left-anterior-superior", (-1, 1, 1))):
            write_nrrd(self.file, space, compress=space == "RAS")
            for order in (1, 2):
                grid, names, report = segmentation.Segmentation(self.file, {1: "organ", 2: "lesion"}, size=2, order=order).mesh()
                self.assertEqual(sorted(names.values()), ["lesion", "organ"])
                number = next(n for n, name in names.items() if name == "lesion")
                for at, sign, here in zip(middle_of(grid, number), signs, MIDDLE):
                    self.assertAlmostEqual(at, sign * here, delta=.05, msg=(space, order))
                found = volumes(grid)
                self.assertAlmostEqual(found[number] / (6 * 6 * 4 * 3), 1, delta=.1)
                self.assertEqual(grid.GetNumberOfCells(), report["tets"])

    def test_slicers_own_files_have_names(self):
        write_nrrd(self.file, "left-posterior-superior",
                   "Segment0_ID:=Segment_1\nSegment0_LabelValue:=1\nSegment0_Layer:=0\nSegment0_Name:=liver\nSegment0_Extent:=0 19 0 15 0 11\n"
                   "Segment1_ID:=Segment_2\nSegment1_LabelValue:=2\nSegment1_Layer:=0\nSegment1_Name:=large vessel\nSegment1_Extent:=0 19 0 15 0 11\n")
        named = self.file.with_suffix(".seg.nrrd")
        self.file.rename(named)
        _, names, _ = segmentation.Segmentation(named, size=3).mesh()
        self.assertEqual(sorted(names.values()), ["large vessel", "liver"])

    def test_what_is_refused(self):
        write_nrrd(self.file, "scanner-xyz")
        with self.assertRaises(program.Refused):
            segmentation.Segmentation(self.file, size=3).mesh()
        self.file.write_text("nothing")
        with self.assertRaises(program.Refused):
            segmentation.Segmentation(self.file, size=3).mesh()

    def test_the_module_is_python(self):
        """All that can be said of it without Slicer."""
        py_compile.compile(str(ROOT / "addons/slicer/Octafront/Octafront.py"), cfile=str(self.file) + "c", doraise=True)


if __name__ == "__main__":
    unittest.main()
