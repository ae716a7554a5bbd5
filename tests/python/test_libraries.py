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

    def test_vtk_finds_the_same_volume_in_wedges(self):
        points, triangles = cube()
        surface = octafront.Surface(points, triangles, patches=np.arange(12) // 2, patch_names=list("abcdef"))
        mesh = octafront.mesh(surface, size=0.3, layers=3, first=0.01, on="a,c")
        grid = mesh.to_pyvista()
        alone = len(mesh) - 3 * len(mesh.wedges) - 2 * len(mesh.pyramids)
        self.assertEqual(grid.grid.GetNumberOfCells(), alone + len(mesh.wedges) + len(mesh.pyramids))
        self.assertEqual(len(grid.cell_data["region"]), grid.grid.GetNumberOfCells())
        self.assertAlmostEqual(grid.volume(), 1, places=4)  # VTK divides bent sides its own way

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

    def test_meshio_has_the_names_of_the_file(self):
        mesh = two_cubes()
        sets = mesh.sets
        with tempfile.TemporaryDirectory() as folder:
            mesh.save(folder + "/m.msh")
            file, there, tagged = meshio.read(folder + "/m.msh"), mesh.to_meshio(), mesh.to_meshio()
            for part in ("region", "patch", "curve"):  # meshio cannot read what it writes of them
                del tagged.cell_data[part]
            meshio.write(folder + "/again.msh", tagged, file_format="gmsh22")
            again = meshio.read(folder + "/again.msh")
        parts = [name for names in mesh.names.values() for name in names]
        self.assertEqual(len(parts), 2 + 11 + 20)
        for name in parts:
            self.assertEqual(there.field_data[name].tolist(), file.field_data[name].tolist(), name)
            self.assertEqual(again.field_data[name].tolist(), file.field_data[name].tolist(), name)
        for name in [*parts, "some", "both", "edges"]:
            self.assertEqual(cells_of(there, name), cells_of(file, name), name)
            self.assertTrue(cells_of(there, name), name)
        for kind in ("tetra", "triangle", "line"):
            for name in ("gmsh:physical", "gmsh:geometrical"):
                tags = there.get_cell_data(name, kind)
                self.assertEqual(np.bincount(tags).tolist(), np.bincount(file.get_cell_data("gmsh:physical", kind)).tolist())
        self.assertEqual(there.point_sets["held"].tolist(), sets["held"][1].tolist())
        self.assertEqual(len(there.cells[1].data), len(mesh.faces))

    def test_meshio_has_wedges_and_quadrilaterals(self):
        points, triangles = cube()
        surface = octafront.Surface(points, triangles, patches=np.arange(12) // 2, patch_names=list("abcdef"))
        mesh = octafront.mesh(surface, size=0.3, layers=3, first=0.01, on="a").add_set("all", range(3), kind="elements")
        mesh.add_set("faces", np.arange(len(mesh.faces)), kind="faces")
        with tempfile.TemporaryDirectory() as folder:
            mesh.save(folder + "/m.msh")
            file, there = meshio.read(folder + "/m.msh"), mesh.to_meshio()
        for kind in ("tetra", "wedge", "triangle", "quad"):
            self.assertEqual(len(there.get_cells_type(kind)), len(file.get_cells_type(kind)), kind)
            self.assertGreater(len(there.get_cells_type(kind)), 0)
        for name in [*"abcdef", "layers", "volume", "faces"]:
            self.assertEqual(cells_of(there, name), cells_of(file, name), name)
        a, b, c, d = (there.points[there.get_cells_type("wedge")[:, k]] for k in (0, 1, 2, 3))
        self.assertGreater(np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a).min(), 0)

    def test_meshio_loses_none_of_two_equal_names(self):
        mesh = two_cubes().add_set("bottom", [0], kind="faces").add_set("low", [5], kind="faces")
        there = mesh.to_meshio()
        self.assertEqual(there.cell_sets["bottom_"][1].tolist(), [0])
        self.assertEqual(there.cell_sets["bottom"][1].tolist(), np.flatnonzero(mesh.patches == 0).tolist())
        self.assertEqual(there.cell_sets["low"][0].tolist(), np.flatnonzero(mesh.regions == 0).tolist())
        self.assertEqual(there.cell_sets["low"][1].tolist(), [5])

    def test_meshio_has_the_patches_of_a_surface(self):
        there = octafront.Surface(*cube(), patches=np.arange(12) // 6, patch_names=["a", "b"]).to_meshio()
        self.assertEqual(there.cell_sets["b"][0].tolist(), [6, 7, 8, 9, 10, 11])
        self.assertEqual(there.field_data["b"].tolist(), [2, 2])

    def test_vtk_surfaces_are_input(self):
        sphere_of_vtk = vtk.vtkSphereSource()
        sphere_of_vtk.SetThetaResolution(24)
        sphere_of_vtk.SetPhiResolution(12)
        sphere_of_vtk.Update()
        mesh = octafront.mesh(sphere_of_vtk.GetOutput(), size=0.2)
        whole = octafront.check(sphere_of_vtk.GetOutput()).volume
        self.assertAlmostEqual(whole, np.pi / 6, delta=0.03)
        self.assertAlmostEqual(volume_of(mesh), whole, delta=0.08 * whole)
        box = vtk.vtkCubeSource()  # quadrilaterals
        box.Update()
        self.assertAlmostEqual(volume_of(octafront.mesh(box.GetOutput(), size=0.3)), 1, places=9)
        self.assertTrue(octafront.check(octafront.mend(box.GetOutput())))
        joined = octafront.join_bodies({"box": box.GetOutput(), "ball": sphere_of_vtk.GetOutput()})
        self.assertEqual(joined.region_names, ["box", "ball"])

    def test_vtk_meshes_are_input(self):
        for order in (1, 2):
            mesh = octafront.mesh(*cube(), size=0.4, order=order)
            grid = mesh.to_pyvista().grid
            self.assertTrue(octafront.check(grid))
            better = octafront.improve(grid)
            self.assertGreaterEqual(better.quality["beta_min"], mesh.quality["beta_min"])
            # Its boundary, triangulated anew.
            self.assertAlmostEqual(volume_of(octafront.mesh(grid, size=0.3)), 1, places=9)

    def test_meshio_objects_are_input_with_their_names(self):
        mesh = two_cubes()
        with tempfile.TemporaryDirectory() as folder:
            mesh.save(folder + "/m.msh")
            file = meshio.read(folder + "/m.msh")
        for there in (mesh.to_meshio(), file):
            back = octafront.Mesh.of(there)
            self.assertEqual(len(back), len(mesh))
            self.assertTrue(octafront.check(there))
            self.assertEqual(len(back.sets["some"][1]), 2)
            self.assertEqual(len(octafront.improve(there).names["regions"]), 2)
            for name in ("low", "high"):
                self.assertEqual(part_size(back.names["regions"], back.regions, name),
                                 part_size(mesh.names["regions"], mesh.regions, name))
            for name in ("bottom", "side 3"):
                self.assertEqual(part_size(back.names["patches"], back.patches, name),
                                 part_size(mesh.names["patches"], mesh.patches, name))
        faces = octafront.Surface(*cube(), patches=np.arange(12) // 6, patch_names=["a", "b"]).to_meshio()
        again = octafront.mesh(faces, size=0.4)
        self.assertEqual(again.names["patches"][:2], ["a", "b"])
        self.assertAlmostEqual(volume_of(again), 1, places=9)
        quads = meshio.Mesh(np.array(cube()[0]), [("quad", np.array([[0, 1, 3, 2], [4, 5, 7, 6], [0, 1, 5, 4], [2, 3, 7, 6],
                                                                    [0, 2, 6, 4], [1, 3, 7, 5]]))])
        self.assertAlmostEqual(volume_of(octafront.mesh(quads, size=0.4)), 1, places=9)


def volume_of(mesh):
    a, b, c, d = (mesh.points[mesh.tets[:, i]] for i in range(4))
    return np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a).sum() / 6


def part_size(names, numbers, name):
    return int((numbers == names.index(name)).sum())


def two_cubes():
    """One on the other, with a patch for each of eleven sides, and sets of all kinds."""
    points, triangles = cube()
    walls = np.vstack([triangles, triangles[[t for t in range(12) if t not in (0, 1)]] + 8])
    sides = np.array([[-1, 0]] * 12 + [[-1, 1]] * 10)
    sides[[2, 3]] = [1, 0]
    names = ["bottom", "wall", *(f"side {i}" for i in range(9))]
    surface = octafront.Surface(np.vstack([points, points + [0, 0, 1]]), walls, sides=sides, region_names=["low", "high"],
                                patches=np.arange(22) // 2, patch_names=names)
    mesh = octafront.mesh(surface, size=0.4).add_set("held", box=[[0, 0, 0], [1, 1, 0]])
    mesh.add_set("some", [1, 3], kind="elements").add_set("edges", [1, 2], kind="edges")
    return mesh.add_set("both", [2, 5, len(mesh.faces) + 1], kind="faces")


def cells_of(mesh, name):
    """Where the corners of the cells of a set lie."""
    return {frozenset(map(tuple, mesh.points[corners])) for block, members in zip(mesh.cells, mesh.cell_sets[name])
            for corners in block.data[members.astype(int)]}


if __name__ == "__main__":
    unittest.main()
