"""`octafront picture`: picture_test.py OCTAFRONT SAMPLES_DIR."""
import json
import pathlib
import struct
import subprocess
import sys
import tempfile
import unittest
import zlib

OCTAFRONT, SAMPLES = sys.argv[1], pathlib.Path(sys.argv[2])


def read_png(data):
    """Width, height and rows of bytes r, g, b."""
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    at, body = 8, b""
    while at < len(data):
        length, name = struct.unpack(">I4s", data[at:at + 8])
        content = data[at + 8:at + 8 + length]
        assert struct.unpack(">I", data[at + 8 + length:at + 12 + length])[0] == zlib.crc32(name + content)
        if name == b"IHDR":
            width, height = struct.unpack(">II", content[:8])
        if name == b"IDAT":
            body += content
        at += 12 + length
    body, rows, above = zlib.decompress(body), [], bytes(3 * width)
    for y in range(height):
        kind, line = body[y * (3 * width + 1)], bytearray(body[y * (3 * width + 1) + 1:(y + 1) * (3 * width + 1)])
        for i in range(len(line)):
            line[i] = (line[i] + (0 if kind == 0 else line[i - 3] * (i >= 3) if kind == 1 else above[i])) & 255
        rows.append(bytes(line))
        above = rows[-1]
    return width, height, rows


def colours(rows):
    return {row[i:i + 3] for row in rows for i in range(0, len(row), 3)}


class Pictures(unittest.TestCase):
    def setUp(self):
        self.scratch = tempfile.TemporaryDirectory()
        self.dir = pathlib.Path(self.scratch.name)

    def tearDown(self):
        self.scratch.cleanup()

    def run_cli(self, *arguments, status=0):
        done = subprocess.run([OCTAFRONT, *map(str, arguments)], capture_output=True, timeout=120)
        self.assertEqual(done.returncode, status, done.stdout + done.stderr)
        return done

    def picture(self, *arguments):
        file = self.dir / "p.png"
        self.run_cli("picture", *arguments, "-o", file, "--size", "320x240", "-q")
        return read_png(file.read_bytes())

    def test_of_surfaces_meshes_images_and_formulas(self):
        mesh, flat = self.dir / "m.vtu", self.dir / "flat.msh"
        self.run_cli("mesh", SAMPLES / "bracket.stl", "-o", mesh, "--size", 6, "-q")
        self.run_cli("mesh", SAMPLES / "bracket.stl", "-o", flat, "--size", 6, "--order", 2, "--patches", "-q")
        for arguments in ((SAMPLES / "bracket.stl",), (mesh,), (flat, "--color", "patch", "--names"), (mesh, "--cut", "x=40%"), (mesh, "--worst"),
                          (mesh, "--color", "size"), (SAMPLES / "head_labels.nii.gz", "--cut", "y"), ("gyroid(x,y,z) - 0.3", "--view", "1,2,3"),
                          (SAMPLES / "bracket.stl", SAMPLES / "gear.obj"), (flat, "--highlight", "patch_2", "--highlight", "box:0,0,0,9,9,9")):
            width, height, rows = self.picture(*arguments)
            self.assertEqual((width, height), (320, 240))
            self.assertGreater(len(colours(rows)), 30, arguments)
            self.assertEqual(rows[0][:3], b"\xff\xff\xff")

    def test_is_the_same_again_and_on_any_number_of_threads(self):
        mesh = self.dir / "m.vtu"
        self.run_cli("mesh", SAMPLES / "gear.obj", "-o", mesh, "-q")
        made = set()
        for threads in (1, 2, 2):
            self.run_cli("picture", mesh, "-o", self.dir / "p.png", "--cut", "z", "--threads", threads, "-q")
            made.add((self.dir / "p.png").read_bytes())
        self.assertEqual(len(made), 1)
        self.assertIn(self.run_cli("picture", mesh, "-o", "-", "--cut", "z").stdout, made)

    def test_a_broken_surface_is_shown_as_it_is(self):
        holed = self.dir / "holed.stl"
        facet = "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex {} 0 0\nvertex 0 1 0\nendloop\nendfacet\n"
        holed.write_text("solid o\n" + facet.format(1) + facet.format(-1) + "endsolid\n")
        self.assertGreater(len(colours(self.picture(holed, "--view", "top")[2])), 20)

    def test_says_what_is_not_in_it(self):
        done = json.loads(self.run_cli("picture", SAMPLES / "bracket.stl", "-o", self.dir / "p.png", "--names", "--json", "-").stdout)
        self.assertEqual(done["picture"]["width"], 1200)
        self.assertEqual(done["picture"]["file"], str(self.dir / "p.png"))

    def test_refuses_what_cannot_be(self):
        bracket, out = SAMPLES / "bracket.stl", self.dir / "p.png"
        for arguments, status, words in (((bracket, "-o", self.dir / "p.jpg"), 2, "PNG"), ((bracket, "-o", out, "--cut", "w"), 2, "no cut"),
                                         ((bracket, "-o", out, "--view", "0,0,0"), 2, "no view"), ((bracket, "-o", out, "--size", "10x10"), 2, "64 to 8192"),
                                         ((bracket, "-o", out, "--size", "wide"), 2, "1200x900"), ((bracket, "-o", out, "--worst"), 2, "tetrahedra"),
                                         ((bracket, "-o", out, "--highlight", "lid"), 2, "lid"), ((bracket, "-o", out, "--color", "red"), 2, "quality"),
                                         ((self.dir / "none.stl", "-o", out), 3, "no such file"), ((bracket, "-o", self.dir / "no/p.png"), 5, "folder"),
                                         ((bracket,), 2, "--output")):
            self.assertIn(words, self.run_cli("picture", *arguments, status=status).stderr.decode(), arguments)
            self.assertFalse(out.exists())


unittest.main(argv=sys.argv[:1])
