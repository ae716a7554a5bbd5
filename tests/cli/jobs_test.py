"""Jobs of solvers: jobs_test.py OCTAFRONT SAMPLES_DIR. Where CalculiX is installed it says what they come to; cards of others are added up."""
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


def minus(a, b):
    return [x - y for x, y in zip(a, b)]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def total(vectors):
    return [sum(axis) for axis in zip(*vectors)]


class Ansys:
    """Nodes, elements, components and commands of a .cdb."""

    def __init__(self, text):
        self.points, self.elements, self.components, self.commands = {}, {}, {}, []
        lines = iter(text.splitlines())
        for line in lines:
            words = line.split(",")
            if words[0] in ("NBLOCK", "EBLOCK"):
                next(lines)
                self.read_block(words, lines)
            elif words[0] == "CMBLOCK":
                next(lines)
                self.components[words[1].strip()] = self.read_component(int(words[3]), lines)
            else:
                self.commands.append(words)
        self.points.update({int(n): [float(x) for x in at] for n, *at in self.of("N") if n.isdigit()})

    def read_block(self, words, lines):
        if words[0] == "NBLOCK":
            for _ in range(int(words[4])):
                line = next(lines)
                self.points[int(line[:10])] = [float(line[30 + 25 * k:55 + 25 * k]) for k in range(3)]
            return
        for _ in range(int(words[4])):
            fields = next(lines).split()
            nodes = fields[11:]
            while len(nodes) < int(fields[8]):
                nodes += next(lines).split()
            self.elements[int(fields[10])] = [int(n) for n in nodes]

    @staticmethod
    def read_component(count, lines):
        items, members = [], []
        while len(items) < count:
            items += [int(n) for n in next(lines).split()]
        for n in items:
            members += [n] if n > 0 else range(members[-1] + 1, 1 - n)
        return set(members)

    def of(self, *names):
        return [words[1:] for words in self.commands if words[0] in names]

    def behind(self, *command):
        """The commands from this one on."""
        at = next(i for i, words in enumerate(self.commands) if words[:len(command)] == list(command))
        return self.commands[at:]

    def force(self, rotated):
        """The sum, of nodes of this component in directions of the system that keypoints 1 to 3 are."""
        o, x, y = [[float(v) for v in k[1:]] for k in self.of("K")[:3]] if rotated else [None] * 3
        sums = []
        for node, label, value in self.of("F"):
            i = "XYZ".index(label[1])
            axes = [[float(i == k) for k in range(3)] for i in range(3)]
            if rotated and int(node) in self.components[rotated]:
                u, v = minus(x, o), minus(y, o)
                r = minus(self.points[int(node)], o)
                out = total([[dot(r, u) * k for k in u], [dot(r, v) * k for k in v]])
                out = [k / math.hypot(*out) for k in out]
                along = [k / math.hypot(*cross(u, v)) for k in cross(u, v)]
                axes = [out, cross(along, out), along]
            sums.append([float(value) * k for k in axes[i]])
        return total(sums)

    def area(self, nodes):
        """With direction, of the corners of a triangle."""
        a, b, c = [self.points[int(n)] for n in nodes[:3]]
        return [k / 2 for k in cross(minus(b, a), minus(c, a))]


def aster(text):
    """By name what each command of a .comm is given, run as the Python that it is."""
    calls = {}

    class Commands(dict):
        def __missing__(self, name):
            if not name.isupper():
                raise KeyError(name)
            return lambda **given: calls.setdefault(name, []).append(given) or f"{name} {len(calls[name])}"

    exec(compile(text, "job.comm", "exec"), Commands(_F=dict))
    return calls


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
        if "built without HDF5" in done.stderr:
            self.skipTest("built without HDF5")
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

    def test_wrong_places_are_refused_before_a_mesh_is_made(self):
        wrong = {("--fix", "lid"): "--fix: there is no region, patch.*\"low/top\"", ("--fix", "low/top|lid"): None, ("--fix", "lid|low/top"): "there is no",
                 ("--load", "low=1,2,3"): "--load: there is no patch", ("--pressure", "high/lid=1"): "--pressure: there is no", ("--couple", "R=lid"): "--couple: there",
                 ("--pretension", "bolt=1"): "--pretension: there is no region.*\"high\"", ("--friction", "low|hig=.1"): r"there is no opened contact.*\"low_high/top .low.high.",
                 ("--fix", "box:1,2"): "has 2 numbers", ("--fix", "patches:low/top,lid"): "there is no region",
                 ("--load", "REF=1,2,3", "--couple", "REF=low/top"): None, ("--friction", "low_high/top=.1"): None, ("--fix", "foot", "--group", "foot=low/bottom"): None}
        for options, said in wrong.items():
            told = self.mesh("low.obj high.obj", "--contacts", "split", "--dry-run", *options, status=0 if said is None else 2)
            self.assertRegex(told, said or "tetrahedra")
        (self.dir / "job.json").write_text('{"materials": {"lowe": {"E": 1}}}')
        self.assertRegex(self.mesh("low.obj high.obj", "--dry-run", "--job", self.dir / "job.json", status=2), "--materials: there is no region")
        self.assertRegex(self.mesh("low.obj high.obj", "--dry-run", "--friction", "low|high=.1", status=2), "there is none; open contacts by --contacts split")

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
            pressed += float(p) * math.hypot(*cross(minus(b, a), minus(c, a))) / 2
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

    def rod_job(self):
        job = {"gravity": [0, 0, -9810], "couple": {"REF": "bottom", "HOOK": {"place": "top", "at": [9, 0, 40], "kind": "distributing"}},
               "fix": {"REF": "xyzr"}, "load": {"HOOK": [0, 7, 0]}}
        (self.dir / "job.json").write_text(json.dumps(job))
        return ("--job", self.dir / "job.json", "--fix", "side_1=axial", "--load", "top=100,50,-3", "--pressure", "side_0=2")

    def test_ansys_has_the_same_job(self):
        for order in 1, 2:
            self.mesh("rod.obj", *self.rod_job(), "--order", order, out="job.cdb")
            deck = Ansys((self.dir / "job.cdb").read_text())
            self.expect(deck.force("SIDE_1"), [100, 57, -3])
            self.assertEqual([float(n) for n in deck.of("ACEL")[0]], [0, 0, 9810])
            faces = {1: (0, 1, 2), 2: (0, 1, 3), 3: (1, 2, 3), 4: (2, 0, 3)}
            pressed = sum(float(p) * math.hypot(*deck.area([deck.elements[int(e)][k] for k in faces[int(face)]]))
                          for e, face, label, _, p in deck.of("SFE"))
            self.assertAlmostEqual(pressed / (2 * 15 * 2 * 24 * 5 * math.sin(math.pi / 24)), 1, delta=.02)
            for e, face, *_ in deck.of("SFE"):
                self.assertTrue({deck.elements[int(e)][k] for k in faces[int(face)]} <= deck.components["SIDE_0"])
            ref, hook = (deck.of(card)[0] for card in ("CERIG", "RBE3"))
            self.assertEqual((ref[1:], hook[1:]), (["ALL", "UXYZ"], ["ALL", "ALL"]))
            self.expect(deck.points[int(ref[0])] + deck.points[int(hook[0])], [0, 0, 0, 9, 0, 40])
            self.assertIn(["CMSEL", "S", "BOTTOM"], deck.commands[:deck.commands.index(["CERIG", *ref])][-3:])
            self.assertEqual(deck.of("D"), [["SIDE_1", "UZ", "0", "", "", ""], [ref[0], "UX", "0", "", "", "", "UY", "UZ", "ROTX", "ROTY", "ROTZ"]])
            self.assertIn(["MP", "DENS", "1", "7.85e-09"], deck.commands)
            self.assertEqual(deck.of("NROTAT"), [["SIDE_1"]])

    def test_contacts_of_ansys_are_whole_and_face_each_other(self):
        for options, kind in ((), "5"), (("--friction", .2), None), (("--order", 2), "5"):
            self.mesh("low.obj high.obj", "--contacts", "split", "--fix", "low/bottom", "--load", "high/top=30,0,-300", *options, out="job.cdb")
            deck = Ansys((self.dir / "job.cdb").read_text())
            self.assertEqual([k[2] for k in deck.of("KEYOPT") if k[1] == "12"], [kind] if kind else [])
            self.assertEqual(["NSUBST", "4", "200", "4"] in deck.commands, kind is None)
            self.assertEqual([mp[2] for mp in deck.of("MP") if mp[0] == "MU"], [] if kind else ["0.2"])
            side = {}
            for words in deck.behind("ET"):
                if words[0] == "TYPE":
                    now = side.setdefault(words[1], [])
                if words[0] == "EN":
                    now.append(deck.area(words[2:]))
                    if "--order" in options:
                        corners, middle = [deck.points[int(n)] for n in words[2:4]], deck.points[int(words[6 if words[4] == words[5] else 5])]
                        self.expect([2 * x for x in middle], total(corners))
            contact, target = side["12"], side["11"]
            self.expect(total(contact), [-x for x in total(target)])
            self.assertAlmostEqual(math.hypot(*total(contact)), 98, delta=1e-6)
            self.assertAlmostEqual(sum(math.hypot(*a) for a in contact), 98, delta=1e-6)

    def test_bolts_of_ansys_are_equations(self):
        self.mesh("rod.obj", "--fix", "bottom", "--fix", "top", "--pretension", "body=1000", "--pressure", "side_0=1", out="job.cdb")
        deck = Ansys((self.dir / "job.cdb").read_text())
        bolt = deck.of("F")[0][0]
        self.assertEqual(deck.of("F"), [[bolt, "FX", "1000."]])
        equations = deck.of("CE")
        pairs = {(int(e[2]), int(e[5])) for e in equations}
        self.assertEqual(len(equations), 3 * len(pairs))
        along = next(float(e[10]) for e in equations if e[3] == "UZ")
        for in_front, behind in pairs:
            self.assertEqual(deck.points[in_front], deck.points[behind])
            high = lambda node: max(deck.points[n][2] for nodes in deck.elements.values() if node in nodes for n in nodes)
            self.assertGreater(along * high(in_front), along * high(behind))
        steps = [i for i, words in enumerate(deck.commands) if words == ["SOLVE"]]
        self.assertTrue(steps[0] < deck.commands.index(["D", bolt, "UX", "%_FIX%"]) < steps[1])

    def test_code_aster_has_the_same_job(self):
        for order in 1, 2:
            self.mesh("rod.obj", *self.rod_job(), "--order", order, out="job.med")
            calls = aster((self.dir / "job.comm").read_text())
            given = {key: entries for charge in calls["AFFE_CHAR_MECA"] for key, entries in charge.items()}
            force, = given["FORCE_FACE"]
            self.expect([force[axis] / force["FX"] for axis in ("FX", "FY", "FZ")], [1, .5, -.03])
            self.assertEqual(force["GROUP_MA"], "top")
            self.assertEqual(given["PRES_REP"], ({"GROUP_MA": "side_0", "PRES": 2},))
            self.assertEqual(given["FORCE_NODALE"], ({"GROUP_NO": "HOOK", "FY": 7},))
            self.assertEqual(given["PESANTEUR"], ({"GRAVITE": 9810, "DIRECTION": (0, 0, -1), "GROUP_MA": ("body",)},))
            self.assertEqual(given["DDL_IMPO"], ({"GROUP_MA": "side_1", "DZ": 0}, {"GROUP_NO": "REF", **dict.fromkeys(("DX", "DY", "DZ", "DRX", "DRY", "DRZ"), 0)}))
            self.assertEqual(given["LIAISON_SOLIDE"], ({"GROUP_NO": ("bottom", "REF")},))
            self.assertEqual((given["LIAISON_RBE3"][0]["GROUP_NO_MAIT"], given["LIAISON_RBE3"][0]["GROUP_NO_ESCL"]), ("HOOK", "top"))
            self.assertEqual([(p["NOM_GROUP_MA"], p["GROUP_NO"]) for p in calls["CREA_MAILLAGE"][0]["CREA_POI1"]], [("REF", "REF"), ("HOOK", "HOOK")])
            self.assertEqual(set(calls["DEFI_GROUP"][0]["CREA_GROUP_NO"]["GROUP_MA"]), {"top", "bottom", "side_1"})
            self.assertEqual(len(calls["MECA_STATIQUE"][0]["EXCIT"]), len(calls["AFFE_CHAR_MECA"]))
            self.assertEqual({a["GROUP_NO"] for a in calls["POST_RELEVE_T"][0]["ACTION"]}, {"REF", "side_1"})
            self.assertIn("F mmed job.med D 20\n", (self.dir / "job.export").read_text())
            self.mesh("bar.obj", "--order", order, "--fix", "bottom", "--load", "top=100,50,-3", out="job.med")
            force, = aster((self.dir / "job.comm").read_text())["AFFE_CHAR_MECA"][1]["FORCE_FACE"]
            self.expect([98 * force[axis] for axis in ("FX", "FY", "FZ")], [100, 50, -3])

    def test_code_aster_ties_what_nothing_else_holds(self):
        self.mesh("low.obj high.obj", "--contacts", "split", "--fix", "low/top", "--couple", "REF=low/bottom", "--fix", "REF", out="job.med")
        calls = aster((self.dir / "job.comm").read_text())
        tie, = calls["AFFE_CHAR_MECA"][0]["LIAISON_MAIL"]
        tied, = calls["DEFI_GROUP"][1]["CREA_GROUP_NO"]
        self.assertEqual(tied, {"NOM": "tied_1", "DIFFE": ("low_high_top__low_high_", "low_top")})
        self.assertEqual((tie["GROUP_MA_MAIT"], tie["GROUP_NO_ESCL"]), ("high", "tied_1"))
        self.assertEqual([m["GROUP_MA"] for m in calls["AFFE_MATERIAU"][0]["AFFE"]], ["low", "high"])

    def test_code_aster_holds_cylinders_by_their_normals(self):
        self.mesh("rod.obj", "--fix", "side_0=radial axial", "--fix", "bottom", out="job.med")
        held = aster((self.dir / "job.comm").read_text())["AFFE_CHAR_MECA"][0]
        without = {"GROUP_MA": "side_0", "SANS_GROUP_NO": ("bottom",)}
        self.assertEqual(held["FACE_IMPO"], ({**without, "DNOR": 0},))
        self.assertEqual(held["DDL_IMPO"], ({**without, "DZ": 0}, {"GROUP_MA": "bottom", "DX": 0, "DY": 0, "DZ": 0}))
        for options, said in {("--fix", "side_0=tangential"): "has no tangential direction", ("--pretension", "body=1"): "has no bolts",
                              ("--fix", "side_0=radial", "--fix", "side_1=axial"): "share nodes"}.items():
            self.assertRegex(self.mesh("rod.obj", *options, status=2, out="job.med"), said)
        self.assertRegex(self.mesh("low.obj high.obj", "--contacts", "split", "--friction", .1, status=2, out="job.med"), "is linear, and ties contacts")

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

    def test_what_hangs_on_nothing_is_said(self):
        lines = [line.split() for line in (self.dir / "high.obj").read_text().splitlines()]
        (self.dir / "far.obj").write_text("\n".join(" ".join([*w[:3], str(float(w[3]) + 9)] if w[:1] == ["v"] else w) for w in lines) + "\n")
        self.assertIn('nothing joins "far" to what is held', self.mesh("low.obj far.obj", "--fix", "low/bottom", "--load", "far/top=0,0,1"))
        for options in ("--split", "low_high/top"), ("--couple", "REF=high/top"), ("--fix", "high/top"):
            self.assertNotIn("nothing joins", self.mesh("low.obj high.obj", "--fix", "low/bottom", *options))

    def test_notes_of_contacts(self):
        tied = self.mesh("rod.obj sleeve.obj", "--contacts", "split", "--fix", "rod/bottom")
        self.assertIn("some nodes of \"rod/bottom\" are tied to another part", tied)
        self.assertNotIn("tied", self.mesh("rod.obj sleeve.obj", "--contacts", "split", "--fix", "rod/bottom", "--friction", 0))
        self.assertIn("is curved and slides", self.mesh("rod.obj sleeve.obj", "--contacts", "separate", "--friction", 0))
        self.assertNotIn("is curved", self.mesh("low.obj high.obj", "--contacts", "separate", "--friction", 0))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
