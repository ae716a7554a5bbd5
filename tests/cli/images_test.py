"""Images on the command line: images_test.py OCTAFRONT SAMPLES_DIR."""
import gzip
import json
import pathlib
import re
import struct
import subprocess
import sys
import tempfile
import unittest

OCTAFRONT, SAMPLES = sys.argv[1], pathlib.Path(sys.argv[2])
LABELS, CT, NAMES = SAMPLES / "head_labels.nii.gz", SAMPLES / "head_ct.nii.gz", SAMPLES / "head_labels.txt"


def nifti(size, values, code=2, pack="B", spacing=(1, 1, 1)):
    """NIfTI-1 with an sform, of values along i, then j, then k."""
    header = bytearray(352)
    struct.pack_into("<i", header, 0, 348)
    struct.pack_into("<8h", header, 40, 3, *size, 1, 1, 1, 1)
    struct.pack_into("<hh", header, 70, code, 0)
    struct.pack_into("<8f", header, 76, 1, *spacing, 1, 1, 1, 1)
    struct.pack_into("<f", header, 108, 352)
    header[123] = 2
    struct.pack_into("<h", header, 254, 1)
    for row in range(3):
        struct.pack_into("<4f", header, 280 + 16 * row, *(spacing[row] if a == row else 0 for a in range(3)), 0)
    header[344:348] = b"n+1\0"
    return bytes(header) + struct.pack(f"<{len(values)}{pack}", *values)


def boxes(size, *filled):
    """Values of boxes (label, lo, hi behind it), 0 elsewhere."""
    def value(p):
        inside = [label for label, lo, hi in filled if all(a <= x < b for x, a, b in zip(p, lo, hi))]
        return inside[-1] if inside else 0
    return [value((i, j, k)) for k in range(size[2]) for j in range(size[1]) for i in range(size[0])]


class Images(unittest.TestCase):
    def setUp(self):
        self.scratch = tempfile.TemporaryDirectory()
        self.dir = pathlib.Path(self.scratch.name)

    def tearDown(self):
        self.scratch.cleanup()

    def run_cli(self, *arguments, status=0):
        done = subprocess.run([OCTAFRONT, *map(str, arguments)], capture_output=True, text=True, timeout=300)
        self.assertEqual(done.returncode, status, f"{done.stdout}{done.stderr}")
        return done

    def volumes(self, *arguments):
        report = self.dir / "regions.json"
        self.run_cli("check", *arguments, "--json", report)
        return {r["name"]: r["volume"] for r in json.loads(report.read_text())["input_regions"]}

    def info(self, *arguments):
        return json.loads(self.run_cli("info", *arguments, "--json", "-").stdout)

    def write(self, name, data):
        (self.dir / name).write_bytes(data)
        return self.dir / name

    def two_boxes(self, name="boxes.nii.gz"):
        size = (14, 12, 10)
        return self.write(name, gzip.compress(nifti(size, boxes(size, (3, (2, 2, 2), (10, 10, 8)), (7, (6, 2, 2), (10, 10, 8))))))

    def test_labels_become_regions_with_names_and_volumes(self):
        named = self.volumes(LABELS, "--labels", NAMES)
        self.assertEqual(list(named), ["brain", "csf", "skull", "skin", "lesion"])
        voxels = {entry["value"]: entry["voxels"] for entry in self.info(LABELS)["labels"]}
        for value, (name, volume) in zip((2, 3, 4, 5, 11), named.items()):
            self.assertAlmostEqual(volume / (64 * voxels[value]), 1, 2, name)
        self.assertEqual(list(self.volumes(self.two_boxes())), ["label 3", "label 7"])

    def test_names_of_labels_in_latin_1(self):
        names = self.write("names.txt", b"3 K\xf6rper\n7 Herz\n")
        report = self.dir / "r.json"
        said = self.run_cli("mesh", self.two_boxes(), "--labels", names, "--size", 4, "-o", self.dir / "l.vtu", "--json", report)
        self.assertIn("taken as Latin-1: \"K\u00f6rper\"", said.stdout)
        self.assertEqual([r["name"] for r in json.loads(report.read_text())["regions"]], ["K\u00f6rper", "Herz"])

    def test_a_mesh_of_labels_from_end_to_end(self):
        out, report = self.dir / "out.msh", self.dir / "r.json"
        self.run_cli("mesh", LABELS, "--labels", NAMES, "-o", out, "--json", report, "--improve", "fast")
        found = json.loads(report.read_text())
        self.assertGreater(found["quality"]["beta_min"], 0.1)
        self.assertEqual(len(found["regions"]), 5)
        self.run_cli("check", out)

    def test_labels_that_touch_themselves_everywhere_become_a_mesh(self):
        # Noise at the scale of voxels: surfaces that touch in lone edges and points, layers of one voxel, labels of one.
        size, state = (12, 12, 12), 7
        values = []
        for _ in range(size[0] * size[1] * size[2]):
            state = state * 1103515245 + 12345 & 0x7fffffff
            values.append((state >> 16) % 3)
        values[0] = 9
        image = self.write("noise.nii", nifti(size, values))
        out, report = self.dir / "noise.msh", self.dir / "noise.json"
        self.run_cli("mesh", image, "--size", "1.5", "-o", out, "--json", report, "--improve", "fast")
        found = json.loads(report.read_text())
        self.assertEqual([r["name"] for r in found["regions"]], ["label 1", "label 2", "label 9"])
        for region, before in zip(found["regions"][:2], found["input_regions"]):
            self.assertAlmostEqual(region["volume"] / before["volume"], 1, delta=0.05)
        self.run_cli("check", out)

    def test_regions_keep_their_volumes_at_any_size(self):
        # A ball in a ball, elements of a third of the inner radius: chords alone would cut off several percent.
        n, values = 28, []
        for k in range(n):
            for j in range(n):
                for i in range(n):
                    r = sum((x - 13.5) ** 2 for x in (i, j, k)) ** 0.5
                    values.append(2 if r < 7 else 1 if r < 12 else 0)
        image, report = self.write("balls.nii", nifti((n, n, n), values)), self.dir / "balls.json"
        self.run_cli("mesh", image, "--size", "2.5", "--curvature", "3", "-o", self.dir / "balls.msh", "--json", report)
        found = json.loads(report.read_text())
        for label, region in zip((1, 2), found["regions"]):
            self.assertAlmostEqual(region["volume"] / values.count(label), 1, delta=0.01, msg=region["name"])

    def test_pieces_of_one_label_are_one_region(self):
        two = (5, (1, 1, 1), (4, 4, 4))
        pieces = {
            "apart": boxes((10, 10, 10), two, (5, (6, 6, 6), (9, 9, 9))),
            "corner": boxes((10, 10, 10), two, (5, (4, 4, 4), (7, 7, 7))),
            "diagonal": boxes((10, 10, 10), *((5, (i, i, i), (i + 1, i + 1, i + 1)) for i in range(2, 7))),
        }
        for name, values in pieces.items():
            image = self.write(f"{name}.nii", nifti((10, 10, 10), values))
            for ending in ("vtu", "msh", "inp", "med"):
                out = self.dir / f"{name}.{ending}"
                made = self.run_cli("mesh", image, "--size", "1", "-o", out, "--improve", "fast")
                if ending == "vtu":
                    self.assertRegex(made.stdout, "[25] bodies")
                groups = [g["name"] for g in self.info(out)["groups"] if g["origin"] == "region"]
                self.assertEqual(groups, ["label 5"], f"{name}.{ending}")

    def test_small_labels_keep_the_volume_of_their_voxels(self):
        for shape in ((1, 1, 1), (2, 1, 1), (3, 1, 1), (4, 1, 1), (2, 2, 1), (5, 1, 1)):
            small = (1, (4, 4, 4), tuple(4 + n for n in shape))
            voxels = shape[0] * shape[1] * shape[2]
            for inside in (False, True):
                around = [(2, (1, 1, 1), (10, 10, 10))] if inside else []
                image = self.write("small.nii", nifti((11, 11, 11), boxes((11, 11, 11), *around, small)))
                self.assertAlmostEqual(self.volumes(image)["label 1"] / voxels, 1, delta=0.1, msg=f"{shape} {inside}")

    def test_volumes_that_are_lost_are_named_with_their_voxels(self):
        inside = range(1, 7)
        values = [1 + (i + j + k) % 2 if i in inside and j in inside and k in inside else 0
                  for k in range(8) for j in range(8) for i in range(8)]
        said = self.run_cli("check", self.write("checkerboard.nii", nifti((8, 8, 8), values))).stdout
        self.assertRegex(said, r'volume of 2 regions differs .* "label 1" \(108 voxels, 108; made [0-9.]+\)')

    def test_images_too_far_away_for_their_voxels_are_refused(self):
        for origin, status in (("0,1e17,0", 3), ("1e12,0,0", 0)):
            header = ("NRRD0004\ntype: uint8\ndimension: 3\nspace: right-anterior-superior\nsizes: 6 6 6\n"
                      f"space directions: (1,0,0) (0,1,0) (0,0,1)\nspace origin: ({origin})\nencoding: raw\n\n")
            image = self.write("far.nrrd", header.encode() + bytes(boxes((6, 6, 6), (1, (1, 1, 1), (5, 5, 5)))))
            for options in ((), ("--iso", "0.5")):
                said = self.run_cli("check", image, *options, status=status)
                self.assertEqual("double precision" in said.stderr, status != 0)

    def test_regions_carry_the_numbers_of_their_labels(self):
        image, out = self.two_boxes(), self.dir / "numbers"
        self.run_cli("mesh", image, "--size", "2", "-o", f"{out}.vtk", "--improve", "fast")
        self.assertIn(b"label", pathlib.Path(f"{out}.vtk").read_bytes())
        self.run_cli("mesh", image, "--size", "2", "-o", f"{out}.mesh", "--improve", "fast")
        tets = pathlib.Path(f"{out}.mesh").read_text().split("Tetrahedra\n")[1].split("\n")[1:]
        references = {line.split()[4] for line in tets if len(line.split()) == 5}
        self.assertEqual(references, {"3", "7"})

    def test_large_numbers_are_labels_and_negative_spacing_is_said(self):
        size = (6, 6, 6)
        values = boxes(size, (4000000000, (1, 1, 1), (5, 5, 5)))
        image = self.write("large.nii", nifti(size, values, code=768, pack="I"))
        self.assertEqual(list(self.volumes(image)), ["label 4000000000"])
        data = bytearray(nifti(size, boxes(size, (1, (1, 1, 1), (5, 5, 5))), spacing=(1, -1, 1)))
        struct.pack_into("<h", data, 254, 0)
        self.assertRegex(self.run_cli("check", self.write("negative.nii", bytes(data))).stdout, "axis 1 is -1, below 0")

    def test_ignored_and_merged_labels(self):
        image = self.two_boxes()
        self.assertEqual(list(self.volumes(image, "--ignore", "0,7")), ["label 3"])
        self.assertEqual(list(self.volumes(image, "--ignore", "none")), ["label 0", "label 3", "label 7"])
        both = self.volumes(image, "--merge", "3,7=both")
        self.assertAlmostEqual(both["both"] / (8 * 8 * 6), 1, 3)
        for bad in ("3,4", "=x", "3,x=y"):
            self.run_cli("check", image, "--merge", bad, status=2)
        self.assertIn("merged and ignored", self.run_cli("check", image, "--merge", "3,7=b", "--ignore", "7", status=2)
                      .stderr.replace("ignored and merged", "merged and ignored"))
        self.assertIn("no region", self.run_cli("check", image, "--ignore", "0,3,7", status=3).stderr)

    def test_grey_values_need_bands_and_bands_share_surfaces(self):
        message = self.run_cli("check", CT, status=3).stderr
        for part in ("grey", "--iso", "--band", "octafront info"):
            self.assertIn(part, message)
        alone, both = self.volumes(CT, "--iso", 400), self.volumes(CT, "--band", "soft=-300:400", "--band", "bone=400:")
        self.assertEqual(list(both), ["soft", "bone"])
        self.assertAlmostEqual(alone["body"] / both["bone"], 1, 9)
        for bad in ("400", "x:y", "5:3", "=1:2", ":"):
            self.run_cli("check", CT, "--band", bad, status=2)
        self.assertEqual(self.run_cli("check", CT, "--band", "a=0:400", "--band", "b=300:", status=3).stdout.count("region"), 0)
        self.run_cli("check", CT, "--iso", 400, "--merge", "1,2=x", status=2)
        self.run_cli("check", LABELS, "--image", "labels", "--iso", 1, status=2)
        self.assertEqual(list(self.volumes(LABELS, "--image", "grey", "--iso", "3.5")), ["body"])

    def test_what_reaches_the_edge_is_said_or_refused(self):
        self.assertIn('closed flat at the edge of the image: "label 5" (first k)', self.run_cli("check", LABELS).stdout)
        message = self.run_cli("check", LABELS, "--closed-at-box=no", status=3).stderr
        self.assertIn("label 5", message)
        self.run_cli("check", self.two_boxes(), "--closed-at-box=no")
        self.run_cli("check", LABELS, "--closed-at-box")

    def test_grey_values_become_fields_and_materials(self):
        size = (14, 12, 10)
        ct = self.write("ct.nii", nifti(size, [100 + 10 * (n % 14) for n in range(14 * 12 * 10)], 4, "h"))
        mesh, deck, report = self.dir / "m.vtu", self.dir / "m.inp", self.dir / "m.json"
        law = ("--sample", f"{ct}=HU", "--field", "E = 3 * HU", "--material-bins", 4)
        done = self.run_cli("mesh", self.two_boxes(), "-o", mesh, "-o", deck, "--size", 2, "--json", report, *law)
        self.assertIn("mean E", done.stdout)
        bins = json.loads(report.read_text())["material_bins"]
        self.assertEqual([b["set"] for b in bins], ["E_1", "E_2", "E_3", "E_4"])
        self.assertAlmostEqual(sum(b["volume"] for b in bins), 8 * 8 * 6, 0)
        for b in bins:
            self.assertTrue(b["least"] <= b["mean"] <= b["most"])
            self.assertIn(f"*SOLID SECTION, ELSET={b['set']}, MATERIAL={b['set']}", deck.read_text())
        # Between the middles of voxels 2 and 9, faces half a voxel beyond.
        self.assertTrue(3 * 110 <= bins[0]["least"] and bins[-1]["most"] <= 3 * 200, bins)
        self.assertIn("metric", self.run_cli("adapt", mesh, "-o", self.dir / "a.vtu", "--from", "HU", "--elements", 500).stdout)
        self.run_cli("mesh", self.two_boxes(), "-o", deck, "--material-bins", 4, status=2)
        self.run_cli("mesh", self.two_boxes(), "-o", deck, "--sample", f"{ct}=HU", "--field", "E=rho", status=2)
        self.run_cli("mesh", self.two_boxes(), "-o", deck, "--sample", f"{mesh}=HU", status=3)

    def test_a_cut_is_a_patch_and_groups_name_it(self):
        mesh = self.dir / "cut.vtu"
        half = ("--crop", "0:5,:,:", "--size", 2)
        self.run_cli("mesh", self.two_boxes(), "-o", mesh, *half, "--group", "FIX=patches:box_i1")
        patches = {p["name"] for p in self.info(mesh)["patches"]} if "patches" in self.info(mesh) else set()
        self.assertIn("box_i1", str(self.info(mesh)), patches)
        self.assertIn("FIX", str(self.info(mesh)))
        message = self.run_cli("mesh", self.two_boxes(), "-o", self.dir / "no.vtu", *half, "--group", "FIX=patches:nosuch", status=2)
        self.assertIn("box_i1", message.stderr)
        self.assertFalse((self.dir / "no.vtu").exists())
        self.run_cli("convert", mesh, "-o", self.dir / "no.vtu", "--group", "FIX=patches:nosuch", status=2)

    def test_electrodes_are_discs_on_the_skin(self):
        size = (30, 30, 20)
        image = self.write("plate.nii", nifti(size, boxes(size, (5, (2, 2, 2), (28, 28, 10)))))
        made = self.volumes(image, "--electrode", "15,15,20:6:3", "--electrode", "3,15,6:3:2")
        self.assertEqual(list(made), ["label 5", "electrode 1", "electrode 2"])
        self.assertAlmostEqual(made["electrode 1"] / (3.1416 * 36 * 3), 1, 1)
        self.assertIn("electrode 1: ", self.run_cli("check", image, "--electrode", "15,15,20:6:3", "--electrode", "3,15,6:3:2").stdout)
        self.assertEqual(list(self.volumes(image, "--electrode", "15,15,9:6:3")), ["label 5", "electrode"])
        for bad in ("1,2:3:4", "1,2,3:4", "1,2,3:0:4", "1,2,3:x:4"):
            self.run_cli("check", image, "--electrode", bad, status=2)
        self.run_cli("check", CT, "--band", "100:", "--electrode", "0,0,0:5:5", status=2)

    def test_electrodes_say_what_they_got_and_where_they_stand(self):
        size = (30, 30, 20)
        image = self.write("plate.nii", nifti(size, boxes(size, (5, (2, 2, 2), (28, 28, 10)))))

        def said(*electrodes, status=0):
            done = self.run_cli("check", image, *(word for e in electrodes for word in ("--electrode", e)), status=status)
            return done.stderr if status else done.stdout

        def voxels(text, name):
            return int(re.search(name + r": (\d+) voxels on the skin", text)[1])

        alone = voxels(said("15,15,10:6:2"), "electrode")
        gel = said("15,15,10:6:2", "15,15,10:6:4")
        self.assertEqual(voxels(gel, "electrode 1"), alone)
        self.assertGreater(voxels(gel, "electrode 2"), 0)
        self.assertIn(f"of its disc electrode 1 has {alone}", gel)
        none = said("15,15,10:6:2", "15,15,10:6:2", status=2)
        self.assertIn(f"electrode 2 at (15, 15, 10) gets no voxel, for of its disc electrode 1 has {alone}, all of it", none)
        self.assertNotIn("from (", said("15,15,11:6:2"))
        self.assertIn("on the skin at (15, 15, 9), 6 from (15, 15, 15)", said("15,15,15:6:2"))
        far = said("15,15,23:6:2", status=2)
        for part in ("(15, 15, 23) is 14 from the skin", "nearest at (15, 15, 9)", "RAS or LPS"):
            self.assertIn(part, far)

    def test_surfaces_of_labels_go_before_voxels(self):
        n, values = 20, []
        for k in range(n):
            for j in range(n):
                for i in range(n):
                    values.append(7 if sum((x - 9.5) ** 2 for x in (i, j, k)) < 36 else 0)
        image, ball = self.write("ball.nii", nifti((n, n, n), values)), self.dir / "ball.stl"
        self.run_cli("surface", "(x-9.5)^2 + (y-9.5)^2 + (z-9.5)^2 < 49", "--box", "0,0,0,19,19,19", "--size", "1", "-o", ball)
        made = self.volumes(image, "--surface-of", f"7={ball}")
        self.assertAlmostEqual(made["label 7"] / (4 / 3 * 3.1416 * 343), 1, delta=.02)
        said = self.run_cli("check", image, "--surface-of", f"label 7={ball}").stdout
        self.assertRegex(said, r'"label 7" follows .*ball.stl: \d+ voxels get')
        self.assertIn("does not have", self.run_cli("check", image, "--surface-of", f"8={ball}", status=2).stderr)
        for bad in ("ball.stl", "=ball.stl", "7="):
            self.run_cli("check", image, "--surface-of", bad, status=2)
        self.run_cli("check", image, "--surface-of", f"7={self.dir}/none.stl", status=3)
        self.run_cli("check", ball, "--surface-of", f"7={ball}", status=2)
        self.run_cli("mesh", image, "--surface-of", f"7={ball}", "--periodic", "xyz", "-o", self.dir / "x.vtu", status=2)

    def test_cropping_and_resampling(self):
        image = self.two_boxes()
        cropped = self.volumes(image, "--crop", "0:5,:,:")
        self.assertEqual(list(cropped), ["label 3"])
        self.assertAlmostEqual(cropped["label 3"] / (4 * 8 * 6), 1, 3)
        for bad in ("0:5", "0:5,:", "0:14,:,:", "5:3,:,:", "a:b,:,:"):
            self.run_cli("check", image, "--crop", bad, status=2)
        done = self.run_cli("info", image)
        self.assertIn("14 x 12 x 10 voxels of 1 x 1 x 1", done.stdout)
        self.assertIn("taken: 7 x 6 x 5 voxels of 2 x 2 x 2", self.run_cli("check", image, "--resample", 2).stdout)
        self.assertIn("taken: 7 x 12 x 20", self.run_cli("check", image, "--resample", "2,1,.5").stdout)
        for bad in ("0", "1,2", "x", "-1"):
            self.run_cli("check", image, "--resample", bad, status=2)

    def test_cleaning_is_said(self):
        size = (14, 12, 10)
        values = boxes(size, (1, (2, 2, 2), (12, 10, 8)), (0, (5, 5, 5), (6, 6, 6)), (1, (1, 1, 1), (2, 2, 2)))
        image = self.write("spots.nii", nifti(size, values, spacing=(2, 1, 1)))
        done = self.run_cli("check", image, "--islands", 3, "--holes", 3)
        self.assertIn('islands below 3: "label 1" 1 (1 voxel)', done.stdout)
        self.assertIn("holes below 3: 1 filled (1 voxel)", done.stdout)
        self.assertAlmostEqual(self.volumes(image, "--islands", 3, "--holes", 3)["label 1"] / (2 * 10 * 8 * 6), 1, 3)
        # Grey values follow: the surface of the cleaned image is nearly that of an image without the spots.
        grey = self.write("grey.nii", nifti(size, [100 * v for v in values], 4, "h", (2, 1, 1)))
        bands = ("--image", "grey", "--band", "a=50:")
        clean = self.volumes(grey, *bands, "--islands", 3, "--holes", 3)["a"]
        plain = self.write("plain.nii", nifti(size, [100 * v for v in boxes(size, (1, (2, 2, 2), (12, 10, 8)))], 4, "h", (2, 1, 1)))
        self.assertAlmostEqual(clean / self.volumes(plain, *bands)["a"], 1, 4)

    def test_specks_below_an_element_go_or_are_meshed_soundly(self):
        size = (24, 24, 24)
        image = self.write("specks.nii", nifti(size, boxes(size, (1, (2, 2, 2), (22, 22, 16)), (2, (9, 9, 9), (11, 12, 10)), (2, (3, 3, 17), (21, 21, 22)))))
        mesh, report = self.dir / "specks.vtu", self.dir / "specks.json"
        def run(*options):
            done = self.run_cli("mesh", image, "--size", 4, "-o", mesh, "--json", report, *options)
            return done.stdout + done.stderr, json.loads(report.read_text())
        said, clean = run()
        self.assertIn('of "label 2" 1 (6 voxels)', said)
        said, kept = run("--specks", 0)
        self.assertNotIn("specks below", said)
        for made in (clean, kept):
            self.assertGreater(made["quality"]["dihedral_min_degrees"], 5)
        volume = {region["name"]: region["volume"] for region in kept["regions"]}
        self.assertAlmostEqual(volume["label 2"] / (6 + 18 * 18 * 5), 1, 2)
        # What is more than 1 % of its label is no speck.
        few = self.write("few.nii", nifti(size, boxes(size, (1, (2, 2, 2), (22, 22, 16)), (2, (9, 9, 9), (11, 12, 10)), (2, (3, 3, 17), (9, 9, 20)))))
        self.assertNotIn("specks below", self.run_cli("mesh", few, "--size", 4, "-o", mesh).stdout)

    def test_content_tells_what_a_file_is(self):
        data = self.two_boxes().read_bytes()
        for name in ("boxes", "boxes.dat", "boxes.stl"):
            self.assertEqual(self.info(self.write(name, data))["format"], "NIfTI-1, compressed, placed by its sform")
        message = self.run_cli("check", self.write("cut.nii.gz", data[:-40]), status=3).stderr
        self.assertIn("cut.nii.gz", message)
        self.assertIn("--series is for images", self.run_cli("check", SAMPLES / "gear.obj", "--series", 1, status=2).stderr)
        self.assertIn("is no mask", self.run_cli("info", self.dir, status=3).stderr)

    def test_info_describes_the_grid(self):
        found = self.info(LABELS)
        self.assertEqual((found["size"], found["frame"], found["unit"]), ([44, 56, 46], "RAS", "mm"))
        self.assertEqual(found["axes"], [[4, 0, 0], [0, 4, 0], [0, 0, 4]])
        self.assertEqual(found["box"], [[-88, -112, -92], [88, 112, 92]])
        grey = self.info(CT)
        self.assertEqual(sum(grey["histogram"]), 44 * 56 * 46)
        self.assertIn("to the right", self.run_cli("info", LABELS).stdout)

    def test_lengths_with_units_know_the_image(self):
        self.run_cli("mesh", LABELS, "--dry-run", "--size", "1.2cm")
        unknown = self.write("a.nrrd", b"NRRD0004\ntype: uchar\ndimension: 3\nsizes: 2 2 2\nencoding: raw\n\n" + b"\1" * 8)
        self.assertIn("--unit", self.run_cli("mesh", unknown, "--dry-run", "--size", "1cm", status=2).stderr)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
