"""What other libraries make of our meshes: Debian's meshio and VTK. pyvista is not in Debian: a stand-in takes what it
would be given and makes VTK's own object of it, as pyvista does."""

import sys
import tempfile
import types
import unittest

import meshio
import numpy as np
import vtk
from vtk.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy

import octafront
from shapes import cube, sphere


class CellData(dict):
    pass


class UnstructuredGrid:
    """pyvista.UnstructuredGrid(cells, celltypes, points), as far as it goes."""

    def __init__(self, cells, celltypes, points):
        self.cell_data = CellData()
        array = vtk.vtkCellArray()
        array.ImportLegacyFormat(numpy_to_vtkIdTypeArray(np.ascontiguousarray(cells, np.int64), deep=True))
        place = vtk.vtkPoints()
        place.SetData(numpy_to_vtk(np.ascontiguousarray(points), deep=True))
        self.grid = vtk.vtkUnstructuredGrid()
        self.grid.SetPoints(place)
        self.grid.SetCells(numpy_to_vtk(celltypes, deep=True, array_type=vtk.VTK_UNSIGNED_CHAR), array)

    def extract_cells(self, ids):
        self.extracted = ids
        return self

    def plot(self, **keywords):
        return keywords

    def volume(self):
        sizes = vtk.vtkCellSizeFilter()
        sizes.SetInputData(self.grid)
        sizes.Update()
        return vtk_to_numpy(sizes.GetOutput().GetCellData().GetArray("Volume")).sum()


class PolyData:
    def __init__(self, points, faces):
        self.points, self.faces, self.cell_data = points, faces, CellData()


class Libraries(unittest.TestCase):
    def setUp(self):
        sys.modules["pyvista"] = types.SimpleNamespace(UnstructuredGrid=UnstructuredGrid, PolyData=PolyData)

    def test_vtk_finds_the_same_volume(self):
        for order in (1, 2):
            mesh = octafront.mesh(*cube(), size=0.3, order=order)
            grid = mesh.to_pyvista()
            self.assertEqual(grid.grid.GetNumberOfCells(), len(mesh))
            self.assertAlmostEqual(grid.volume(), 1, places=9)
            self.assertAlmostEqual(grid.cell_data["beta"].mean(), mesh.quality["beta_mean"])

    def test_plot_cuts_between_elements(self):
        mesh = octafront.mesh(*cube(), size=0.2)
        grid = mesh.to_pyvista()
        mesh.to_pyvista = lambda: grid
        self.assertEqual(mesh.plot(clip=(1, 0, 0), color="red")["color"], "red")
        centres = mesh.points[mesh.tets].mean(axis=1)
        self.assertTrue((centres[grid.extracted, 0] <= 0.5).all())
        self.assertAlmostEqual(len(grid.extracted) / len(mesh), 0.5, delta=0.1)

    def test_a_surface_for_pyvista(self):
        data = octafront.Surface(*cube()).to_pyvista()
        self.assertEqual(data.faces.reshape(-1, 4)[:, 0].tolist(), [3] * 12)

    def test_meshio_and_back(self):
        for order, kind in ((1, "tetra"), (2, "tetra10")):
            mesh = octafront.mesh(*sphere(), size=0.4, order=order).add_set("top", sphere=([0, 0, 1], 0.5))
            there = mesh.to_meshio()
            self.assertEqual([block.type for block in there.cells], [kind, "triangle"])
            self.assertEqual(there.point_sets["top"].tolist(), mesh.sets["top"][1].tolist())
            with tempfile.NamedTemporaryFile(suffix=".vtu") as file:
                meshio.write(file.name, there)
                read = meshio.read(file.name)
            again = octafront.Mesh(read.points, read.cells[0].data)
            np.testing.assert_array_equal(again.tets, mesh.tets)
            self.assertTrue(octafront.check(again))
            self.assertEqual(again.quality["beta_min"], mesh.quality["beta_min"])
        self.assertEqual(len(octafront.Surface(*cube()).to_meshio().cells[0].data), 12)


if __name__ == "__main__":
    unittest.main()
