"""The report page as a file, without a browser: page_test.py OCTAFRONT SAMPLES_DIR. In one: tests/report/page/browser_test.py."""
import json
import math
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

from page_file import Page, corners_of

OCTAFRONT, SAMPLES = sys.argv[1], pathlib.Path(sys.argv[2])
HOSTILE = '"><script>alert(1)</script><!--\n\u202e'


class PageFile(unittest.TestCase):
    def setUp(self):
        self.scratch = tempfile.TemporaryDirectory()
        self.dir = pathlib.Path(self.scratch.name)

    def tearDown(self):
        self.scratch.cleanup()

    def run_cli(self, *arguments, status=0):
        done = subprocess.run([OCTAFRONT, *map(str, arguments)], capture_output=True, timeout=120)
        self.assertEqual(done.returncode, status, done.stdout + done.stderr)
        return done

    def bracket(self, *more):
        page, mesh, report = self.dir / "page.html", self.dir / "mesh.mesh", self.dir / "report.json"
        self.run_cli("mesh", SAMPLES / "bracket.stl", "-o", mesh, "--report", page, "--json", report, *more)
        return Page(page), mesh, json.loads(report.read_text())

    def read_medit(self, file):
        words = file.read_text().split()
        at, found = 0, {}
        for key, width in (("Vertices", 4), ("Tetrahedra", 5), ("Triangles", 4)):
            at = words.index(key)
            n = int(words[at + 1])
            values = words[at + 2:at + 2 + n * width]
            found[key] = [values[i * width:(i + 1) * width] for i in range(n)]
        points = [tuple(map(float, p[:3])) for p in found["Vertices"]]
        tets = [tuple(int(v) - 1 for v in t[:4]) for t in found["Tetrahedra"]]
        triangles = [(tuple(int(v) - 1 for v in t[:3]), int(t[3])) for t in found["Triangles"]]
        return points, tets, triangles

    def test_holds_the_mesh_element_by_element(self):
        page, mesh, report = self.bracket("--size", 6, "--patches")
        points, tets, triangles = self.read_medit(mesh)
        drawn, packed = page.points(), page.tets()
        self.assertEqual(len(packed), len(tets))
        number, step = {}, page.facts["step"]
        for theirs, ours in zip(packed, tets):
            for a, b in zip(theirs, ours):
                self.assertEqual(number.setdefault(a, b), b)
                self.assertLessEqual(max(abs(x - y) for x, y in zip(drawn[a], points[b])), 0.51 * step)
        self.assertEqual(len(number), len(points))
        faces = page.faces("boundary", False)
        self.assertEqual(len(faces), len(triangles))
        patch_of = {tuple(sorted(t)): patch for t, patch in triangles}
        patches = {patch: set() for _, patch in triangles}
        for half_face, patch in faces:
            key = tuple(sorted(number[v] for v in corners_of(packed, half_face)))
            patches[patch_of.pop(key)].add(patch)
        self.assertEqual(patch_of, {})
        self.assertTrue(all(len(p) == 1 for p in patches.values()), "a patch of the file is a patch of the page")
        self.assertEqual(len(page.facts["patches"]), len(patches))
        self.assertEqual(page.faces("walls", True), [])

    def test_holds_quality_and_sizes_by_element(self):
        page, _, report = self.bracket("--size", 6)
        beta = page.stream("beta")
        classes = [0] * 5
        for byte in beta:
            classes[min(4, int(byte / 255 * 5))] += 1
        n = report["tets"]
        self.assertEqual(len(beta), n)
        for ours, theirs in zip(classes, report["quality"]["beta_classes"]):
            self.assertLess(abs(ours - theirs), 0.02 * n)
        self.assertAlmostEqual(min(beta) / 255, report["quality"]["beta_min"], delta=0.003)
        low, high = page.facts["scales"]["min_dihedral"]
        least = low + min(page.stream("min_dihedral")) / 255 * (high - low)
        self.assertAlmostEqual(least, report["quality"]["dihedral_min_degrees"], delta=0.2)
        low, high = page.facts["scales"]["size_ratio"]
        ratios = [2 ** (low + b / 255 * (high - low)) for b in page.stream("size_ratio")]
        self.assertAlmostEqual(sum(ratios) / n, report["volume_edges"]["mean_ratio"], delta=0.1)

    def test_numbers_are_those_of_the_json_file(self):
        page, _, report = self.bracket("--size", 6)
        self.assertEqual(page.report, report)
        self.assertEqual(page.report["worst_elements"][0]["number"], report["worst_element"]["number"])
        betas = [e["beta"] for e in page.report["worst_elements"]]
        self.assertEqual(betas, sorted(betas))
        self.assertIn("--size 6", page.report["command_line"])

    def test_fetches_nothing(self):
        page, _, _ = self.bracket("--size", 9)
        icon, still = page.links
        self.assertEqual(icon, "data:,", "an icon that is none")
        self.assertTrue(still.startswith("data:image/png;base64,"), "the picture for browsers that cannot draw")
        self.assertLess(len(still), 100_000)
        self.assertIn("default-src 'none'", page.text)
        for word in ("http:", "https:", "//cdn", "import(", "fetch(", "XMLHttpRequest", "WebSocket", "innerHTML"):
            self.assertNotIn(word, page.text)

    def test_repair_is_told_with_places(self):
        lines = (SAMPLES / "shell.off").read_text().splitlines()
        header = next(i for i, line in enumerate(lines) if line[:1].isdigit())
        counts = lines[header].split()
        faces = int(counts[1])
        first = len(lines) - faces
        turned = lines[first].split()
        lines[first] = " ".join([turned[0], *reversed(turned[1:])])
        lines.append(lines[first + 1])
        lines[header] = f"{counts[0]} {faces + 1} {counts[2]}"
        surface = self.dir / "dirty.off"
        surface.write_text("\n".join(lines) + "\n")
        page = self.dir / "page.html"
        self.run_cli("mesh", surface, "-o", self.dir / "m.vtu", "--report", page)
        changes = {c["what"]: c for c in Page(page).report["repairs"]}
        self.assertEqual(changes["faces turned"]["count"], 1)
        self.assertEqual(len(changes["faces turned"]["places"]), 1)
        self.assertEqual(sum(c["count"] for what, c in changes.items() if what.startswith("faces removed")), 1)

    def test_meshes_of_other_tools_have_pages(self):
        _, mesh, _ = self.bracket("--size", 9)
        out = self.dir / "other.html"
        self.run_cli("report", mesh, "-o", out)
        page = Page(out)
        self.assertEqual(page.report["command"], "report")
        self.assertNotIn("mesh-size_ratio", page.scripts)
        self.assertEqual(len(page.tets()), page.report["tets"])

    def test_regions_have_walls(self):
        """Two tetrahedra of two regions, as another tool writes them: nothing is said of the face between."""
        mesh = self.dir / "two.msh"
        mesh.write_text("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n3 1 \"a\"\n3 2 \"" +
                        HOSTILE.replace("\n", " ").replace('"', "'") + "x" * 10000 + "\"\n$EndPhysicalNames\n"
                        "$Nodes\n5\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n5 1 1 1\n$EndNodes\n"
                        "$Elements\n2\n1 4 2 1 1 1 2 3 4\n2 4 2 2 2 2 3 4 5\n$EndElements\n")
        out = self.dir / "two.html"
        self.run_cli("report", mesh, "-o", out)
        page = Page(out)
        self.assertEqual(len(page.faces("walls", True)), 1)
        self.assertEqual(page.numbers("region"), [0, 1])
        low, high, _ = page.faces("walls", True)[0]
        tets = page.tets()
        self.assertEqual(sorted(corners_of(tets, low)), sorted(corners_of(tets, high)))
        self.assertIn("<script>alert", page.facts["regions"][1])

    def test_hostile_names_stay_data(self):
        # The end of the element that holds it, by way of a folder.
        before, behind = HOSTILE.split("/")
        surface = self.dir / before / (behind + ".stl")
        surface.parent.mkdir()
        surface.write_bytes((SAMPLES / "bracket.stl").read_bytes())
        broken = os.fsencode(self.dir) + b"/\xff\xfe<b>.stl"
        pathlib.Path(os.fsdecode(broken)).write_bytes((SAMPLES / "bracket.stl").read_bytes())
        plain, _, _ = self.bracket("--size", 9)
        for name in (surface, os.fsdecode(broken)):
            page = self.dir / "hostile.html"
            self.run_cli("mesh", name, "-o", self.dir / "m.vtu", "--report", page, "--size", 9)
            read = Page(page)
            self.assertEqual(read.tags, plain.tags, "the same elements as for a harmless name")
            self.assertIn(".stl", read.report["input"])

    def test_is_small(self):
        page, _, report = self.bracket("--elements", 50000)
        # 10 MB for 200,000 elements are allowed.
        self.assertLess(len(page.text), 20 * report["tets"] + 100_000)

    def test_pages_are_pages(self):
        done = self.run_cli("mesh", SAMPLES / "bracket.stl", "-o", self.dir / "m.vtu", "--report", "x.json", status=2)
        self.assertIn(b"--json", done.stderr)
        self.run_cli("mesh", SAMPLES / "bracket.stl", "-o", self.dir / "m.vtu", "--report", self.dir / "no" / "x.html",
                     status=5)
        piped = self.dir / "m.vtu"
        self.run_cli("mesh", SAMPLES / "bracket.stl", "-o", piped, "--size", 9)
        self.assertTrue(self.run_cli("report", piped, "-o", "-").stdout.startswith(b"<!DOCTYPE html>"))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[3:])
