"""Jobs for Abaqus and CalculiX: jobs_test.py OCTAFRONT SAMPLES_DIR. Where CalculiX is installed it says what they come to."""
import json
import math
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

OCTAFRONT, SAMPLES = sys.argv[1], pathlib.Path(sys.argv[2])
needs_ccx = unittest.skipUnless(shutil.which("ccx"), "CalculiX is not installed")


def prism(sides, radius, heights):
    """OBJ of a prism along z, sections at these heights; groups bottom, side_0, side_1, ..., top."""
    ring = [(radius * math.cos(2 * math.pi * i / sides), radius * math.sin(2 * math.pi * i / sides)) for i in range(sides)]
    lines = [f"v {x!r} {y!r} {z!r}" for z in heights for x, y in ring]
    lines += ["g bottom", "f " + " ".join(str(i + 1) for i in reversed(range(sides)))]
    for k in range(len(heights) - 1):
        lines.append(f"g side_{k}")
        for i in range(sides):
            a, b = k * sides + i + 1, k * sides + (i + 1) % sides + 1
            lines.append(f"f {a} {b} {b + sides} {a + sides}")
    last = (len(heights) - 1) * sides
    return "\n".join([*lines, "g top", "f " + " ".join(str(last + i + 1) for i in range(sides))]) + "\n"


def sleeve(sides, inner, outer, heights):
    """OBJ around prism(sides, inner, heights), its hole by the same facets."""
    ring = [(r * math.cos(2 * math.pi * i / sides), r * math.sin(2 * math.pi * i / sides)) for r in (inner, outer) for i in range(sides)]
    lines, last = [f"v {x!r} {y!r} {z!r}" for z in heights for x, y in ring], 2 * sides * (len(heights) - 1)
    for i in range(sides):
        a, b = i + 1, (i + 1) % sides + 1
        lines += ["g rims", f"f {a} {b} {a + sides}", f"f {b} {b + sides} {a + sides}"]
        lines += [f"f {last + b} {last + a} {last + b + sides}", f"f {last + a} {last + a + sides} {last + b + sides}"]
        for k in range(0, last, 2 * sides):
            above = k + 2 * sides
            lines += ["g hole", f"f {k + b} {k + a} {above + a}", f"f {k + b} {above + a} {above + b}", "g round"]
            lines += [f"f {k + sides + a} {k + sides + b} {above + sides + b}", f"f {k + sides + a} {above + sides + b} {above + sides + a}"]
    return "\n".join(lines) + "\n"


def cards(bulk):
    """Names and fields of Nastran's cards, of 8 or 16 characters, from all of their lines."""
    found = []
    for line in bulk.split("BEGIN BULK\n")[1].splitlines():
        if line.startswith(("$", "ENDDATA")):
            continue
        width = 16 if "*" in line[:8] else 8
        fields = [line[i:i + width].strip() for i in range(8, 72, width)]
        if line[0] in " *+":
            found[-1][1].extend(fields)
        else:
            found.append((line[:8].strip(" *"), fields))
    return found


class Jobs(unittest.TestCase):
    def setUp(self):
        self.scratch = tempfile.TemporaryDirectory()
        self.dir = pathlib.Path(self.scratch.name)
        (self.dir / "bar.obj").write_text(prism(4, 7, (0, 40)))
        (self.dir / "rod.obj").write_text(prism(24, 5, (0, 15, 30)))
        (self.dir / "sleeve.obj").write_text(sleeve(24, 5, 9, (0, 15, 30)))
        (self.dir / "low.obj").write_text(prism(4, 14, (0, 8)))
        (self.dir / "high.obj").write_text(prism(4, 7, (8, 16)))

    def tearDown(self):
        self.scratch.cleanup()

    def mesh(self, bodies, *options, status=0, out="job.inp"):
        done = subprocess.run([OCTAFRONT, "mesh", *(self.dir / body for body in bodies.split()), "-o", self.dir / out, "--size", "4", *map(str, options)],
                              capture_output=True, text=True, timeout=120)
        self.assertEqual(done.returncode, status, done.stdout + done.stderr)
        return done.stdout + done.stderr

    def reactions(self):
        """By set what it came to in the end: CalculiX's totals."""
        done = subprocess.run(["ccx", "job"], cwd=self.dir, capture_output=True, text=True, timeout=120)
        self.assertNotIn("*ERROR", done.stdout)
        totals = re.findall(r"total force \(fx,fy,fz\) for set (\S+) .*\n\n(.*)\n", (self.dir / "job.dat").read_text())
        return {name.lower(): [float(n) for n in force.split()] for name, force in totals}

    def expect(self, found, wanted):
        most = max(map(abs, wanted))
        for a, b in zip(found, wanted):
            self.assertAlmostEqual(a, b, delta=1e-3 * most)

    def test_a_deck_has_what_was_asked(self):
        job = {"materials": {"default": {"name": "steel", "E": 2e5, "density": 7e-9}}, "gravity": [0, 0, -9810],
               "couple": {"REF": {"place": "top", "at": [0, 0, 60], "kind": "distributing"}}, "load": {"REF": [0, 0, 5]}}
        (self.dir / "job.json").write_text(json.dumps(job))
        told = self.mesh("bar.obj", "--job", self.dir / "job.json", "--fix", "bottom=xz", "--pressure", "side_0=2")
        self.assertNotIn("PLACEHOLDER", told)
        deck = (self.dir / "job.inp").read_text()
        for part in ("*MATERIAL, NAME=steel\n*ELASTIC\n2e+05, 0.3\n*DENSITY\n7e-09\n*SOLID SECTION, ELSET=body, MATERIAL=steel\n",
                     "SURFACE=top, CONSTRAINT NAME=REF_coupling\n*DISTRIBUTING\n", "*BOUNDARY\nbottom, 1, 1\nbottom, 3, 3\n*STEP",
                     "*DSLOAD\nside_0, P, 2.\n", "body, GRAV, 9810., 0., 0., -1.\n", "*NODE PRINT, NSET=bottom, TOTALS=YES, GLOBAL=YES\nRF\n"):
            self.assertTrue(part in deck, part)
        self.assertIn("PLACEHOLDER: no material is given for \"body\"", self.mesh("bar.obj", "--fix", "bottom"))

    def test_what_makes_no_job_is_refused(self):
        bad = {("--fix", "lid"): "there is no \"lid\"|there is no", ("--load", "top=1,2"): "needs three numbers",
               ("--fix", "top=up"): "may be \"all\"", ("--fix", "bottom=radial"): "is no cylinder",
               ("--pretension", "body=-1"): "a force above 0", ("--pretension", "body=9"): "no patch that is a cylinder",
               ("--friction", "-1"): "0 or more", ("--job", self.dir / "none.json"): "there is no such file",
               ("--job", self.dir / "job.json"): "\"loads\", which is none of"}
        (self.dir / "job.json").write_text('{"loads": {}}')
        for options, said in bad.items():
            self.assertRegex(self.mesh("bar.obj", *options, status=2), said)
        for more in ("--fix", "side_0"), ("--couple", "Q=side_0"):
            self.assertRegex(self.mesh("bar.obj", "--couple", "REF=top", *more, status=2), "share nodes")
        self.assertRegex(self.mesh("bar.obj", "--pressure", "top=1", "--pressure", "top=2", status=2), "have another one")
        self.assertRegex(self.mesh("bar.obj", "--fix", "top", status=2, out="job.msh"), "--job is for abaqus")
        self.assertRegex(self.mesh("rod.obj", "--fix", "side_0=radial", "--fix", "bottom=x", status=2), "share nodes")

    def test_nastran_has_the_same_job(self):
        (self.dir / "job.json").write_text('{"gravity": [0, 0, -9810], "couple": {"REF": "bottom"}, "fix": {"REF": "xyzr"}}')
        self.mesh("rod.obj", "--job", self.dir / "job.json", "--fix", "side_1=axial", "--load", "top=100,50,-3", "--pressure", "side_0=2",
                  "--order", 2, out="job.bdf")
        text = (self.dir / "job.bdf").read_text()
        self.assertRegex(text, r"^SOL 101\nCEND\n(.*\n)*SPC = 1\nLOAD = 3\n")
        bulk = cards(text)
        of = lambda name: [fields for card, fields in bulk if card == name]
        force = [sum(float(fields[4 + axis]) for fields in of("FORCE")) for axis in range(3)]
        self.expect(force, [100, 50, -3])
        point = {int(f[0]): [float(x) for x in f[2:5]] for f in of("GRID")}
        pressed = 0
        tets = {int(f[0]): {int(n) for n in f[2:6]} for f in of("CTETRA")}
        for _, element, p, *_, on, off in (fields[:8] for fields in of("PLOAD4")):
            self.assertTrue({int(on), int(off)} <= tets[int(element)] and on != off)
            a, b, c = [point[n] for n in tets[int(element)] - {int(off)}]
            u, v = [b[i] - a[i] for i in range(3)], [c[i] - a[i] for i in range(3)]
            cross = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
            pressed += float(p) * math.hypot(*cross) / 2
        round_it = 2 * 24 * 5 * math.sin(math.pi / 24)
        self.assertAlmostEqual(pressed / (2 * 15 * round_it), 1, delta=.02)  # elements are longer than its facets
        axis = [float(x) for x in of("CORD2C")[0][2:8]]
        self.expect([axis[3 + i] - axis[i] for i in range(2)] + [abs(axis[5] - axis[2])], [0, 0, 1])
        side = {int(f[0]) for f in of("GRID") if f[5:6] == ["1"]}
        held = {spc[1]: {int(n) for n in spc[2:] if n} for spc in of("SPC1")}
        self.assertEqual(held["3"], side)
        self.assertTrue(side and all(point[n][2] > 14.9 for n in side))
        self.assertEqual(held["123456"], {int(of("RBE2")[0][1])})
        self.assertIn("Nastrans differ", self.mesh("rod.obj", "--pretension", "body=3", status=2, out="job.bdf"))

    @needs_ccx
    def test_reactions_are_the_loads(self):
        for order in 1, 2:
            self.mesh("bar.obj", "--order", order, "--fix", "bottom", "--load", "top=100,20,-300")
            self.expect(self.reactions()["bottom"], [-100, -20, 300])
        # Wedges of second order lack the nodes in the middles of their sides.
        self.mesh("bar.obj", "--order", 2, "--layers", 2, "--first", .3, "--on", "side_0", "--fix", "box:-9,-9,-1,9,9,.01",
                  "--load", "top=100,20,-300")
        self.expect(*self.reactions().values(), [-100, -20, 300])

    @needs_ccx
    def test_forces_follow_directions_of_a_cylinder(self):
        self.mesh("rod.obj", "--fix", "bottom", "--fix", "side_1=axial", "--load", "top=100,50,0")
        self.expect(self.reactions()["bottom"][:2], [-100, -50])

    @needs_ccx
    def test_reference_points_bear_and_hold(self):
        self.mesh("bar.obj", "--fix", "bottom", "--couple", "REF=top", "--load", "REF=100,0,50")
        self.expect(self.reactions()["bottom"], [-100, 0, -50])
        self.mesh("bar.obj", "--fix", "REF", "--couple", "REF=bottom", "--load", "top=100,0,50")
        self.expect(self.reactions()["ref"], [-100, 0, -50])

    @needs_ccx
    def test_contacts_bear_tied_and_by_friction(self):
        for options in (), ("--order", 2), ("--friction", .2):
            self.mesh("low.obj high.obj", "--split", "low_high/top", "--fix", "low/bottom", "--load", "high/top=30,0,-300", *options)
            self.assertEqual("*CONTACT PAIR" in (self.dir / "job.inp").read_text(), "--friction" in options)
            self.expect(self.reactions()["low_bottom"], [-30, 0, 300])

    @needs_ccx
    def test_a_bolt_bears_its_pretension(self):
        for order in 1, 2:
            self.mesh("rod.obj", "--order", order, "--fix", "bottom", "--fix", "top", "--pretension", "body=1000")
            found = self.reactions()
            self.expect(found["bottom"], [0, 0, -1000])
            self.expect(found["top"], [0, 0, 1000])
        # Its length stays: half of what comes along goes to each end.
        self.mesh("rod.obj", "--fix", "bottom", "--couple", "REF=top", "--fix", "REF", "--pretension", "body=1000", "--pressure", "side_0=0")
        self.expect(self.reactions()["bottom"], [0, 0, -1000])

    def test_a_bolt_is_cut_where_its_hole_lets_it_slide(self):
        job = ["--contacts", "split", "--fix", "rod/bottom", "--fix", "rod/top", "--pretension", "rod=1000"]
        self.assertIn("let one of them slide", self.mesh("rod.obj sleeve.obj", *job, status=2))
        self.mesh("rod.obj sleeve.obj", *job, "--fix", "sleeve/round", "--friction", 0)
        if shutil.which("ccx"):
            self.assertAlmostEqual(self.reactions()["rod_bottom"][2], -1000, delta=10)

    def test_notes_of_contacts(self):
        tied = self.mesh("rod.obj sleeve.obj", "--contacts", "split", "--fix", "rod/bottom")
        self.assertIn("some nodes of \"rod/bottom\" are tied to another part", tied)
        self.assertNotIn("tied", self.mesh("rod.obj sleeve.obj", "--contacts", "split", "--fix", "rod/bottom", "--friction", 0))
        self.assertIn("is curved and slides", self.mesh("rod.obj sleeve.obj", "--contacts", "separate", "--friction", 0))
        self.assertNotIn("is curved", self.mesh("low.obj high.obj", "--contacts", "separate", "--friction", 0))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
