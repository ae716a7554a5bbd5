"""The Python package as it is installed. Run with the Python of an environment that has it: python -m unittest"""

import copy
import gc
import html
import inspect
import json
import multiprocessing
import os
import pathlib
import pickle
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time
import types
import unittest

import numpy as np

import octafront
from shapes import cube, sphere

SAMPLES = pathlib.Path(os.environ["OCTAFRONT_SAMPLES"])


def hash_by_field(field):
    return octafront.mesh(*sphere(), size=field).report["hash"]


def meshed_hash(_):
    return octafront.mesh(*sphere(), size=0.2).report["hash"]


class VirtualRank:
    """A communicator as mpi4py has them, among threads."""

    def __init__(self, rank, places, barrier):
        self.rank, self.places, self.barrier = rank, places, barrier

    def Get_rank(self):
        return self.rank

    def Get_size(self):
        return len(self.places)

    def Is_inter(self):
        return False

    def _of_all(self, mine, take):
        self.places[self.rank] = mine
        self.barrier.wait()
        got = take(list(self.places))
        self.barrier.wait()
        return got

    def allgather(self, mine):
        return self._of_all(mine, lambda places: places)

    def Allgatherv(self, mine, into):
        self._put(into, self._of_all(mine, np.concatenate))

    def Alltoallv(self, mine, into):
        def take(places):
            firsts = [sum(counts[:self.rank]) for _, counts in places]
            return np.concatenate([data[first:first + counts[self.rank]] for (data, counts), first in zip(places, firsts)])

        self._put(into, self._of_all(mine, take))

    @staticmethod
    def _put(into, got):
        data, counts = into
        assert len(data) == sum(counts) == len(got)
        data[:] = got


def on_ranks(count, work):
    """What work(comm) returns or raises on each of so many ranks."""
    places, barrier, ends = [None] * count, threading.Barrier(count, timeout=120), [None] * count

    def run(rank):
        try:
            ends[rank] = work(VirtualRank(rank, places, barrier))
        except BaseException as error:
            ends[rank] = error

    threads = [threading.Thread(target=run, args=(rank,)) for rank in range(count)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    return ends


class Case(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)


class SharedByRanks(Case):
    def test_the_mesh_of_a_process_alone_on_each(self):
        alone = octafront.mesh(*sphere(), size=0.1)
        for count in (1, 2, 3):
            for mesh in on_ranks(count, lambda comm: octafront.mesh(*sphere(), size=0.1, comm=comm)):
                self.assertEqual(mesh.report["hash"], alone.report["hash"])
                self.assertTrue(np.array_equal(mesh.tets, alone.tets))
                talk = [stage for stage in mesh.report["stages"] if "rounds of talk" in json.dumps(stage)]
                self.assertEqual(bool(talk), count > 1)

    def test_functions_and_images(self):
        asked = [0, 0]

        def by_function(comm):
            def size(points):
                asked[comm.rank] += len(points)
                return 0.1 + 0.1 * np.abs(points[:, 0])

            return octafront.mesh(*sphere(), size=size, comm=comm).report["hash"]

        alone = octafront.mesh(*sphere(), size=lambda points: 0.1 + 0.1 * np.abs(points[:, 0])).report["hash"]
        self.assertEqual(on_ranks(2, by_function), [alone, alone])
        self.assertTrue(all(asked))
        labels = np.zeros((12, 12, 12), np.uint8)
        labels[3:9, 3:9, 3:6], labels[3:9, 3:9, 6:9] = 1, 2
        alone = octafront.mesh_image(labels, size=1).report["hash"]
        self.assertEqual(on_ranks(2, lambda comm: octafront.mesh_image(labels, size=1, comm=comm).report["hash"]), [alone] * 2)

    def test_what_fails_on_one_ends_all(self):
        def of_file(comm):
            return octafront.mesh("missing.stl" if comm.rank == 1 else SAMPLES / "bracket.stl", size=5, comm=comm)

        ends = on_ranks(3, of_file)
        self.assertEqual([type(end) for end in ends], [octafront.InputError] * 3)
        self.assertTrue(str(ends[0]).startswith("rank 1 of 3: "), ends[0])
        self.assertIn("missing.stl", str(ends[2]))
        ends = on_ranks(2, lambda comm: octafront.mesh(*sphere(), size=-1 if comm.rank == 0 else 1, comm=comm))
        self.assertEqual([type(end) for end in ends], [octafront.OptionError] * 2)
        ends = on_ranks(2, lambda comm: octafront.mesh(*sphere(), size=0.1 if comm.rank == 0 else 0.2, comm=comm))
        for end in ends:
            self.assertIsInstance(end, octafront.InternalError)
            self.assertIn("rank 1 of 2", str(end))

    def test_one_that_stops_ends_all(self):
        def stopped(comm):
            return octafront.mesh(*sphere(), size=0.1, comm=comm,
                                  progress=lambda phase, fraction: comm.rank == 0 or phase != "volume front")

        self.assertEqual([type(end) for end in on_ranks(3, stopped)], [octafront.Cancelled] * 3)

        def broken(comm):
            def tell(phase, fraction):
                if comm.rank == 1 and phase == "improve":
                    raise KeyError("mine")

            return octafront.mesh(*sphere(), size=0.1, comm=comm, progress=tell)

        self.assertEqual([type(end) for end in on_ranks(3, broken)], [octafront.Cancelled, KeyError, octafront.Cancelled])

    def test_what_is_no_communicator(self):
        for wrong in (2, "MPI.COMM_WORLD", object()):
            with self.assertRaisesRegex(octafront.OptionError, "mpi4py"):
                octafront.mesh(*sphere(), size=1, comm=wrong)
        with self.assertRaisesRegex(TypeError, "option of mesh"):
            octafront.surface(*sphere(), size=1, comm=None)


class Meshing(Case):
    def test_arrays_in_and_out(self):
        points, triangles = sphere()
        mesh = octafront.mesh(points, triangles, size=0.3)
        self.assertEqual(mesh.points.shape[1], 3)
        self.assertEqual(mesh.points.dtype, np.float64)
        self.assertEqual(mesh.tets.shape[1], 4)
        a, b, c, d = (mesh.points[mesh.tets[:, i]] for i in range(4))
        volumes = np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a) / 6
        self.assertTrue((volumes > 0).all())
        self.assertAlmostEqual(volumes.sum(), mesh.report["volume"], places=9)
        self.assertAlmostEqual(volumes.sum(), 4 / 3 * np.pi, delta=0.3)
        self.assertEqual(len(mesh.regions), len(mesh.tets))
        self.assertEqual(len(mesh.patches), len(mesh.faces))

    def test_the_same_mesh_as_the_command_line_and_for_every_number_of_threads(self):
        program = pathlib.Path(sys.executable).parent / "octafront"
        file, made = SAMPLES / "bracket.stl", self.folder / "b.mesh"
        report = self.folder / "b.json"
        subprocess.run([program, "mesh", file, "-o", made, "--size", "4", "--json", report], check=True,
                       stdout=subprocess.DEVNULL)
        hashes = {octafront.mesh_file(file, size=4, threads=n).report["hash"] for n in (1, 2)}
        hashes.add(json.loads(report.read_text())["hash"])
        self.assertEqual(len(hashes), 1, hashes)

    def test_arrays_are_views_that_outlive_their_mesh(self):
        mesh = octafront.mesh(*cube(), size=0.3)
        points, before = mesh.points, np.array(mesh.points)
        self.assertFalse(points.flags.writeable)
        self.assertFalse(points.flags.owndata)
        del mesh
        gc.collect()
        octafront.mesh(*cube(), size=0.25)
        np.testing.assert_array_equal(points, before)

    def test_arrays_of_any_layout_and_type(self):
        points, triangles = cube()
        expected = octafront.mesh(points, triangles, size=0.4).report["hash"]
        for p, t in [(np.asfortranarray(points), triangles.astype(np.uint8)), (points.astype(np.float32), triangles),
                     (points.tolist(), triangles.tolist()), (np.repeat(points, 2, axis=0)[::2], triangles[:, :]),
                     (points.astype(int), triangles.astype(np.uint32))]:
            self.assertEqual(octafront.mesh(p, t, size=0.4).report["hash"], expected)

    def test_patches_and_names(self):
        points, triangles = cube()
        patches = np.arange(12) // 2
        names = ["bottom", "top", "front", "back", "left", "right \"><script>"]
        surface = octafront.Surface(points, triangles, patches=patches, patch_names=names)
        mesh = octafront.mesh(surface, size=0.3)
        self.assertEqual(mesh.names["patches"], names)
        top = mesh.faces[mesh.patches == 1]
        self.assertTrue((mesh.points[top][..., 2] == 1).all())
        self.assertTrue(any("|" in name for name in mesh.names["curves"]))

    def test_sides_and_region_names_go_in_and_out(self):
        points, triangles = cube()
        sides = np.tile([-1, 0], (12, 1))
        surface = octafront.Surface(points, triangles, sides=sides, region_names=["steel"])
        self.assertEqual(surface.region_names, ["steel"])
        np.testing.assert_array_equal(surface.sides, np.tile([octafront.OUTSIDE, 0], (12, 1)))
        np.testing.assert_array_equal(octafront.Surface(points, triangles).sides, surface.sides)

    def test_two_regions(self):
        points, triangles = cube()
        upper = points + [0, 0, 1]
        walls = np.vstack([triangles, triangles[[t for t in range(12) if t not in (0, 1)]] + 8])
        # The top of the lower cube is the bottom of the upper one.
        sides = np.array([[-1, 0]] * 12 + [[-1, 1]] * 10)
        sides[[2, 3]] = [1, 0]
        surface = octafront.Surface(np.vstack([points, upper]), walls, sides=sides, region_names=["low", "high"])
        mesh = octafront.mesh(surface, size=0.3)
        self.assertEqual(mesh.names["regions"], ["low", "high"])
        heights = mesh.points[mesh.tets].mean(axis=1)[:, 2]
        np.testing.assert_array_equal(mesh.regions, heights > 1)
        self.assertTrue((mesh.points[mesh.interfaces][..., 2] == 1).all())
        self.assertGreater(len(mesh.interfaces), 10)

    def test_what_lies_inside(self):
        points, triangles = cube()
        sheet = ([[.25, .25, .5], [.75, .25, .5], [.75, .75, .5], [.25, .75, .5]], [[0, 1, 2], [0, 2, 3]])
        mesh = octafront.mesh(points, triangles, size=.2, sheet={"crack": sheet}, split="crack",
                              wire={"rod": [[.1, .1, .1], [.9, .1, .1]]}, inner_points={"gauges": np.array([[.5, .5, .8]])})
        self.assertTrue({"crack_plus", "crack_minus"} <= set(mesh.names["patches"]))
        behind, front = mesh.split_faces[:, :3], mesh.split_faces[:, 3:]
        self.assertGreater(len(behind), 0)
        np.testing.assert_array_equal(mesh.points[behind], mesh.points[front])
        self.assertIn("rod", mesh.names["curves"])
        with self.assertRaises(octafront.OptionError):
            octafront.mesh(points, triangles, sheet={"crack": 3})

    def test_second_order(self):
        mesh = octafront.mesh(*sphere(), size=0.4, order=2)
        self.assertEqual((mesh.order, mesh.mid_nodes.shape), (2, (len(mesh.tets), 6)))
        self.assertTrue(octafront.check(mesh))

    def test_a_mesh_keeps_its_surface(self):
        points, triangles = cube()
        mesh = octafront.mesh(points, triangles, keep_surface=True)
        self.assertEqual(len(mesh.faces), 12)



class Images(Case):
    """A core in a rind, voxels of 1 x 1 x 1.5."""

    def setUp(self):
        super().setUp()
        i, j, k = np.indices((30, 26, 18))
        self.distance = np.sqrt((i - 15.) ** 2 + (j - 13.) ** 2 + (1.5 * (k - 9.)) ** 2)
        self.labels = np.where(self.distance < 6, 2, np.where(self.distance < 10, 1, 0))
        self.affine = np.array([[0, -1, 0, 5], [1, 0, 0, 2], [0, 0, 1.5, 3], [0, 0, 0, 1.]])

    def test_labels_of_an_array_become_regions(self):
        mesh = octafront.mesh_image(self.labels, spacing=(1, 1, 1.5), labels={1: "rind", 2: "core"}, size=1.2)
        self.assertTrue(octafront.check(mesh))
        self.assertEqual(mesh.names["regions"], ["rind", "core"])
        volumes = tet_volumes(mesh)
        for region, label in enumerate((1, 2)):
            self.assertAlmostEqual(volumes[mesh.regions == region].sum() / (1.5 * (self.labels == label).sum()), 1, delta=0.03)
        made = {r["name"]: r["volume"] for r in mesh.report["image"]["regions"]}
        self.assertAlmostEqual(made["core"], 1.5 * (self.labels == 2).sum(), delta=1e-3 * made["core"])

    def test_any_type_and_layout_is_the_same_image(self):
        first = octafront.image_surface(self.labels.astype(np.uint8), self.affine)
        for values in (self.labels.astype(np.int64), self.labels.astype(np.float64), self.labels.astype(">i2"),
                       np.asfortranarray(self.labels), np.repeat(self.labels, 2, axis=0)[::2], self.labels.tolist()):
            again = octafront.image_surface(np.asarray(values), self.affine, threads=2)
            np.testing.assert_array_equal(again.points, first.points)
            np.testing.assert_array_equal(again.sides, first.sides)
        self.assertEqual(octafront.image_surface(self.labels * (2**24 + 1.0)).region_names, ["label 16777217", "label 33554434"])

    def test_surfaces_of_labels_go_before_voxels(self):
        middle = np.array([15, 13, 13.5])
        octafront.image_surface(-self.distance, iso=-6.1, spacing=(1, 1, 1.5)).save(self.folder / "ball.ply")
        ball = lambda **keywords: octafront.image_surface((self.distance < 6.6).astype(int), spacing=(1, 1, 1.5), **keywords)
        placed = ball(surface_of={1: self.folder / "ball.ply"})
        np.testing.assert_allclose(np.linalg.norm(placed.points - middle, axis=1), 6.1, atol=0.15)
        self.assertIn('"label 1" follows', " ".join(placed.report["notes"]))
        self.assertEqual(placed.points.tobytes(), ball(surface_of={"label 1": [self.folder / "ball.ply"]}).points.tobytes())
        with self.assertRaisesRegex(octafront.OptionError, "does not have"):
            ball(surface_of={"liver": self.folder / "ball.ply"})

    def test_an_affine_map_places_the_voxels(self):
        plain = octafront.image_surface(self.labels, spacing=(1, 1, 1.5)).points
        placed = octafront.image_surface(self.labels, self.affine).points
        steps = plain / (1, 1, 1.5)
        np.testing.assert_allclose(placed, steps @ self.affine[:3, :3].T + self.affine[:3, 3], atol=1e-9)
        for bad in ({"affine": np.eye(3)}, {"affine": np.diag([1, 1, 1, 2.])}, {"spacing": (1, 2)},
                    {"affine": self.affine, "spacing": 1}, {"series": 1}):
            with self.assertRaises(octafront.OptionError):
                octafront.image_surface(self.labels, **bad)
        with self.assertRaises(octafront.InputError):
            octafront.image_surface(self.labels, np.diag([1, 1, 0, 1]))

    def test_grey_values_lie_between_voxels(self):
        ball = octafront.image_surface(-self.distance, iso=-8.3, spacing=(1, 1, 1.5))
        middle = np.array([15, 13, 13.5])
        np.testing.assert_allclose(np.linalg.norm(ball.points - middle, axis=1), 8.3, atol=0.1)
        both = octafront.image_surface(-self.distance, bands={"core": (-5, None), "rind": (-9, -5)}, spacing=(1, 1, 1.5))
        self.assertEqual(both.region_names, ["core", "rind"])
        with self.assertRaises(octafront.InputError) as caught:
            octafront.mesh_image(self.distance)
        self.assertIn("`bands`", str(caught.exception))
        broken = self.distance.copy()
        broken[3, 4, 5] = np.nan
        with self.assertRaisesRegex(octafront.InputError, r"voxel \(3, 4, 5\)"):
            octafront.image_surface(broken, iso=5)

    def test_regions_are_chosen_and_cleaned(self):
        regions = lambda **keywords: [r["name"] for r in octafront.image_surface(self.labels, **keywords).report["regions"]]
        self.assertEqual(regions(), ["label 1", "label 2"])
        self.assertEqual(regions(ignore=()), ["label 0", "label 1", "label 2"])
        self.assertEqual(regions(ignore=[0, 1]), ["label 2"])
        self.assertEqual(regions(merge={"both": (1, 2)}), ["both"])
        speck = self.labels.copy()
        speck[1, 1, 1] = 1
        notes = octafront.image_surface(speck, islands=2).report["notes"]
        self.assertTrue(any("islands" in note for note in notes), notes)
        self.assertEqual(octafront.image_surface(self.labels, crop=((15, None), (None, 25), (0, 17)), resample=2).report["size"], [8, 13, 9])
        with self.assertRaisesRegex(octafront.InputError, "label 2"):
            octafront.image_surface(self.labels, crop=((15, None), (0, 25), (0, 17)), closed_at_box=False)
        for bad in ({"kind": "gray"}, {"islands": -1}, {"close_voxels": 1000}, {"merge": {"a": ["x"]}}, {"crop": ((-1, 3), (0, 1), (0, 1))},
                    {"iso": 1, "kind": "labels"}, {"resample": 0}):
            with self.assertRaises(octafront.OptionError, msg=bad):
                octafront.image_surface(self.labels, **bad)
        with self.assertRaises(TypeError):
            octafront.mesh_image(self.labels, sise=2)

    def test_files_and_the_command_line_make_the_same(self):
        program = pathlib.Path(sys.executable).parent / "octafront"
        file, names, report = SAMPLES / "head_labels.nii.gz", SAMPLES / "head_labels.txt", self.folder / "r.json"
        subprocess.run([program, "mesh", file, "--labels", names, "--size", "14", "-o", self.folder / "h.msh", "--json", report],
                       check=True, stdout=subprocess.DEVNULL)
        mesh = octafront.mesh_image(file, labels=names, size=14)
        self.assertEqual(mesh.report["hash"], json.loads(report.read_text())["hash"])
        self.assertEqual(mesh.names["regions"], ["brain", "csf", "skull", "skin", "lesion"])
        self.assertEqual(mesh.report["image"]["frame"], "RAS")
        with self.assertRaisesRegex(octafront.InputError, "no such file"):
            octafront.image_surface(self.folder / "none.nii")
        with self.assertRaises(octafront.OptionError):
            octafront.image_surface(file, spacing=2)


def tet_volumes(mesh):
    a, b, c, d = (mesh.points[mesh.tets[:, i]] for i in range(4))
    return np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a) / 6


class Complexes(Case):
    """Boxes, whose volumes are exact."""

    @staticmethod
    def block(lo, hi):
        points, triangles = cube()
        points = np.asarray(points, float)
        least, extent = points.min(axis=0), np.ptp(points, axis=0)
        return octafront.Surface((points - least) / extent * (np.subtract(hi, lo)) + lo, triangles)

    def test_bodies_share_faces_and_the_later_one_has_its_way(self):
        joined = octafront.join_bodies({"plate": self.block((0, 0, 0), (4, 4, 1)), "pin": self.block((1, 1, 0), (2, 2, 3))})
        made = {r["name"]: r["volume"] for r in joined.report["regions"]}
        self.assertAlmostEqual(made["plate"], 15, places=12)
        self.assertAlmostEqual(made["pin"], 3, places=12)
        mesh = octafront.mesh(joined, size=0.5)
        self.assertTrue(octafront.check(mesh))
        self.assertEqual(mesh.names["regions"], ["plate", "pin"])
        self.assertGreater(len(mesh.interfaces), 0)
        volumes = tet_volumes(mesh)
        self.assertAlmostEqual(volumes[mesh.regions == 1].sum(), 3, places=9)

    def test_contacts_of_parts_are_opened(self):
        parts = octafront.join_bodies({"a": self.block((0, 0, 0), (1, 1, 1)), "b": self.block((1, 0, 0), (3, 1, 1))})
        self.assertEqual(octafront.mesh(parts, size=.5).opened_contacts, [])
        for way, conforming in (("split", True), ("separate", False)):
            mesh = octafront.mesh(parts, size=.5, contacts=way)
            self.assertEqual(mesh.opened_contacts, [("a_b (a|b)", "a_b (b|a)", conforming)])
            self.assertEqual(mesh.report["opened_contacts"][0]["conforming"], conforming)
        with self.assertRaisesRegex(octafront.OptionError, "there is no contact"):
            octafront.mesh(parts, size=.5, contact="a|c=split")

    def test_regions_are_named_and_emptied_by_points(self):
        with_wall = octafront.join_bodies({"a": self.block((0, 0, 0), (1, 1, 1)), "b": self.block((1, 0, 0), (3, 1, 1))})
        walls = octafront.Surface(with_wall.points, with_wall.triangles)
        cells = octafront.complex_of_walls(walls, regions={"left": (0.5, 0.5, 0.5)})
        self.assertEqual({r["name"]: round(r["volume"], 12) for r in cells.report["regions"]}, {"left": 1, "region_1": 2})
        one = octafront.complex_of_walls(walls, regions={"all": [(0.5, 0.5, 0.5), (2, 0.5, 0.5)]}, threads=1)
        self.assertEqual([round(r["volume"], 12) for r in one.report["regions"]], [3])
        half = octafront.complex_of_walls(walls, voids=np.array([[2, 0.5, 0.5]]))
        self.assertEqual([round(r["volume"], 12) for r in half.report["regions"]], [1])
        self.assertEqual(octafront.complex_of_walls(*cube()).report["regions"], [])

    def test_a_leak_has_its_way_with_it(self):
        points, triangles = self.block((0, 0, 0), (1, 1, 1)).points, self.block((0, 0, 0), (1, 1, 1)).triangles
        open_box = octafront.Surface(points, triangles[1:])
        with self.assertRaises(octafront.InputError) as raised:
            octafront.complex_of_walls(open_box, regions={"in": (0.5, 0.5, 0.5)})
        self.assertGreater(len(raised.exception.leak), 1)
        with self.assertRaisesRegex(octafront.OptionError, "`cells` is one of auto, regions, merge"):
            octafront.complex_of_walls(open_box, cells="all")
        with self.assertRaisesRegex(octafront.OptionError, "three coordinates"):
            octafront.complex_of_walls(open_box, regions={"in": (0.5, 0.5)})

    def test_a_soup_is_mended(self):
        box = self.block((0, 0, 0), (1, 1, 1))
        clean = octafront.mend(box)
        self.assertTrue(clean.report["clean"])
        np.testing.assert_array_equal(clean.points, box.points)
        closed = octafront.mend(box.points, box.triangles[1:])
        self.assertFalse(closed.report["clean"])
        self.assertAlmostEqual(closed.report["volume_after"], 1, places=9)
        self.assertTrue(octafront.check(octafront.mesh(closed, size=0.3)))
        self.assertTrue(np.all(np.isinf(closed.bounds)))  # nothing moved
        torn = np.array(box.points)[np.array(box.triangles)].reshape(-1, 3)
        torn[:3] += (0, 1e-4, 2e-4)
        sewn = octafront.mend(torn, np.arange(len(torn)).reshape(-1, 3))
        self.assertTrue(np.any(sewn.bounds == sewn.report["tolerance"]))
        np.testing.assert_array_equal(pickle.loads(pickle.dumps(sewn)).bounds, sewn.bounds)
        wrapped = octafront.mend(box, way="wrap", distance=0.1)
        self.assertLess(wrapped.points.min(), -0.05)
        with self.assertRaises(octafront.InputError):
            octafront.mend(box.points, box.triangles[:1])


class BesideTheLine(Case):
    def line(self, *arguments):
        report = self.folder / "report.json"
        program = pathlib.Path(sys.executable).parent / "octafront"
        subprocess.run([program, "mesh", *map(str, arguments), "-o", self.folder / "mesh.vtu", "--json", report], check=True,
                       stdout=subprocess.DEVNULL)
        return json.loads(report.read_text())


class OneWayIn(BesideTheLine):
    """Of the same input the command line and Python make the same mesh, bit for bit."""

    def soup(self):
        """Two spheres that overlap, one of them with a hole."""
        points, triangles = sphere()
        shifted = np.vstack([points, points + (0.7, 0, 0)])
        return octafront.Surface(shifted, np.vstack([triangles[1:], triangles + len(points)]))

    def test_a_clean_file(self):
        file = SAMPLES / "bracket.stl"
        expected = self.line(file, "--size", 6)["hash"]
        for source in (file, str(file), [file], octafront.Surface.read(file)):
            self.assertEqual(octafront.mesh(source, size=6).report["hash"], expected)

    def test_a_soup(self):
        soup, file = self.soup(), self.folder / "soup.off"
        soup.save(file)
        expected = self.line(file, "--size", .4, "--tolerance", .01)
        for source in (file, soup, octafront.Surface.read(file), octafront.mend(soup, tolerance=.01)):
            self.assertEqual(octafront.mesh(source, size=.4, tolerance=.01).report["hash"], expected["hash"])
        self.assertEqual(octafront.mesh(octafront.mend(soup, tolerance=.01), size=.4).report["hash"], expected["hash"])
        made = octafront.mesh(soup.points, soup.triangles, size=.4, tolerance=.01)
        self.assertEqual(made.report["hash"], expected["hash"])
        self.assertEqual(made.report["intake"]["repair"], expected["repair"])
        self.assertTrue(made.report["intake"]["notes"])
        automatic = self.line(file)["hash"]  # where bounds of repair hold
        self.assertEqual(octafront.mesh(file).report["hash"], automatic)
        self.assertEqual(octafront.mesh(pickle.loads(pickle.dumps(octafront.mend(soup)))).report["hash"], automatic)
        with self.assertRaises(octafront.InputError):
            octafront.mesh(soup, repair="none")

    def test_two_bodies(self):
        plate, pin = Complexes.block((0, 0, 0), (1, 1, 1)), Complexes.block((.25, .25, 1), (.75, .75, 1.5))
        files = [self.folder / "plate.off", self.folder / "pin.off"]
        plate.save(files[0]), pin.save(files[1])
        expected = self.line(*files, "--size", .25)["hash"]
        for source in (files, {"plate": plate, "pin": files[1]}, octafront.join_bodies({"plate": plate, "pin": pin})):
            mesh = octafront.mesh(source, size=.25)
            self.assertEqual(mesh.report["hash"], expected)
            self.assertEqual(mesh.names["regions"], ["plate", "pin"])

    def test_images(self):
        file, names = SAMPLES / "head_labels.nii.gz", SAMPLES / "head_labels.txt"
        expected = self.line(file, "--labels", names, "--resample", 12, "--size", 30)["hash"]
        surface = octafront.image_surface(file, labels=names, resample=12, size=30)
        for mesh in (octafront.mesh(file, labels=names, resample=12, size=30), octafront.mesh(surface, size=30),
                     octafront.mesh_image(file, labels=names, resample=12, size=30),
                     octafront.mesh(pickle.loads(pickle.dumps(surface)), size=30)):
            self.assertEqual(mesh.report["hash"], expected)
        grey, bands = SAMPLES / "head_ct.nii.gz", {"skin": (-200, 226), "bone": (226, None)}
        expected = self.line(grey, "--band", "skin=-200:226", "--band", "bone=226:", "--resample", 12, "--size", 30)["hash"]
        self.assertEqual(octafront.mesh(grey, bands=bands, resample=12, size=30).report["hash"], expected)

    def test_what_is_asked_on_the_way_in(self):
        plate = Complexes.block((0, 0, 0), (1, 1, 1))
        walls = octafront.Surface(plate.points, plate.triangles)
        self.assertEqual(octafront.mesh(walls, size=.5, region={"it": (.5, .5, .5)}).names["regions"], ["it"])
        for bad in ({"cells": "all"}, {"tolerance": -1}, {"tolerance": float("inf")}, {"bands": {"a": (0, 1)}},
                    {"close_voxels": -1}, {"repair": True}, {"region": {"in": (.5, .5)}}):
            with self.assertRaises(octafront.OptionError, msg=bad):
                octafront.mesh(self.soup(), size=.5, **bad)
        with self.assertRaises(octafront.InputError) as raised:
            octafront.mesh(walls.points, walls.triangles[1:], region={"in": (.5, .5, .5)})
        self.assertGreater(len(raised.exception.leak), 1)
        self.assertEqual(octafront.surface(self.soup(), size=.4).report["intake"]["repair"]["clean"], False)
        self.assertGreater(octafront.size_field(self.soup(), size=.4).expected_tets, 100)


class Cad(BesideTheLine):
    def setUp(self):
        super().setUp()
        if not (pathlib.Path(octafront.__file__).parent / "_bin" / "octafront-cad").exists():
            self.skipTest("built without OpenCASCADE")

    def test_the_same_mesh_as_the_command_line(self):
        file = SAMPLES / "bracket.step"
        for keywords, line in (({"size": 6}, ["--size", 6]), ({"elements": 4000}, ["--elements", 4000]),
                               ({"size": "6mm", "unit": "in"}, ["--size", "6mm", "--unit", "in"]),
                               ({"size": 8, "size_of": {"color #d03030": 2}}, ["--size", 8, "--size-of", "color #d03030=2"])):
            self.assertEqual(octafront.mesh(file, **keywords).report["hash"], self.line(file, *line)["hash"], keywords)

    def test_names_sets_and_volumes(self):
        mesh = octafront.mesh(SAMPLES / "assembly.step", size=6)
        self.assertEqual(mesh.names["regions"], ["plate", "bracket", "bolt", "bolt#2"])
        self.assertTrue({"seat", "fillet", "ground"} <= set(mesh.names["patches"]))
        kind, members = mesh.sets["solids of color #f09020"]
        self.assertEqual(kind, "elements")
        self.assertEqual(set(mesh.regions[members]), {2, 3})
        self.assertEqual(mesh.sets["layer mounting"][0], "faces")
        for region in mesh.report["regions"]:
            self.assertAlmostEqual(region["volume"] / region["true_volume"], 1, delta=.03)  # what chords cut off

    def test_groups_by_what_something_is_like(self):
        mesh = octafront.mesh(SAMPLES / "assembly.step", size=6, group={"foot": "largest plane at z min", "tips": "points at z max"})
        kind, members = mesh.sets["foot"]
        self.assertEqual(kind, "faces")
        self.assertEqual(len(members), np.sum(mesh.patches == mesh.names["patches"].index("ground")))
        kind, members = mesh.sets["tips"]
        self.assertEqual(kind, "nodes")
        np.testing.assert_array_equal(mesh.points[members][:, 2], 50)
        with self.assertRaises(octafront.OptionError):
            octafront.mesh(SAMPLES / "assembly.step", size=6, group={"foot": ""})

    def test_a_surface_that_was_read_keeps_its_geometry(self):
        surface = octafront.read(SAMPLES / "bracket.step")
        mesh = octafront.mesh(surface, size=6)
        self.assertGreater(mesh.report["true_volume"], 22000)
        self.assertEqual(octafront.mesh(surface, size=6, repair="auto").report["hash"], mesh.report["hash"])

    def test_shapes_that_write_themselves_are_input(self):
        class Shape:  # of CadQuery or FreeCAD
            def exportStep(self, name):
                shutil.copy(SAMPLES / "bracket.step", name)

        class Workplane:
            def vals(self):
                return [Shape()]

        wanted = octafront.mesh(SAMPLES / "bracket.step", size=8)
        for source in (Shape(), Workplane()):
            mesh = octafront.mesh(source, size=8)
            self.assertEqual(mesh.report["hash"], wanted.report["hash"])
            self.assertEqual(mesh.names, wanted.names)
        self.assertEqual(octafront.join_bodies({"part": Shape()}).region_names, ["part"])
        with self.assertRaisesRegex(octafront.InputError, "no shapes"):
            octafront.mesh(types.SimpleNamespace(vals=lambda: []))

    def test_without_the_program_it_says_what_to_do(self):
        os.environ["OCTAFRONT_CAD"] = "/bin/false"
        self.addCleanup(os.environ.pop, "OCTAFRONT_CAD")
        with self.assertRaisesRegex(octafront.InputError, "exit status 1"):
            octafront.mesh(SAMPLES / "bracket.step")
        os.environ["OCTAFRONT_CAD"] = str(self.folder / "none")
        with self.assertRaisesRegex(octafront.InputError, "none does not start: No such file"):
            octafront.mesh(SAMPLES / "bracket.step")


class Sizes(Case):
    def test_a_function_is_asked_in_batches(self):
        batches = []

        def size_at(points):
            batches.append(points.shape)
            return 0.1 + 0.3 * points[:, 0]

        mesh = octafront.mesh(*cube(), size=size_at, gradation=0.5)
        left = mesh.points[:, 0] < 0.2
        self.assertGreater(left.sum(), (mesh.points[:, 0] > 0.8).sum())
        self.assertGreater(max(n for n, _ in batches), 50)
        self.assertLess(len(batches), 200)

    def test_errors_of_a_function_come_through(self):
        def fails(points):
            raise KeyError("mine")

        with self.assertRaisesRegex(KeyError, "mine"):
            octafront.mesh(*cube(), size=fails)
        with self.assertRaisesRegex(octafront.OptionError, r"it has to return \(\d+,\)"):
            octafront.mesh(*cube(), size=lambda p: np.ones(3))
        with self.assertRaisesRegex(octafront.OptionError, "sizes must be above 0"):
            octafront.mesh(*cube(), size=lambda p: -np.ones(len(p)))

    def test_a_field_predicts_and_is_used(self):
        field = octafront.size_field(*sphere(), size=0.25)
        self.assertAlmostEqual(field([[0, 0, 0]])[0], 0.25, places=3)
        self.assertEqual(field(np.zeros((5, 3))).shape, (5,))
        self.assertEqual(field.metric_at(np.zeros((5, 3))).shape, (5, 3, 3))
        np.testing.assert_array_equal(field.metric_at([[0, 0, 0]])[0], np.eye(3) / field([[0, 0, 0]])[0] ** 2)
        mesh = octafront.mesh(*sphere(), size_field=field)
        self.assertAlmostEqual(len(mesh) / field.expected_tets, 1, delta=0.25)
        self.assertEqual(octafront.mesh(*sphere(), size=field).report["hash"], mesh.report["hash"])
        field.save(self.folder / "grid.vtu")
        again = octafront.SizeField.read(self.folder / "grid.vtu")
        self.assertAlmostEqual(again([[0.5, 0, 0]])[0], field([[0.5, 0, 0]])[0], places=6)

    def test_a_copy_of_a_field_makes_the_same_mesh(self):
        for field in (octafront.size_field(*sphere(), size=0.3, gradation=0.3, interior="graded"), octafront.SizeField(0.35)):
            expected = hash_by_field(field)
            for copied in (pickle.loads(pickle.dumps(field)), copy.copy(field), copy.deepcopy(field)):
                self.assertEqual((hash_by_field(copied), copied.report), (expected, field.report))
            with multiprocessing.get_context("spawn").Pool(2) as pool:
                self.assertEqual(set(pool.map_async(hash_by_field, [field] * 2).get(timeout=120)), {expected})
        packed = field.__getstate__()
        with self.assertRaisesRegex(octafront.InputError, "no packed size field"):
            octafront.SizeField.__new__(octafront.SizeField).__setstate__({**packed, "packed": packed["packed"][:-1]})

    def test_what_the_library_holds_is_not_copied_by_its_address(self):
        for made in (octafront.SizeField(1), octafront.Surface(*cube())):
            with self.assertRaisesRegex(TypeError, "cannot be copied"):
                copy.copy(made._handle)

    def test_lengths_have_units_as_on_the_command_line(self):
        plain, inches = SAMPLES / "bracket.stl", self.folder / "in.obj"
        octafront.Surface.read(plain).save(inches)
        inches.write_text("# File units = inches\n" + inches.read_text())
        program = pathlib.Path(sys.executable).parent / "octafront"
        for file, line, said in ((plain, ["--size", "0.6cm", "--unit", "mm", "--max-deviation", "0.005in"],
                                  {"size": "0.6cm", "unit": "MM", "max_deviation": " 0.005 in"}),
                                 (inches, ["--size", "160mm", "--min-size", "4in"], {"size": "160mm", "min_size": "4in"})):
            report = self.folder / "report.json"
            subprocess.run([program, "mesh", file, "-o", self.folder / "m.vtu", "--json", report, *line], check=True,
                           stdout=subprocess.DEVNULL)
            for source in (file, [file]):
                self.assertEqual(octafront.mesh(source, **said).report["hash"], json.loads(report.read_text())["hash"])
        self.assertEqual(octafront.mesh(*cube(), size="0.5").report["hash"], octafront.mesh(*cube(), size=0.5).report["hash"])
        for bad, words in (({"size": "2mm"}, "does not say what its coordinates count"), ({"size": "2 miles"}, "its unit"),
                           ({"size": "mm"}, "needs a number, or a length"), ({"size": 1, "unit": "mile"}, "one of um, mm"),
                           ({"size": "-1"}, "above 0"), ({"size": "inf"}, "needs a number")):
            with self.assertRaisesRegex(octafront.OptionError, words, msg=bad):
                octafront.mesh(*cube(), **bad)

    def test_regions_and_points(self):
        plain = len(octafront.mesh(*cube(), size=0.4))
        region = {"sphere": [0.5, 0.5, 0.5], "radius": 0.2, "size": 0.08}
        self.assertGreater(len(octafront.mesh(*cube(), size=0.4, regions=[region])), 1.5 * plain)
        self.assertGreater(len(octafront.mesh(*cube(), size=0.4, regions=np.array([[0, 0, 0, 0.05]]))), plain)
        points = np.hstack([cube()[0], np.full((8, 1), 0.2)])
        self.assertGreater(len(octafront.mesh(*cube(), point_sizes=points, gradation=0.9)), plain)
        file = self.folder / "r.csv"
        file.write_text("0, 0, 0, 0.05\n")
        self.assertGreater(len(octafront.mesh(*cube(), size=0.4, regions=file)), plain)

    def test_sizes_by_name(self):
        points, triangles = cube()
        surface = octafront.Surface(points, triangles, patches=np.arange(12) // 2, patch_names=list("abcdef"))
        plain = len(octafront.mesh(surface, size=0.4))
        self.assertGreater(len(octafront.mesh(surface, size=0.4, size_of={"b": 0.1})), 1.5 * plain)
        with self.assertRaises(octafront.OptionError):
            octafront.mesh(surface, size=0.4, size_of={"b": -1})
        near = octafront.mesh(surface, size=0.4, size_near={"b": (0.1, 0.5), (0, 0, 0): (0.05, 0.2)})
        self.assertGreater(len(near), 1.5 * plain)
        for wrong in ({"b": 0.1}, {"b": (0.1, -1)}, {(0, 0): (0.1, 1)}):
            with self.assertRaises(octafront.OptionError):
                octafront.mesh(surface, size=0.4, size_near=wrong)

    def test_sizes_on_a_mesh_and_by_a_function_alone(self):
        old = octafront.mesh(*cube(), size=0.3)
        sizes = 0.08 + 0.1 * old.points[:, 0]
        by_points = octafront.mesh(*cube(), size_field=(old.points, old.tets, sizes))
        by_function = octafront.mesh(*cube(), size=lambda p: 0.08 + 0.1 * p[:, 0])
        self.assertAlmostEqual(len(by_points) / len(by_function), 1, delta=0.15)
        by_elements = octafront.mesh(*cube(), size_field=(old.points, old.tets, np.full(len(old.tets), 0.1)))
        self.assertAlmostEqual(len(by_elements) / len(octafront.mesh(*cube(), size=0.1)), 1, delta=0.15)
        for wrong in ((old.points, old.tets), (old.points, old.tets + 10**6, sizes), (old.points, old.tets, sizes[1:])):
            with self.assertRaises(octafront.OptionError):
                octafront.mesh(*cube(), size_field=wrong)

    def test_functions_and_formulas_are_bodies(self):
        box = ((-1.2, -1.2, -1.2), (1.2, 1.2, 1.2))
        ball = octafront.mesh(lambda p: np.linalg.norm(p, axis=1) - 1, box=box, resolution=32, size=0.2)
        same = octafront.mesh("hypot(x, y, z) - 1", box=box, resolution=32, size=0.2)
        for mesh in (ball, same):
            # Chords of .2 cut 1.5 % off.
            self.assertAlmostEqual(mesh.report["volume"], 4 / 3 * np.pi, delta=0.08)
            self.assertLess(abs(np.linalg.norm(mesh.points[np.unique(mesh.faces)], axis=1) - 1).max(), 2e-3)
        with self.assertRaises(octafront.OptionError):
            octafront.mesh(lambda p: p[:, 0])
        with self.assertRaises(octafront.OptionError):
            octafront.mesh(lambda p: p, box=box)
        with self.assertRaises(octafront.OptionError):
            octafront.mesh("gyriod(x, y, z)")

    def test_number_of_elements(self):
        self.assertAlmostEqual(len(octafront.mesh(*sphere(), elements=20000)) / 20000, 1, delta=0.15)


class Refusals(Case):
    def refused(self, kind, words, function, *arguments, **keywords):
        with self.assertRaisesRegex(kind, words) as context:
            function(*arguments, **keywords)
        return context.exception

    def test_misspelt_keywords(self):
        self.refused(TypeError, "did you mean 'size'", octafront.mesh, *cube(), sise=1)
        self.refused(TypeError, "did you mean 'gradation'", octafront.mesh_file, "x", gradatoin=1)
        self.refused(TypeError, r"option of mesh\(\)", octafront.surface, *cube(), core="none")
        self.refused(TypeError, "unexpected keyword argument 'qqqqqq'$", octafront.mesh, *cube(), qqqqqq=1)
        self.refused(TypeError, "positional", octafront.mesh, *cube(), 0.1)

    def test_options(self):
        self.refused(octafront.OptionError, "`size` is -1, but must be above 0", octafront.mesh, *cube(), size=-1)
        self.refused(octafront.OptionError, "`size` and `elements` contradict", octafront.mesh, *cube(), size=1, elements=9)
        self.refused(octafront.OptionError, "`size` needs a number", octafront.mesh, *cube(), size="large")
        self.refused(octafront.OptionError, "`size` is nan: it must be finite", octafront.mesh, *cube(), size=float("nan"))
        self.refused(octafront.OptionError, "`method` is one of octree-aft", octafront.mesh, *cube(), method="best")
        self.refused(octafront.OptionError, "`elements` needs a whole number", octafront.mesh, *cube(), elements=10.5)
        self.refused(octafront.OptionError, "`threads`", octafront.mesh, *cube(), threads=-1)
        # Fields of the library are called as here.
        self.refused(octafront.OptionError, "`size_field`|size grid", octafront.mesh, *cube(), size=1,
                     size_field=octafront.SizeField(1))
        self.refused(ValueError, "above 0", octafront.SizeField, 0)

    def test_arrays(self):
        points, triangles = cube()
        self.refused(octafront.OptionError, r"\(n, 3\), not \(8, 2\)", octafront.mesh, points[:, :2], triangles)
        self.refused(octafront.OptionError, "whole numbers, not float64", octafront.mesh, points, triangles * 1.0)
        self.refused(octafront.OptionError, "holds -1", octafront.mesh, points, triangles - 1)
        self.refused(octafront.OptionError, "numbers, not <U", octafront.mesh, points.astype(str), triangles)
        ragged, equal = [[0, 0, 0], [1, 0]], "rows of equal length"
        self.refused(octafront.OptionError, "points must be.*" + equal, octafront.mesh, ragged, triangles)
        self.refused(octafront.OptionError, "triangles must be.*" + equal, octafront.mesh, points, ragged)
        self.refused(octafront.OptionError, "patches must be.*" + equal, octafront.Surface, points, triangles, patches=ragged)
        self.refused(octafront.OptionError, "sides must be.*" + equal, octafront.Surface, points, triangles, sides=ragged)
        self.refused(octafront.OptionError, "tets must be.*" + equal, octafront.Mesh, points, ragged)
        self.refused(octafront.OptionError, "an image must be.*" + equal, octafront.image_surface, [ragged])
        self.refused(octafront.OptionError, "`spacing` must be", octafront.image_surface, np.ones((3, 3, 3)), spacing=ragged)
        self.refused(octafront.OptionError, "`affine` must be", octafront.image_surface, np.ones((3, 3, 3)), ragged)
        self.refused(octafront.OptionError, "`point_sizes`.*" + equal, octafront.mesh, points, triangles, point_sizes=ragged)
        self.refused(octafront.OptionError, '"box" of region 0', octafront.mesh, points, triangles,
                     regions=[{"box": ragged, "size": 1}])
        error = self.refused(octafront.InputError, "names point 8, but there are 8", octafront.mesh, points, triangles + 1)
        self.assertIsInstance(error, ValueError)
        points[3, 1] = np.nan
        self.refused(octafront.InputError, "point 3", octafront.mesh, points, triangles)
        self.refused(octafront.InputError, "", octafront.mesh, np.zeros((0, 3)), np.zeros((0, 3), int))
        self.refused(TypeError, r"give points \(n, 3\) and triangles", octafront.mesh, points)

    def test_defects_are_evidence(self):
        points, triangles = cube()
        error = self.refused(octafront.InputError, "open edge", octafront.mesh, points, triangles[:-1], repair="none")
        self.assertEqual(error.defects["open_edges"]["count"], 3)
        self.assertFalse(str(error).endswith("\n"))
        self.assertEqual(error.defects["region_conflicts"]["count"], 0)
        place = error.defects["open_edges"]["first"][0]
        self.assertEqual(len(place["at"]), 3)
        self.assertTrue(all(face < 11 for face in place["faces"]))

    def test_files(self):
        self.refused(octafront.InputError, "missing.stl", octafront.mesh_file, self.folder / "missing.stl")
        bad = self.folder / "bad.off"
        bad.write_text("OFF\n8 12 0\n1 2\n")
        self.refused(octafront.InputError, "bad.off, byte 5", octafront.mesh_file, bad)
        open_cube = self.folder / "open.off"
        octafront.Surface(cube()[0], cube()[1][:-1]).save(open_cube)
        self.refused(octafront.InputError, "^.*open.off: ", octafront.mesh_file, open_cube, repair="none")
        mesh = octafront.mesh(*cube(), size=0.5)
        self.refused(octafront.OptionError, "ending", mesh.save, self.folder / "mesh.xyz")
        self.refused(octafront.OutputError, "", mesh.save, self.folder / "nowhere" / "mesh.vtu")
        self.refused(octafront.OptionError, "zero byte", mesh.save, "a\0b.vtu")
        self.assertFalse((self.folder / "nowhere").exists())

    def test_errors_mirror_those_of_the_library(self):
        self.assertTrue(issubclass(octafront.OpenCavityError, octafront.MeshingError))
        for kind in ("OptionError", "InputError", "MeshingError", "OutputError", "Cancelled"):
            self.assertTrue(issubclass(getattr(octafront, kind), octafront.Error))

    def test_an_open_cavity_comes_as_a_surface(self):
        from octafront._jobs import Job
        job = Job("repair", octafront.Surface(*cube())._handle)
        job.run()
        error = job._failure(4, "open", {})
        self.assertIsInstance(error, octafront.OpenCavityError)
        self.assertEqual(len(error.cavity.triangles), 12)


class Running(Case):
    def test_progress(self):
        told = []
        octafront.mesh(*sphere(), size=0.08, progress=lambda phase, fraction: told.append((phase, fraction)))
        self.assertGreater(len({phase for phase, _ in told}), 2)
        self.assertTrue(all(f is None or 0 <= f <= 1 for _, f in told))

    def test_false_cancels(self):
        with self.assertRaises(octafront.Cancelled):
            octafront.mesh(*sphere(60, 120), size=0.012, progress=lambda phase, fraction: False)

    def test_passes_are_told(self):
        passes = []
        octafront.mesh(*cube(), size=0.3, after_pass=lambda name, worst: passes.append((name, worst["beta"])))
        self.assertEqual([name for name, _ in passes][:2], ["start", "pieces"])

    def test_errors_in_progress_come_through(self):
        def fails(phase, fraction):
            raise ZeroDivisionError(phase)

        with self.assertRaises(ZeroDivisionError):
            octafront.mesh(*sphere(), size=0.1, progress=fails)

    def test_other_threads_of_python_work_meanwhile(self):
        counted, done = [0], threading.Event()

        def count():
            while not done.is_set():
                counted[0] += 1
                time.sleep(0.001)

        thread = threading.Thread(target=count)
        thread.start()
        octafront.mesh(*sphere(), size=0.06, threads=1)
        done.set()
        thread.join()
        self.assertGreater(counted[0], 20)

    def test_two_meshes_at_once(self):
        made = []
        threads = [threading.Thread(target=lambda: made.append(octafront.mesh(*sphere(), size=0.15).report["hash"]))
                   for _ in range(3)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(len(set(made)), 1)
        self.assertEqual(len(made), 3)

    def test_processes_that_were_forked_mesh_too(self):
        expected = meshed_hash(0)
        with multiprocessing.get_context("fork").Pool(2) as pool:
            self.assertEqual(set(pool.map_async(meshed_hash, range(3)).get(timeout=120)), {expected})

    def test_ctrl_c(self):
        code = ("import octafront, shapes, sys\n"
                "print('begun', flush=True)\n"
                "try:\n"
                "    octafront.mesh(*shapes.sphere(60, 120), size=0.008)\n"
                "except KeyboardInterrupt:\n"
                "    print('interrupted')\n"
                "    print(len(octafront.mesh(*shapes.cube(), size=.5).tets) > 0)\n")
        program = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.assertEqual(program.stdout.readline(), "begun\n")
        time.sleep(0.7)
        program.send_signal(signal.SIGINT)
        out, err = program.communicate(timeout=120)
        self.assertEqual((out, err), ("interrupted\nTrue\n", ""))

    def test_no_memory_is_lost(self):
        def resident():
            status = pathlib.Path("/proc/self/status").read_text()
            return int(next(line for line in status.splitlines() if line.startswith("VmRSS")).split()[1])

        def work():
            mesh = octafront.mesh(*sphere(), size=0.12)
            mesh.element_quality(), mesh.sets, mesh.names, octafront.check(mesh)
            try:
                octafront.mesh(sphere()[0], sphere()[1][:-1], repair="none")
            except octafront.InputError:
                pass

        for _ in range(3):
            work()
        before = resident()
        for _ in range(10):
            work()
        self.assertLess(resident() - before, 20_000)


class Meshes(Case):
    def test_adapt_follows_sizes_at_its_own_points(self):
        old = octafront.mesh(*cube(), size=0.3)
        wanted = 0.08 + 0.3 * np.linalg.norm(old.points, axis=1)
        new = octafront.adapt(old, sizes=wanted)
        self.assertGreater(len(new.tets), 1.5 * len(old.tets))
        fit = new.report["fit"]
        self.assertGreater(fit["fitting"], 0.93 * fit["edges"])
        self.assertLess(fit["longest"], 2)
        self.assertAlmostEqual(new.report["volume"], 1, 9)
        self.assertLess(new.report["deviation"]["upper"], new.report["deviation"]["bound"])
        with self.assertRaises(octafront.OptionError):
            octafront.adapt(old, sizes=wanted, size_field=(old.points, old.tets, wanted))
        with self.assertRaises(octafront.OptionError):
            octafront.adapt(old, sizes=-wanted)

    def test_adapt_goes_to_the_surface_that_is_given(self):
        fine = sphere(48, 96)
        old = octafront.mesh(*sphere(10, 20), size=0.6)
        points = np.asarray(fine[0])
        new = octafront.adapt(old, size=0.25, surface=fine)
        whole = octafront.Surface(*fine)
        on = new.points[np.unique(new.faces)]
        self.assertLess(np.abs(np.linalg.norm(on, axis=1) - 1).max(), 0.005)
        self.assertLess(new.report["deviation"]["upper"], new.report["deviation"]["bound"])
        np.testing.assert_array_equal(octafront.adapt(old, size=0.25, surface=whole).points, new.points)
        metric = np.tile(np.eye(3) / 0.09, (len(old.points), 1, 1))
        self.assertGreater(len(old.adapt(metric=metric, surface=whole).tets), 0)
        with self.assertRaises(octafront.InputError):
            octafront.adapt(old, size=0.25, surface=(points + 9, fine[1]))

    def test_adapt_of_a_surface_alone(self):
        ball = octafront.Surface(*sphere())
        wanted = 0.1 + 0.1 * np.abs(ball.points[:, 2])
        new = octafront.adapt(ball, sizes=wanted)
        self.assertIsInstance(new, octafront.Surface)
        self.assertGreater(new.report["fit"]["fitting"], 0.9 * new.report["fit"]["edges"])
        metric = np.tile(np.diag([100.0, 25.0, 25.0]), (len(ball.points), 1, 1))
        self.assertGreater(octafront.adapt(ball, metric=metric).report["fit"]["quality_mean"], 0.7)
        with self.assertRaises(octafront.OptionError):
            octafront.adapt(ball, size=0.2, fields={"u": wanted})
        with self.assertRaises(octafront.OptionError):
            octafront.adapt(ball, size=0.2, only="box:0,0,0,1,1,1")

    def test_adapt_changes_only_what_is_asked(self):
        old = octafront.mesh(*cube(), size=0.12)
        new = octafront.adapt(old, size=0.05, only=["sphere:0,0,0,0.2", "box:0,0,0,0.1,0.1,0.1"], halo=1)
        self.assertGreater(len(new.tets), len(old.tets))
        kept = new.old_tets >= 0
        self.assertTrue(0.3 * len(old.tets) < kept.sum() < len(old.tets))
        self.assertTrue((new.old_tets[kept] == np.flatnonzero(kept)).all())
        self.assertTrue((new.tets[kept] == old.tets[new.old_tets[kept]]).all())
        far = np.linalg.norm(old.points, axis=1) > 0.7
        self.assertTrue((new.points[:len(old.points)][far] == old.points[far]).all())
        self.assertTrue((new.old_points[:len(old.points)][far] == np.flatnonzero(far)).all())
        with self.assertRaises(octafront.OptionError):
            octafront.adapt(old, size=0.05, only="nobody")

    def test_fields_go_to_another_mesh(self):
        old, new = octafront.mesh(*cube(), size=0.2), octafront.mesh(*cube(), size=0.17)
        linear, tensor = 2 * old.points - 1, np.arange(9.0 * len(old.tets)).reshape(-1, 3, 3)
        made = octafront.carry(old, new, {"u": linear, "s": tensor}, linear_elements=True)
        self.assertLess(np.abs(made["u"] - (2 * new.points - 1)).max(), 1e-12)
        self.assertEqual(made["s"].shape, (len(new.tets), 3, 3))
        of_tensor = made.report["carried"][1]
        self.assertEqual((of_tensor["name"], of_tensor["components"], of_tensor["beyond"]), ("s", 9, 0))
        self.assertLess(of_tensor["integral_error"], 1e-12)
        self.assertGreaterEqual(made["s"].min(), 0)
        self.assertEqual(made.report["carry"]["outside_nodes"], 0)
        better = octafront.improve(old, fields={"u": linear})
        self.assertLess(np.abs(better.fields["u"] - (2 * better.points - 1)).max(), 1e-12)
        self.assertIn("carried", better.report)
        with self.assertRaises(octafront.OptionError):
            octafront.carry(old, new, {"u": linear[1:]})
        with self.assertRaises(TypeError):
            octafront.carry(old, new, {"u": linear}, size=1)

    def test_integration_points_go_to_another_mesh(self):
        old, new = octafront.mesh(*cube(), size=0.2), octafront.mesh(*cube(), size=0.17)
        near, far = 0.58541019662496845, 0.13819660112501051

        def points_of(mesh):
            corners = mesh.points[mesh.tets]
            return far * corners.sum(1)[:, None] + (near - far) * corners
        made = octafront.carry(old, new, {"S": points_of(old)}, integration_points="S")
        self.assertEqual(made["S"].shape, (len(new.tets), 4, 3))
        self.assertLess(np.median(np.abs(made["S"] - points_of(new))), 1e-12)
        self.assertLess(made.report["carried"][0]["integral_error"], 1e-12)
        self.assertEqual(made.report["carried"][0]["components"], 3)
        quadratic = octafront.carry(old, new, {"u": old.points**2}, quadratic_nodes=True)["u"]
        self.assertLess(np.abs(quadratic - new.points**2).max(), 1e-9)

    def test_meshes_move(self):
        old = octafront.mesh(*cube(), size=0.2)
        stretch = old.points * [8, 0, 0]
        stress = np.arange(6.0 * len(old.tets)).reshape(-1, 6)
        new = old.move(stretch, fields={"x": old.points[:, 0], "s": stress})
        self.assertEqual(new.report["history"][-1]["fraction"], 1)
        self.assertAlmostEqual(new.report["history"][-1]["volume"], 9 * abs(np.prod(np.ptp(old.points, axis=0))), places=9)
        self.assertLess(np.abs(9 * new.fields["x"] - new.points[:, 0]).max(), 1e-9)
        self.assertEqual(new.fields["s"].shape, (len(new.tets), 6))
        with self.assertRaises(octafront.OptionError):
            old.move(stretch[1:])
        with self.assertRaises(octafront.MeshingError):
            old.move(-2 * old.points * [1, 0, 0])

    def test_level_sets_become_faces(self):
        old = octafront.mesh(*cube(), size=0.15)
        phi = np.linalg.norm(old.points - old.points.mean(0), axis=1)
        new = octafront.adapt(old, level_sets={"ball": (phi, 0.3)}, fields={"u": 2 * old.points - 1})
        self.assertEqual(new.names["regions"], ["outside", "ball"])
        self.assertIn("ball_surface", new.names["patches"])
        self.assertLess(np.abs(new.fields["u"] - (2 * new.points - 1)).max(), 1e-12)
        self.assertEqual([cut["name"] for cut in new.report["level_sets"]], ["ball"])
        self.assertGreater(new.quality["dihedral_min_degrees"], 12)
        both = octafront.adapt(old, level_sets={"ball": (phi, 0.3), "low": old.points[:, 2] - 0.1}, size=0.12)
        self.assertEqual(both.names["regions"], ["outside", "ball", "low"])
        with self.assertRaises(octafront.OptionError):
            octafront.adapt(old, level_sets={"ball": phi[1:]})

    def test_adapt_carries_fields(self):
        old = octafront.mesh(*cube(), size=0.2)
        linear = 2 * old.points - 1
        density = np.linspace(-1, 3, len(old.tets))
        new = octafront.adapt(old, size=0.1, fields={"u": linear, "p": linear[:, 0], "rho": density})
        self.assertLess(np.abs(new.fields["u"] - (2 * new.points - 1)).max(), 1e-12)
        self.assertEqual(new.fields["p"].shape, (len(new.points),))

        def volumes(mesh):
            a, b, c, d = (mesh.points[mesh.tets[:, k]] for k in range(4))
            return np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a) / 6
        had, has = density * volumes(old), new.fields["rho"] * volumes(new)
        self.assertLess(abs(had.sum() - has.sum()), 1e-12 * np.abs(had).sum())
        for wrong in (linear[:-1], np.full(len(old.points), np.nan), 3.0):
            with self.assertRaises(octafront.OptionError):
                octafront.adapt(old, size=0.1, fields={"u": wrong})

    def test_adapt_follows_a_metric_of_a_field(self):
        mesh = octafront.mesh(*cube(), size=0.2)
        field = mesh.points[:, 0] ** 2 + 0.1 * mesh.points[:, 1] ** 2
        hessian = octafront.metrics.hessians(mesh, field)
        np.testing.assert_allclose(hessian, np.broadcast_to(np.diag([2, 0.2, 0]), hessian.shape), atol=1e-6)
        metric = octafront.metrics.of_field(mesh, field, elements=4000, max_size=0.3)
        self.assertAlmostEqual(octafront.metrics.complexity(mesh, metric), 4000 / 10.2, delta=40)
        new = mesh.adapt(metric=metric)
        self.assertGreater(new.report["fit"]["fitting"], 0.8 * new.report["fit"]["edges"])
        six = metric[:, [0, 0, 0, 1, 1, 2], [0, 1, 2, 1, 2, 2]]
        np.testing.assert_array_equal(octafront.adapt(mesh, metric=six, threads=1).points, new.points)
        both = octafront.metrics.intersected(metric, octafront.metrics.of_sizes(np.full(len(metric), 0.1)))
        self.assertGreaterEqual(np.linalg.eigvalsh(both).min(), 100 * (1 - 1e-9))
        bounded = octafront.metrics.bounded(metric, min_size=0.1, max_size=0.2)
        self.assertGreaterEqual(np.linalg.eigvalsh(bounded).min(), 25 * (1 - 1e-9))
        graded = octafront.metrics.graded(mesh, both, gradation=0.2)
        self.assertGreaterEqual(octafront.metrics.complexity(mesh, graded), octafront.metrics.complexity(mesh, both))
        self.assertEqual(octafront.metrics.implied(mesh).shape, metric.shape)
        scaled = octafront.metrics.with_complexity(mesh, metric, 100)
        self.assertAlmostEqual(octafront.metrics.complexity(mesh, scaled), 100, 6)
        with self.assertRaises(octafront.InputError):
            octafront.adapt(mesh, metric=-metric)
        with self.assertRaises(octafront.InputError):
            octafront.adapt(mesh, metric=metric[:-1])
        with self.assertRaises(octafront.OptionError):
            octafront.adapt(mesh, metric=metric, sizes=field)
        with self.assertRaises(octafront.OptionError):
            octafront.adapt(mesh, metric=metric[:, 0])

    def test_improve_and_check(self):
        mesh = octafront.mesh(*sphere(), size=0.3, improve="none")
        better = octafront.improve(mesh, surface=octafront.Surface(*sphere()))
        self.assertGreater(better.quality["beta_mean"], mesh.quality["beta_mean"])
        self.assertEqual(better.report["before"]["beta_min"], mesh.quality["beta_min"])
        self.assertTrue(octafront.check(better))
        found = octafront.check(better, solver="calculix")
        self.assertTrue(found.solver)
        with self.assertRaises(octafront.OptionError):
            octafront.check(better, solver="mine")

    def test_objects_of_other_libraries_are_input(self):
        points, triangles = cube()
        of_trimesh = types.SimpleNamespace(vertices=points, faces=triangles)
        of_open3d = types.SimpleNamespace(vertices=points.tolist(), triangles=triangles.tolist())
        wanted = octafront.mesh(points, triangles, size=0.4)
        for source in (of_trimesh, of_open3d):
            self.assertEqual(octafront.mesh(source, size=0.4).report["hash"], wanted.report["hash"])
            self.assertTrue(octafront.check(source))
        self.assertEqual(octafront.mesh({"a": of_trimesh}, size=0.4).names["regions"], ["a"])
        for function in (octafront.mesh, octafront.mend, octafront.improve):
            with self.assertRaisesRegex((TypeError, octafront.OptionError), "SimpleNamespace"):
                function(types.SimpleNamespace(corners=points))

    def test_a_mesh_is_meshed_anew_with_its_regions(self):
        points, triangles = cube()
        walls = np.vstack([triangles, triangles[2:] + 8])
        sides = np.array([[-1, 0]] * 12 + [[-1, 1]] * 10)
        sides[[2, 3]] = [1, 0]
        surface = octafront.Surface(np.vstack([points, points + [0, 0, 1]]), walls, sides=sides, region_names=["low", "high"])
        mesh = octafront.mesh(octafront.mesh(surface, size=0.5), size=0.3)
        self.assertEqual(mesh.names["regions"], ["low", "high"])
        self.assertGreater(len(mesh.interfaces), 8)

    def test_quality_of_elements(self):
        mesh = octafront.mesh(*cube(), size=0.3)
        beta = mesh.element_quality()
        self.assertAlmostEqual(beta.mean(), mesh.quality["beta_mean"], places=12)
        self.assertAlmostEqual(beta.min(), mesh.quality["beta_min"], places=12)
        self.assertAlmostEqual(mesh.element_quality("min_dihedral").min(), mesh.quality["dihedral_min_degrees"], places=9)
        self.assertAlmostEqual(mesh.element_quality("max_dihedral").max(), mesh.quality["dihedral_max_degrees"], places=9)

    def test_from_arrays_of_another_tool(self):
        made = octafront.mesh(*cube(), size=0.4)
        tets = np.array(made.tets)
        tets[::2] = tets[::2, [1, 0, 2, 3]]  # inverted
        points = np.vstack([made.points, [[9, 9, 9]]])  # of no element
        regions = (made.points[made.tets].mean(axis=1)[:, 0] > 0.5).astype(int)
        mesh = octafront.Mesh(points, tets, regions=regions, region_names=["left", "right"])
        self.assertTrue(octafront.check(mesh), octafront.check(mesh).text)
        self.assertEqual(len(mesh.faces), len(made.faces))
        self.assertEqual(mesh.names["regions"], ["left", "right"])
        np.testing.assert_array_equal(np.bincount(mesh.regions), np.bincount(regions))
        with self.assertRaises(octafront.InputError):
            octafront.Mesh(points, tets + 1000)

    def test_second_order_from_arrays(self):
        made = octafront.mesh(*sphere(), size=0.5, order=2)
        cells = np.hstack([made.tets, made.mid_nodes[:, [0, 3, 1, 2, 4, 5]]])  # in VTK's order
        mesh = octafront.Mesh(made.points, cells)
        np.testing.assert_array_equal(mesh.mid_nodes, made.mid_nodes)
        self.assertTrue(octafront.check(mesh))

    def test_save_and_read(self):
        points, triangles = cube()
        surface = octafront.Surface(points, triangles, patches=np.arange(12) // 2, patch_names=list("abcdef"))
        mesh = octafront.mesh(surface, size=0.3)
        mesh.add_set("held", box=[[0, 0, 0], [1, 1, 0]]).add_set("ends", patches=["a", 1])
        mesh.add_set("two", [3, 1, 3], kind="elements")
        self.assertEqual(mesh.sets["two"][1].tolist(), [1, 3])
        self.assertTrue((mesh.points[mesh.sets["held"][1], 2] == 0).all())
        self.assertEqual(len(mesh.sets["ends"][1]), (mesh.patches <= 1).sum())
        for ending in (".vtu", ".msh", ".inp", ".mesh"):
            mesh.save(self.folder / ("m" + ending))
            again = octafront.read(self.folder / ("m" + ending))
            self.assertIsInstance(again, octafront.Mesh)
            self.assertEqual(len(again), len(mesh))
            self.assertTrue(octafront.check(again))
        mesh.save(self.folder / "text.msh", ascii=True)
        (self.folder / "text.msh").read_text("ascii")
        np.testing.assert_array_equal(octafront.read(self.folder / "text.msh").points, mesh.points)
        notes = mesh.save(self.folder / "cells.vtk", cells_only=True)
        self.assertIn(f"cells only: {len(mesh.faces)} faces", " ".join(notes))
        alone = octafront.read(self.folder / "cells.vtk")
        np.testing.assert_array_equal(alone.tets, mesh.tets)
        self.assertFalse(any(alone.names["patches"]))
        with self.assertRaisesRegex(octafront.OptionError, "text"):
            mesh.save(self.folder / "m.meshb", ascii=True)
        with self.assertRaisesRegex(octafront.OptionError, "faces"):
            mesh.save(self.folder / "m.stl", cells_only=True)
        again = octafront.read(self.folder / "m.inp")
        self.assertIn("held", [g["name"] for g in octafront.check(again).groups])
        self.assertTrue(mesh.save(self.folder / "m.stl"), "a surface cannot hold a mesh, and nothing was said")
        self.assertIsInstance(octafront.read(self.folder / "m.stl"), octafront.Surface)
        with self.assertRaisesRegex(octafront.InputError, "nothing|no "):
            mesh.add_set("empty", box=[[5, 5, 5], [6, 6, 6]])
        with self.assertRaises(octafront.OptionError):
            mesh.add_set("far", [len(mesh.points)])

    def test_a_mesh_is_a_job_of_a_solver(self):
        mesh = octafront.mesh(*cube(), size=0.4)
        job = {"fix": {"box:-1,-1,-1,2,2,.01": "xy"}, "gravity": [0, 0, -9.81]}
        self.assertIn("PLACEHOLDER", " ".join(mesh.save(self.folder / "dict.inp", job=job)))
        (self.folder / "job.json").write_text(json.dumps(job))
        mesh.save(self.folder / "file.inp", job=self.folder / "job.json")
        text = (self.folder / "dict.inp").read_text()
        self.assertIn("*STEP", text)
        self.assertEqual((self.folder / "file.inp").read_text(), text)
        with self.assertRaisesRegex(octafront.OptionError, '"lift", which is none of'):
            mesh.save(self.folder / "m.inp", job={"lift": {}})
        with self.assertRaises(octafront.InputError):
            mesh.save(self.folder / "m.inp", job="nowhere.json")

    def test_meshes_are_written_in_parts(self):
        mesh = octafront.mesh(*cube(), size=0.3)
        mesh.save(self.folder / "m.pvtu", parts=3)
        self.assertEqual(sorted(p.name for p in (self.folder / "m").iterdir()), [f"m_000{k}.vtu" for k in range(3)])
        pieces = [octafront.read(p) for p in (self.folder / "m").iterdir()]
        self.assertGreater(sum(len(p) for p in pieces), len(mesh))
        mesh.save(self.folder / "s.msh", parts=np.int64(2), split_files=True)
        self.assertTrue((self.folder / "s_1.msh").exists() and (self.folder / "s_2.msh").exists())
        mesh.save(self.folder / "w.msh", parts=2)
        self.assertEqual(len(octafront.read(self.folder / "w.msh")), len(mesh))
        for wrong in ({"parts": -1}, {"parts": 10 ** 7}, {"parts": len(mesh) + 1}, {"parts": 2, "partitioner": "luck"}):
            with self.assertRaises(octafront.OptionError):
                mesh.save(self.folder / "m.pvtu", **wrong)
        with self.assertRaisesRegex(octafront.OptionError, "not written in parts"):
            mesh.save(self.folder / "m.vtu", parts=2)

    def test_pickle_and_copy(self):
        mesh = octafront.mesh(*cube(), size=0.4).add_set("s", [0, 1])
        for again in (pickle.loads(pickle.dumps(mesh)), copy.deepcopy(mesh)):
            np.testing.assert_array_equal(again.points, mesh.points)
            np.testing.assert_array_equal(again.tets, mesh.tets)
            self.assertEqual(again.sets.keys(), mesh.sets.keys())
            self.assertEqual(again.report, mesh.report)
        surface = pickle.loads(pickle.dumps(mesh.boundary()))
        self.assertTrue(octafront.check(surface))

    def test_names_of_any_bytes(self):
        points, triangles = cube()
        names = ["line\nend", "\udcff broken", "x" * 10000, "<script>alert(1)</script>"]
        surface = octafront.Surface(points, triangles, patches=np.arange(12) // 3, patch_names=names)
        mesh = octafront.mesh(surface, size=0.5)
        self.assertEqual(mesh.names["patches"], ["line end", "ÿ broken", *names[2:]])
        self.assertNotIn("<script>", mesh._repr_html_())
        mesh._repr_html_().encode()

    def test_a_page_to_look_at(self):
        points, triangles = cube()
        surface = octafront.Surface(points, triangles, patches=np.arange(12) // 6, patch_names=["</script><b>", "\udcff"])
        page = self.folder / "page.html"
        octafront.mesh(surface, size=0.3).save_page(page)
        self.assertNotIn("</script><b>", page.read_text())
        octafront.Mesh(cube()[0], [[0, 1, 2, 4]]).save_page(page)
        self.assertIn("<html", page.read_text().lower())
        with self.assertRaises(octafront.OutputError):
            octafront.mesh(*cube(), size=0.5).save_page(self.folder / "nowhere" / "page.html")

    def test_pictures(self):
        mesh = octafront.mesh(*cube(), size=0.4)
        png = mesh.picture(self.folder / "cut.png", cut=(1, 0, 0), color="size", size=(300, 200))
        self.assertEqual((png[:8], png[16:24]), (b"\x89PNG\r\n\x1a\n", b"\0\0\1\x2c\0\0\0\xc8"))
        self.assertEqual((self.folder / "cut.png").read_bytes(), png)
        self.assertEqual(octafront.picture(mesh, cut="x", color="size", size=(300, 200), threads=2), png)
        mesh.save(self.folder / "m.vtu")
        self.assertEqual(octafront.picture(self.folder / "m.vtu", cut="x", color="size", size=(300, 200)), png)
        for other in (mesh.picture(size=(300, 200)), mesh.picture(worst=True, size=(300, 200)), mesh.boundary().picture(size=(300, 200)),
                      octafront.picture(octafront.Surface(*cube()), view="top", up="x", bare=True, size=(300, 200), edges="features")):
            self.assertEqual(other[16:24], png[16:24])
            self.assertNotEqual(other, png)
        surface = octafront.Surface(*cube(), patches=np.arange(12) // 2, patch_names=[f"side {i}" for i in range(6)])
        plain = surface.picture(size=(300, 200))
        self.assertNotEqual(surface.picture(size=(300, 200), highlight="side 1", names=True), plain)
        for wrong in ({"cut": "w"}, {"color": "blue"}, {"size": (10, 10)}, {"size": 300}, {"highlight": "nowhere"}, {"view": (0, 0, 0)},
                      {"path": self.folder / "a.jpg"}):
            with self.assertRaises(octafront.OptionError, msg=wrong):
                mesh.picture(**wrong)
        with self.assertRaises(octafront.OutputError):
            mesh.picture(self.folder / "nowhere" / "a.png")
        with self.assertRaises(octafront.Cancelled):
            mesh.picture(size=(6000, 6000), progress=lambda phase, fraction: False)  # a small one is done before anybody is asked

    def test_large_meshes_are_a_picture_in_notebooks(self):
        from octafront import _html
        largest, _html._LARGEST = _html._LARGEST, 10
        try:
            shown = octafront.mesh(*cube(), size=0.4)._repr_html_()
        finally:
            _html._LARGEST = largest
        self.assertIn("data:image/png;base64,", shown)
        self.assertNotIn("<iframe", shown)

    def test_repr(self):
        mesh = octafront.mesh(*cube(), size=0.4)
        self.assertIn(f"{len(mesh)} tetrahedra", repr(mesh))
        shown = mesh._repr_html_()
        self.assertIn("<svg", shown)
        self.assertIn("<iframe", shown)
        mesh.save_page(self.folder / "page.html")
        self.assertIn(html.escape((self.folder / "page.html").read_text()), shown)
        self.assertIn("triangles", repr(octafront.Surface(*cube())))


class Surfaces(Case):
    def test_repair_and_check(self):
        points, triangles = cube()
        soup = octafront.Surface(points[triangles].reshape(-1, 3), np.arange(36).reshape(-1, 3)[:, ::-1])
        repaired = octafront.repair(soup)
        self.assertEqual((len(repaired.points), repaired.report["merged_vertices"]), (8, 28))
        self.assertTrue(repaired.report["clean"])
        found = octafront.check(soup)
        self.assertTrue(found)
        self.assertAlmostEqual(found.volume, 1)
        broken = octafront.check(points, triangles[1:])
        self.assertFalse(broken)
        self.assertIn("open", str(broken))

    def test_surface(self):
        surface = octafront.surface(*sphere(), size=0.2)
        edges = surface.points[surface.triangles] - surface.points[np.roll(surface.triangles, 1, axis=1)]
        self.assertAlmostEqual(np.linalg.norm(edges, axis=2).mean(), 0.2, delta=0.02)
        surface.save(self.folder / "s.ply")
        self.assertEqual(len(octafront.read(self.folder / "s.ply").triangles), len(surface.triangles))


class Package(Case):
    def test_signatures_show_the_options(self):
        for function, task in ((octafront.mesh, "mesh"), (octafront.size_field, "size"), (octafront.improve, "improve")):
            parameters = inspect.signature(function).parameters
            self.assertIn("threads", parameters)
            self.assertNotIn("keywords", parameters)
            self.assertTrue(all(p.kind == p.KEYWORD_ONLY for name, p in parameters.items()
                                if name not in ("points", "triangles", "mesh", "path")))
        self.assertIn("gradation: How fast sizes may change", octafront.mesh.__doc__)

    def test_boundary_layers(self):
        points, triangles = cube()
        surface = octafront.Surface(points, triangles, patches=np.arange(12) // 2, patch_names=list("abcdef"))
        mesh = octafront.mesh(surface, size=0.3, layers=3, first=0.01, on="a,b")
        self.assertEqual(mesh.names["regions"], ["volume", "layers"])
        walls = mesh.report["layers"]
        self.assertEqual([w["patch"] for w in walls], ["a", "b"])
        self.assertEqual({w["share_full"] for w in walls}, {1})
        with self.assertRaisesRegex(octafront.OptionError, "no region or patch"):
            octafront.mesh(surface, size=0.3, layers=3, first=0.01, on="z")

    def test_wedges_and_pyramids(self):
        points, triangles = cube()
        surface = octafront.Surface(points, triangles, patches=np.arange(12) // 2, patch_names=list("abcdef"))
        mesh = octafront.mesh(surface, size=0.3, layers=3, first=0.01, on="a")
        self.assertEqual(mesh.wedges.shape[1], 6)
        self.assertGreater(len(mesh.wedges), 0)
        self.assertGreater(len(mesh.quads), 0)
        self.assertEqual(3 * len(mesh.wedges) + 2 * len(mesh.pyramids), (mesh.regions == 1).sum())
        a, b, c, d = (mesh.points[mesh.wedges[:, k]] for k in (0, 1, 2, 3))
        self.assertGreater(np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a).min(), 0)
        again = pickle.loads(pickle.dumps(mesh))
        np.testing.assert_array_equal(again.wedges, mesh.wedges)
        np.testing.assert_array_equal(again.quads, mesh.quads)
        with tempfile.TemporaryDirectory() as folder:
            mesh.save(folder + "/m.inp")
            read = octafront.Mesh.read(folder + "/m.inp")
        self.assertEqual(len(read.wedges), len(mesh.wedges))
        self.assertEqual(len(octafront.improve(mesh).wedges), len(mesh.wedges))
        state = mesh.__getstate__()
        state["arrays"]["wide_cells"][0, 0] = len(mesh.tets)
        broken = octafront.Mesh.__new__(octafront.Mesh)
        broken.__setstate__(state)
        with self.assertRaisesRegex(octafront.InputError, "wide_cells"):
            octafront.check(broken)

    def test_every_option_can_be_given(self):
        from octafront._library import option_table
        from octafront._options import keywords_of
        mesh = octafront.mesh(*cube(), size=0.5)
        for row in option_table():
            given = {} if row["default"] is None else {row["name"]: row["default"]}
            if row["name"] in keywords_of("mesh"):
                octafront.mesh(*cube(), size=0.5, **given)
            elif row["name"] in keywords_of("move"):
                octafront.move(mesh, 0 * mesh.points, **given)
            else:
                octafront.adapt(mesh, size=0.5, **given)

    def test_import_costs_less_than_that_of_numpy(self):
        code = ("import time; a = time.process_time(); import octafront; b = time.process_time(); import numpy; "
                "print((b - a) / (time.process_time() - b))")
        ratios = [float(subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True).stdout)
                  for _ in range(5)]
        self.assertLess(min(ratios), 1)

    def test_nothing_is_imported_before_it_is_asked_for(self):
        code = (f"import sys, octafront; octafront.mesh_file({str(SAMPLES / 'bracket.stl')!r}, size=8).save('b.vtu'); "
                "print([m for m in ('numpy', 'pyvista', 'meshio', 'vtk', 'matplotlib') if m in sys.modules])")
        done = subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True, cwd=self.folder)
        self.assertEqual(done.stdout.strip(), "[]")

    def test_libraries_for_pictures_are_asked_for_by_name(self):
        mesh = octafront.mesh(*cube(), size=0.5)
        for function in (mesh.plot, mesh.to_pyvista, mesh.boundary().to_pyvista):
            with self.assertRaisesRegex(ImportError, "pip install pyvista"):
                function()
        with self.assertRaisesRegex(ImportError, "pip install meshio"):
            mesh.to_meshio()

    def test_the_command_line_tool_comes_along(self):
        program = pathlib.Path(sys.executable).parent / "octafront"
        for command in ([program], [sys.executable, "-m", "octafront"]):
            done = subprocess.run([*command, "--version"], check=True, capture_output=True, text=True)
            self.assertEqual(done.stdout.strip(), octafront.__version__)
        done = subprocess.run([program, "mesh", "--sise", "1"], capture_output=True, text=True)
        self.assertEqual(done.returncode, 2)

    def test_formats(self):
        self.assertIn("abaqus", {f["name"] for f in octafront.formats()})


if __name__ == "__main__":
    unittest.main()
