"""The workbench without a program, in a browser: page_test.py OCTAFRONT_HTML OCTAFRONT SAMPLES_DIR [--times | TEST ...]

Chromium without a window, as tests/cli/ui_test.py has it; WebGL is drawn by the processor. axe-core comes from npm.
  --times      prints docs/use/web.md's table of seconds beside the program and its server, and tests nothing
"""

import json
import pathlib
import shlex
import subprocess
import sys
import tempfile
import time
import unittest
import zipfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "cli"))
try:
    from workbench import Page, Program, axe, browser, serious
except ImportError:
    print("no python3-selenium here: skipped; scripts/web.sh installs it")
    sys.exit(77)

PAGE, OCTAFRONT, SAMPLES = (pathlib.Path(argument).resolve() for argument in sys.argv[1:4])
HOSTILE = "<img src=x onerror=alert(1)>.stl"


class Alone(Page):
    """The page from the disk, and what one does with it."""

    def __init__(self, driver, size=(1280, 900)):
        driver.get_log("performance")
        super().__init__(driver, PAGE.as_uri(), size)

    def open(self, *files):
        self.js("octafront.now.info = null")
        self.driver.find_element("id", "files").send_keys("\n".join(map(str, files)))
        self.wait(lambda: self.js("return octafront.now.info !== null"))
        self.idle()

    def sample(self, title):
        self.js("[...document.querySelectorAll('#samples button')].find(b => b.textContent === arguments[0]).click()", title)
        self.wait(lambda: self.js("return octafront.now.surface !== null"))
        self.idle()

    def by(self, kind, value):
        self.choose("by", kind)
        self.put(kind, value)

    def mesh(self, seconds=300):
        """The report of the mesh, which is shown."""
        self.click("go")
        self.idle(seconds)
        assert not self.shows("trouble"), self.text("trouble")
        return self.js("return octafront.now.made.report")

    def save(self, format):
        self.js("octafront.now.saved = null")
        self.put("format", format)
        self.click("save")
        return self.wait(lambda: self.js("return octafront.now.saved?.name"))

    def requests(self):
        """Addresses asked for since it was opened, but for those inside the page."""
        messages = [json.loads(entry["message"])["message"] for entry in self.driver.get_log("performance")]
        urls = [m["params"].get("request", m["params"])["url"] for m in messages if m["method"] in ("Network.requestWillBeSent", "Network.webSocketCreated")]
        return [url for url in urls if not url.startswith(("data:", "blob:"))]

    def pick_a_face(self):
        """Of those that are seen; its name."""
        name = self.js("""const c = document.getElementById('canvas'), counts = new Map();
            for (let y = 6; y < c.clientHeight; y += 12) for (let x = 6; x < c.clientWidth; x += 12) { const p = octafront.placesAt(x, y, false)[0]; if (p) counts.set(p.name, (counts.get(p.name) ?? 0) + 1); }
            return [...counts].sort((a, b) => b[1] - a[1])[0][0]""")
        self.tap(*self.where("face", name))
        return name


def by_hand(page, *more):
    """The report of the job as the page writes it for a shell, run by the program beside the samples."""
    words = shlex.split(page.text("repeat"))
    target = words.index("-o") + 1
    run = subprocess.run([OCTAFRONT, *words[1:target], "/dev/null", "--format", "vtu", *words[target + 1:], *more, "-q", "--json", "-"], cwd=SAMPLES, check=True, capture_output=True, timeout=900)
    return json.loads(run.stdout)


class Workbench(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scratch = tempfile.TemporaryDirectory()
        cls.dir = pathlib.Path(cls.scratch.name)
        cls.driver = browser(cls.dir, logs=("browser", "performance"))

    @classmethod
    def tearDownClass(cls):
        cls.driver.quit()
        cls.scratch.cleanup()

    def tearDown(self):
        errors = [e["message"] for e in self.driver.get_log("browser") if e["level"] == "SEVERE"]
        self.assertEqual(errors, [], "no error on the console, whatever was done")

    def whole(self, name):
        file = self.dir / name
        Page.wait(self.page, lambda: file.exists() and not file.with_name(name + ".crdownload").exists() and file.stat().st_size == self.page.js("return octafront.now.saved?.bytes"))
        return file

    def test_a_job_from_a_sample_to_a_deck(self):
        for size in ((1280, 900), (390, 844)):
            with self.subTest(size=size):
                self.page = page = Alone(self.driver, size)
                page.sample("bracket")
                page.settle()
                face = page.pick_a_face()
                self.assertEqual(page.picked(), ["face:" + face])
                page.put("name", "held")
                page.click("do-name")
                page.put("local-size", "2")
                page.click("do-size")
                page.by("size", "5")
                page.wait(lambda: "elements" in page.text("estimate") and "--size-of" in page.text("estimate"), 60)
                page.click("preview")
                page.idle()
                self.assertTrue(page.js("return octafront.stage.preview !== null"))
                report = page.mesh()
                self.assertEqual(report["hash"], by_hand(page)["hash"], "the same mesh as the program's")
                page.click("next")
                self.assertIn("1 of", page.text("worst"))
                self.assertTrue(page.shows("element"))
                self.assertLessEqual(page.js("return document.documentElement.scrollWidth"), size[0])
                deck = self.whole(page.save("abaqus"))
                self.assertIn("held", deck.read_text())
                page.put("format", "msh")
                self.assertEqual(page.js("return JSON.parse(new DOMParser().parseFromString(octafront.now.made.text, 'text/html').getElementById('report').textContent).command_line"), page.text("repeat"))
                self.assertNotIn("/files-of-page/bracket", page.js("return octafront.now.made.text"))
                told = subprocess.run([OCTAFRONT, "info", deck], check=True, capture_output=True, text=True).stdout
                self.assertIn(str(report["tets"]), "".join(c for c in told if c not in ",\u202f"))
                self.assertEqual(page.requests(), [PAGE.as_uri()], "nothing is asked for but the page itself")
                deck.unlink()

    def test_forbids_requests(self):
        page = Alone(self.driver)
        refused = self.driver.execute_async_script("const done = arguments[0]; fetch('https://example.org/').then(() => done(false), () => done(true))")
        self.assertTrue(refused)
        self.driver.get_log("browser")  # where the browser says so
        self.assertEqual(page.requests(), [PAGE.as_uri()])

    def test_voxels_options_and_second_order(self):
        page = Alone(self.driver)
        page.sample("head (labels)")
        self.assertIn("regions", page.text("part"))
        page.by("size", 8)
        page.put("option-improve", "fast")
        page.put("order", "2")
        report = page.mesh()
        self.assertIn("--improve fast", page.text("repeat"))
        self.assertEqual(report["hash"], by_hand(page)["hash"])

    def test_several_files_and_no_patches(self):
        page = Alone(self.driver)
        page.open(SAMPLES / "bracket.stl")
        page.js("document.getElementById('patches').click()")
        page.by("size", 6)
        self.assertNotIn("--patches", page.text("repeat"))
        self.assertEqual(page.mesh()["hash"], by_hand(page)["hash"])
        page.open(SAMPLES / "bracket.stl", SAMPLES / "gear.obj")
        page.by("size", 6)
        self.assertEqual(page.js("return octafront.now.surface.regions.length"), 2)
        self.assertEqual(page.mesh()["hash"], by_hand(page)["hash"])

    def test_a_run_can_be_cancelled(self):
        page = Alone(self.driver)
        page.open(SAMPLES / "torus_knot.ply")
        page.by("elements", 3000000)
        page.click("go")
        page.wait(lambda: page.shows("busy") and "meshing" not in page.text("busy-text"), 60)
        begun = time.time()
        page.click("cancel")
        page.idle(5)
        self.assertLess(time.time() - begun, 5)
        self.assertFalse(page.shows("trouble"))
        page.by("elements", 5000)
        self.assertEqual(page.mesh()["hash"], by_hand(page)["hash"])

    def test_what_is_wrong_is_said(self):
        page = Alone(self.driver)
        for name, content, words in (("text.stl", b"nothing of the kind", ("text.stl",)), ("part.step", (SAMPLES / "bracket.step").read_bytes(), ("octafront ui", "STL"))):
            (self.dir / name).write_bytes(content)
            page.driver.find_element("id", "files").send_keys(str(self.dir / name))
            page.wait(lambda: page.shows("trouble"))
            for word in words:
                self.assertIn(word, page.text("trouble"))
            self.assertNotIn("/files-of-page", page.text("trouble"))
        page.open(SAMPLES / "bracket.stl")
        self.assertFalse(page.shows("trouble"))
        page.put("option-gradation", "nonsense")
        page.click("go")
        page.wait(lambda: page.shows("trouble"))
        page.by("size", -3)
        page.click("go")
        page.idle()
        self.assertIn("above 0", page.text("trouble"))

    def test_names_of_files_are_never_markup(self):
        page = Alone(self.driver)
        hostile = self.dir / HOSTILE
        hostile.write_bytes((SAMPLES / "bracket.stl").read_bytes())
        page.open(hostile)
        self.assertIn(HOSTILE, page.text("part"))
        page.by("size", 8)
        page.mesh()
        self.assertEqual(page.js("return document.querySelectorAll('img').length"), 0)

    def test_a_mesh_is_looked_at_and_saved_in_every_format(self):
        self.page = page = Alone(self.driver)
        given = self.dir / "inputs/given.msh"
        given.parent.mkdir()
        subprocess.run([OCTAFRONT, "mesh", SAMPLES / "bracket.stl", "-o", given, "--size", "8", "-q"], check=True)
        page.open(given)
        page.wait(lambda: page.shows("step-save"))
        page.click("next")
        self.assertIn("1 of", page.text("worst"))
        formats = page.js("return octafront.now.about.formats.map(f => f.name)")
        self.assertGreaterEqual(len(formats), 12)
        for format in formats:
            file = self.whole(page.save(format))
            self.assertFalse(page.shows("trouble"), (format, page.text("trouble")))
            if file.suffix == ".zip":
                self.assertIsNone(zipfile.ZipFile(file).testzip())
            file.unlink()
        page.js("octafront.now.saved = null")
        page.click("save-page")
        self.assertIn("<!DOCTYPE html>", self.whole("given.html").read_text()[:20])

    def test_axe_finds_nothing_serious(self):
        script = axe(self.dir / "axe")
        if script is None:
            self.skipTest("npm has no axe-core here")
        for size in ((1280, 900), (390, 844)):
            page = Alone(self.driver, size)
            self.assertEqual(serious(self.driver, script), [], (size, "empty"))
            page.sample("bracket")
            page.by("size", 6)
            page.wait(lambda: "elements" in page.text("estimate"))
            self.assertEqual(serious(self.driver, script), [], (size, "set up"))
            page.mesh()
            page.click("next")
            page.settle()
            self.assertEqual(serious(self.driver, script), [], (size, "looked at"))


def times():
    print("| elements | the program, one thread | the page alone | ratio | from the click to the picture, alone | by the server |")
    print("| --- | --- | --- | --- | --- | --- |")
    with tempfile.TemporaryDirectory() as scratch:
        for wanted in (10000, 100000, 1000000):
            driver, seconds, reports = browser(scratch, logs=("browser", "performance")), [], []
            for alone in (True, False):
                program = None if alone else Program(OCTAFRONT, SAMPLES / "torus_knot.ply")
                page = Alone(driver) if alone else Page(driver, program.address)
                if alone:
                    page.open(SAMPLES / "torus_knot.ply")
                page.choose("by", "elements")
                page.put("elements", wanted)
                page.wait(lambda: page.text("estimate") and not page.js("return document.getElementById('estimate').hasAttribute('aria-busy')"), 60)
                begun = time.time()
                page.click("go")
                page.idle(1500)
                seconds.append(time.time() - begun)
                reports.append(page.js("return octafront.now.made.report"))
                if alone:
                    native = by_hand(page, "--threads", "1")
                else:
                    program.end()
            driver.quit()
            assert len({report["hash"] for report in (native, *reports)}) == 1, "the same mesh"
            print(f"| {native['tets']:,} | {native['wall_seconds']:.1f} s | {reports[0]['wall_seconds']:.1f} s | {reports[0]['wall_seconds'] / native['wall_seconds']:.1f} | {seconds[0]:.1f} s | {seconds[1]:.1f} s |", flush=True)


if __name__ == "__main__":
    times() if "--times" in sys.argv else unittest.main(argv=sys.argv[:1] + sys.argv[4:])
