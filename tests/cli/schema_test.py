"""`octafront schema`: what it says of options and reports is so: schema_test.py OCTAFRONT SAMPLES_DIR."""
import json
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

from report_schema import breaches, expect_report, schema_of

OCTAFRONT, SAMPLES = sys.argv[1], pathlib.Path(sys.argv[2])


class Schema(unittest.TestCase):
    def setUp(self):
        self.scratch = tempfile.TemporaryDirectory()
        self.dir = pathlib.Path(self.scratch.name)

    def tearDown(self):
        self.scratch.cleanup()

    def report(self, *arguments, status=0):
        done = subprocess.run([OCTAFRONT, *map(str, arguments), "--json", "-"], capture_output=True, timeout=120)
        self.assertEqual(done.returncode, status, done.stderr)
        return json.loads(done.stdout)

    def test_is_a_schema_of_the_draft_that_it_names(self):
        schema = schema_of(OCTAFRONT)
        self.assertEqual(schema["$schema"], "https://json-schema.org/draft/2020-12/schema")
        try:
            import jsonschema
        except ImportError:
            self.skipTest("python3-jsonschema is not installed")
        jsonschema.Draft202012Validator.check_schema(schema)
        for arguments, status in ((("info", SAMPLES / "bracket.stl"), 0), (("mesh", "none.stl", "-o", "x.vtu"), 3)):
            jsonschema.Draft202012Validator(schema).validate(self.report(*arguments, status=status))

    def test_has_the_options_of_each_command(self):
        schema = schema_of(OCTAFRONT)
        for name, options in schema["$defs"].items():
            if not name.startswith("options_of_"):
                continue
            command = name.removeprefix("options_of_")
            help_of_all = subprocess.run([OCTAFRONT, "help", command, "all"], capture_output=True, text=True, check=True).stdout
            shown = set(re.findall(r"^  (?:-\w,)?--([\w-]+)", help_of_all, re.M)) - {"help"}
            self.assertEqual(set(options["properties"]), shown, command)
            self.assertTrue(all(option["description"] for option in options["properties"].values()), command)

    def test_ranges_are_those_of_the_program(self):
        """A value at each end is taken, one beyond it refused."""
        typed = {"kind": "image"}
        for table in ("options", "intake", "writing"):
            for name, rule in schema_of(OCTAFRONT)["$defs"][table]["properties"].items():
                option = typed.get(name, name)
                known = schema_of(OCTAFRONT)["$defs"]["options_of_mesh"]["properties"]
                if option.replace("_", "-") not in known:
                    continue
                for end, step in (("minimum", -1), ("exclusiveMinimum", 0), ("maximum", 1), ("exclusiveMaximum", 0)):
                    if end not in rule:
                        continue
                    self.assertNotEqual(breaches(rule[end] + step, rule), [], name)
                    done = subprocess.run([OCTAFRONT, "mesh", SAMPLES / "bracket.stl", "-o", self.dir / "m.vtu",
                                           f"--{option.replace('_', '-')}={rule[end] + step}"], capture_output=True, text=True)
                    self.assertEqual(done.returncode, 2, f"{name} {rule[end] + step}: {done.stderr}")
                if rule.get("enum"):
                    self.assertIn(rule["default"], rule["enum"])

    def test_reports_are_as_it_says(self):
        bracket, mesh = SAMPLES / "bracket.stl", self.dir / "m.msh"
        runs = [("mesh", bracket, "-o", mesh, "--size", 8, "--patches", "--layers", 2, "--first", 0.3, "--on", "patch_1"),
                ("mesh", bracket, "-o", mesh, "-o", self.dir / "m.vtu", "--size", 8, "--order", 2, "--Re", 1),
                ("mesh", bracket, "--dry-run"), ("size", bracket, "--size", 8), ("info", bracket), ("check", bracket),
                ("surface", bracket, "-o", self.dir / "s.ply", "--size", 8),
                ("repair", bracket, "-o", self.dir / "r.ply")]
        statuses = {1: 2}
        for i, run in enumerate(runs):
            expect_report(self, OCTAFRONT, self.report(*run, status=statuses.get(i, 0)))
        plain = self.dir / "plain.msh"
        self.report("mesh", bracket, "-o", plain, "--size", 8)
        for run in (("info", mesh), ("check", mesh, "--solver", "ABAQUS"), ("convert", mesh, "-o", self.dir / "c.inp"),
                    ("improve", mesh, "-o", self.dir / "i.msh"), ("report", mesh, "-o", self.dir / "p.html"),
                    ("adapt", plain, "--size", 9, "-o", self.dir / "a.msh"), ("convert", plain, "-o", self.dir / "f.vtu", "--field", "x2=x*x"),
                    ("carry", self.dir / "f.vtu", plain, "-o", self.dir / "g.vtu")):
            expect_report(self, OCTAFRONT, self.report(*run))
        for image in ("head_labels.nii.gz", "head_ct.nii.gz"):
            expect_report(self, OCTAFRONT, self.report("info", SAMPLES / image))

    def test_the_check_sees_what_is_wrong(self):
        report = self.report("info", SAMPLES / "bracket.stl")
        for key, value in (("vertices", "many"), ("secret", 1), ("box", [[0, 0, 0]]), ("options", {"size": "2"})):
            self.assertNotEqual(breaches({**report, key: value}, schema_of(OCTAFRONT)), [], key)
        self.assertNotEqual(breaches({k: v for k, v in report.items() if k != "status"}, schema_of(OCTAFRONT)), [])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[3:])
