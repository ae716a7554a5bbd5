"""The page that makes meshes, in a browser: page_test.py OCTAFRONT_HTML OCTAFRONT SAMPLES_DIR [--pictures | --times]

Chromium without a window, as tests/report/page/browser_test.py has it; WebGL is drawn by the processor.
  --pictures   writes the picture of docs/use/web.md, and one of a phone beside the page, and tests nothing
  --times      prints docs/use/web.md's table of times and memory beside the native program, and tests nothing
"""

import json
import pathlib
import subprocess
import sys
import tempfile
import time
import unittest

try:
    from selenium import webdriver
    from selenium.webdriver.chrome.options import Options
    from selenium.webdriver.chrome.service import Service
    from selenium.webdriver.common.by import By
except ImportError:
    print("no python3-selenium here: skipped; scripts/web.sh installs it")
    sys.exit(77)

PAGE, OCTAFRONT, SAMPLES = pathlib.Path(sys.argv[1]).resolve(), sys.argv[2], pathlib.Path(sys.argv[3]).resolve()
HOSTILE = "<img src=x onerror=alert(1)>.stl"


def browser(downloads, width=1280, height=800):
    options = Options()
    options.binary_location = "/usr/bin/chromium"
    # Root may not use the sandbox, and containers have little shared memory.
    for argument in ("--headless=new", "--no-sandbox", "--disable-dev-shm-usage", "--use-angle=swiftshader",
                     "--enable-unsafe-swiftshader", "--hide-scrollbars", f"--window-size={width},{height}"):
        options.add_argument(argument)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
    options.add_experimental_option("prefs", {"download.default_directory": str(downloads)})
    driver = webdriver.Chrome(service=Service("/usr/bin/chromedriver"), options=options)
    driver.set_script_timeout(600)
    return driver


class Page:
    """The page, opened, and what one does with it."""

    def __init__(self, driver, size=None):
        self.driver = driver
        if size:  # windows have a least width: a phone is pretended
            driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride",
                                   {"width": size[0], "height": size[1], "deviceScaleFactor": 1, "mobile": False})
        driver.get_log("browser"), driver.get_log("performance")
        driver.get(PAGE.as_uri())
        self.wait(lambda: self.js("return performance.getEntriesByName('ready').length"), 60)

    def wait(self, condition, seconds=60):
        end = time.time() + seconds
        while time.time() < end:
            if (value := condition()):
                return value
            time.sleep(0.05)
        raise AssertionError("waited in vain; the page says: " + self.text("trouble"))

    def js(self, script, *arguments):
        return self.driver.execute_script(script, *arguments)

    def text(self, name):
        return self.js("return document.getElementById(arguments[0]).textContent", name)

    def shows(self, name):
        return self.js("const e = document.getElementById(arguments[0]); return e.getClientRects().length > 0", name)

    def click(self, name):
        self.driver.find_element(By.ID, name).click()

    def put(self, name, value):
        """Into a field, as typing does."""
        self.js("""const e = document.getElementById(arguments[0]);
            if (e.type === 'checkbox') e.checked = arguments[1]; else e.value = arguments[1];
            e.dispatchEvent(new Event('input', {bubbles: true})); e.dispatchEvent(new Event('change', {bubbles: true}));""", name, value)

    def by(self, kind, value):
        self.js("document.querySelector(`[name=by][value=${arguments[0]}]`).click()", kind)
        self.put(kind, value)

    def choose(self, *files):
        self.driver.find_element(By.ID, "files").send_keys("\n".join(str(f) for f in files))

    def idle(self, seconds=60):
        self.wait(lambda: self.js("return octafront.now.work === null"), seconds)

    def open(self, *files):
        self.js("window.before = octafront.now.part")
        self.choose(*files)
        self.wait(lambda: self.js("return octafront.now.part !== window.before && octafront.now.work === null"))
        self.wait(lambda: self.shows("step-mesh"))

    def mesh(self, seconds=120):
        self.js("performance.clearMeasures('mesh shown')")
        self.click("go")
        self.wait(lambda: self.js("return performance.getEntriesByName('mesh shown').length"), seconds)
        self.idle()
        return self.js("return octafront.now.mesh.report")

    def in_report(self, script):
        """In the frame with the report page, once that has drawn its mesh."""
        self.driver.switch_to.frame("report")
        try:
            self.wait(lambda: self.js("return performance.getEntriesByName('first picture').length"), 60)
            return self.js(script)
        finally:
            self.driver.switch_to.default_content()

    def saved(self):
        self.js("octafront.now.saved = null")
        self.click("save")
        name = self.wait(lambda: self.js("return octafront.now.saved?.name"))
        return name

    def requests(self):
        """Addresses asked for since it was opened, but for those inside the page."""
        found = []
        for entry in self.driver.get_log("performance"):
            message = json.loads(entry["message"])["message"]
            if message["method"] in ("Network.requestWillBeSent", "Network.webSocketCreated"):
                url = message["params"].get("request", message["params"])["url"]
                if not url.startswith(("data:", "blob:")):
                    found.append(url)
        return found


def native(*files, **options):
    flags = [f for name, value in options.items() for f in ["--" + name] + ([] if value is True else [str(value)])]
    run = subprocess.run([OCTAFRONT, "mesh", *map(str, files), *flags, "-q", "--json", "-", "-o", "/dev/null", "--format", "vtu"],
                         check=True, capture_output=True, timeout=900)
    return json.loads(run.stdout)


class WebPage(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scratch = tempfile.TemporaryDirectory()
        cls.dir = pathlib.Path(cls.scratch.name)
        cls.driver = browser(cls.dir)

    @classmethod
    def tearDownClass(cls):
        cls.driver.quit()
        cls.scratch.cleanup()

    def tearDown(self):
        errors = [e["message"] for e in self.driver.get_log("browser") if e["level"] == "SEVERE"]
        self.assertEqual(errors, [], "no error on the console, whatever was done")

    def test_meshes_a_file_as_the_native_program_does_and_asks_nobody(self):
        page = Page(self.driver)
        page.open(SAMPLES / "bracket.stl")
        self.assertIn("bracket.stl", page.text("part"))
        self.assertIn("volume", page.text("part"))
        page.wait(lambda: "elements" in page.text("estimate"))
        page.by("elements", 20000)
        report = page.mesh()
        self.assertEqual(report["hash"], native(SAMPLES / "bracket.stl", elements=20000, patches=True)["hash"])
        shown = page.in_report("return [octafront.mesh.facts.tets, octafront.vertices, document.getElementById('title').textContent, document.getElementById('command').textContent]")
        self.assertEqual(shown[0], report["tets"])
        self.assertGreater(shown[1], 1000)
        self.assertEqual(shown[2:], ["bracket.stl", "octafront mesh bracket.stl -o mesh.msh --elements 20000 --patches"])
        for choice in ("msh", "vtu", "nastran", "tetgen"):
            page.put("format", choice)
            name = page.saved()
            page.wait((self.dir / name).exists)
        self.assertEqual(page.requests(), [PAGE.as_uri()], "nothing is asked for but the page itself")
        made = subprocess.run([OCTAFRONT, "info", str(self.dir / "bracket.msh")], check=True, capture_output=True, text=True).stdout
        self.assertIn(str(report["tets"]), made.replace(",", "").replace("\u202f", ""))

    def test_forbids_requests(self):
        page = Page(self.driver)
        refused = self.driver.execute_async_script(
            "const done = arguments[0]; fetch('https://example.org/').then(() => done(false), () => done(true))")
        self.assertTrue(refused)
        self.driver.get_log("browser")  # where the browser says so
        self.assertEqual(page.requests(), [PAGE.as_uri()])

    def test_draws_the_part_and_turns_it(self):
        page = Page(self.driver)
        page.open(SAMPLES / "gear.obj")
        drawn = """const {picture, camera} = octafront.now.view, canvas = document.getElementById('canvas');
            picture.draw(camera, {edges: true, background: [0, 0, 0, 1], plane: [0, 0, 0, 1]});
            const copy = document.createElement('canvas'); copy.width = canvas.width; copy.height = canvas.height;
            const c = copy.getContext('2d'); c.drawImage(canvas, 0, 0);
            const bytes = c.getImageData(0, 0, copy.width, copy.height).data; let lit = 0, sum = 0;
            for (let i = 0; i < bytes.length; i += 4) if (bytes[i] + bytes[i + 1] > 0) { ++lit; sum = (sum * 31 + bytes[i] + i) % 1e9; }
            return [lit / (copy.width * copy.height), sum];"""
        share, before = page.js(drawn)
        self.assertGreater(share, 0.1)
        page.js("octafront.now.view.camera.turn(0.4, 0.1)")
        self.assertNotEqual(page.js(drawn)[1], before)

    def test_a_run_can_be_cancelled(self):
        page = Page(self.driver)
        page.open(SAMPLES / "torus_knot.ply")
        page.by("elements", 3000000)
        page.click("go")
        page.wait(lambda: page.shows("busy") and "meshing" not in page.text("busy-text"))
        begun = time.time()
        page.click("cancel")
        page.idle(5)
        self.assertLess(time.time() - begun, 5)
        self.assertFalse(page.shows("trouble"))
        page.by("elements", 5000)
        self.assertEqual(page.mesh()["hash"], native(SAMPLES / "torus_knot.ply", elements=5000, patches=True)["hash"])

    def test_what_is_wrong_is_said(self):
        page = Page(self.driver)
        bad = self.dir / "text.stl"
        bad.write_text("nothing of the kind")
        page.choose(bad)
        page.wait(lambda: page.shows("trouble"))
        self.assertIn("text.stl", page.text("trouble"))
        page.open(SAMPLES / "bracket.stl")
        self.assertFalse(page.shows("trouble"))
        page.by("size", -3)
        page.click("go")
        page.wait(lambda: page.shows("trouble"))
        self.assertIn("above 0", page.text("trouble"))

    def test_names_of_files_are_never_markup(self):
        page = Page(self.driver)
        hostile = self.dir / HOSTILE
        hostile.write_bytes((SAMPLES / "bracket.stl").read_bytes())
        page.open(hostile)
        self.assertIn(HOSTILE, page.text("part"))
        page.by("size", 8)
        page.mesh()
        self.assertEqual(page.js("return document.querySelectorAll('img').length"), 0)
        self.assertEqual(page.in_report("return [document.querySelectorAll('img').length, document.getElementById('title').textContent]"), [0, HOSTILE])

    def test_samples_options_and_regions(self):
        page = Page(self.driver)
        page.js("[...document.querySelectorAll('#samples button')].at(-1).click()")
        page.wait(lambda: page.shows("step-mesh"))
        self.assertIn("regions", page.text("part"))
        page.by("size", 8)
        page.put("option-improve", "fast")
        page.put("order", "2")
        report = page.mesh()
        self.assertEqual(report["hash"], native(SAMPLES / "head_labels.nii.gz", size=8, improve="fast", order=2, patches=True)["hash"])

    def test_fits_a_phone(self):
        page = Page(self.driver, (390, 844))
        try:
            page.open(SAMPLES / "bracket.stl")
            self.assertLessEqual(page.js("return document.documentElement.scrollWidth"), 390)
            page.by("size", 8)
            page.mesh()
            self.assertTrue(page.shows("report"))
            self.assertLessEqual(page.in_report("return document.documentElement.scrollWidth"), 390)
            page.js("document.querySelector('[data-show=setup]').click()")
            self.assertTrue(page.shows("save"))
        finally:
            self.driver.execute_cdp_cmd("Emulation.clearDeviceMetricsOverride", {})


def pictures():
    folder = PAGE.parent
    with tempfile.TemporaryDirectory() as scratch:
        driver = browser(scratch)
        for width, height in ((1280, 800), (390, 844)):
            page = Page(driver, (width, height))
            driver.save_screenshot(str(folder / f"page-{width}-empty.png"))
            page.open(SAMPLES / "bracket.stl")
            page.wait(lambda: "elements" in page.text("estimate"))
            driver.save_screenshot(str(folder / f"page-{width}-part.png"))
            page.js("document.querySelector('[data-show=stage]').click()")
            time.sleep(0.5)
            driver.save_screenshot(str(folder / f"page-{width}-seen.png"))
            page.by("elements", 20000)
            page.js("document.querySelector('[data-show=setup]').click()")
            page.mesh()
            page.in_report("octafront.inner.setClipAxis('y'); return 0")
            time.sleep(1)
            driver.save_screenshot(str(folder / f"page-{width}-mesh.png"))
            page.js("document.querySelector('[data-show=setup]').click()")
            driver.save_screenshot(str(folder / f"page-{width}-save.png"))
        driver.quit()


def times():
    print("| elements | native, one thread | the page | ratio | memory of the page's module | page of the mesh shown |")
    print("| --- | --- | --- | --- | --- | --- |")
    with tempfile.TemporaryDirectory() as scratch:
        for wanted in (10000, 100000, 1000000):
            driver = browser(scratch)
            page = Page(driver)
            page.open(SAMPLES / "torus_knot.ply")
            page.by("elements", wanted)
            report = page.mesh(1500)
            memory = driver.execute_async_script("const done = arguments[0]; octafront.now.mesh.memory().then(done)")
            shown = page.in_report("return performance.getEntriesByName('first picture')[0].duration")
            driver.quit()
            alone = native(SAMPLES / "torus_knot.ply", elements=wanted, patches=True, threads=1)
            assert alone["hash"] == report["hash"], "the same mesh"
            ratio = report["wall_seconds"] / alone["wall_seconds"]
            print(f"| {report['tets']:,} | {alone['wall_seconds']:.1f} s | {report['wall_seconds']:.1f} s | {ratio:.2f} | {memory / 1e6:,.0f} MB | {shown / 1e3:.1f} s |", flush=True)


if "--pictures" in sys.argv:
    pictures()
elif "--times" in sys.argv:
    times()
else:
    unittest.main(argv=sys.argv[:1])
