"""The command line as a user meets it: cli_test.py OCTAFRONT SAMPLES_DIR."""
import json
import math
import pathlib
import os
import pty
import random
import re
import resource
import signal
import struct
import subprocess
import sys
import tempfile
import time
import unittest
import xml.etree.ElementTree
import zlib

from report_schema import expect_report

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


# Of three products, in kg/m3, g/cm3 by a unit of the file's own, and a volume in the place of a density.
DENSITIES = """#9001=(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT($,.METRE.));
#9002=(MASS_UNIT()NAMED_UNIT(*)SI_UNIT(.KILO.,.GRAM.));
#9003=DERIVED_UNIT((#9004,#9005));
#9004=DERIVED_UNIT_ELEMENT(#9001,-3.);
#9005=DERIVED_UNIT_ELEMENT(#9002,1.);
#9006=MEASURE_REPRESENTATION_ITEM('density measure',POSITIVE_RATIO_MEASURE(2700.),#9003);
#9007=REPRESENTATION('density',(#9006),#9008);
#9008=REPRESENTATION_CONTEXT('','');
#9009=PROPERTY_DEFINITION('material property','density',#{plate});
#9010=PROPERTY_DEFINITION_REPRESENTATION(#9009,#9007);
#9011=(CONVERSION_BASED_UNIT('CENTIMETRE',#9012)LENGTH_UNIT()NAMED_UNIT(#9013));
#9012=LENGTH_MEASURE_WITH_UNIT(LENGTH_MEASURE(10.),#9014);
#9013=DIMENSIONAL_EXPONENTS(1.,0.,0.,0.,0.,0.,0.);
#9014=(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.));
#9015=(MASS_UNIT()NAMED_UNIT(*)SI_UNIT($,.GRAM.));
#9016=DERIVED_UNIT((#9017,#9018));
#9017=DERIVED_UNIT_ELEMENT(#9011,-3.);
#9018=DERIVED_UNIT_ELEMENT(#9015,1.);
#9019=MEASURE_REPRESENTATION_ITEM('density measure',POSITIVE_RATIO_MEASURE(7.85),#9016);
#9020=REPRESENTATION('density',(#9019),#9008);
#9021=PROPERTY_DEFINITION('material property','density',#{bolt});
#9022=PROPERTY_DEFINITION_REPRESENTATION(#9021,#9020);
#9030=DERIVED_UNIT((#9031));
#9031=DERIVED_UNIT_ELEMENT(#9014,3.);
#9032=MEASURE_REPRESENTATION_ITEM('volume measure',VOLUME_MEASURE(22620.5),#9030);
#9033=REPRESENTATION('volume',(#9032),#9008);
#9034=PROPERTY_DEFINITION('geometric validation property','volume',#{bracket});
#9035=PROPERTY_DEFINITION_REPRESENTATION(#9034,#9033);
"""


class CommandLine(unittest.TestCase):
    def setUp(self):
        self.scratch = tempfile.TemporaryDirectory()
        self.dir = pathlib.Path(self.scratch.name)
        self.part = self.dir / "part.off"
        self.part.write_text(TETRAHEDRON)

    def tearDown(self):
        self.scratch.cleanup()

    def run_cli(self, *arguments, status=0, **options):
        options = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, **options}
        done = subprocess.run([OCTAFRONT, *map(str, arguments)], text=True, timeout=120, errors="replace", **options)
        self.assertEqual(done.returncode, status, f"{done.stdout}{done.stderr}")
        words = [str(word) for word in arguments]
        if status not in (2, 5) and "--json" in words and words[words.index("--json") + 1].endswith(".json"):
            expect_report(self, OCTAFRONT, json.loads(pathlib.Path(words[words.index("--json") + 1]).read_text()))
        return done

    def files(self):
        return sorted(p.name for p in self.dir.iterdir())

    CUBE = [(0, 2, 3), (0, 3, 1), (4, 5, 7), (4, 7, 6), (0, 1, 5), (0, 5, 4), (2, 6, 7), (2, 7, 3), (0, 4, 6),
            (0, 6, 2), (1, 3, 7), (1, 7, 5)]

    def write_box(self, name, low, high, faces=None):
        """A box as an OFF file; corner number x + 2 y + 4 z."""
        corners = [[(low, high)[n >> axis & 1][axis] for axis in range(3)] for n in range(8)]
        faces = self.CUBE if faces is None else faces
        lines = ["OFF", f"8 {len(faces)} 0", *(" ".join(map(str, c)) for c in corners),
                 *("3 {} {} {}".format(*f) for f in faces)]
        (self.dir / name).write_text("\n".join(lines) + "\n")
        return self.dir / name

    def regions_of(self, *arguments):
        """Names and volumes of the regions that the input makes."""
        report = self.dir / "regions.json"
        # Whether check finds fault with them is another matter.
        subprocess.run([OCTAFRONT, "check", *map(str, arguments), "--json", report], capture_output=True, timeout=120)
        return {r["name"]: r["volume"] for r in json.loads(report.read_text()).get("input_regions", [])}

    def test_copies_that_mpi_does_not_know_of_are_refused(self):
        """With MPI or without: nobody starts them here."""
        for rank, said in ("0", 1), ("1", 0):
            launched = {**os.environ, "OMPI_COMM_WORLD_RANK": rank, "OMPI_COMM_WORLD_SIZE": "3"}
            done = self.run_cli("mesh", self.part, "-o", self.dir / "part.vtu", status=2, env=launched)
            self.assertEqual(done.stderr.count("3 copies were started"), said)
            info = self.run_cli("info", self.part, env=launched)
            self.assertEqual(info.stdout.count("triangles"), said)
        self.assertEqual(self.files(), ["part.off"])

    def test_several_files_are_several_bodies(self):
        plate = self.write_box("plate.off", (0, 0, 0), (2, 2, 1))
        bolt = self.write_box("bolt.off", (0.5, 0.5, 0.5), (1, 1, 2))
        regions = self.regions_of(plate, bolt)
        self.assertEqual(list(regions), ["plate", "bolt"])
        self.assertAlmostEqual(regions["plate"], 4 - 0.125, 12)
        self.assertAlmostEqual(regions["bolt"], 0.375, 12)
        # The other way round the plate has its way.
        self.assertAlmostEqual(self.regions_of(bolt, plate)["bolt"], 0.25, 12)

    def test_parts_of_one_file_unite_or_are_regions_by_name(self):
        both = self.dir / "both.obj"
        lines = []
        for low, high in ((0, 2), (1, 3)):
            lines += [f"v {x} {y} {z}" for z in (low, high) for y in (low, high) for x in (low, high)]
        for name, first in (("bone", 1), ("marrow", 9)):
            lines += [f"g {name}"] + ["f {} {} {}".format(*(c + first for c in f)) for f in self.CUBE]
        both.write_text("\n".join(lines) + "\n")
        self.assertEqual(self.regions_of(both, "--overlap", "regions"), {"bone": 7, "marrow": 8})
        done = self.run_cli("mesh", both, "--overlap", "regions", "-o", self.dir / "parts.vtu")
        self.assertIn("marrow", done.stdout)
        united = json.loads(self.run_cli("mesh", both, "-o", self.dir / "one.vtu", "--json", "-").stdout)
        self.assertAlmostEqual(united["volume"], 15, 9)
        one = self.write_box("one.off", (0, 0, 0), (1, 1, 1))
        self.assertIn("names", self.run_cli("mesh", one, "--overlap", "regions", "-o", self.dir / "a.vtu", status=3).stderr)

    def write_solids(self, name, *solids):
        """An STL file of boxes, as bytes: (name, low, high) each."""
        lines = []
        for title, low, high in solids:
            corners = [[(low, high)[n >> axis & 1][axis] for axis in range(3)] for n in range(8)]
            lines.append(b"solid " + title)
            for face in self.CUBE:
                vertices = b"".join("vertex {} {} {}\n".format(*corners[c]).encode() for c in face)
                lines.append(b"facet normal 0 0 0\nouter loop\n" + vertices + b"endloop\nendfacet")
            lines.append(b"endsolid " + title)
        (self.dir / name).write_bytes(b"\n".join(lines) + b"\n")
        return self.dir / name

    def test_names_in_latin_1_become_utf_8(self):
        both = self.write_solids("both.stl", (b"K\xf6rper", (0, 0, 0), (1, 1, 1)), (b"Loch \x1b", (1, 0, 0), (2, 1, 1)))
        out = self.dir / "both.vtu"
        done = self.run_cli("mesh", both, "--size", ".4", "-o", out, "-o", self.dir / "both.xdmf", "--json", self.dir / "r.json")
        self.assertIn('taken as Latin-1: "K\u00f6rper"', done.stdout)
        self.assertIn("1 name had control characters", done.stdout)
        found = json.loads((self.dir / "r.json").read_text())
        self.assertEqual([r["name"] for r in found["regions"]], ["K\u00f6rper", "Loch  "])
        for file in self.dir.glob("*.xdmf"):
            xml.etree.ElementTree.parse(file)
        # The tags of the VTU file, without the data behind them.
        head = out.read_bytes().split(b"<AppendedData")[0] + b"</VTKFile>"
        self.assertIn("K\u00f6rper", ",".join(e.get("Name", "") for e in xml.etree.ElementTree.fromstring(head).iter()))

    def test_solids_of_one_file_that_touch_or_nest_are_regions(self):
        touching = self.write_solids("t.stl", (b"left", (0, 0, 0), (1, 1, 1)), (b"right", (1, 0, 0), (2, 1, 1)))
        self.assertEqual(self.regions_of(touching), {"left": 1, "right": 1})
        nested = self.write_solids("n.stl", (b"ball", (1, 1, 1), (2, 2, 2)), (b"A", (0, 0, 0), (3, 3, 3)))
        self.assertEqual(self.regions_of(nested), {"A": 26, "ball": 1})
        crossing = self.write_solids("c.stl", (b"a", (0, 0, 0), (2, 2, 2)), (b"b", (1, 1, 1), (3, 3, 3)))
        said = self.run_cli("mesh", crossing, "--size", 1, "-o", self.dir / "c.vtu").stdout
        self.assertIn('the parts "a", "b" overlap and are united; --overlap later', said)
        said = self.run_cli("mesh", crossing, "--size", 1, "-o", self.dir / "c.vtu", "--overlap", "regions").stdout
        self.assertIn('"b" takes 1 from "a"', said)

    def test_what_is_dropped_has_an_option_that_keeps_it(self):
        # A wall that hangs in the box, on one of its sides.
        corners = [(x, y, z) for z in (0, 2) for y in (0, 2) for x in (0, 2)] + [(1, 0, .5), (1, 0, 1.5), (1, 1, 1)]
        faces = [*self.CUBE, (8, 9, 10)]
        crack = self.dir / "crack.off"
        crack.write_text("\n".join(["OFF", f"{len(corners)} {len(faces)} 0", *("{} {} {}".format(*c) for c in corners),
                                    *("3 {} {} {}".format(*f) for f in faces)]) + "\n")
        said = self.run_cli("mesh", crack, "--size", 1, "-o", self.dir / "c.vtu").stdout
        self.assertRegex(said, "area 0.5.*--cells regions|--sheets keep")
        sheet = self.dir / "sheet.off"
        sheet.write_text("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")
        box = self.write_box("box.off", (0, 0, 0), (2, 2, 2))
        self.assertIn("sheet.off: ", self.run_cli("mesh", box, sheet, "-o", self.dir / "c.vtu", status=3).stderr)

    def test_sizes_that_lie_elsewhere_are_named(self):
        box = self.write_box("box.off", (0, 0, 0), (1, 1, 1))
        regions, points, grid = self.dir / "r.json", self.dir / "p.csv", self.dir / "grid.vtu"
        regions.write_text('[{"point": [50, 50, 50], "size": 0.1}]')
        said = self.run_cli("mesh", box, "--size", ".5", "--regions", regions, "-o", self.dir / "a.vtu").stdout
        self.assertIn("1 of 1 region in --regions lies outside of the model", said)
        points.write_text("50, 50, 50, 0.3\n")
        said = self.run_cli("mesh", box, "--point-sizes", points, "-o", self.dir / "a.vtu").stdout
        self.assertIn("1 of 1 point in --point-sizes lies outside of the model", said)
        far = self.write_box("far.off", (10, 0, 0), (11, 1, 1))
        self.run_cli("size", far, "--size", ".5", "-o", grid)
        refused = self.run_cli("mesh", box, "--size-field", grid, "-o", self.dir / "b.vtu", status=2).stderr
        self.assertIn("the model lies elsewhere", refused)

    def test_a_number_that_is_missed_is_said(self):
        said = self.run_cli("mesh", SAMPLES / "bracket.stl", "--elements", 10, "-o", self.dir / "a.vtu").stdout
        self.assertRegex(said, r"10 elements were wanted; \d+ made: ")

    def test_a_mesh_that_is_not_what_is_required_is_not_written(self):
        out, report = self.dir / "a.vtu", self.dir / "r.json"
        out.write_text("older")
        for command, options, code in (
                (("mesh", self.part), ("--size", .3, "--require-angle", 60), "require-angle"),
                (("mesh", self.part), ("--size", .3, "--require-size", 1), "require-size"),
                (("mesh", SAMPLES / "torus_knot.ply"), ("--size", 6, "--require-volume", .0001), "require-volume")):
            said = self.run_cli(*command, *options, "-o", out, "--json", report, status=4)
            self.assertEqual(out.read_text(), "older")
            r = json.loads(report.read_text())
            self.assertEqual(r["error"]["kind"], "requirement")
            self.assertIn(code, [note["code"] for note in r["notes"]])
            self.assertGreater(r["tets"], 0)
            self.assertIn(options[-2], said.stderr)
        mesh = self.dir / "b.vtu"
        self.run_cli("mesh", self.part, "--size", .3, "--require-angle", 5, "--require-volume", .1, "--require-size", 4, "-o", mesh)
        self.run_cli("improve", mesh, "--require-angle", 60, "-o", self.dir / "c.vtu", status=4)
        self.run_cli("adapt", mesh, "--size", .2, "--require-size", 1, "-o", self.dir / "c.vtu", status=4)
        self.assertNotIn("c.vtu", self.files())

    def test_defects_of_a_surface_that_is_refused_are_in_the_report(self):
        hole, report = self.dir / "hole.off", self.dir / "r.json"
        hole.write_text(TETRAHEDRON.replace("4 4 0", "4 3 0").replace("3 0 2 1\n", ""))
        self.run_cli("mesh", hole, "--repair", "none", "-o", self.dir / "a.vtu", "--json", report, status=3)
        self.assertEqual(json.loads(report.read_text())["defects"]["open_edges"]["count"], 3)

    def test_a_dry_run_knows_of_kept_triangles(self):
        # Larger than the size: points inside the walls, which the triangles alone do not ask for.
        options = ("mesh", SAMPLES / "bracket.stl", "--keep-surface", "--size", 2, "--json", "-", "--improve", "none")
        said = json.loads(self.run_cli(*options, "--dry-run").stdout)["dry_run"]["expected_tets"]
        made = json.loads(self.run_cli(*options, "-o", self.dir / "a.vtu").stdout)["tets"]
        self.assertLess(abs(said / made - 1), 0.3)

    def test_check_refuses_inverted_torn_and_doubled_meshes(self):
        corners = ["0 0 0", "1 0 0", "0 1 0", "0 0 1", "0 0 -1"]
        inner = [".1 .1 .1", ".2 .1 .1", ".1 .2 .1", ".1 .1 .2"]

        def check(points, tets, status):
            file = self.dir / "m.mesh"
            file.write_text("MeshVersionFormatted 2\nDimension 3\nVertices {}\n{}\nTetrahedra {}\n{}\nEnd\n".format(
                len(points), "\n".join(p + " 0" for p in points), len(tets), "\n".join(t + " 1" for t in tets)))
            return self.run_cli("check", file, status=status).stderr

        check(corners, ["1 2 3 4", "1 3 2 5"], 0)
        # All the other way round is another convention; some are a defect.
        check(corners, ["2 1 3 4", "3 1 2 5"], 0)
        self.assertIn("1 of its 2 elements are inverted", check(corners, ["1 2 3 4", "3 1 2 5"], 3))
        self.assertIn("torn", check(corners + corners[:3], ["1 2 3 4", "6 8 7 5"], 3))
        self.assertIn("torn, or in two copies", check(corners[:4] * 2, ["1 2 3 4", "5 6 7 8"], 3))
        self.assertIn("cross or touch", check(corners[:4] + ["-.5 .1 .1", ".5 .1 .1", "-.5 .2 .1", "-.5 .1 .2"], ["1 2 3 4", "5 6 7 8"], 3))
        self.assertIn("inside of other elements", check(corners[:4] + inner, ["1 2 3 4", "5 6 7 8"], 3))

    def test_check_judges_wedges(self):
        corners = ["0 0 0", "1 0 0", "0 1 0", "0 0 1", "1 0 1", "0 1 1", "0 0 2", "1 0 2", "0 1 2"]

        def check(prisms, status):
            file = self.dir / "m.mesh"
            file.write_text("MeshVersionFormatted 2\nDimension 3\nVertices {}\n{}\nPrisms {}\n{}\nEnd\n".format(
                len(corners), "\n".join(p + " 0" for p in corners), len(prisms), "\n".join(p + " 1" for p in prisms)))
            done = self.run_cli("check", file, "--json", self.dir / "found.json", status=status)
            return done.stdout + done.stderr, json.loads((self.dir / "found.json").read_text())

        said, found = check(["1 2 3 4 5 6", "4 5 6 7 8 9"], 0)
        self.assertIn("wedges: 2, least scaled Jacobian 0.8165", said)  # sin 45 over sin 60
        self.assertEqual(found["wedges"]["count"], 2)
        self.assertEqual(found["wedges"]["torn"], 0)
        said, _ = check(["1 2 3 4 5 6", "4 6 5 7 9 8"], 3)
        self.assertIn("1 of its 2 wedges and pyramids are inverted", said)
        said, _ = check(["1 2 3 4 5 6", "4 5 6 7 9 8"], 3)
        self.assertIn("is torn: the Jacobian is not positive at 3 of its 6 corners", said)

    def test_convert_and_improve_keep_wedges(self):
        points = [(i, j, k) for k in (0, 1, 2) for j in (0, 1) for i in (0, 1)]
        rows = [[1 + 4 * level + c for level in (k, k + 1) for c in half] for k in (0, 1) for half in ((0, 1, 3), (0, 3, 2))]
        file = self.dir / "m.mesh"
        file.write_text("MeshVersionFormatted 2\nDimension 3\nVertices {}\n{}\nPrisms {}\n{}\nEnd\n".format(
            len(points), "\n".join("%g %g %g 0" % p for p in points), len(rows),
            "\n".join(" ".join(map(str, row)) + " 1" for row in rows)))
        self.run_cli("convert", file, "-o", self.dir / "m.bdf", "--order", 2)
        self.assertEqual((self.dir / "m.bdf").read_text().count("CPENTA"), 4)
        self.run_cli("convert", self.dir / "m.bdf", "-o", self.dir / "m.vtu")
        self.run_cli("improve", self.dir / "m.vtu", "-o", self.dir / "m.inp")
        self.assertIn("TYPE=C3D6", (self.dir / "m.inp").read_text())
        done = self.run_cli("check", self.dir / "m.inp")
        self.assertIn("wedges: 4", done.stdout + done.stderr)

    def test_meshes_of_all_formats_are_meshed_anew(self):
        bracket = SAMPLES / "bracket.stl"
        outputs = [self.dir / f"a.{ending}" for ending in ("vtu", "vtk", "inp", "bdf", "unv", "vol")]
        self.run_cli("mesh", bracket, "--size", 12, *(word for o in outputs for word in ("-o", o)))
        for file in outputs:
            found = json.loads(self.run_cli("mesh", file, "--size", 12, "-o", self.dir / "b.vtu", "--json", "-").stdout)
            self.assertLess(abs(found["volume"] / found["input_volume"] - 1), 0.02, file.name)

    def test_a_group_of_a_patch_that_is_not_there_is_refused(self):
        done = self.run_cli("mesh", self.part, "-q", "-o", self.dir / "a.vtu", "--group", "g=patches:none", status=2)
        self.assertEqual(done.stdout, "")
        self.assertIn('there is no patch "none"', done.stderr)
        self.assertFalse((self.dir / "a.vtu").exists())

    def needs_cad(self):
        if not (pathlib.Path(OCTAFRONT).parent / "../cad/octafront-cad").exists():
            self.skipTest("no program that reads CAD")

    def test_info_of_an_assembly_lists_parts_and_contacts(self):
        self.needs_cad()
        report = self.dir / "info.json"
        said = self.run_cli("info", SAMPLES / "assembly.step").stdout
        self.assertIn('part "bolt", 2 times, "bolt", "bolt#2": each volume 1434.43', said)
        self.assertIn('patch "ground": plane, area', said)
        self.assertIn('contact of "plate" and "bolt": cylinder of radius 4, area 201.062, patch "plate|bolt"', said)
        self.run_cli("info", SAMPLES / "assembly.step", "--json", report)
        info = json.loads(report.read_text())
        self.assertEqual({c["patch"] for c in info["contacts"]},
                         {"seat", "plate|bolt", "plate|bolt#2", "bracket|bolt", "bracket|bolt#2", "bolt hole 1", "bolt hole 2"})
        self.assertEqual([p["name"] for p in info["cad_patches"]], info["places"]["patches"])
        self.assertEqual([s.get("product") for s in info["solids"]], ["plate", "bracket", "bolt", "bolt"])
        self.assertIn(f'shortest edge {info["shortest_edges"][0]["size"]:.4g}, "{info["shortest_edges"][0]["name"]}"', said)
        self.assertEqual([e["size"] for e in info["shortest_edges"]], sorted(e["size"] for e in info["shortest_edges"]))

    def test_how_small_the_sample_is(self):
        self.needs_cad()
        info = json.loads(self.run_cli("info", SAMPLES / "bracket.step", "--json", "-").stdout)
        self.assertEqual([round(e["size"], 9) for e in info["shortest_edges"][:4]], [6, 6, 6, 6])  # across its plates
        self.assertAlmostEqual(info["narrowest_faces"][0]["size"], 2 * 240 / 92, places=9)  # 6 x 40
        checked = json.loads(self.run_cli("check", SAMPLES / "bracket.step", "--json", "-").stdout)
        self.assertAlmostEqual(checked["thickness"]["least"], 6, delta=.05)
        self.assertAlmostEqual(checked["shortest_edge"]["length"], 6, places=6)
        self.assertIn("thinnest", self.run_cli("check", SAMPLES / "gear.obj").stdout)

    def test_densities_of_a_step_file_are_those_of_a_job(self):
        self.needs_cad()
        body, end = (SAMPLES / "assembly.step").read_text().rsplit("ENDSEC;", 1)
        products = {name: next(re.findall(rf"#(\d+) = PRODUCT_DEFINITION\('design','',#{form}\b", body)[0]
                               for form in re.findall(rf"#(\d+) = PRODUCT_DEFINITION_FORMATION\('','',#{number}\)", body))
                    for number, name in re.findall(r"#(\d+) = PRODUCT\('(\w+)'", body)}
        heavy = self.dir / "heavy.step"
        heavy.write_text(body + DENSITIES.format(**products) + "ENDSEC;" + end)
        report, deck = self.dir / "info.json", self.dir / "heavy.inp"
        self.run_cli("info", heavy, "--json", report)
        self.assertEqual({s["name"]: "density" in s and round(s["density"], 6) for s in json.loads(report.read_text())["solids"]},
                         {"plate": 2700, "bracket": False, "bolt": 7850, "bolt#2": 7850})
        materials = self.dir / "materials.json"

        def densities_with(text):
            materials.write_text(text)
            told = self.run_cli("mesh", heavy, "-o", deck, "--size", 12, "--fix", "ground", "--materials", materials).stdout
            found = re.findall(r"\*MATERIAL, NAME=(\S+)\n\*ELASTIC\n.*\n(?:\*DENSITY\n(\S+))?", deck.read_text())
            return told, {name: density and round(float(density), 15) for name, density in found}

        told, made = densities_with('{"plate": {"name": "alu", "E": 70000, "density": 3e-9}, "bolt": {"name": "steel", "E": 2e5}}')
        self.assertIn('densities of the input, as they go with newtons: 7.85e-09 of "bolt", 7.85e-09 of "bolt#2"\n', told)
        self.assertEqual(made, {"alu": 3e-9, "steel": 7.85e-9, "placeholder": 7.85e-9})
        told, made = densities_with('{"default": {"name": "metal", "E": 2e5}}')
        self.assertIn('2.7e-09 of "plate", 7.85e-09 of "bolt", 7.85e-09 of "bolt#2"\n', told)
        self.assertEqual(made, {"metal": 2.7e-9, "metal_of_bracket": "", "metal_of_bolt": 7.85e-9})
        told = self.run_cli("mesh", heavy, "-o", deck, "--size", .012, "--unit", "m", "--fix", "ground").stdout
        self.assertIn("E 2.1e+11, nu 0.3, density 7850 stand there, which is steel in N, m and s", told)
        self.assertIn('2700 of "plate"', told)

    def test_orders_3_and_4_are_the_same_in_each_format(self):
        part, report = SAMPLES / "gear.obj", self.dir / "report.json"
        for order in (3, 4):
            files = [self.dir / f"part{order}{end}" for end in (".msh", ".vtu", "_text.msh", "_text.vtu")]
            self.run_cli("mesh", part, "--size", 12, "--order", order, "-o", files[0], "-o", files[1], "--json", report)
            self.run_cli("convert", files[1], "-o", files[2], "--ascii", "--format", "msh22")
            self.run_cli("convert", files[0], "-o", files[3], "--ascii")
            self.assertIn(f" {29 if order == 3 else 30} ", files[2].read_text())
            told, volumes, places = set(), [], []
            for file in files:
                said = self.run_cli("check", file).stdout
                self.assertIn(f"tetrahedra of order {order}", said)
                told.update(re.findall("order .: every Jacobian proven positive; the least scaled one is ([0-9.]+)", said))
                self.run_cli("info", file, "--json", report)
                found = json.loads(report.read_text())
                self.assertEqual(found["order"], order)
                volumes.append(found["volume"])
                places.append((sorted(found["places"]["patches"]), len(found["places"]["curves"])))
            self.assertEqual(len(told), 1, told)
            self.assertLess(max(volumes) / min(volumes), 1 + 1e-9)
            self.assertEqual(places, places[:1] * len(files))
            self.assertIn("holds no elements of order", self.run_cli("convert", files[0], "-o", self.dir / "linear.inp").stdout)
            back = self.run_cli("convert", files[0], "-o", self.dir / "back.vtu", "--order", "1").stdout
            self.assertIn("written", back)
            # One node of one element pulled away: found, with its element.
            lines = files[2].read_text().split("\n")
            at = lines.index("$Nodes") + 1 + int(lines[lines.index("$Nodes") + 1])
            number, x, y, z = lines[at].split()
            lines[at] = f"{number} {float(x) + 50} {y} {z}"
            files[2].write_text("\n".join(lines))
            self.assertIn("is not positive everywhere", self.run_cli("check", files[2], status=3).stderr)
        refused = self.run_cli("mesh", part, "-o", self.dir / "a.vtu", "--order", 3, "--layers", 2, "--total", 1, status=2)
        self.assertIn("--order 3 and 4 go with neither --layers nor --periodic yet", refused.stderr)

    def test_contacts_are_shared_split_or_separate(self):
        self.needs_cad()
        mesh, report = self.dir / "a.vtu", self.dir / "a.json"

        def made(*options):
            self.run_cli("mesh", SAMPLES / "assembly.step", "-o", mesh, "--size", 9, "--json", report, *options)
            self.run_cli("check", mesh)
            return json.loads(report.read_text())

        shared, split = made(), made("--contacts", "split")
        self.assertNotIn("opened_contacts", shared)
        self.assertEqual(len(split["opened_contacts"]), 7)
        self.assertIn(["seat (plate|bracket)", "seat (bracket|plate)"], [c["patches"] for c in split["opened_contacts"]])
        self.assertEqual(split["tets"], shared["tets"])
        self.assertGreater(split["points"], shared["points"])
        apart = made("--contacts", "separate", "--contact", "bracket|plate=shared", "--size-of", "bolt=3")
        self.assertEqual(len(apart["opened_contacts"]), 6)
        self.assertFalse(any(c["conforming"] for c in apart["opened_contacts"]))
        for region in apart["regions"]:
            self.assertAlmostEqual(region["volume"] / region["true_volume"], 1, delta=.02)  # chords of the bolts
        rules = self.dir / "contacts.txt"
        rules.write_text("# seat only\nplate|bracket=split\n")
        self.assertEqual(len(made("--contact", rules)["opened_contacts"]), 1)
        refused = self.run_cli("mesh", SAMPLES / "assembly.step", "-o", mesh, "--contact", "plate|nut=split", status=2)
        self.assertIn('there is no contact "plate|nut"; there are contacts "bolt hole 1"', refused.stderr)
        refused = self.run_cli("mesh", self.part, "-o", mesh, "--contacts", "splitt", status=2)
        self.assertIn("give shared, split or separate", refused.stderr)

    def test_one_name_is_one_patch_of_every_option(self):
        self.needs_cad()
        part, mesh, report = self.dir / "part.step", self.dir / "part.vtu", self.dir / "part.json"
        text = (SAMPLES / "bracket.step").read_text()
        part.write_text(text.replace("'bolt hole 2'", "'hole'").replace("'bolt hole 1'", "'hole'"))
        made = self.run_cli("mesh", part, "-o", mesh, "--size", 8, "--size-of", "hole=1", "--on", "hole", "--layers", 2,
                            "--first", ".1", "--group", "both=hole", "--group", "low=planes at z min", "--json", report).stdout
        walls = json.loads(report.read_text())["layers"]
        self.assertEqual([wall["patch"] for wall in walls], ["hole"])
        groups = {(g["origin"], g["name"]): g["size"]
                  for g in json.loads(self.run_cli("check", mesh, "--json", "-").stdout)["groups"]}
        self.assertGreater(groups["patch", "hole"], 200, made)
        self.assertEqual(groups["faces", "both"], groups["patch", "hole"])
        self.assertGreater(groups["faces", "low"], 0)
        self.assertNotIn(("faces", "planes at z min"), groups)
        refused = self.run_cli("mesh", part, "-o", mesh, "--size", 8, "--size-of", "spheres=2", status=2)
        self.assertIn('nothing is called "spheres", and there is nothing of that kind', refused.stderr)

    def test_parts_for_structures_hear_of_second_order(self):
        self.needs_cad()
        for ending, order, says in ((".inp", 1, True), (".inp", 2, False), (".vtu", 1, False)):
            done = self.run_cli("mesh", SAMPLES / "bracket.step", "--size", 12, "--order", order, "-o", self.dir / f"part{ending}")
            self.assertEqual("elements of first order" in done.stdout + done.stderr, says, (ending, order))

    def test_devices_as_outputs(self):
        whole = self.run_cli("mesh", self.part, "-o", self.dir / "a.mesh") and (self.dir / "a.mesh").read_text()
        self.assertEqual(self.run_cli("mesh", self.part, "-o", "/dev/stdout", "--format", "medit").stdout, whole)
        self.run_cli("mesh", self.part, "-o", "/dev/null", "--format", "vtu")
        self.assertIn("--format", self.run_cli("mesh", self.part, "-o", "/dev/null", status=2).stderr)

    def test_a_body_that_is_covered_is_refused_by_name(self):
        inner = self.write_box("inner.off", (1, 1, 1), (2, 2, 2))
        outer = self.write_box("outer.off", (0, 0, 0), (3, 3, 3))
        done = self.run_cli("mesh", inner, outer, "-o", self.dir / "a.vtu", status=3)
        self.assertIn("inner", done.stderr)
        self.assertNotIn("a.vtu", self.files())

    def test_points_name_and_empty_cells(self):
        both = self.dir / "both.obj"
        lines = []
        for z in range(3):
            lines += [f"v {x} {y} {z}" for y in (0, 1) for x in (0, 1)]
        for k in range(2):
            skip = 2 if k else 0  # the wall between both boxes is there once
            lines += ["f {} {} {}".format(*(4 * k + c + 1 for c in f)) for f in self.CUBE[skip:]]
        both.write_text("\n".join(lines) + "\n")
        self.assertEqual(self.regions_of(both), {"region_1": 1, "region_2": 1})
        seeds = ("--region", "low=.3,.4,.5", "--region", "high=.3,.4,1.5")
        self.assertEqual(self.regions_of(both, *seeds), {"low": 1, "high": 1})
        self.assertEqual(self.regions_of(both, "--void", ".3,.4,.5", "--region", "high=.3,.4,1.5"), {"high": 1})
        self.assertEqual(self.regions_of(both, "--cells", "merge"), {"body": 2})
        for bad in ("low", "low=1,2", "=1,2,3", "low=1,2,x"):
            self.run_cli("check", both, "--region", bad, status=2)
        # Without a triangle of the wall the names share a cell, and the way between is shown.
        lines.pop(12 + 2)
        both.write_text("\n".join(lines) + "\n")
        done = self.run_cli("mesh", both, *seeds, "-o", self.dir / "out.vtu", status=3)
        self.assertIn("low", done.stderr)
        self.assertIn("out.leak.ply", self.files())

    def test_shells_inside_others(self):
        nested = self.dir / "nested.obj"
        for inward, regions in ((False, 2), (True, 0)):
            lines = []
            for low, high in ((0, 3), (1, 2)):
                lines += [f"v {x} {y} {z}" for z in (low, high) for y in (low, high) for x in (low, high)]
            lines += ["f {} {} {}".format(*(c + 1 for c in f)) for f in self.CUBE]
            lines += ["f {} {} {}".format(*(c + 9 for c in (reversed(f) if inward else f))) for f in self.CUBE]
            nested.write_text("\n".join(lines) + "\n")
            self.assertEqual(len(self.regions_of(nested)), regions)
            self.assertEqual(len(self.regions_of(nested, "--nested", "region")), 2)
            self.assertEqual(len(self.regions_of(nested, "--nested", "cavity")), 1)

    def test_tetgen_plcs_have_regions_holes_and_markers(self):
        plc = self.dir / "frame.poly"
        nodes = [f"{4 * k + c + 1} {x} {y} {k}" for k in range(3) for c, (x, y) in
                 enumerate(((0, 0), (1, 0), (1, 1), (0, 1)))]
        facets = [f"1 0 {k + 1}\n4 {4 * k + 1} {4 * k + 2} {4 * k + 3} {4 * k + 4}" for k in range(3)]
        for k in range(2):
            for c in range(4):
                d = (c + 1) % 4
                facets.append(f"1 0 9\n4 {4 * k + c + 1} {4 * k + d + 1} {4 * k + d + 5} {4 * k + c + 5}")
        plc.write_text("\n".join(["12 3 0 0", *nodes, f"{len(facets)} 1", *facets, "0",
                                   "2", "1 .5 .4 .3 7 0.1", "2 .5 .4 1.3 8"]) + "\n")
        self.assertEqual(self.regions_of(plc), {"region_7": 1, "region_8": 1})
        plc.write_text(plc.read_text().replace("\n0\n2\n1 .5 .4 .3 7 0.1\n", "\n1\n1 .5 .4 .3\n1\n"))
        self.assertEqual(self.regions_of(plc), {"region_8": 1})

    def test_second_order_is_curved_reported_and_proven_from_the_file(self):
        files, report = [self.dir / f"torus.{ending}" for ending in ("msh", "inp", "bdf", "vtu", "unv")], self.dir / "report.json"
        outputs = [word for file in files for word in ("-o", file)]
        done = self.run_cli("mesh", SAMPLES / "torus_knot.ply", *outputs, "--order", 2, "--json", report, "--improve", "fast")
        self.assertIn("curved, every element proven valid", done.stdout)
        r = json.loads(report.read_text())["second_order"]
        self.assertGreater(r["curved_edges"], 1000)
        self.assertEqual(r["edges"], r["curved_edges"] + r["eased_edges"] + r["straight_edges"])
        self.assertGreater(r["least_scaled_jacobian"], 0)
        for file in files:
            self.run_cli("check", file, "--json", report)
            found = json.loads(report.read_text())
            self.assertEqual(found["second_order"]["invalid"], 0)
            # Formats with fewer digits than a double change it a little.
            self.assertAlmostEqual(found["second_order"]["least_scaled_jacobian"], r["least_scaled_jacobian"], 6)

    def test_a_mid_side_node_out_of_place_is_named(self):
        out = self.dir / "part.msh"
        self.run_cli("mesh", self.part, "-o", out, "--order", 2, "--size", 0.3)
        text = self.dir / "part.inp"
        self.run_cli("convert", out, "-o", text)
        lines = text.read_text().splitlines()
        first = lines[lines.index(next(line for line in lines if line.startswith("*ELEMENT"))) + 1].split(",")
        nodes = lines.index("*NODE")
        corner, middle = int(first[1]), int(first[5])
        lines[nodes + middle] = ",".join([str(middle), *lines[nodes + corner].split(",")[1:]])
        text.write_text("\n".join(lines) + "\n")
        report = self.dir / "report.json"
        done = self.run_cli("check", text, "--solver", "nastran", "--json", report, status=3)
        self.assertIn("element 0 at", done.stderr)
        found = json.loads(report.read_text())
        self.assertGreater(found["second_order"]["invalid"], 0)
        corners = next(f for f in found["solver"] if "TET_DETG" in f["measure"])
        self.assertIn(0, [e["number"] for e in corners["worst"]])

    def test_solvers_are_asked_about_meshes_only(self):
        out = self.dir / "part.msh"
        self.run_cli("mesh", self.part, "-o", out, "--size", 0.3)
        for solver in ("abaqus", "ansys", "nastran", "calculix"):
            self.assertIn(" 0 elements", self.run_cli("check", out, "--solver", solver).stdout)
        self.run_cli("check", self.part, "--solver", "ansys", status=2)
        self.run_cli("check", out, "--solver", "abacus", status=2)

    def test_meshes_to_every_format_and_reports(self):
        for ending in ("vtu", "msh", "mesh", "meshb", "vtk", "inp", "bdf", "unv", "vol", "ele"):
            out, report = self.dir / f"part.{ending}", self.dir / "report.json"
            done = self.run_cli("mesh", self.part, "-o", out, "--size", 0.2, "--json", report)
            self.assertIn("tetrahedra", done.stdout)
            self.assertIn("0.8 - 1.0", done.stdout)
            self.assertEqual(done.stderr, "", "quiet when piped")
            r = json.loads(report.read_text())
            self.assertGreater(r["tets"], 50)
            self.assertEqual(sum(r["quality"]["beta_classes"]), r["tets"])
            self.assertIn(f"a valid mesh of {r['tets']} tetrahedra", self.run_cli("check", out).stdout)

    def test_the_mesh_does_not_hang_on_the_c_library(self):
        """Its elementary functions have variants for processors, which differ in the last bit."""
        hashes = set()
        for tunables in ("", "glibc.cpu.hwcaps=-FMA,-FMA4,-AVX2"):
            for options in (["--elements", 20000], ["--order", 2], ["--layers", 3, "--first-part", 0.1]):
                out = self.dir / "m.json"
                self.run_cli("mesh", SAMPLES / "torus_knot.ply", "-o", self.dir / "m.vtu", "--json", out, *options, env={**os.environ, "GLIBC_TUNABLES": tunables})
                hashes.add((str(options), json.loads(out.read_text())["hash"]))
        self.assertEqual(len(hashes), 3, hashes)

    def test_same_input_same_file(self):
        a, b = self.dir / "a.vtu", self.dir / "b.vtu"
        self.run_cli("mesh", self.part, "-o", a, "--size", 0.15, "--threads", 1)
        self.run_cli("mesh", self.part, "-o", b, "--size", 0.15, "--threads", 3)
        self.assertEqual(a.read_bytes(), b.read_bytes())

    def test_improves_meshes_of_every_format(self):
        for ending in ("vtu", "msh", "mesh", "meshb", "vtk", "inp", "bdf", "unv", "vol", "ele"):
            start, out, report = self.dir / f"start.{ending}", self.dir / "better.vtu", self.dir / "report.json"
            self.run_cli("mesh", self.part, "-o", start, "--size", 0.2, "--improve", "none")
            done = self.run_cli("improve", start, "-o", out, "--surface", self.part, "--json", report)
            self.assertIn("improved:", done.stdout)
            self.assertNotIn("0 bodies", done.stdout)
            self.assertGreater(json.loads(report.read_text())["quality"]["beta_mean"], 0.7)
            self.assertIn("a valid mesh", self.run_cli("check", out).stdout)

    def test_adapts_a_mesh_to_other_sizes(self):
        start, out, report = self.dir / "a.msh", self.dir / "b.vtu", self.dir / "r.json"
        self.run_cli("mesh", SAMPLES / "bracket.stl", "-o", start, "--size", 8, "--patches")
        done = self.run_cli("adapt", start, "--size", 4, "-o", out, "--json", report, "--max-deviation", 0.1)
        deviation = json.loads(report.read_text())["deviation"]
        self.assertEqual(deviation["bound"], 0.1)
        self.assertTrue(0 < deviation["lower"] <= deviation["upper"] < 0.4, deviation)
        self.assertEqual(deviation["upper"] > 0.1, "beyond the bound" in done.stdout)
        done = self.run_cli("adapt", start, "--size", 4, "-o", out, "--json", report)
        self.assertIn("of the edges fit", done.stdout)
        deviation = json.loads(report.read_text())["deviation"]
        self.assertLess(deviation["upper"], deviation["bound"])
        fit = json.loads(report.read_text())["fit"]
        self.assertGreater(fit["fitting"], 0.9 * fit["edges"])
        self.assertLess(fit["longest"], 2)
        self.assertIn("a valid mesh", self.run_cli("check", out).stdout)

    def test_adapts_on_the_surface_that_is_given(self):
        start, out, report = self.dir / "a.msh", self.dir / "b.msh", self.dir / "r.json"
        self.run_cli("mesh", SAMPLES / "bracket.stl", "-o", start, "--size", 12)
        self.run_cli("adapt", start, "--size", 4, "-o", out, "--surface", SAMPLES / "bracket.stl", "--json", report)
        made = json.loads(report.read_text())
        self.assertLess(made["deviation"]["upper"], made["deviation"]["bound"])
        self.assertIn("a valid mesh", self.run_cli("check", out).stdout)
        (self.dir / "away.obj").write_text("v 900 0 0\nv 901 0 0\nv 900 1 0\nf 1 2 3\n")
        away = self.run_cli("adapt", start, "--size", 4, "-o", self.dir / "c.msh", "--surface", self.dir / "away.obj", status=3)
        self.assertIn("near no wall", away.stderr)
        self.assertFalse((self.dir / "c.msh").exists())

    def test_adapts_a_surface_alone(self):
        report = self.dir / "r.json"
        for name in ("a.ply", "b.vtu", "c.msh", "d.vtk", "e.mesh", "f.meshb"):
            out = self.dir / name
            self.run_cli("adapt", SAMPLES / "bracket.stl", "--size", 2, "-o", out, "--json", report)
            made = json.loads(report.read_text())
            self.assertGreater(made["fit"]["fitting"], 0.95 * made["fit"]["edges"])
            again = self.run_cli("adapt", out, "--size", 5, "-o", self.dir / "again.ply", "--json", report)
            self.assertIn("of the edges fit", again.stdout)
        for option in (("--only", "box:0,0,0,1,1,1"), ("--map", self.dir / "m.csv"), ("--carry", "u")):
            refused = self.run_cli("adapt", SAMPLES / "bracket.stl", "--size", 5, "-o", self.dir / "x.ply", *option, status=2)
            self.assertIn("a surface alone", refused.stderr)
        self.assertIn("holds meshes of tetrahedra",
                      self.run_cli("adapt", SAMPLES / "bracket.stl", "--size", 5, "-o", self.dir / "x.inp", status=2).stderr)

    def test_fields_of_the_input_go_along(self):
        start, with_field, report = self.dir / "a.vtk", self.dir / "in.vtk", self.dir / "r.json"
        self.run_cli("mesh", SAMPLES / "bracket.stl", "-o", start, "--size", 8, "--ascii")
        text = start.read_text()
        count = int(text.split("POINTS ")[1].split()[0])
        xs = [float(w) for w in text.split("POINTS ")[1].split()[2:2 + 3 * count]][0::3]
        field = "POINT_DATA %d\nSCALARS T double 1\nLOOKUP_TABLE default\n" % count + "\n".join(map(repr, xs)) + "\n"
        with_field.write_text(text.partition("POINT_DATA")[0] + field)
        out = self.dir / "b.vtk"
        self.run_cli("adapt", with_field, "--size", 5, "-o", out, "--ascii", "--json", report)
        self.assertEqual([(f["name"], f["of"], f["components"]) for f in json.loads(report.read_text())["carried"]], [("T", "points", 1)])
        made = out.read_text()
        count = int(made.split("POINTS ")[1].split()[0])
        xs = [float(w) for w in made.split("POINTS ")[1].split()[2:2 + 3 * count]][0::3]
        values = [float(w) for w in made.split("T 1 %d double" % count)[1].split()[:count]]
        self.assertLess(max(abs(x - t) for x, t in zip(xs, values)), 1)  # walls move off the old ones by little
        self.assertLess(sorted(abs(x - t) for x, t in zip(xs, values))[count // 2], 1e-9)
        # And again from that file, without one, and where it is not.
        self.run_cli("adapt", out, "--size", 8, "-o", self.dir / "c.msh", "--json", report)
        self.assertEqual([(f["name"], f["of"], f["components"]) for f in json.loads(report.read_text())["carried"]], [("T", "points", 1)])
        self.run_cli("adapt", out, "--size", 8, "-o", self.dir / "c.vtu", "--carry", "none", "--json", report)
        self.assertNotIn("carried", json.loads(report.read_text()))
        self.assertIn("no field", self.run_cli("adapt", out, "--size", 8, "-o", self.dir / "d.vtu", "--carry", "u", status=3).stderr)
        self.run_cli("adapt", out, "--size", 8, "-o", self.dir / "d.inp", "--carry", "T", status=2)

    def test_carries_fields_to_another_mesh(self):
        old, new, out, report = (self.dir / name for name in ("old.vtu", "new.msh", "out.vtk", "r.json"))
        self.run_cli("mesh", SAMPLES / "bracket.stl", "-o", old, "--size", 8, "--keep-surface", "--field", "T=300+x", "--field", "s=T^2")
        self.run_cli("mesh", SAMPLES / "bracket.stl", "-o", new, "--size", 6, "--keep-surface")
        done = self.run_cli("carry", old, new, "-o", out, "--ascii", "--json", report)
        self.assertIn("integral", done.stdout)
        told = json.loads(report.read_text())
        self.assertEqual(told["inputs"], [str(old), str(new)])
        self.assertEqual(len(told["carried"]), 4)
        for field in told["carried"]:
            self.assertEqual(field["beyond"], 0)
            self.assertLess(field["integral_error"], 1e-12)
            self.assertGreaterEqual(field["after"]["least"][0], field["before"]["least"][0])
            self.assertLessEqual(field["after"]["greatest"][0], field["before"]["greatest"][0])
        made = out.read_text()
        count = int(made.split("POINTS ")[1].split()[0])
        xs = [float(w) for w in made.split("POINTS ")[1].split()[2:2 + 3 * count]][0::3]
        values = [float(w) for w in made.split("T 1 %d double" % count)[1].split()[:count]]
        self.assertLess(max(abs(300 + x - t) for x, t in zip(xs, values)), 1e-9)
        self.run_cli("carry", out, new, "-o", self.dir / "again.vtu", "--linear-elements", "--free-integrals", "--carry", "T", "--json", report)
        self.assertEqual([f["of"] for f in json.loads(report.read_text())["carried"]], ["points", "elements"])
        # Improvement takes them along, too.
        self.run_cli("improve", old, "-o", self.dir / "better.vtu", "--json", report)
        self.assertLess(max(f["integral_error"] for f in json.loads(report.read_text())["carried"]), 1e-12)
        for words, status, said in ((("carry", new, old, "-o", out), 3, "no field"), (("carry", old, "-o", out), 2, "2"),
                                    (("carry", old, new, "-o", self.dir / "x.inp"), 2, "no output holds fields"),
                                    (("carry", old, new, "-o", new), 2, "overwritten"), (("carry", old, new, "-o", out, "--carry", "nosuch"), 3, "nosuch")):
            self.assertIn(said, self.run_cli(*words, status=status).stderr)

    def test_carries_values_at_mid_side_nodes(self):
        old, new, out, report = (self.dir / name for name in ("old.vtu", "new.msh", "out.vtk", "r.json"))
        self.run_cli("mesh", SAMPLES / "bracket.stl", "-o", old, "--size", 8, "--order", 2, "--field", "T=300+x*x")
        self.run_cli("mesh", SAMPLES / "bracket.stl", "-o", new, "--size", 5)
        self.assertIn("--quadratic-nodes", self.run_cli("carry", old, new, "-o", out, status=3).stderr)

        def error_of(file):
            self.run_cli("carry", file, new, "-o", out, "--ascii", "--quadratic-nodes", "--carry", "T", "--json", report)
            made = out.read_text()
            count = int(made.split("POINTS ")[1].split()[0])
            xs = [float(w) for w in made.split("POINTS ")[1].split()[2:2 + 3 * count]][0::3]
            return sum(abs(300 + x * x - float(w)) for x, w in zip(xs, made.split("T 1 %d double" % count)[1].split())) / count
        mean = error_of(old)
        self.assertLess(mean, 0.1)  # linear elements of this size have 5
        # Conversion keeps fields of all points, in any order that a format has them in.
        self.run_cli("convert", old, "-o", self.dir / "other.msh")
        self.assertAlmostEqual(error_of(self.dir / "other.msh"), mean, places=9)
        self.run_cli("convert", old, "-o", self.dir / "corners.vtk", "--order", 1)
        self.run_cli("carry", self.dir / "corners.vtk", new, "-o", out, "--carry", "T")
        self.assertIn("left out: T", self.run_cli("convert", self.dir / "corners.vtk", "-o", self.dir / "high.vtu", "--order", 3).stdout)
        self.assertIn("four points", self.run_cli("carry", old, new, "-o", out, "--quadratic-nodes", "--integration-points", "T", status=3).stderr)

    def test_level_sets_become_faces(self):
        start, out, report = self.dir / "in.vtu", self.dir / "out.vtu", self.dir / "r.json"
        self.run_cli("mesh", SAMPLES / "bracket.stl", "-o", start, "--size", 4, "--field", "phi=sqrt((x-5)^2+y^2+(z-4)^2)-9", "--field", "low=z-3")
        done = self.run_cli("adapt", start, "--level-set", "phi", "--level-set", "low=.2", "-o", out, "--json", report)
        self.assertIn("between regions", done.stdout)
        told = json.loads(report.read_text())
        self.assertEqual([r["name"] for r in told["regions"]], ["outside", "phi", "low"])
        self.assertEqual([c["name"] for c in told["level_sets"]], ["phi", "low"])
        self.assertLess(max(f["integral_error"] for f in told["carried"]), 1e-12)
        self.assertIn("phi_surface", self.run_cli("check", out).stdout)
        for words, status in ((("--level-set", "nosuch"), 3), (("--level-set", "phi=x"), 2), (("--level-set", "phi", "--map", self.dir / "m.csv"), 2),
                              (("--level-set", "phi", "--level-set", "phi=1"), 2), (("--level-set", "phi", "--least-piece", "-1"), 2)):
            self.run_cli("adapt", start, "-o", self.dir / "x.vtu", *words, status=status)
        self.assertNotIn("x.vtu", self.files())

    def test_moves_by_a_field(self):
        bare, start, out, report = (self.dir / name for name in ("a.vtk", "in.vtk", "out.vtu", "r.json"))
        self.run_cli("mesh", SAMPLES / "bracket.stl", "-o", bare, "--size", 8, "--ascii")
        text = bare.read_text()
        count = int(text.split("POINTS ")[1].split()[0])
        xyz = [float(w) for w in text.split("POINTS ")[1].split()[2:2 + 3 * count]]

        def moved(name, row, status=0):
            rows = "\n".join(row(*xyz[i:i + 3]) for i in range(0, 3 * count, 3))
            start.write_text(text.partition("POINT_DATA")[0] + f"POINT_DATA {count}\nFIELD f 2\n{name} 3 {count} double\n{rows}\n"
                             f"x 1 {count} double\n" + "\n".join(map(repr, xyz[0::3])) + "\n")
            return self.run_cli("move", start, "--displacement", "u", "-o", out, "--json", report, status=status)
        moved("u", lambda x, y, z: f"{2 * x!r} 0 0")
        told = json.loads(report.read_text())
        self.assertEqual(told["history"][-1]["fraction"], 1)
        self.assertEqual([f["name"] for f in told.get("carried", [{"name": "x"}])], ["x"])
        volume = json.loads(self.run_cli("info", bare, "--json", "-").stdout)["volume"]
        self.assertAlmostEqual(told["history"][-1]["volume"] / volume, 3, delta=0.03)
        self.assertEqual([f["name"] for f in told["carried"]], ["x"])
        # Only the boundary has a say; and what is poor is meshed anew.
        self.run_cli("move", start, "--displacement", "u", "-o", out, "--boundary-alone", "--remesh", "--least-quality", ".4", "--json", report)
        told = json.loads(report.read_text())
        self.assertIn("remeshed", [step["change"] for step in told["history"]])
        self.assertAlmostEqual(told["history"][-1]["volume"] / volume, 3, delta=0.05)
        out.unlink()
        self.assertIn("no field", moved("v", lambda x, y, z: "0 0 0", status=3).stderr)
        self.run_cli("move", start, "-o", out, status=2)
        self.assertNotIn(out.name, self.files())

    def test_carries_vectors_of_elements(self):
        old = self.dir / "old.vtk"
        old.write_text("""# vtk DataFile Version 3.0
a tetrahedron of two
ASCII
DATASET UNSTRUCTURED_GRID
POINTS 5 double
0 0 0  1 0 0  0 1 0  0 0 1  1 1 1
CELLS 2 10
4 0 1 2 3
4 1 2 3 4
CELL_TYPES 2
10 10
CELL_DATA 2
VECTORS v double
1 2 3
4 5 6
""".replace("VECTORS v double", "FIELD more 1\nv 3 2 double"))
        out, report = self.dir / "out.vtu", self.dir / "r.json"
        self.run_cli("carry", old, old, "-o", out, "--json", report)
        field = json.loads(report.read_text())["carried"][0]
        self.assertEqual((field["components"], field["after"]), (3, field["before"]))
        self.assertEqual((field["before"]["least"], field["before"]["greatest"]), ([1, 2, 3], [4, 5, 6]))
        self.run_cli("carry", out, old, "-o", self.dir / "again.vtk", "--json", report)
        self.assertEqual(json.loads(report.read_text())["carried"][0], field)

    def test_adapts_only_what_is_asked(self):
        start, out, table, report = (self.dir / name for name in ("a.msh", "b.msh", "map.json", "r.json"))
        self.run_cli("mesh", SAMPLES / "bracket.stl", "-o", start, "--size", 5, "--patches")
        done = self.run_cli("adapt", start, "--size", 2, "--only", "sphere:10,10,5,6", "--halo", 1, "-o", out, "--map", table,
                            "--json", report)
        self.assertIn("in a halo of 1 layers", done.stdout)
        self.assertIn("a valid mesh", self.run_cli("check", out).stdout)
        moved = json.loads(table.read_text())
        for kind in ("vertices", "elements"):
            self.assertIn(-1 if kind == "elements" else 0, moved[kind])
            self.assertTrue(all(new in (-1, old) for old, new in enumerate(moved[kind])), kind)
        self.assertGreater(json.loads(report.read_text())["tets"], len(moved["elements"]))
        for wrong, says in (("nobody", "no region, patch, curve or set"), ("box:1,2,3", "6 numbers")):
            refused = self.run_cli("adapt", start, "--size", 2, "--only", wrong, "-o", self.dir / "c.msh", status=2)
            self.assertIn(says, refused.stderr)
        self.run_cli("adapt", start, "--size", 2, "-o", self.dir / "c.msh", "--map", self.dir / "map.txt", status=2)
        self.assertFalse((self.dir / "c.msh").exists())

    def test_adapts_a_mesh_to_a_metric_of_a_file_or_a_field(self):
        start, out, report = self.dir / "a.mesh", self.dir / "b.vtu", self.dir / "r.json"
        self.run_cli("mesh", SAMPLES / "bracket.stl", "-o", start, "--size", 10)
        words = start.read_text().split()
        count = int(words[words.index("Vertices") + 1])
        sol = "MeshVersionFormatted 2\nDimension 3\nSolAtVertices\n%d\n1 3\n" % count
        (self.dir / "m.sol").write_text(sol + "0.04 0 0.01 0 0 0.01\n" * count + "End\n")
        self.run_cli("adapt", start, "--metric", self.dir / "m.sol", "-o", out, "--json", report,
                     "--save-metric", self.dir / "m.vtu")
        fit = json.loads(report.read_text())["fit"]
        self.assertGreater(fit["fitting"], 0.85 * fit["edges"])
        self.assertIn("a valid mesh", self.run_cli("check", out).stdout)
        # What was written is the same metric.
        again = self.dir / "c.vtu"
        self.run_cli("adapt", start, "--metric", self.dir / "m.vtu", "-o", again)
        self.assertEqual(again.read_bytes(), out.read_bytes())
        (self.dir / "m.sol").write_text(sol + "0.04 0 0.01 0 0 0.01\n" * (count - 1) + "1 0 -1 0 0 1\nEnd\n")
        refused = self.run_cli("adapt", start, "--metric", self.dir / "m.sol", "-o", self.dir / "d.vtu", status=3)
        self.assertIn("not positive definite: point %d" % (count - 1), refused.stderr)
        self.assertFalse((self.dir / "d.vtu").exists())
        self.run_cli("adapt", start, "--metric", self.dir / "m.sol", "--size", 3, "-o", out, status=2)
        at = words.index("Vertices") + 2
        points = [[float(w) for w in words[at + 4 * v:at + 4 * v + 3]] for v in range(count)]
        values = "".join("%r\n" % (x * x + 0.2 * y * y + 0.2 * z * z) for x, y, z in points)
        (self.dir / "a.sol").write_text("MeshVersionFormatted 2\nDimension 3\nSolAtVertices\n%d\n1 1\n" % count + values + "End\n")
        self.run_cli("adapt", start, "--from", "solution_1", "--elements", 8000, "-o", out, "--json", report)
        self.assertAlmostEqual(json.loads(report.read_text())["tets"], 8000, delta=2400)
        self.run_cli("adapt", start, "--from", "solution_1", "-o", out, status=2)

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

    def test_a_mesh_with_a_field_gives_sizes(self):
        self.write_box("box.off", (0, 0, 0), (1, 1, 1))
        box, old = self.dir / "box.off", self.dir / "old.vtk"
        self.run_cli("mesh", box, "-o", old, "--ascii", "--size", 0.3)
        text = old.read_text()
        count = int(text.split("POINTS ")[1].split()[0])
        xs = [float(w) for w in text.split("POINTS ")[1].split()[2:2 + 3 * count]][0::3]
        field = f"POINT_DATA {count}\nSCALARS h double 1\nLOOKUP_TABLE default\n" + "\n".join(str(0.05 + 0.1 * x) for x in xs)
        old.write_text(text.partition("POINT_DATA")[0] + field + "\n")
        report = self.dir / "report.json"
        self.run_cli("mesh", box, "-o", self.dir / "new.vtu", "--size-field", f"{old}:h", "--json", report)
        many = json.loads(report.read_text())["tets"]
        self.run_cli("mesh", box, "-o", self.dir / "new.vtu", "--size", 0.1, "--json", report)
        self.assertGreater(many, json.loads(report.read_text())["tets"])
        wrong = self.run_cli("mesh", box, "-o", self.dir / "new.vtu", "--size-field", f"{old}:g", status=3)
        self.assertIn('no field "g"', wrong.stderr)
        self.assertIn('"h"', wrong.stderr)

    def test_sizes_near_places_are_told(self):
        self.write_box("box.off", (0, 0, 0), (1, 1, 1))
        said = self.run_cli("mesh", self.dir / "box.off", "-o", self.dir / "box.vtu", "--size", 0.2, "--size-near",
                            "0,0,0=0.05:0.4")
        self.assertRegex(said.stdout, r"sizes are asked by .*--size over [\d.]+ %")
        self.assertIn("--size-near (0, 0, 0)", said.stdout)
        for wrong in ("0,0,0=0.05", "=1:2", "0,0,0=a:b"):
            self.assertIn("--size-near", self.run_cli("mesh", self.dir / "box.off", "-o", self.dir / "box.vtu",
                                                      "--size-near", wrong, status=2).stderr)
        nobody = self.run_cli("mesh", self.dir / "box.off", "-o", self.dir / "box.vtu", "--size-near", "lid=1:2", status=2)
        self.assertIn('"lid"', nobody.stderr)

    def test_a_formula_is_a_body(self):
        cell, report = self.dir / "cell.msh", self.dir / "report.json"
        self.run_cli("mesh", "gyroid(x,y,z) - 0.3", "-o", cell, "--cell", 2, "--size", 0.2, "--json", report)
        found = json.loads(report.read_text())
        # The part of the cell that is below .3, by 200^3 samples, times its volume.
        self.assertAlmostEqual(found["volume"], 8 * 0.59682, delta=0.05)
        self.run_cli("check", cell)
        self.assertIn("x_min", self.run_cli("info", cell).stdout)
        self.assertIn("at character 9", self.run_cli("mesh", "gyroid+(", "-o", cell, status=2).stderr)
        self.assertIn("--box", self.run_cli("mesh", "x - 0.5", "-o", cell, status=2).stderr)
        self.assertIn("--cell", self.run_cli("mesh", self.part, "-o", cell, "--cell", 2, status=2).stderr)

    def test_walls_get_layers(self):
        self.write_box("plate.off", (0, 0, 0), (20, 20, 1))
        plate, report = self.dir / "plate.off", self.dir / "report.json"
        tets = []
        for more in ((), ("--shell", 2)):
            self.run_cli("mesh", plate, "-o", self.dir / "plate.vtu", "--size", 5, "--json", report, *more)
            tets.append(json.loads(report.read_text())["tets"])
            self.run_cli("check", self.dir / "plate.vtu")
        self.assertGreater(tets[1], 1.5 * tets[0])
        self.assertLess(tets[1], 4 * tets[0])
        self.assertIn("--shell", self.run_cli("mesh", plate, "-o", self.dir / "plate.vtu", "--shell", 1, status=2).stderr)

    def test_an_edited_grid_is_passed_back(self):
        grid, out = self.dir / "grid.vtu", self.dir / "o.vtu"
        self.run_cli("size", self.part, "-o", grid, "--size", 0.2)
        self.run_cli("mesh", self.part, "-o", self.dir / "direct.vtu", "--size", 0.2)
        self.run_cli("mesh", self.part, "-o", out, "--size-field", grid)
        count = lambda file: self.run_cli("check", file).stdout.split("mesh of ")[1]
        self.assertEqual(count(out), count(self.dir / "direct.vtu"))
        self.assertIn("no other", self.run_cli("mesh", self.part, "-o", out, "--size-field", grid, "--size", 1,
                                               status=2).stderr)
        self.run_cli("size", self.part, "-o", self.dir / "grid.txt", status=2)

    def test_sizes_come_from_files(self):
        sizes, regions, report = self.dir / "sizes.csv", self.dir / "regions.json", self.dir / "r.json"
        sizes.write_text("x,y,z,h\n0,0,0,0.05\n1,0,0,0.3\n0,1,0,0.3\n0,0,1,0.3\n")
        regions.write_text('[{"sphere": [0.2, 0.2, 0.2], "radius": 0.1, "size": 0.03}]')
        tets = []
        for option in ([], ["--point-sizes", sizes], ["--regions", regions]):
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
        counts = struct.pack("<4q", 0, 6, 4, 1)  # points, curves, surfaces, volumes
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
        self.assertIn("--size and --elements contradict", done.stderr)
        self.assertNotIn("o.vtu", self.files())

    def test_help_and_version(self):
        self.assertIn("sizes", self.run_cli("mesh", "--help").stdout)
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
        bad = self.dir / "bad.off"
        bad.write_text(TETRAHEDRON.replace("4 4 0", "4 3 0").replace("3 0 2 1\n", ""))
        for done in (self.run_cli("mesh", bad, "-o", self.dir / "bad.vtu", "--repair", "none", status=3),
                     self.run_cli("check", bad, status=3)):
            self.assertIn("open", done.stderr)
        self.assertNotIn("bad.vtu", self.files())

    def test_an_open_surface_is_mended_with_a_report(self):
        bad, out, places = self.dir / "bad.off", self.dir / "closed.ply", self.dir / "places.ply"
        bad.write_text(TETRAHEDRON.replace("4 4 0", "4 3 0").replace("3 0 2 1\n", ""))
        done = self.run_cli("repair", bad, "-o", out, "--json", self.dir / "r.json", "--defects", places)
        self.assertIn("1 hole closed", done.stdout)
        self.assertIn("clean: 1 body", self.run_cli("check", out).stdout)
        repair = json.loads((self.dir / "r.json").read_text())["repair"]
        self.assertEqual([(c["kind"], c["within_tolerance"]) for c in repair["changes"]], [("closed", False)])
        self.assertAlmostEqual(repair["volume_after"], 1 / 6)
        self.assertIn(b"closed by repair", out.read_bytes())
        self.assertIn("8 triangles", self.run_cli("info", places).stdout)
        self.run_cli("mesh", bad, "-o", self.dir / "m.vtu", "--size", 0.3)
        self.assertIn("a valid mesh", self.run_cli("check", self.dir / "m.vtu").stdout)
        same = self.dir / "same.off"
        self.run_cli("repair", self.part, "-o", same)
        surfaces = [self.run_cli("check", f).stdout.partition("clean: ")[2] for f in (self.part, same)]
        self.assertEqual(surfaces[0], surfaces[1])

    def write_torus(self, name, inside_out):
        n, m = 24, 12
        at = [[2 * math.pi * i / n, 2 * math.pi * j / m] for i in range(n) for j in range(m)]
        points = [((3 + math.cos(v)) * math.cos(u), (3 + math.cos(v)) * math.sin(u), math.sin(v)) for u, v in at]
        faces = []
        for i in range(n):
            for j in range(m):
                a, b, c, d = (m * ((i + x) % n) + (j + y) % m for x, y in ((0, 0), (1, 0), (1, 1), (0, 1)))
                faces += [(a, b, c), (a, c, d)]
        lines = ["OFF", f"{len(points)} {len(faces)} 0", *(" ".join(map(str, p)) for p in points),
                 *("3 {} {} {}".format(*((f[0], f[2], f[1]) if inside_out else f)) for f in faces)]
        (self.dir / name).write_text("\n".join(lines) + "\n")
        return self.dir / name

    def test_a_surface_inside_out_is_meshed_as_if_it_were_not(self):
        sizes = []
        for inside_out in (False, True):
            report = self.dir / "r.json"
            self.run_cli("mesh", self.write_torus("torus.off", inside_out), "-o", self.dir / "m.vtu", "--json", report)
            sizes.append(json.loads(report.read_text())["tets"])
        self.assertEqual(*sizes)

    def test_a_sheet_is_refused_and_can_be_wrapped(self):
        sheet, out = self.dir / "sheet.off", self.dir / "skin.off"
        sheet.write_text("OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n3 0 2 3\n")
        done = self.run_cli("repair", sheet, "-o", out, status=3)
        self.assertIn("encloses nothing", done.stderr)
        self.run_cli("repair", sheet, "-o", out, "--repair", "wrap", "--wrap-distance", 0.1)
        self.assertIn("clean: 1 body", self.run_cli("check", out).stdout)

    def test_output_that_cannot_be_written_is_status_5(self):
        self.run_cli("mesh", self.part, "-o", self.dir / "absent" / "o.vtu", status=5)

    def test_meshes_are_written_in_parts(self):
        mesh = self.dir / "m.vtu"
        self.run_cli("mesh", SAMPLES / "bracket.stl", "-o", mesh, "--size", "8", "-q")
        self.run_cli("convert", mesh, "-o", self.dir / "w.vtu", "-o", self.dir / "p.pvtu", "--parts", "3", "-q")
        self.assertEqual(len(list((self.dir / "p").iterdir())), 3)
        self.assertTrue((self.dir / "w.vtu").exists())
        for wrong, words in ((["--parts", "-2"], "range"), (["--parts", "2"], "not written in parts"),
                             (["--parts", "two"], "two")):
            done = self.run_cli("convert", mesh, "-o", self.dir / "x.vtu", *wrong, status=2)
            self.assertIn(words, done.stderr)
        done = self.run_cli("convert", mesh, "-o", self.dir / "x.pvtu", "--parts", "999999", status=2)
        self.assertIn("more than the", done.stderr)
        self.assertFalse(list(self.dir.glob("x*")))

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

    def test_no_output_overwrites_an_input_or_another_output(self):
        link, hard, out = self.dir / "link.off", self.dir / "hard.off", self.dir / "o.vtu"
        link.symlink_to(self.part)
        os.link(self.part, hard)
        for target in (self.part, link, hard):
            done = self.run_cli("mesh", self.part, "-o", out, "--json", target, status=2)
            self.assertIn("overwritten", done.stderr)
            self.run_cli("surface", self.part, "-o", target, status=2)
        sizes = self.dir / "sizes.csv"
        sizes.write_text("0 0 0 1\n")
        self.run_cli("mesh", self.part, "-o", out, "--point-sizes", sizes, "--json", sizes, status=2)
        lost = self.dir / "lost"
        lost.symlink_to(out)
        self.run_cli("mesh", self.part, "-o", out, "--json", lost, status=2)
        cavity = self.dir / "o.cavity.off"
        cavity.write_text(TETRAHEDRON)
        self.run_cli("mesh", cavity, "-o", out, status=2)
        self.assertEqual(self.part.read_text(), TETRAHEDRON)
        self.assertFalse(out.exists())

    def test_json_tells_the_whole_run_also_of_failures(self):
        report = self.dir / "r.json"
        self.run_cli("mesh", self.part, "-o", self.dir / "o.vtu", "--size", 0.3, "--keep-surface", "--json", report)
        r = json.loads(report.read_text())
        self.assertEqual((r["command"], r["input"]), ("mesh", str(self.part)))
        self.assertRegex(r["version"], r"\d+\.\d+")
        self.assertEqual((r["options"]["size"], r["options"]["keep-surface"]), ("0.3", "true"))
        self.assertEqual(len(r["worst_element"]["at"]), 3)
        bad = self.dir / "bad.off"
        bad.write_text(TETRAHEDRON[:-8])
        self.run_cli("mesh", bad, "-o", self.dir / "o.vtu", "--json", report, status=3)
        r = json.loads(report.read_text())
        self.assertEqual(r["error"]["kind"], "input")
        self.assertIn("bad.off", r["error"]["message"])
        self.run_cli("mesh", self.part, "-o", self.dir / "o.vtu", "--size", -1, "--json", report, status=2)
        self.assertEqual(json.loads(report.read_text())["error"]["kind"], "usage")

    def failed_json(self, *arguments, status):
        """The JSON of a run that fails, with all that one always has."""
        done = self.run_cli(*arguments, "--json", "-", status=status)
        told = json.loads(done.stdout)
        self.assertEqual((told["program"], told["status"], told["error"]["status"]), ("octafront", status, status))
        self.assertEqual(set(told["error"]), {"status", "kind", "code", "message"})
        self.assertIn(told["error"]["message"].split("\n")[0], done.stderr)
        return told

    def test_json_answers_also_where_the_command_line_is_wrong(self):
        out = self.dir / "o.vtu"
        for code, arguments in {"unknown_option": ("mesh", self.part, "--sise", 2),
                                "unknown_command": ("mehs", self.part),
                                "usage": ("mesh", self.part, "-o", out, "--size", "much")}.items():
            told = self.failed_json(*arguments, status=2)
            self.assertEqual((told["error"]["kind"], told["error"]["code"]), ("usage", code))
            self.assertIn("octafront " + arguments[0], told["command_line"])
        for arguments in ("mesh",), ("mesh", self.part), ("mesh", self.part, "-o", ""), ("mesh", self.part, "-o", "-"), \
                ("mesh", self.part, "-o", self.part), ("mesh", self.part, "-o", out, "--size", "2mm"), ():
            self.assertEqual(self.failed_json(*arguments, status=2)["error"]["kind"], "usage")
        for command in "mesh", "check", "info", "convert", "repair", "improve", "adapt":
            told = self.failed_json(command, self.dir / "none.off", *(() if command in ("check", "info") else ("-o", self.dir / "o.ply")),
                                    status=3)
            self.assertEqual((told["command"], told["error"]["kind"]), (command, "input"))
        self.assertEqual(json.loads(self.run_cli("info", self.part, "--json", "-").stdout)["status"], 0)

    def test_json_of_a_wrong_command_line_overwrites_no_input(self):
        report = self.dir / "r.json"
        self.run_cli("mesh", self.part, "--sise", 2, "--json", report, status=2)
        self.assertEqual(json.loads(report.read_text())["error"]["code"], "unknown_option")
        self.run_cli("mesh", "--json", self.part, "--sise", 2, status=2)
        scan = self.dir / "scan.json"
        scan.write_text("{}")
        self.run_cli("mesh", scan, "--json", scan, "--sise", 2, status=2)
        self.assertEqual((self.part.read_text(), scan.read_text()), (TETRAHEDRON, "{}"))

    def test_json_of_a_refused_surface_has_its_defects(self):
        self.part.write_text(TETRAHEDRON.replace("4 4 0", "4 3 0").replace("3 0 2 1\n", ""))
        box = self.write_box("box.off", (5, 5, 5), (6, 6, 6))
        for inputs in (self.part,), (box, self.part):
            told = self.failed_json("mesh", *inputs, "-o", self.dir / "o.vtu", "--repair", "none", status=3)
            self.assertEqual((told["clean"], told["defects"]["open_edges"]["count"]), (False, 3))

    def test_json_can_go_to_standard_output_alone(self):
        done = self.run_cli("mesh", self.part, "-o", self.dir / "o.vtu", "--size", 0.3, "--json", "-")
        self.assertGreater(json.loads(done.stdout)["tets"], 0)
        self.run_cli("mesh", self.part, "-o", "-", status=2)
        self.assertEqual(self.files(), ["o.vtu", "part.off"])

    def test_check_writes_json(self):
        surface = json.loads(self.run_cli("check", self.part, "--json", "-").stdout)
        self.assertEqual((surface["kind"], surface["clean"], surface["bodies"]), ("surface", True, 1))
        self.part.write_text(TETRAHEDRON.replace("4 4 0", "4 3 0").replace("3 0 2 1\n", ""))
        surface = json.loads(self.run_cli("check", self.part, "--json", "-", status=3).stdout)
        self.assertEqual((surface["clean"], surface["defects"]["open_edges"]["count"]), (False, 3))
        self.assertEqual(surface["error"]["kind"], "input")

    def test_names_that_no_text_has_do_no_harm(self):
        evil = os.fsencode(self.dir) + b"/\x1b[31m\xff\xc2\x9b.off"
        with open(evil, "w") as file:
            file.write(TETRAHEDRON)
        done = self.run_cli("check", os.fsdecode(evil), "--json", self.dir / "r.json")
        self.assertIn("\\x1b[31m\\xff\\xc2\\x9b.off", done.stdout)
        self.assertTrue(json.loads((self.dir / "r.json").read_text())["clean"])
        self.assertNotIn("\x1b", self.run_cli("check", "\x1b[31m.stl", status=3).stderr)

    def test_names_cannot_write_lines_of_their_own(self):
        odd = self.dir / "a\noctafront: all is well\x7f\u202e.off"
        odd.write_text(TETRAHEDRON)
        for done in (self.run_cli("check", odd), self.run_cli("info", odd), self.run_cli("check", f"{odd}.stl", status=3),
                     self.run_cli("mesh", odd, "-o", self.dir / "b\nc.vtu", "--size", 0.3)):
            text = done.stdout + done.stderr
            self.assertNotRegex(text, "(?m)^octafront: all|^c.vtu|[\x7f\u202e\x1b]")
            self.assertIn("\\noctafront: all is well\\x7f", text)
        told = self.run_cli("info", odd, "--json", "-").stdout
        self.assertNotRegex(told, "[\x7f\u202e\x1b]")
        self.assertEqual(json.loads(told)["input"], str(odd))

    def test_limits_end_a_run(self):
        out = self.dir / "o.vtu"
        for arguments in ("mesh", self.part, "-o", out), ("surface", self.part, "-o", self.dir / "o.ply"), ("size", self.part):
            told = self.failed_json(*arguments, "--size", 0.01, "--max-elements", 1000, status=7)
            self.assertEqual((told["error"]["kind"], told["error"]["code"]), ("limit", "max_elements"))
            self.assertIn("--max-elements", told["error"]["message"])
        self.run_cli("mesh", self.part, "-o", out, "--size", 0.1, "--max-elements", 100_000)
        for command in ("check", out), ("convert", out, "-o", self.dir / "o.msh"), ("improve", out, "-o", self.dir / "o.msh"):
            self.assertEqual(self.failed_json(*command, "--max-elements", 10, status=7)["error"]["code"], "max_elements")
        begun = resource.getrusage(resource.RUSAGE_CHILDREN)
        told = self.failed_json("mesh", self.part, "-o", self.dir / "late.vtu", "--size", 0.004, "--cpu-seconds", 0.3, status=7)
        ended = resource.getrusage(resource.RUSAGE_CHILDREN)
        self.assertEqual(told["error"]["code"], "cpu_seconds")
        self.assertLess(ended.ru_utime + ended.ru_stime - begun.ru_utime - begun.ru_stime, 2)
        told = self.failed_json("mesh", self.part, "-o", self.dir / "late.vtu", "--size", 0.004, "--memory", "100MB", status=6)
        self.assertIn("--memory", told["error"]["message"])
        self.assertEqual(self.files(), ["o.vtu", "part.off"])
        for wrong in ("--memory", "much"), ("--memory", "1kB"), ("--memory", "-1GB"), ("--cpu-seconds", 0), ("--max-elements", 0.5), \
                ("--cpu-seconds", "nan"), ("--memory", "nanGB"), ("--max-elements", -3):
            self.run_cli("mesh", self.part, "-o", out, *wrong, status=2)

    def test_what_does_not_fit_is_refused_before_it_is_unpacked(self):
        header = struct.pack("<i36x8h12x4h8f3f", 348, 3, 1000, 1000, 1000, 1, 1, 1, 1, 0, 4, 16, 0, *[1.0] * 8, 352, 1, 0)
        packed = zlib.compressobj(wbits=31)
        bomb = self.dir / "bomb.nii.gz"
        # Nobody comes to what would have to be zeros.
        bomb.write_bytes(packed.compress(header.ljust(344, b"\0") + b"n+1\0" + b"\0" * 4096) +
                         packed.flush(zlib.Z_FULL_FLUSH) + os.urandom(2_100_000))
        for command in ("info", bomb), ("mesh", bomb, "-o", self.dir / "o.vtu"):
            told = self.failed_json(*command, "--memory", "500MB", status=6)
            self.assertEqual(told["error"]["code"], "memory_limit")
            self.assertRegex(told["error"]["message"], "1000000000 voxels would take .* 500 MB may be taken")

    def progress(self, terminal):
        """What a run writes to a terminal of that kind."""
        ours, theirs = pty.openpty()
        self.run_cli("mesh", self.part, "-o", self.dir / "o.vtu", "--size", 0.2, stderr=theirs,
                     env={**os.environ, "TERM": terminal})
        os.close(theirs)
        text = b""
        try:
            while chunk := os.read(ours, 65536):
                text += chunk
        except OSError:
            pass  # the end of a terminal
        os.close(ours)
        return text

    def test_progress_is_for_terminals_that_can_wipe_a_line(self):
        self.assertIn(b"%", self.progress("xterm"))
        self.assertEqual(self.progress("dumb"), b"")

    def test_usage_errors_help(self):
        out = self.dir / "o.vtu"
        for arguments, words in (
            (["--max-siz", 1], "did you mean --max-size?"),
            (["--size-grid", "x"], "--size-grid is called --size-field now"),
            (["--interior", "dense"], 'uniform, graded; "dense" is none of them'),
            (["--size", ""], "empty value behind --size"),
            (["--size="], "empty value behind --size="),
        ):
            done = self.run_cli("mesh", self.part, "-o", out, *arguments, status=2)
            self.assertIn(words, done.stderr)
        self.assertIn("did you mean mesh?", self.run_cli("mehs", self.part, status=2).stderr)
        self.assertIn("--output?", self.run_cli("mesh", self.part, "--ouput", out, status=2).stderr)
        for text in (self.run_cli("mesh", "--help").stdout, done.stderr):
            self.assertNotIn("{", text)

    def test_options_are_checked_before_anything_is_read(self):
        (self.dir / "unread.stl").write_text("no surface")
        for bad in (["--size", -1], ["--gradation", 7], ["--grading", 7], ["--feature-angle", 999]):
            done = self.run_cli("mesh", self.dir / "unread.stl", "-o", self.dir / "o.vtu", *bad, status=2)
            self.assertNotIn("unread", done.stderr)
            self.assertIn(bad[0].replace("grading", "gradation") + " ", done.stderr)

    def test_errors_name_the_file_at_fault(self):
        out, absent = self.dir / "o.vtu", self.dir / "absent"
        for option in ("--size-field", "--point-sizes", "--regions"):
            done = self.run_cli("mesh", self.part, "-o", out, option, absent, status=3)
            self.assertTrue(done.stderr.startswith(f"octafront: {absent}: "), done.stderr)
        self.run_cli("mesh", self.part, "-o", out, "--size", 0.3)
        bad = self.dir / "open.off"
        bad.write_text(TETRAHEDRON.replace("4 4 0", "4 3 0").replace("3 0 2 1\n", ""))
        for surface in (bad, absent):
            done = self.run_cli("improve", out, "-o", self.dir / "p.vtu", "--surface", surface, status=3)
            self.assertTrue(done.stderr.startswith(f"octafront: {surface}: "), done.stderr)

    def test_notes_name_options(self):
        done = self.run_cli("mesh", self.part, "-o", self.dir / "o.vtu", "--keep-surface", "--gap", 2)
        self.assertIn("--gap", done.stdout)
        self.assertNotIn("`", done.stdout)

    def test_full_disks_pipes_and_memories_are_told(self):
        out = self.dir / "o.vtu"
        with open("/dev/full", "w") as full:
            self.run_cli("check", self.part, status=5, stdout=full)
        limit = lambda what, size: lambda: resource.setrlimit(what, (size, size))
        self.run_cli("mesh", self.part, "-o", out, "--size", 0.1, status=5,
                     preexec_fn=limit(resource.RLIMIT_FSIZE, 1000))
        done = self.run_cli("mesh", self.part, "-o", out, "--elements", "20000000", "--threads", 1, status=6,
                            preexec_fn=limit(resource.RLIMIT_AS, 150_000_000))
        self.assertIn("out of memory", done.stderr)
        self.assertEqual(self.files(), ["part.off"])
        # A closed stream must not let an output take its number.
        self.run_cli("mesh", self.part, "-o", out, "--size", 0.3, preexec_fn=lambda: os.close(1))
        self.assertIn("a valid mesh", self.run_cli("check", out).stdout)

    def interrupted(self, *arguments, after=0.3):
        run = subprocess.Popen([OCTAFRONT, *map(str, arguments)], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                               text=True)
        time.sleep(after)
        run.send_signal(signal.SIGINT)
        start = time.monotonic()
        _, error = run.communicate(timeout=30)
        self.assertEqual(run.returncode, 130, error)
        return time.monotonic() - start

    def test_interrupts_end_the_wait_for_a_pipe(self):
        fifo = self.dir / "fifo"
        os.mkfifo(fifo)
        self.interrupted("check", fifo, after=1)  # signals count from when the program has begun
        writer = os.open(fifo, os.O_RDWR)
        os.write(writer, b"OFF\n4 4 0\n")
        self.interrupted("check", fifo, after=1)
        os.close(writer)

    def test_convert_keeps_names_and_says_what_it_cannot(self):
        bracket, mesh, report = SAMPLES / "bracket.stl", self.dir / "a.msh", self.dir / "report.json"
        done = self.run_cli("mesh", bracket, "-o", mesh, "--size", 8, "--patches", "--group",
                            "held=box:-100,-100,-1,100,100,1", "--group", "two=patches:1,2", "--group",
                            "far=sphere:1e6,0,0,1", "--json", report)
        self.assertIn('group "far": nothing lies there', done.stdout)
        self.assertIn("far", str(json.loads(report.read_text())["output"]["notes"]))
        check = lambda file: [(g["origin"], g["name"], g["size"]) for g in json.loads(
            self.run_cli("check", file, "--json", "-").stdout)["groups"]]
        groups = check(mesh)
        self.assertEqual(sorted(g[:2] for g in groups if g[0] in ("nodes", "faces")), [("faces", "two"), ("nodes", "held")])
        # Through formats that hold the same: the same groups at the end.
        file = mesh
        for ending in ("vtu", "vtk", "unv", "msh"):
            file, before = self.dir / f"b.{ending}", file
            self.assertNotIn("left out", self.run_cli("convert", before, "-o", file).stdout)
        self.assertEqual(sorted(check(file)), sorted(groups))
        done = self.run_cli("convert", mesh, "-o", self.dir / "c.mesh", "--order", 2)
        self.assertIn("MEDIT holds no further sets of nodes: left out are held", done.stdout)
        self.assertIn("tetrahedra of order 2", self.run_cli("check", self.dir / "c.mesh").stdout)
        self.run_cli("convert", mesh, "-o", self.dir / "case", "--format", "openfoam")
        self.assertTrue((self.dir / "case/owner").exists())
        self.run_cli("convert", mesh, "-o", self.dir / "old.msh", "--format", "MSH22")
        self.assertIn(b"2.2 1 8", (self.dir / "old.msh").read_bytes()[:40])
        self.assertIn("abaqus", self.run_cli("convert", mesh, "-o", self.dir / "x.msh", "--format", "abacus", status=2).stderr)
        self.run_cli("convert", mesh, "-o", self.dir, "--format", "openfoam", status=5)
        for bad in ("held", "=box:1,2,3,4,5,6", "a=box:1,2,3", "a=cone:1,2", "a=sphere:0,0,0,-1", "a=box:1,2,3,4,5,x"):
            self.run_cli("convert", mesh, "-o", self.dir / "d.msh", "--group", bad, status=2)

    def test_polyhedra(self):
        """The dual of bodies with layers and of several regions, in the formats that have it."""
        bracket, mesh = SAMPLES / "bracket.stl", self.dir / "a.vtu"
        cells = lambda folder: 1 + max(int(n) for n in re.findall(r"^\d+$", (folder / "owner").read_text().split("\n(\n")[1], re.M))
        for case in ("tets", "dual", "b", "c", "x"):
            (self.dir / case).mkdir()
        self.run_cli("mesh", bracket, "-o", mesh, "--size", 8, "--layers", 2, "--first-part", .1, "--layers-outside")
        self.run_cli("convert", mesh, "-o", self.dir / "tets/polyMesh")
        done = self.run_cli("convert", mesh, "-o", self.dir / "dual/polyMesh", "--polyhedral")
        self.assertNotIn("wedges", done.stdout)
        self.assertLess(cells(self.dir / "dual/polyMesh"), .8 * cells(self.dir / "tets/polyMesh"))
        zones = [(self.dir / f"{case}/polyMesh/cellZones").read_text() for case in ("tets", "dual")]
        names = [re.findall(r"(\S+)\n\{", zone[zone.index("(") :]) for zone in zones]
        self.assertEqual(names[0], names[1])
        self.run_cli("mesh", bracket, "-o", self.dir / "b/polyMesh", "--size", 8, "--polyhedral", "--threads", 1)
        self.run_cli("mesh", bracket, "-o", self.dir / "c/polyMesh", "--size", 8, "--polyhedral", "--threads", 2)
        for file in ("points", "faces", "owner", "neighbour", "boundary"):
            self.assertEqual(*[(self.dir / case / "polyMesh" / file).read_bytes() for case in "bc"])
        said = self.run_cli("mesh", bracket, "-o", self.dir / "x.msh", "--polyhedral", status=2).stderr
        self.assertRegex(said, r"Gmsh MSH 4.1 has no polyhedra here; --polyhedral is for vtu, openfoam")
        self.run_cli("convert", mesh, "-o", self.dir / "x/polyMesh", "--polyhedral", "--parts", 2, status=2)

    def test_places_are_named_alike_by_every_option(self):
        """Patches without names, by the names that the file written gives them."""
        bracket, out = SAMPLES / "bracket.stl", self.dir / "m.msh"
        make = ("mesh", bracket, "-o", out, "--size", 8, "--patches")
        patches = lambda: {g["name"]: g["size"] for g in json.loads(
            self.run_cli("info", out, "--json", "-").stdout)["groups"] if g["origin"] == "patch"}
        self.run_cli(*make)
        plain = patches()
        for place in ("patch_3", "3", "patches:patch_3"):
            self.run_cli(*make, "--size-of", f"{place}=4")
            self.assertGreater(patches()["patch_3"], 1.5 * plain["patch_3"], place)
            report = self.dir / "layers.json"
            self.run_cli(*make, "--layers", 1, "--first", 0.2, "--on", place, "--json", report)
            self.assertEqual([w["patch"] for w in json.loads(report.read_text())["layers"]], ["patch_3"])
            self.run_cli(*make, "--size-near", f"{place}=4:10", "--group", f"g={place}")
            self.run_cli("adapt", out, "--size", 8, "--only", place, "--keep", "patch_1", "-o", self.dir / "b.msh")
        self.run_cli(*make, "--size-of", "box:-1e3,-1e3,-1e3,1e3,1e3,1e3=6", "--size-near", "sphere:0,0,0,1=4:10")
        for option, place in (("--size-of", "lid=2"), ("--on", "lid"), ("--size-near", "lid=2:3")):
            layers = ["--layers", 1, "--first", 0.2] if option == "--on" else []
            done = self.run_cli(*make, option, place, *layers, status=2)
            self.assertIn('"lid"', done.stderr)
            self.assertIn('"patch_3"', done.stderr)
            self.assertIn(option, done.stderr)
        self.run_cli(*make, "--layers", 1, "--first", 0.2, "--layers-in", "body")

    def test_damaged_hdf5_files_do_not_end_the_program(self):
        """One in forty of such changes crashes libhdf5 1.10."""
        self.run_cli("mesh", self.part, "-o", self.dir / "m.vtu", "--size", ".2")
        made = subprocess.run([OCTAFRONT, "convert", self.dir / "m.vtu", "-o", self.dir / "m.med"], capture_output=True)
        if made.returncode == 2:
            self.skipTest("built without HDF5")
        whole = (self.dir / "m.med").read_bytes()
        random.seed(1)
        damaged = self.dir / "damaged.med"
        statuses = set()
        for _ in range(150):
            changed = bytearray(whole)
            for _ in range(random.choice((1, 2, 4))):
                changed[random.randrange(2000)] = random.choice((0, 1, 255))
            damaged.write_bytes(changed)
            statuses.add(subprocess.run([OCTAFRONT, "info", damaged], capture_output=True, timeout=60).returncode)
        self.assertEqual(statuses - {0, 3}, set())
        self.assertIn(3, statuses)

    def test_groups_outlive_improvement(self):
        mesh, better = self.dir / "a.vtu", self.dir / "b.vtu"
        self.run_cli("mesh", SAMPLES / "bracket.stl", "-o", mesh, "--size", 8, "--patches", "--improve", "none", "--group",
                     "two=patches:1,2")
        self.run_cli("improve", mesh, "-o", better)
        groups = [[g for g in json.loads(self.run_cli("check", m, "--json", "-").stdout)["groups"] if g["origin"] != "region"]
                  for m in (mesh, better)]
        self.assertEqual(groups[0], groups[1])
        self.assertIn("curve", {g["origin"] for g in groups[0]})

    def test_sets_of_elements_outlive_improvement(self):
        mesh, better = self.dir / "a.vtu", self.dir / "b.vtu"
        self.run_cli("mesh", SAMPLES / "bracket.stl", "-o", mesh, "--size", 8, "--improve", "none", "--group",
                     "some=elements:box:0,0,-100,40,60,100", "--group", "within=box:-20,-20,-100,20,20,100")
        made = self.run_cli("improve", mesh, "-o", better)
        self.assertNotIn("no longer", made.stdout + made.stderr)
        names = [sorted(g["name"] for g in json.loads(self.run_cli("check", m, "--json", "-").stdout)["groups"])
                 for m in (mesh, better)]
        self.assertEqual(names[0], names[1])
        self.assertIn("some", names[0])
        self.assertIn("within", names[0])

    def test_a_pipe_is_read_to_its_end(self):
        fifo = self.dir / "fifo"
        os.mkfifo(fifo)
        run = subprocess.Popen([OCTAFRONT, "check", fifo], stdout=subprocess.PIPE, text=True)
        with open(fifo, "w") as writer:
            writer.write(TETRAHEDRON)
            writer.flush()
            time.sleep(0.1)
            writer.write("# the end\n")
        self.assertIn("clean", run.communicate(timeout=30)[0])

    def test_method_octree_meshes_what_the_others_refuse(self):
        bad, out = self.dir / "open.off", self.dir / "open.vtu"
        bad.write_text(TETRAHEDRON.replace("4 4 0", "4 3 0").replace("3 0 2 1\n", ""))
        self.run_cli("mesh", bad, "-o", out, "--repair", "none", status=3)
        done = self.run_cli("mesh", bad, "-o", out, "--repair", "none", "--method", "octree", "--size", 0.1)
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
