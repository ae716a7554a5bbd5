"""How the command line helps: help_test.py OCTAFRONT SAMPLES_DIR."""
import json
import os
import pathlib
import pty
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import time
import unittest

from report_schema import expect_report

OCTAFRONT, SAMPLES = sys.argv[1], pathlib.Path(sys.argv[2])
BRACKET = SAMPLES / "bracket.stl"


def scaled(stl, factor):
    """The bytes of a binary STL in another scale."""
    data = bytearray(stl.read_bytes())
    for at in range(84, len(data), 50):
        corners = struct.unpack_from("<9f", data, at + 12)
        struct.pack_into("<9f", data, at + 12, *(factor * c for c in corners))
    return bytes(data)


class Help(unittest.TestCase):
    def setUp(self):
        self.scratch = tempfile.TemporaryDirectory()
        self.dir = pathlib.Path(self.scratch.name)

    def tearDown(self):
        self.scratch.cleanup()

    def run_cli(self, *arguments, status=0, **options):
        options = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, **options}
        done = subprocess.run([OCTAFRONT, *map(str, arguments)], timeout=120, **options)
        self.assertEqual(done.returncode, status, f"{done.stdout}{done.stderr}")
        done.out = (done.stdout or b"").decode(errors="replace")
        done.err = (done.stderr or b"").decode(errors="replace")
        if "--json" in arguments and "-" in arguments and done.out:
            expect_report(self, OCTAFRONT, json.loads(done.out))
        return done

    def json_of(self, *arguments, status=0):
        return json.loads(self.run_cli(*arguments, "--json", "-", status=status).out)

    # --- help, manual, completion: one table

    def commands(self):
        block = self.run_cli("help").out.split("Subcommands:")[1]
        return re.findall(r"^  (\w+) ", block, re.M)

    def options(self, command):
        terms = re.findall(r"^  (-\S+)", self.run_cli("help", command, "all").out, re.M)
        return {name for term in terms for name in term.split(",") if name.startswith("--")}

    def test_help_of_a_command_has_options_and_examples_that_run(self):
        for command in self.commands():
            text = self.run_cli("help", command).out
            self.assertIn("Examples:", text, command)
            self.assertEqual(text, self.run_cli(command, "--help").out, command)
        self.assertIn("did you mean mesh?", self.run_cli("help", "mehs", status=2).err)

    def test_help_fits_a_screen_and_leads_to_the_rest(self):
        for command in self.commands():
            lines = self.run_cli("help", command).out.splitlines()
            self.assertLessEqual(len(lines), 45, command)
            self.assertLessEqual(max(map(len, lines)), 100, command)
        brief = self.run_cli("help", "mesh").out
        self.assertEqual(len(re.findall(r"^  (?:-\w,)?--", brief, re.M)), 20)
        groups = re.findall(r"(\w+) \d+", brief.split("a group of")[1].split("or all")[0])
        shown = []
        for group in groups:
            text = self.run_cli("help", "mesh", group).out
            shown += re.findall(r"^  (?:-\w,)?(--[\w-]+)", text, re.M)
        self.assertEqual(len(shown), len(set(shown)))
        self.assertEqual(set(shown) | {"--help"}, set(re.findall(r"^  (?:-\w,)?(--[\w-]+)", self.run_cli("help", "mesh", "all").out, re.M)))
        for knob in ("--queue", "--ranking", "--facets", "--ideal-distance", "--core", "--relaxation", "--sweeps"):
            self.assertIn(knob, self.run_cli("help", "mesh", "paper").out)
        self.assertIn("sizes, surface, ", self.run_cli("help", "mesh", "colours", status=2).err)

    def test_examples_are_valid(self):
        for part in ("part.stl", "scan.ply", "a.stl", "b.ply", "part.obj", "plate.stl", "soup.obj"):
            (self.dir / part).write_bytes(scaled(BRACKET, 0.25))
        for sample, image in (("head_labels.nii.gz", "labels.nii.gz"), ("head_labels.txt", "names.txt"),
                              ("head_ct.nii.gz", "head.nii.gz")):
            shutil.copy(SAMPLES / sample, self.dir / image)
        shutil.copy(SAMPLES / "bracket.step", self.dir / "part.step")
        (self.dir / "parts").mkdir()
        reads_cad = (pathlib.Path(OCTAFRONT).parent / "../cad/octafront-cad").exists()
        self.run_cli("surface", SAMPLES / "gear.obj", "--keep-surface", "-o", self.dir / "bolt.stl")
        self.run_cli("mesh", self.dir / "part.stl", "-o", self.dir / "in.msh", "--size", 1.5)
        for to in ("in.vtu", "part.msh", "part.inp", "in.med"):
            self.run_cli("convert", self.dir / "in.msh", "-o", self.dir / to)
        self.run_cli("convert", self.dir / "in.msh", "-o", self.dir / "new.vtk", "--ascii")
        with open(self.dir / "new.vtk") as mesh:
            points = int(mesh.read().split("POINTS ")[1].split()[0])
        with open(self.dir / "new.vtk", "a") as mesh:
            mesh.write(f"POINT_DATA {points}\nSCALARS h double 1\nLOOKUP_TABLE default\n" + "1\n" * points)
        self.run_cli("convert", self.dir / "in.msh", "-o", self.dir / "in.mesh")
        (self.dir / "in.sol").write_text("MeshVersionFormatted 2\nDimension 3\nSolAtVertices\n"
                                         f"{points}\n1 3\n" + "1 0 1 0 0 2\n" * points + "End\n")
        self.run_cli("convert", self.dir / "in.msh", "-o", self.dir / "in.vtu", "--ascii")
        values = " ".join(str(0.01 * v * v) for v in range(points))
        text = (self.dir / "in.vtu").read_text()
        (self.dir / "in.vtu").write_text(text.replace(
            "<PointData>", f'<PointData><DataArray type="Float64" Name="u" format="ascii">{values}</DataArray>', 1))
        self.run_cli("convert", self.dir / "in.msh", "-o", self.dir / "old.vtu", "--field", "T=x", "--field", "rho=y*y")
        self.run_cli("convert", self.dir / "in.msh", "-o", self.dir / "new.msh", "-o", self.dir / "new.vtu")
        vectors = " ".join(["0.1 0 0"] * points)
        (self.dir / "load.vtu").write_text(text.replace(
            "<PointData>", f'<PointData><DataArray type="Float64" Name="u" NumberOfComponents="3" format="ascii">{vectors}</DataArray>', 1))
        for command in self.commands():
            examples = self.run_cli("help", command).out.split("Examples:\n")[1]
            for line in examples.splitlines():
                shell = line.strip().split("    ")[0].replace("1e4,1e5", "1e3,1e4")
                if not shell.startswith("octafront") or command in ("help", "completion", "ui") or (".step" in shell and not reads_cad):
                    continue
                done = subprocess.run(["bash", "-c", f'octafront() {{ "{OCTAFRONT}" "$@"; }}; set -o pipefail; {shell}'],
                                      cwd=self.dir, stdin=subprocess.DEVNULL, capture_output=True, timeout=120)
                self.assertEqual(done.returncode, 0, f"{shell}: {done.stderr}")

    def test_manual_has_every_option(self):
        manual = self.run_cli("help", "--man").out
        plain = manual.replace("\\-", "-")
        for command in self.commands():
            section = manual.split(f'.SS "octafront {command}"')[1].split(".SS ")[0]
            self.assertEqual(section.count("\\-\\-help"), 1)
            for option in self.options(command):
                self.assertIn(f"\\fB{option}\\fR", plain)
        if shutil.which("groff"):
            done = subprocess.run(["groff", "-man", "-Tutf8", "-ww", "-z"], input=manual.encode(), capture_output=True)
            self.assertEqual(done.stderr, b"")

    def complete_in_bash(self, *words):
        script = f"""source <("{OCTAFRONT}" completion bash); compopt() {{ :; }}
COMP_WORDS=({' '.join("'" + w + "'" for w in words)}); COMP_CWORD=$((${{#COMP_WORDS[@]}} - 1)); _octafront
printf '%s\\n' "${{COMPREPLY[@]}}" """
        done = subprocess.run(["bash", "-c", script], capture_output=True, text=True, timeout=60)
        self.assertEqual(done.stderr, "")
        return done.stdout.split()

    def test_bash_completes_commands_options_and_values(self):
        self.assertEqual(self.complete_in_bash("octafront", "me"), ["mesh"])
        self.assertEqual(self.complete_in_bash("octafront", "mesh", "a.stl", "--gradat"), ["--gradation"])
        self.assertEqual(self.complete_in_bash("octafront", "mesh", "--preset", ""), ["draft", "standard", "fine", "head"])
        self.assertEqual(self.complete_in_bash("octafront", "completion", ""), ["bash", "zsh", "fish"])
        for command in self.commands():
            offered = set(self.complete_in_bash("octafront", command, "--"))
            self.assertEqual(offered, self.options(command), command)

    def test_zsh_and_fish_can_read_their_scripts(self):
        for shell, check in (("zsh", ["zsh", "-n"]), ("fish", ["fish", "--no-execute"])):
            script = self.dir / shell
            script.write_text(self.run_cli("completion", shell).out)
            for command in self.commands():
                for option in self.options(command):
                    self.assertRegex(script.read_text(), rf"(-l |--){option[2:]}\b")
            if shutil.which(shell):
                done = subprocess.run([*check, script], capture_output=True, timeout=60)
                self.assertEqual((done.returncode, done.stderr), (0, b""))
        self.run_cli("completion", "tcsh", status=2)

    # --- info

    def test_info_of_surfaces_meshes_and_size_fields(self):
        surface = self.json_of("info", BRACKET)
        self.assertEqual((surface["kind"], surface["unit"]), ("surface", ""))
        self.assertAlmostEqual(surface["area"], 10500, delta=10500)
        self.assertEqual(surface["places"], {"regions": ["body"], "patches": ["patch_1"], "curves": [], "sets": []})
        self.assertLess(surface["box"][0][0], surface["box"][1][0])
        self.run_cli("mesh", BRACKET, "-o", self.dir / "m.msh", "--size", 6, "--order", 2)
        mesh = self.json_of("info", self.dir / "m.msh")
        self.assertEqual((mesh["kind"], mesh["order"]), ("mesh", 2))
        self.assertGreater(mesh["volume"], 20000)
        self.assertTrue(any(g["origin"] == "patch" for g in mesh["groups"]))
        self.assertEqual([g["name"] for g in mesh["groups"]], mesh["places"]["regions"] + mesh["places"]["patches"])
        self.run_cli("size", BRACKET, "-o", self.dir / "s.vtu", "--size", 3)
        field = self.json_of("info", self.dir / "s.vtu")
        self.assertEqual(field["kind"], "size field")
        self.assertAlmostEqual(field["largest_size"], 3, delta=0.1)
        (self.dir / "no.vtu").write_text("nothing")
        self.run_cli("info", self.dir / "no.vtu", status=3)

    def test_info_describes_what_check_refuses(self):
        (self.dir / "open.off").write_text("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")
        self.assertEqual(self.json_of("info", self.dir / "open.off")["triangles"], 1)
        self.run_cli("check", self.dir / "open.off", status=3)

    # --- dry runs

    def test_dry_run_makes_nothing_and_predicts(self):
        # docs/dry-run.md has larger models, time and memory.
        for options in (["--size", 3], ["--elements", 30000], ["--preset", "draft"]):
            said = self.json_of("mesh", BRACKET, "--dry-run", *options)["dry_run"]
            self.assertEqual(list(self.dir.iterdir()), [])
            made = self.json_of("mesh", BRACKET, "-o", self.dir / "m.vtu", *options)
            self.assertAlmostEqual(said["expected_tets"] / made["tets"], 1, delta=0.2)
            self.assertAlmostEqual(said["boundary_faces"], made["boundary_faces"], delta=0.1 * made["boundary_faces"])
            self.assertAlmostEqual(said["memory_bytes"] / made["peak_memory_bytes"], 1, delta=0.5)
            self.assertGreater(said["seconds"], 0)
            (self.dir / "m.vtu").unlink()
        aft = self.json_of("mesh", BRACKET, "--dry-run", "--method", "aft")["dry_run"]
        self.assertIsNone(aft["seconds"], "nothing is claimed that was not measured")
        self.assertIn("nothing was made", self.run_cli("mesh", BRACKET, "--dry-run").out)
        self.assertIn("--output is required", self.run_cli("mesh", BRACKET, status=2).err)

    # --- units

    def obj(self, unit):
        file = self.dir / f"in_{unit}.obj"
        self.run_cli("surface", BRACKET, "-o", file, "--size", 5)
        if unit:
            file.write_text(f"# Alias OBJ Model File\n# File units = {unit}\n" + file.read_text())
        return file

    def test_lengths_with_units(self):
        inches, plain = self.obj("inches"), self.obj("")
        self.assertEqual(self.json_of("info", inches)["unit"], "in")
        asked = self.json_of("size", inches, "--size", "5.08cm")
        self.assertEqual(asked["options"]["size"], "5.08cm")
        self.assertAlmostEqual(asked["expected_tets"], self.json_of("size", inches, "--size", "2")["expected_tets"], 3)
        given = self.json_of("size", plain, "--unit", "mm", "--size", "0.5cm", "--max-deviation", "1e-4m")
        same = self.json_of("size", plain, "--size", "5", "--max-deviation", "0.1")
        self.assertAlmostEqual(given["expected_tets"], same["expected_tets"], 3)
        # What is said on the command line goes before what the file says.
        self.assertAlmostEqual(self.json_of("size", inches, "--unit", "mm", "--size", "5mm")["expected_tets"],
                               self.json_of("size", plain, "--size", "5")["expected_tets"], 3)

    def test_lengths_that_mean_nothing_are_refused(self):
        self.assertIn("--unit", self.run_cli("size", BRACKET, "--size", "2mm", status=2).err)
        for bad in ("2furlongs", "mm", "2 2", "abc", "2mm3"):
            self.assertIn("--size", self.run_cli("size", BRACKET, "--size", bad, status=2).err)
        self.assertIn("mm", self.run_cli("size", BRACKET, "--size", "2mm", "--unit", "ell", status=2).err)
        for bad in ("inf", "nan", "-2", "0mm"):
            self.run_cli("size", BRACKET, "--size", bad, "--unit", "mm", status=2)

    # --- presets

    def test_presets_are_finer_in_turn_and_options_go_before(self):
        tets = [self.json_of("mesh", BRACKET, "--dry-run", "--preset", p)["dry_run"]["expected_tets"]
                for p in ("draft", "standard", "fine")]
        self.assertLess(2.5 * tets[0], tets[1])
        self.assertLess(2.5 * tets[1], tets[2])
        self.assertEqual(tets[1], self.json_of("mesh", BRACKET, "--dry-run")["dry_run"]["expected_tets"])
        of_size = [self.json_of("mesh", BRACKET, "-o", self.dir / "m.vtu", "--size", 5, *o)["hash"]
                   for o in ([], ["--preset", "draft", "--improve", "default"], ["--preset", "draft"])]
        self.assertEqual(of_size[0], of_size[1])
        self.assertNotEqual(of_size[0], of_size[2], "improved less")
        self.assertIn("draft, standard, fine", self.run_cli("mesh", BRACKET, "--dry-run", "--preset", "x", status=2).err)

    # --- outputs

    def test_several_outputs_are_the_same_mesh(self):
        a, b = self.dir / "a.msh", self.dir / "b.mesh"
        report = self.json_of("mesh", BRACKET, "-o", a, "-o", b, "--size", 6)
        self.assertEqual([o["file"] for o in report["outputs"]], [str(a), str(b)])
        for file in (a, b):
            alone = self.dir / ("alone" + file.suffix)
            self.run_cli("mesh", BRACKET, "-o", alone, "--size", 6)
            self.assertEqual(file.read_bytes(), alone.read_bytes())
        named = [self.dir / "x", self.dir / "y"]
        self.run_cli("convert", a, "-o", named[0], "--format", "abaqus", "-o", named[1], "--format", "vtk")
        self.assertIn(b"*NODE", named[0].read_bytes())
        self.assertIn(b"vtk DataFile", named[1].read_bytes())
        self.assertIn("--format is given 1", self.run_cli("convert", a, "-o", named[0], "-o", named[1], "--format",
                                                           "vtk", status=2).err)
        self.assertIn("the same file", self.run_cli("convert", a, "-o", named[0], "-o", named[0], status=2).err)

    def test_pipes(self):
        file = self.dir / "m.vtk"
        self.run_cli("mesh", BRACKET, "-o", file, "--size", 6)
        piped = self.run_cli("mesh", BRACKET, "-o", "-", "--format", "vtk", "--size", 6)
        self.assertEqual(piped.stdout, file.read_bytes())
        self.assertEqual(piped.err, "")
        with open(BRACKET, "rb") as surface:
            self.assertEqual(self.run_cli("mesh", "-", "-o", "-", "--format", "vtk", "--size", 6, stdin=surface).stdout,
                             file.read_bytes())
        for more in ([], ["--format", "openfoam"], ["--format", "tetgen"], ["--format", "nothing"],
                     ["--format", "vtk", "--json", "-"], ["--format", "vtk", "-o", "-", "--format", "vtk"]):
            self.run_cli("mesh", BRACKET, "-o", "-", *more, status=2)
        with open("/dev/full", "wb") as full:
            self.run_cli("mesh", BRACKET, "-o", "-", "--format", "vtk", "--size", 6, stdout=full, status=5)

    def test_a_terminal_gets_no_mesh(self):
        main, other = pty.openpty()
        done = self.run_cli("mesh", BRACKET, "-o", "-", "--format", "vtk", stdout=other, status=2)
        self.assertIn("terminal", done.err)
        os.close(main), os.close(other)

    # --- progress

    def test_long_stages_tell_the_time_left(self):
        main, other = pty.openpty()
        run = subprocess.Popen([OCTAFRONT, "mesh", BRACKET, "-o", self.dir / "m.vtu", "--elements", "3e7", "--threads",
                                "1"], stdout=subprocess.DEVNULL, stderr=other, env={**os.environ, "TERM": "xterm"})
        os.close(other)
        seen, end = b"", time.time() + 60
        while b" left" not in seen and time.time() < end:
            seen += os.read(main, 4096)
        run.terminate()
        self.assertEqual(run.wait(60), 130)
        os.close(main)
        self.assertRegex(seen, rb"\d+ %, (\d+ s|\d+:\d\d (min|h)) left")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[3:])
