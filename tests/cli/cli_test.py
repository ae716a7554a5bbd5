"""The command line as a user meets it: cli_test.py OCTAFRONT SAMPLES_DIR."""
import csv
import json
import pathlib
import signal
import struct
import subprocess
import sys
import tempfile
import time
import unittest

OCTAFRONT, SAMPLES = sys.argv[1], pathlib.Path(sys.argv[2])

TETRAHEDRON = """OFF
4 4 0
0 0 0
1 0 0
0 1 0
0 0 1
3 1 2 3
3 0 3 2
3 0 1 3
3 0 2 1
"""


class CommandLine(unittest.TestCase):
    def setUp(self):
        self.scratch = tempfile.TemporaryDirectory()
        self.dir = pathlib.Path(self.scratch.name)
        self.part = self.dir / "part.off"
        self.part.write_text(TETRAHEDRON)

    def tearDown(self):
        self.scratch.cleanup()

    def run_cli(self, *arguments, status=0):
        done = subprocess.run([OCTAFRONT, *map(str, arguments)], capture_output=True, text=True, timeout=120)
        self.assertEqual(done.returncode, status, done.stdout + done.stderr)
        return done

    def files(self):
        return sorted(p.name for p in self.dir.iterdir())

    def test_meshes_to_every_format_and_reports(self):
        for ending in ("vtu", "msh", "mesh"):
            out, report = self.dir / f"part.{ending}", self.dir / "report.json"
            done = self.run_cli("mesh", self.part, "-o", out, "--size", 0.2, "--json", report)
            self.assertIn("tetrahedra", done.stdout)
            self.assertIn("0.8 - 1.0", done.stdout)
            self.assertEqual(done.stderr, "", "quiet when piped")
            r = json.loads(report.read_text())
            self.assertGreater(r["tets"], 50)
            self.assertEqual(sum(r["quality"]["beta_classes"]), r["tets"])
            self.assertIn(f"a valid mesh of {r['tets']} tetrahedra", self.run_cli("check", out).stdout)

    def test_same_input_same_file(self):
        a, b = self.dir / "a.vtu", self.dir / "b.vtu"
        self.run_cli("mesh", self.part, "-o", a, "--size", 0.15, "--threads", 1)
        self.run_cli("mesh", self.part, "-o", b, "--size", 0.15, "--threads", 3)
        self.assertEqual(a.read_bytes(), b.read_bytes())

    def test_improves_meshes_of_every_format(self):
        for ending in ("vtu", "msh", "mesh"):
            start, out, report = self.dir / f"start.{ending}", self.dir / "better.vtu", self.dir / "report.json"
            self.run_cli("mesh", self.part, "-o", start, "--size", 0.2, "--improve", "none")
            done = self.run_cli("improve", start, "-o", out, "--surface", self.part, "--json", report)
            self.assertIn("improved:", done.stdout)
            self.assertGreater(json.loads(report.read_text())["quality"]["beta_mean"], 0.7)
            self.assertIn("a valid mesh", self.run_cli("check", out).stdout)

    def test_a_broken_mesh_is_not_improved(self):
        broken = self.dir / "broken.mesh"
        broken.write_text("MeshVersionFormatted 2\nDimension 3\nVertices 5\n0 0 0 0\n1 0 0 0\n0 1 0 0\n0 0 1 0\n"
                          "0.2 0.2 0.2 0\nTetrahedra 2\n1 2 3 4 1\n1 2 3 5 1\nEnd\n")
        done = self.run_cli("improve", broken, "-o", self.dir / "out.vtu", status=3)
        self.assertIn("not a valid mesh", done.stderr)
        self.assertEqual(self.files(), ["broken.mesh", "part.off"])

    def test_keep_surface_keeps_it(self):
        report = self.dir / "report.json"
        self.run_cli("mesh", self.part, "-o", self.dir / "kept.vtu", "--keep-surface", "--json", report)
        self.assertEqual(json.loads(report.read_text())["boundary_faces"], 4)

    def test_surface_and_size_run_that_far(self):
        done = self.run_cli("surface", self.part, "-o", self.dir / "surface.stl", "--size", 0.2)
        self.assertIn("triangles", done.stdout)
        self.assertIn("clean", self.run_cli("check", self.dir / "surface.stl").stdout)
        done = self.run_cli("size", self.part, "-o", self.dir / "grid.vtu")
        self.assertIn("tetrahedra expected", done.stdout)
        self.assertTrue((self.dir / "grid.vtu").stat().st_size > 0)

    def test_an_edited_grid_is_passed_back(self):
        grid, out = self.dir / "grid.vtu", self.dir / "o.vtu"
        self.run_cli("size", self.part, "-o", grid, "--size", 0.2)
        self.run_cli("mesh", self.part, "-o", self.dir / "direct.vtu", "--size", 0.2)
        self.run_cli("mesh", self.part, "-o", out, "--size-grid", grid)
        count = lambda file: self.run_cli("check", file).stdout.split("mesh of ")[1]
        self.assertEqual(count(out), count(self.dir / "direct.vtu"))
        self.assertIn("no other", self.run_cli("mesh", self.part, "-o", out, "--size-grid", grid, "--size", 1,
                                               status=2).stderr)
        self.run_cli("size", self.part, "-o", self.dir / "grid.txt", status=2)

    def test_sizes_come_from_files(self):
        sizes, regions, report = self.dir / "sizes.csv", self.dir / "regions.json", self.dir / "r.json"
        sizes.write_text("x,y,z,h\n0,0,0,0.05\n1,0,0,0.3\n0,1,0,0.3\n0,0,1,0.3\n")
        regions.write_text('[{"sphere": [0.2, 0.2, 0.2], "radius": 0.1, "size": 0.03}]')
        tets = []
        for option in ([], ["--size-field", sizes], ["--regions", regions]):
            self.run_cli("mesh", self.part, "-o", self.dir / "o.vtu", "--size", 0.3, "--json", report, *option)
            tets.append(json.loads(report.read_text())["tets"])
        self.assertGreater(tets[1], 1.2 * tets[0])
        self.assertGreater(tets[2], 1.2 * tets[0])
        self.run_cli("mesh", self.part, "-o", self.dir / "o.vtu", "--regions", sizes.with_name("absent"), status=3)

    def test_numbers_of_elements_may_have_exponents(self):
        self.run_cli("size", self.part, "--elements", "1e3")
        for bad in ("1.5", "1e30", "nan", "0"):
            self.run_cli("size", self.part, "--elements", bad, status=2)

    def test_patches_follow_to_the_mesh(self):
        self.run_cli("mesh", self.part, "-o", self.dir / "o.msh", "--size", 0.3, "--patches")
        text = (self.dir / "o.msh").read_bytes()
        counts = struct.pack("<4q", 0, 0, 4, 1)  # points, curves, surfaces, volumes
        self.assertTrue(b"$Entities\n" + counts in text)

    def test_quiet_prints_nothing(self):
        done = self.run_cli("mesh", self.part, "-o", self.dir / "q.vtu", "--size", 0.3, "-q")
        self.assertEqual((done.stdout, done.stderr), ("", ""))

    def test_usage_errors_are_status_2(self):
        self.run_cli(status=2)
        self.run_cli("mesh", self.part, status=2)
        self.run_cli("mesh", self.part, "-o", self.dir / "o.vtu", "--size", "much", status=2)
        self.run_cli("mesh", self.part, "-o", self.dir / "o.unknown", status=2)
        self.run_cli("mesh", self.part, "-o", self.dir / "o.vtu", "--interior", "dense", status=2)
        done = self.run_cli("mesh", self.part, "-o", self.dir / "o.vtu", "--size", 1, "--elements", 10, status=2)
        self.assertIn("contradict", done.stderr)
        self.assertNotIn("o.vtu", self.files())

    def test_help_and_version(self):
        self.assertIn("Sizes", self.run_cli("mesh", "--help").stdout)
        self.assertRegex(self.run_cli("--version").stdout, r"\d+\.\d+\.\d+")

    def refuse(self, text, fragment, name="bad.off"):
        bad = self.dir / name
        bad.write_bytes(text if isinstance(text, bytes) else text.encode())
        for command in (["check", bad], ["mesh", bad, "-o", self.dir / "bad.vtu"]):
            done = self.run_cli(*command, status=3)
            self.assertIn(fragment, done.stderr)
        self.assertNotIn("bad.vtu", self.files())

    def test_bad_input_is_refused_with_a_reason(self):
        self.refuse("", "empty")
        self.refuse(TETRAHEDRON.replace("1 0 0", "nan 0 0"), "nan")
        self.refuse(TETRAHEDRON[:-8], "bad.off")
        self.refuse(TETRAHEDRON.replace("4 4 0", "4 4000000000 0"), "4000000000")
        self.refuse(TETRAHEDRON.replace("3 0 2 1", "3 0 2 9"), "9")
        self.refuse(b"\x89PNG\r\n\x1a\n" + bytes(100), "bad.stl", "bad.stl")
        missing = self.run_cli("check", self.dir / "absent.stl", status=3)
        self.assertIn("absent.stl", missing.stderr)

    def test_an_open_surface_is_refused_with_the_place(self):
        self.refuse(TETRAHEDRON.replace("4 4 0", "4 3 0").replace("3 0 2 1\n", ""), "open")

    def test_output_that_cannot_be_written_is_status_5(self):
        self.run_cli("mesh", self.part, "-o", self.dir / "absent" / "o.vtu", status=5)

    def test_targets_are_checked_before_the_work(self):
        out = self.dir / "o.vtu"
        self.run_cli("mesh", self.part, "-o", out, "--json", self.dir / "absent" / "r.json", status=5)
        self.run_cli("mesh", self.part, "-o", out, "--json", out, status=2)
        self.assertEqual(self.files(), ["part.off"])

    def test_a_model_too_far_from_the_origin_is_refused(self):
        far = "".join(" ".join(f"{float(x) + 1e15:.17g}" for x in line.split()) + "\n"
                      for line in TETRAHEDRON.splitlines()[2:6])
        self.part.write_text("OFF\n4 4 0\n" + far + "".join(TETRAHEDRON.splitlines(True)[6:]))
        self.assertIn("origin", self.run_cli("mesh", self.part, "-o", self.dir / "o.vtu", status=3).stderr)

    def test_an_old_file_survives_a_failed_run(self):
        out = self.dir / "o.vtu"
        out.write_text("precious")
        bad = self.dir / "bad.off"
        bad.write_text(TETRAHEDRON[:-8])
        self.run_cli("mesh", bad, "-o", out, status=3)
        self.assertEqual(out.read_text(), "precious")

    def test_interrupt_ends_cleanly(self):
        out = self.dir / "big.vtu"
        run = subprocess.Popen([OCTAFRONT, "mesh", self.part, "-o", out, "--elements", "3000000"],
                               stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        time.sleep(1.0)
        run.send_signal(signal.SIGINT)
        _, error = run.communicate(timeout=30)
        self.assertEqual(run.returncode, 130, error)
        self.assertIn("interrupted", error)
        self.assertEqual(self.files(), ["part.off"])

    def test_compare_writes_tables_and_charts(self):
        samples = sorted(p for p in SAMPLES.iterdir() if p.suffix in (".stl", ".obj", ".off", ".ply"))
        start = time.monotonic()
        done = self.run_cli("compare", *samples, "-o", self.dir / "out", "--elements", "4000")
        self.assertLess(time.monotonic() - start, 60)
        rows = list(csv.DictReader((self.dir / "out" / "compare.csv").open()))
        self.assertEqual([r["method"] for r in rows], ["octree-aft", "aft", "octree"] * len(samples))
        for row in rows:
            self.assertEqual(row["failure"], "")
            self.assertAlmostEqual(int(row["elements"]) / 4000, 1, delta=0.3)
            # The octree method loses walls thinner than its elements, and says so.
            self.assertAlmostEqual(float(row["volume_over_input"]), 1, delta=0.7 if row["method"] == "octree" else 0.1)
        runs = json.loads((self.dir / "out" / "compare.json").read_text())
        self.assertEqual(len(runs["runs"]), len(rows))
        self.assertEqual(runs["methods"]["octree-aft"]["failures"], 0)
        if "without cairo" not in done.stdout:
            for name in ("beta_classes", "time_elements", "stages"):
                self.assertTrue((self.dir / "out" / f"{name}.png").read_bytes().startswith(b"\x89PNG"))
                self.assertIn("<svg", (self.dir / "out" / f"{name}.svg").read_text())

    def test_compare_shows_failures_and_fails_if_there_is_nothing_else(self):
        bad = self.dir / "open.off"
        bad.write_text(TETRAHEDRON.replace("4 4 0", "4 3 0").replace("3 0 2 1\n", ""))
        done = self.run_cli("compare", bad, "-o", self.dir / "out", "--elements", "500", "--methods", "aft,octree")
        self.assertIn("failed", done.stdout)
        rows = list(csv.DictReader((self.dir / "out" / "compare.csv").open()))
        self.assertIn("open", rows[0]["failure"])
        self.assertEqual(rows[1]["failure"], "", "the octree method meshes an open surface")
        self.run_cli("compare", bad, "-o", self.dir / "out", "--methods", "aft", status=4)
        self.run_cli("compare", self.part, "-o", self.part / "x", status=5)

    def test_method_octree_meshes_what_the_others_refuse(self):
        bad, out = self.dir / "open.off", self.dir / "open.vtu"
        bad.write_text(TETRAHEDRON.replace("4 4 0", "4 3 0").replace("3 0 2 1\n", ""))
        self.run_cli("mesh", bad, "-o", out, status=3)
        done = self.run_cli("mesh", bad, "-o", out, "--method", "octree", "--size", 0.1)
        self.assertIn("winding number", done.stdout)
        self.assertIn("a valid mesh", self.run_cli("check", out).stdout)
        self.run_cli("mesh", self.part, "-o", out, "--method", "octree", "--keep-surface", status=2)

    def test_shipped_samples_are_clean(self):
        samples = [p for p in SAMPLES.iterdir() if p.suffix in (".stl", ".obj", ".off", ".ply")]
        self.assertGreaterEqual(len(samples), 5)
        for sample in samples:
            with self.subTest(sample=sample.name):
                self.assertIn("clean", self.run_cli("check", sample).stdout)


unittest.main(argv=sys.argv[:1], verbosity=2)
