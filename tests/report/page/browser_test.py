"""The report page in a browser: browser_test.py OCTAFRONT SAMPLES_DIR [--pictures FOLDER | --times]

Debian's Chromium without a window, driven by its own driver (python3-selenium): both come from one source package, so
they fit each other. WebGL is drawn by the processor (SwiftShader); a machine with a graphics card is faster.
  --pictures FOLDER   writes the pictures of docs/use/report.md and docs/use/cad.md there, and tests nothing
  --times             prints docs/use/report.md's table of sizes and times, and tests nothing
"""

import json
import math

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
    from selenium.webdriver.common.action_chains import ActionChains
    from selenium.webdriver.common.by import By
    from selenium.webdriver.common.keys import Keys
except ImportError:
    print("no python3-selenium here: skipped; scripts/test.sh --all installs it")
    sys.exit(77)

OCTAFRONT, SAMPLES = sys.argv[1], pathlib.Path(sys.argv[2])
HOSTILE = '"><script>document.title = "taken"</script><img src=x onerror=alert(1)>\n\u202e'


def browser(width=1400, height=900):
    options = Options()
    options.binary_location = "/usr/bin/chromium"
    # Root may not use the sandbox, and containers have little shared memory.
    for argument in ("--headless=new", "--no-sandbox", "--disable-dev-shm-usage", "--use-angle=swiftshader",
                     "--enable-unsafe-swiftshader", "--hide-scrollbars", f"--window-size={width},{height}"):
        options.add_argument(argument)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
    driver = webdriver.Chrome(service=Service("/usr/bin/chromedriver"), options=options)
    driver.set_script_timeout(30)
    return driver


class View:
    """A page that is open, and what one does with it."""

    def __init__(self, driver, file):
        self.driver = driver
        driver.get_log("browser"), driver.get_log("performance")
        driver.get(pathlib.Path(file).resolve().as_uri())
        self.first_picture = self.wait(lambda: self.js(
            "return performance.getEntriesByName('first picture').map(e => e.duration)[0]"), 120)

    def wait(self, condition, seconds=20):
        end = time.time() + seconds
        while time.time() < end:
            if (value := condition()):
                return value
            time.sleep(0.05)
        raise AssertionError("waited in vain")

    def js(self, script, *arguments):
        return self.driver.execute_script(script, *arguments)

    def click(self, selector):
        self.driver.find_element(By.CSS_SELECTOR, selector).click()
        self.settle()

    def settle(self):
        """Until the picture stands still: over frames that were drawn, however long a busy machine takes for one."""
        last, same, end = None, 0, time.time() + 20
        while same < 3 and time.time() < end:
            self.driver.execute_async_script(
                "const done = arguments[0]; requestAnimationFrame(() => requestAnimationFrame(() => done()))")
            now = self.camera()
            same = same + 1 if now == last else 0
            last = now
            time.sleep(0.15)

    def camera(self):
        return self.js("const c = octafront.camera; return [...c.target, c.distance, ...c.axes.flat()]")

    def picture(self):
        """The canvas as bytes r, g, b, a."""
        self.settle()
        return self.js("""const canvas = document.getElementById('canvas'), copy = document.createElement('canvas');
            copy.width = canvas.width; copy.height = canvas.height;
            octafront.draw();
            const c = copy.getContext('2d');
            c.drawImage(canvas, 0, 0);
            return Array.from(c.getImageData(0, 0, copy.width, copy.height).data.filter((v, i) => i % 64 < 4));""")

    def colours(self):
        data = self.picture()
        return {tuple(data[i:i + 3]) for i in range(0, len(data), 4)}

    def requests(self):
        """Addresses that the page asked for since it was opened."""
        found = []
        for entry in self.driver.get_log("performance"):
            message = json.loads(entry["message"])["message"]
            if message["method"] == "Network.requestWillBeSent":
                found.append(message["params"]["request"]["url"])
        return found

    def errors(self):
        return [e["message"] for e in self.driver.get_log("browser") if e["level"] == "SEVERE"]


def run_cli(*arguments):
    subprocess.run([OCTAFRONT, *map(str, arguments), "--quiet"], check=True, timeout=600)


class Browser(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scratch = tempfile.TemporaryDirectory()
        cls.dir = pathlib.Path(cls.scratch.name)
        cls.page, cls.report = cls.dir / "page.html", cls.dir / "report.json"
        run_cli("mesh", SAMPLES / "bracket.stl", "-o", cls.dir / "m.vtu", "--patches", "--report", cls.page, "--json",
                cls.report)
        cls.driver = browser()

    @classmethod
    def tearDownClass(cls):
        cls.driver.quit()
        cls.scratch.cleanup()

    def open(self, page=None):
        return View(self.driver, page or self.page)

    def tearDown(self):
        errors = [e["message"] for e in self.driver.get_log("browser") if e["level"] == "SEVERE"]
        self.assertEqual(errors, [], "no error on the console, whatever was done")

    def test_shows_the_mesh_and_asks_nobody(self):
        view = self.open()
        colours = view.colours()
        self.assertGreater(len(colours), 50, "a mesh has light and shade")
        self.assertFalse(view.driver.find_element(By.ID, "message").is_displayed())
        self.assertEqual({url.split(":")[0] for url in view.requests()} - {"data"}, {"file"})
        boundary = json.loads(self.report.read_text())["boundary_faces"]
        self.assertEqual(view.js("return octafront.vertices"), 3 * boundary)

    def test_clipping_changes_the_picture_and_shows_whole_elements(self):
        view = self.open()
        before = view.picture()
        view.click("#clip")
        cut = view.picture()
        changed = sum(a != b for a, b in zip(before, cut))
        self.assertGreater(changed, 0.02 * len(cut))
        view.js("const s = document.getElementById('clip-at'); s.value = 300; s.dispatchEvent(new Event('input'))")
        self.assertNotEqual(cut, view.picture())
        # Every face on the cut belongs to an element that stays: one corner of it is not beyond the plane.
        wrong = view.js("""const { mesh, state } = octafront, n = state.clip.normal;
            const faces = octafront.visibleFaces();
            const beyond = v => n[0] * mesh.points[3 * v] + n[1] * mesh.points[3 * v + 1] + n[2] * mesh.points[3 * v + 2] > state.clip.offset;
            let wrong = 0, cut = 0;
            for (let f = 0; f < faces.solid.count; ++f) {
              const t = faces.solid.half[f] >>> 2, count = [0, 1, 2, 3].filter(i => beyond(mesh.tets[4 * t + i])).length;
              if (count > 3) ++wrong;
              if (faces.solid.patch[f] === 0) ++cut;
            }
            return [wrong, cut]""")
        self.assertEqual(wrong[0], 0)
        self.assertGreater(wrong[1], 20)
        view.click("#clip-flip")
        self.assertNotEqual(cut, view.picture())
        view.click("#clip")
        self.assertEqual(before, view.picture(), "closed again")

    def test_what_a_cut_leaves_is_closed(self):
        view = self.open()
        view.click("#clip")
        # Whatever is hidden behind what: each edge of the faces that are drawn has an even number of them.
        odd = view.js("""const { mesh } = octafront, faces = octafront.visibleFaces().solid, count = new Map();
            const FACES = [1, 2, 3, 0, 3, 2, 0, 1, 3, 0, 2, 1];
            for (let f = 0; f < faces.count; ++f) {
              const t = faces.half[f] >>> 2, i = faces.half[f] & 3;
              const v = [0, 1, 2].map(k => mesh.tets[4 * t + FACES[3 * i + k]]);
              for (let k = 0; k < 3; ++k) {
                const [a, b] = [v[k], v[(k + 1) % 3]].sort((x, y) => x - y), key = a * 4294967296 + b;
                count.set(key, (count.get(key) || 0) + 1);
              }
            }
            return [...count.values()].filter(n => n % 2).length""")
        self.assertEqual(odd, 0)

    def test_colours_tell_what_quality_is_worth(self):
        view = self.open()
        self.assertEqual(view.js("return octafront.inner.endsOfColours(octafront.mesh, 'beta')"), [0, 255])
        legend = view.driver.find_element(By.ID, "legend").text
        self.assertIn("0.00", legend)
        self.assertIn("1.00", legend)

    def test_a_browser_that_cannot_draw_shows_a_still_picture(self):
        script = self.driver.execute_cdp_cmd("Page.addScriptToEvaluateOnNewDocument", {
            "source": "HTMLCanvasElement.prototype.getContext = () => null"})
        try:
            self.driver.get(self.page.resolve().as_uri())
            end = time.time() + 30
            while not self.driver.find_elements(By.ID, "beta-histogram") and not self.driver.find_elements(By.CSS_SELECTOR, "#numbers .panel"):
                self.assertLess(time.time(), end)
                time.sleep(0.1)
            still = self.driver.find_element(By.ID, "still")
            self.assertTrue(still.is_displayed())
            self.assertGreater(self.driver.execute_script("return arguments[0].naturalWidth", still), 500)
            self.assertIn("no WebGL 2", self.driver.find_element(By.ID, "message").text)
        finally:
            self.driver.execute_cdp_cmd("Page.removeScriptToEvaluateOnNewDocument", script)

    def test_stretched_colours_span_what_the_elements_have(self):
        view = self.open()
        self.assertFalse(view.driver.find_element(By.ID, "still").is_displayed())
        view.click("#stretch")
        low, high = view.js("return octafront.inner.fittedEnds(octafront.mesh, 'beta')")
        counts = view.js("return octafront.inner.countsOf(octafront.mesh.values.beta, 256)")
        total = sum(counts)
        self.assertLessEqual(sum(counts[:low]) + sum(counts[high + 1:]), 0.004 * total)
        self.assertGreater(sum(counts[:low + 1]), 0.002 * total, "no colour is kept for values that next to none have")
        self.assertEqual(view.js("return [octafront.inner.placeOf([10, 30], 5), octafront.inner.placeOf([10, 30], 10), octafront.inner.placeOf([10, 30], 30), octafront.inner.placeOf([10, 30], 99)]"),
                         [0, 0, 255, 255])
        legend = view.driver.find_element(By.ID, "legend").text
        value = view.js("return octafront.inner.valueOf(octafront.mesh, 'beta', arguments[0])", low)
        self.assertIn(f"{value:.2f}", legend)

    def test_the_mesh_fills_the_picture(self):
        view = self.open()
        for button in range(1, 8):
            view.click(f"#views button:nth-child({button})")
            # Of the rectangle within the margins one side is full, none is crossed.
            wide, high = view.js("""const project = octafront.inner.projector(octafront.camera, document.getElementById('canvas')), p = octafront.mesh.points;
                let box = [1e9, 1e9, -1e9, -1e9];
                for (let i = 0; i < p.length; i += 3) {
                  const [x, y] = project([p[i], p[i + 1], p[i + 2]]);
                  box = [Math.min(box[0], x), Math.min(box[1], y), Math.max(box[2], x), Math.max(box[3], y)];
                }
                const canvas = document.getElementById('canvas'), w = canvas.clientWidth, h = canvas.clientHeight;
                return [[box[0], w - box[2]], [box[1], h - box[3]]]""")
            self.assertGreater(min(wide), 23)
            self.assertGreater(min(high), 51)
            self.assertLess(min(max(wide) - 24, max(high) - 52), 6, button)

    def test_a_smooth_cut_is_flat_and_as_large_as_it_should_be(self):
        page = self.dir / "box.html"
        box = self.dir / "box.obj"
        box.write_text("".join(f"v {x} {y} {z}\n" for z in (0, 1) for y in (0, 2) for x in (0, 3)) +
                       "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n")
        run_cli("mesh", box, "-o", self.dir / "box.vtu", "--size", 0.4, "--report", page)
        view = self.open(page)
        view.click("#clip")
        view.click("#clip-smooth")
        for axis, area in (("x", 2), ("y", 3), ("z", 6)):
            view.js("octafront.inner.setClipAxis(arguments[0]); octafront.inner.moveClip(0.37)", axis)
            found, off, outside = view.js("""const { mesh, state } = octafront, { cross, dot } = octafront.inner, scale = mesh.radius * mesh.facts.step;
                let area = 0, off = 0;
                for (const { corners } of octafront.inner.slice(mesh, state)) {
                  for (const c of corners) off = Math.max(off, Math.abs(dot(c.slice(0, 3), state.clip.normal) - state.clip.offset));
                  for (let i = 2; i < corners.length; ++i) {
                    const [a, b, c] = [corners[0], corners[i - 1], corners[i]].map(p => p.slice(0, 3));
                    area += Math.abs(dot(cross(b.map((x, k) => x - a[k]), c.map((x, k) => x - a[k])), state.clip.normal)) / 2;
                  }
                }
                return [area * scale * scale, off, octafront.inner.planeOf(state)[3] - state.clip.offset]""")
            self.assertAlmostEqual(found, area, delta=1e-3 * area)
            self.assertLess(off, 1e-6)
            self.assertEqual(outside, 0)
        smooth = view.picture()
        view.click("#clip-smooth")
        self.assertTrue(smooth != view.picture(), "whole elements look otherwise")

    def test_a_smooth_cut_has_no_holes(self):
        page = self.dir / "cut.html"
        run_cli("mesh", SAMPLES / "bracket.stl", "-o", self.dir / "cut.vtu", "--size", 4, "--report", page)
        view = self.open(page)
        view.click("#views button:nth-child(3)")  # from +y
        for button in ("#clip", "#clip-smooth", "#edges"):
            view.click(button)
        # Without a quantity for elements that are inside all of the cut has one colour, seen straight on; so it must be as large
        # in pixels as its triangles are.
        view.js("octafront.state.quantity = 'patch'")
        for share in (0.31, 0.5, 0.62):  # the middle is a plane of the lattice
            view.js("octafront.inner.setClipAxis('y'); octafront.inner.moveClip(arguments[0])", share)
            view.settle()
            seen, drawn = view.js("""const o = octafront, canvas = document.getElementById('canvas'), copy = document.createElement('canvas');
                copy.width = canvas.width; copy.height = canvas.height;
                o.draw();
                const c = copy.getContext('2d');
                c.drawImage(canvas, 0, 0);
                const data = c.getImageData(0, 0, copy.width, copy.height).data, counts = new Map();
                for (let i = 0; i < data.length; i += 4) {
                  const colour = data[i] * 65536 + data[i + 1] * 256 + data[i + 2];
                  counts.set(colour, (counts.get(colour) ?? 0) + 1);
                }
                const background = data[0] * 65536 + data[1] * 256 + data[2];
                counts.delete(background);
                const project = o.inner.projector(o.camera, canvas), scale = (copy.width / canvas.clientWidth) ** 2;
                let area = 0;
                for (const { corners } of o.inner.slice(o.mesh, o.state)) {
                  const at = corners.map(p => project(p));
                  for (let i = 2; i < at.length; ++i) area += Math.abs((at[i - 1][0] - at[0][0]) * (at[i][1] - at[0][1]) - (at[i - 1][1] - at[0][1]) * (at[i][0] - at[0][0])) / 2;
                }
                return [Math.max(...counts.values()), area * scale]""")
            self.assertGreater(drawn, 20000)
            self.assertAlmostEqual(seen, drawn, delta=0.04 * drawn)

    def test_second_order_is_drawn_as_it_bends(self):
        ball, page = self.dir / "ball.obj", self.dir / "ball.html"
        RADIUS, N = 3.0, 24
        grid = [(math.sin(math.pi * i / N) * math.cos(math.pi * k / N), math.sin(math.pi * i / N) * math.sin(math.pi * k / N),
                 math.cos(math.pi * i / N)) for i in range(1, N) for k in range(2 * N)]
        at = lambda i, k: 1 + (i - 1) * 2 * N + k % (2 * N)
        poles = len(grid) + 1, len(grid) + 2
        faces = [f"f {poles[0]} {at(1, k)} {at(1, k + 1)}\nf {poles[1]} {at(N - 1, k + 1)} {at(N - 1, k)}\n" for k in range(2 * N)]
        faces += [f"f {at(i, k)} {at(i + 1, k)} {at(i + 1, k + 1)} {at(i, k + 1)}\n" for i in range(1, N - 1) for k in range(2 * N)]
        ball.write_text("".join(f"v {RADIUS * x} {RADIUS * y} {RADIUS * z}\n" for x, y, z in [*grid, (0, 0, 1), (0, 0, -1)]) + "".join(faces))
        run_cli("mesh", ball, "-o", self.dir / "ball.vtu", "--size", 2, "--order", 2, "--report", page)
        view = self.open(page)
        faces, parts = view.js("return [octafront.mesh.boundary.low.length, octafront.mesh.bends.parts]")
        self.assertEqual(view.js("return octafront.vertices"), 3 * faces * parts ** 2, "every face bends")
        least, most = view.js("""const { mesh, inner } = octafront, data = inner.vertexData(mesh, octafront.visibleFaces().solid, 'beta');
            const floats = new Float32Array(data), radii = [], scale = mesh.radius * mesh.facts.step;
            for (let i = 0; i < floats.length; i += 8) radii.push(scale * Math.hypot(floats[i], floats[i + 1], floats[i + 2]));
            return [Math.min(...radii), Math.max(...radii)]""")
        self.assertGreater(least, 0.95 * RADIUS, "faces that were flat would be at .85 of the radius")
        self.assertLess(most, 1.05 * RADIUS, "seen from the middle of the box, which is not that of the ball")
        view.click("#clip")
        view.click("#clip-smooth")
        for share, reach in ((0.5, 1), (0.8, 0.8)):  # of the diameter; of the radius
            area = view.js("""const { mesh, state, inner } = octafront, { cross, dot } = inner, scale = mesh.radius * mesh.facts.step;
                inner.setClipAxis('z'); inner.moveClip(arguments[0]);
                let area = 0;
                for (const { corners } of inner.slice(mesh, state))
                  for (let i = 2; i < corners.length; ++i) {
                    const [a, b, c] = [corners[0], corners[i - 1], corners[i]];
                    area += Math.abs(dot(cross([0, 1, 2].map(k => b[k] - a[k]), [0, 1, 2].map(k => c[k] - a[k])), state.clip.normal)) / 2;
                  }
                return area * scale * scale""", share)
            self.assertAlmostEqual(area, math.pi * (RADIUS * reach) ** 2, delta=0.03 * area)
        view.js("octafront.state.selected = octafront.mesh.boundary.low[0] >>> 2; octafront.draw()")
        self.assertEqual(view.js("return document.getElementById('chosen').getAttribute('d').split('Q').length - 1"), 3, "the edges of its face")
        extent = view.js("return document.getElementById('numbers').textContent").split("extent x, y, z")[1][:20]
        self.assertAlmostEqual(float(extent.split(" × ")[0]), 2 * RADIUS, delta=0.02 * RADIUS)

    def test_lengths_and_directions_are_told(self):
        view = self.open()
        self.assertIn("extent x, y, z", view.js("return document.getElementById('numbers').textContent"))
        pixels, length = view.js("return [document.getElementById('bar').getBoundingClientRect().width, Number(document.getElementById('bar-text').textContent)]")
        self.assertTrue(30 < pixels < 130, pixels)
        # As long as that on the screen, at the middle of the picture and across the view.
        shown = view.js("""const m = octafront.mesh, c = octafront.camera, project = octafront.inner.projector(c, document.getElementById('canvas'));
            const a = project(c.target), b = project(octafront.inner.along(c.target, c.axes[0], arguments[0] / (m.radius * m.facts.step)));
            return Math.hypot(a[0] - b[0], a[1] - b[1])""", length)
        self.assertAlmostEqual(shown, pixels, delta=1.5)
        view.click("#views button:nth-child(1)")  # from +x: y to the right, z upward
        ends = view.js("return ['x', 'y', 'z'].map(a => document.querySelector(`#triad-${a} path`).getAttribute('d'))")
        self.assertEqual(ends[1:], ["M0 0L30.0 0.0", "M0 0L0.0 -30.0"])

    def test_the_title_names_all_inputs_and_regions_have_the_first_colours(self):
        page = self.dir / "several.html"
        run_cli("mesh", SAMPLES / "bracket.stl", SAMPLES / "gear.obj", "-o", self.dir / "several.vtu", "--size", 4, "--report", page)
        view = self.open(page)
        self.assertEqual(view.driver.find_element(By.ID, "title").text, "bracket.stl + gear.obj")
        self.assertEqual(view.js("return [document.getElementById('quantity').value, octafront.state.quantity]"), ["region"] * 2)

    def test_a_click_on_a_worst_element_flies_there(self):
        view = self.open()
        before = view.camera()
        view.click(".worst:nth-child(2)")
        worst = json.loads(self.report.read_text())["worst_elements"][1]
        after = view.camera()
        self.assertNotEqual(before, after)
        self.assertLess(after[3], 0.75 * before[3], "nearer")
        facts = view.js("const m = octafront.mesh; return [m.facts.origin, m.facts.step, m.middle, m.radius]")
        origin, step, middle, radius = facts
        target = [origin[k] + step * (after[k] * radius + middle[k]) for k in range(3)]
        self.assertLess(math.dist(target, worst["at"]), 1e-3 * step * radius)
        self.assertEqual(view.js("return octafront.state.selected"), worst["number"])
        box = view.driver.find_element(By.ID, "element").text
        self.assertIn(str(worst["number"]), box)
        self.assertIn(f"{worst['dihedral_max_degrees']:.1f}", box)

    def test_a_click_on_the_mesh_chooses_what_is_there(self):
        view = self.open()
        view.click(".worst")
        chosen = view.js("return octafront.state.selected")
        view.driver.find_element(By.CSS_SELECTOR, "#element button").click()
        canvas = view.driver.find_element(By.ID, "canvas")
        # The camera looks at the middle of the element that was chosen; nothing else shall be before it.
        view.js("const byte = octafront.mesh.values.beta[arguments[0]];"
                "for (const id of ['filter-low', 'filter-high']) document.getElementById(id).value = byte", chosen)
        view.click("#filter")
        ActionChains(view.driver).move_to_element(canvas).click().perform()
        self.assertEqual(view.wait(lambda: view.js("return octafront.state.selected")), chosen)

    def test_numbers_are_those_of_the_json_file(self):
        view = self.open()
        report = json.loads(self.report.read_text())
        shown = [n for n in view.js("return [...document.querySelectorAll('.number, .bar')].map(n => n.dataset.value)")]
        wanted = [report["tets"], report["points"], report["hash"], report["expected_tets"], report["wall_seconds"],
                  report["volume"], report["quality"]["beta_mean"], report["quality"]["beta_min"],
                  report["quality"]["dihedral_min_degrees"], report["quality"]["dihedral_max_degrees"],
                  report["surface_edges"]["mean_ratio"], report["volume_edges"]["share_within_0.7_1.4"]]
        wanted += report["quality"]["beta_classes"] + report["quality"]["dihedral_histogram"]
        wanted += [e["beta"] for e in report["worst_elements"]] + [s["wall_seconds"] for s in report["stages"]]
        as_numbers = {float(s) for s in shown if s is not None and s.replace(".", "").replace("-", "").replace(
            "e", "").isdigit()}
        for value in wanted:
            self.assertTrue(str(value) in shown or (not isinstance(value, str) and float(value) in as_numbers), value)
        text = view.js("return document.getElementById('numbers').textContent")
        self.assertIn(report["command_line"], text)
        for stage in report["stages"]:
            self.assertIn(stage["name"], text)
        bars = view.js("return [...document.querySelectorAll('#size-histogram .bar')].map(b => Number(b.dataset.value))")
        self.assertEqual(sum(bars), report["tets"])

    def test_parts_are_hidden(self):
        view = self.open()
        all_faces = view.js("return octafront.vertices")
        count = view.js("return Number(document.querySelector('.part .count').textContent.replace(/\\D/g, ''))")
        view.click(".part input")
        view.settle()
        self.assertEqual(view.js("return octafront.vertices"), all_faces - 3 * count)
        view.click("#parts .buttons button:nth-child(2)")
        self.assertEqual(view.wait(lambda: view.js("return octafront.vertices === 0")), True)

    def test_regions_are_hidden_with_the_wall_between_shown(self):
        mesh = self.dir / "two.msh"
        mesh.write_text("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n5\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n5 1 1 1\n"
                        "$EndNodes\n$Elements\n2\n1 4 2 1 1 1 2 3 4\n2 4 2 2 2 2 3 4 5\n$EndElements\n")
        page = self.dir / "two.html"
        run_cli("report", mesh, "-o", page)
        view = self.open(page)
        self.assertEqual(view.js("return octafront.vertices"), 18)
        view.click(".part input")
        self.assertEqual(view.wait(lambda: view.js("return octafront.vertices !== 18 && octafront.vertices")), 12)

    def test_names_and_volumes_of_cad(self):
        if not (pathlib.Path(OCTAFRONT).parent / "../cad/octafront-cad").exists():
            self.skipTest("built without OpenCASCADE")
        page, report = self.dir / "cad.html", self.dir / "cad.json"
        run_cli("mesh", SAMPLES / "assembly.step", "-o", self.dir / "cad.vtu", "--size", 6, "--report", page, "--json", report)
        view = self.open(page)
        report = json.loads(report.read_text())
        text = view.js("return document.getElementById('numbers').textContent")
        for solid in report["regions"]:
            self.assertIn(f"{solid['true_volume']:.6g}, ", text)
            self.assertIn(solid["name"], text)
        self.assertIn(f"(CAD {report['true_volume']:.6g}, ", text)
        parts = view.js("return document.getElementById('parts').textContent")
        for name in ("bolt#2", "fillet", "bolt hole 1", "ground"):
            self.assertIn(name, parts)

    def test_colours_follow_the_choice(self):
        view = self.open()
        seen = []
        for quantity in ("beta", "min_dihedral", "max_dihedral", "size_ratio", "patch"):
            view.js("const s = document.getElementById('quantity'); s.value = arguments[0];"
                    "s.dispatchEvent(new Event('change'))", quantity)
            seen.append(view.picture())
        for i, picture in enumerate(seen):
            for other in seen[:i]:
                self.assertNotEqual(picture, other)

    def test_only_some_elements(self):
        view = self.open()
        view.click("#filter")
        tets = json.loads(self.report.read_text())["tets"]
        drawn = view.js("return octafront.vertices") / 12
        self.assertGreaterEqual(drawn, 0.01 * tets)
        self.assertLess(drawn, 0.5 * tets)

    def test_keys_and_wheel_move_the_camera(self):
        view = self.open()
        canvas = view.driver.find_element(By.ID, "canvas")
        last = view.camera()
        for keys in (Keys.ARROW_LEFT, Keys.SHIFT + Keys.ARROW_UP, "+", "0"):
            canvas.send_keys(keys)
            view.settle()
            self.assertNotEqual(view.camera(), last, repr(keys))
            last = view.camera()
        canvas.send_keys("c")
        self.assertTrue(view.js("return octafront.state.clip.on"))
        ActionChains(view.driver).scroll_by_amount(0, 0).move_to_element(canvas).click_and_hold().move_by_offset(
            80, 30).release().perform()
        self.assertNotEqual(view.camera(), last)

    def test_fingers_pinch(self):
        view = self.open()
        before = view.camera()[3]
        view.js("""const canvas = document.getElementById('canvas');
            canvas.setPointerCapture = () => {};
            const touch = (type, id, x, y) => canvas.dispatchEvent(new PointerEvent(type, { pointerId: id, pointerType: 'touch',
              clientX: x, clientY: y, isPrimary: id === 1, bubbles: true }));
            touch('pointerdown', 1, 300, 300); touch('pointerdown', 2, 400, 300);
            touch('pointermove', 1, 200, 300); touch('pointermove', 2, 500, 300);
            touch('pointerup', 1, 200, 300); touch('pointerup', 2, 500, 300);""")
        self.assertAlmostEqual(view.camera()[3], before / 3, delta=0.01)

    def test_dark_and_light(self):
        view = self.open()
        light = view.js("return getComputedStyle(document.body).backgroundColor")
        before = view.picture()
        view.click("#theme")
        self.assertNotEqual(light, view.js("return getComputedStyle(document.body).backgroundColor"))
        self.assertNotEqual(before, view.picture())

    def test_hostile_names_are_text(self):
        before, behind = HOSTILE.split("/", 1)
        folder = self.dir / before
        folder.mkdir(exist_ok=True)
        surface = folder / (behind.replace("/", "|") + ".obj")
        text = (SAMPLES / "gear.obj").read_text()
        long_name = "<b>bold</b>" + "n" * 10000
        first, second, rest = text.split("\nf ", 2)
        surface.write_bytes(f"{first}\ng {long_name}\nf {second}\ng \xff\xfe\nf {rest}".encode("latin-1"))
        page = self.dir / "hostile.html"
        run_cli("mesh", surface, "-o", self.dir / "h.vtu", "--report", page)
        view = self.open(page)
        self.assertNotEqual(view.driver.title, "taken")
        self.assertIn("onerror", view.driver.find_element(By.ID, "title").text)
        self.assertIn("\\x0a", view.driver.find_element(By.ID, "title").text)
        self.assertIn("\\u{202e}", view.driver.find_element(By.ID, "title").text)
        self.assertEqual(view.js("return document.querySelectorAll('aside img, aside script, aside #numbers b b').length"), 0)
        self.assertTrue(long_name in view.js("return document.getElementById('parts').textContent"), "the long name as text")
        self.assertLess(view.js("return document.documentElement.scrollWidth"), 1401, "nothing runs out of the page")
        self.assertEqual({url.split(":")[0] for url in view.requests()} - {"data"}, {"file"})

    def test_places_in_notes_and_repairs_lead_there(self):
        surface = self.dir / "twice.off"
        lines = (SAMPLES / "shell.off").read_text().splitlines()
        header = next(i for i, line in enumerate(lines) if line[:1].isdigit())
        v, f, e = lines[header].split()
        lines[header] = f"{v} {int(f) + 1} {e}"
        surface.write_text("\n".join([*lines, lines[-1]]) + "\n")
        page = self.dir / "twice.html"
        run_cli("mesh", surface, "-o", self.dir / "t.vtu", "--report", page)
        view = self.open(page)
        before = view.camera()
        view.js("document.querySelector('.places .place').click()")
        view.settle()
        self.assertNotEqual(before, view.camera())
        self.assertNotIn("-100", view.driver.find_element(By.ID, "mark").get_attribute("transform"))

    def test_fits_a_phone(self):
        phone = browser(420, 800)
        try:
            view = View(phone, self.page)
            self.assertGreater(len(view.colours()), 30)
            self.assertLessEqual(view.js("return document.documentElement.scrollWidth"),
                                 view.js("return document.documentElement.clientWidth"))
        finally:
            phone.quit()

    def test_numbers_are_there_without_a_picture(self):
        page = self.dir / "old.html"
        page.write_text(self.page.read_text().replace('getContext("webgl2"', 'getContext("nothing"'))
        self.driver.get(page.as_uri())
        time.sleep(2)
        self.assertIn("WebGL", self.driver.find_element(By.ID, "message").text)
        self.assertGreater(len(self.driver.find_elements(By.CSS_SELECTOR, ".number")), 20)


def write_pictures(folder):
    """The pictures of docs/use/report.md and docs/use/cad.md."""
    with tempfile.TemporaryDirectory() as scratch:
        page = pathlib.Path(scratch) / "page.html"
        run_cli("mesh", SAMPLES / "gear.obj", "-o", pathlib.Path(scratch) / "m.vtu", "--patches", "--report", page)
        driver = browser(1400, 1000)
        view = View(driver, page)
        view.click("#clip")
        driver.save_screenshot(str(folder / "report-cut.png"))
        view.click("#clip")
        view.click("#filter")
        driver.save_screenshot(str(folder / "report-worst.png"))
        view.click("#filter")
        view.click("#theme")
        view.click(".worst")
        driver.save_screenshot(str(folder / "report-element.png"))
        view.js("document.querySelector('#element button').click(); document.querySelector('#views button:last-child').click();"
                "const s = document.getElementById('quantity'); s.value = 'patch'; s.dispatchEvent(new Event('change'));"
                "document.querySelector('[data-axis=x]').click();"
                "const c = document.getElementById('clip-at'); c.value = 500; c.dispatchEvent(new Event('input'));"
                "[...document.querySelectorAll('summary')].find(t => t.textContent === 'Quality').scrollIntoView()")
        view.settle()
        driver.save_screenshot(str(folder / "report-numbers.png"))
        run_cli("mesh", SAMPLES / "assembly.step", "-o", pathlib.Path(scratch) / "m.vtu", "--size", 4, "--report", page)
        view = View(driver, page)
        view.js("const s = document.getElementById('quantity'); s.value = 'patch'; s.dispatchEvent(new Event('change'))")
        view.settle()
        driver.save_screenshot(str(folder / "report-cad.png"))
        run_cli("mesh", SAMPLES / "torus_knot.ply", "-o", pathlib.Path(scratch) / "m.vtu", "--order", 2, "--elements", 3000, "--report", page)
        view = View(driver, page)
        view.click("#clip")
        view.click("#clip-smooth")
        driver.save_screenshot(str(folder / "report-curved.png"))
        driver.quit()


def print_times():
    """Size and time to the first picture by number of elements."""
    print("| elements | page | mesh file (.vtu) | first picture | a cut | a turn |\n| --- | --- | --- | --- | --- | --- |")
    with tempfile.TemporaryDirectory() as scratch:
        scratch = pathlib.Path(scratch)
        for elements, order in ((20_000, 1), (200_000, 1), (200_000, 2), (1_000_000, 1)):
            page, mesh, report = scratch / "page.html", scratch / "m.vtu", scratch / "r.json"
            run_cli("mesh", SAMPLES / "bracket.stl", "-o", mesh, "--elements", elements, "--order", order, "--improve", "fast", "--report", page, "--json", report)
            driver = browser()
            times = []
            for _ in range(3):
                view = View(driver, page)
                times.append(view.first_picture)
            timed = """const start = performance.now(); arguments[0] === 'cut' ? octafront.rebuild() : 0; octafront.draw(); octafront.finish(); return performance.now() - start"""
            view.click("#clip")
            cut = min(view.js(timed, "cut") for _ in range(5))
            turn = min(view.js(timed, "turn") for _ in range(5))
            tets = json.loads(report.read_text())["tets"]
            print(f"| {tets:,}{', second order' if order == 2 else ''} | {page.stat().st_size / 1e6:.2f} MB | {mesh.stat().st_size / 1e6:.1f} MB | {sorted(times)[1] / 1e3:.2f} s | {cut:.0f} ms | {turn:.0f} ms |", flush=True)
            driver.quit()


if __name__ == "__main__":
    if not pathlib.Path("/usr/bin/chromedriver").exists():
        print("no chromium-driver here: skipped; scripts/test.sh --all installs it")
        sys.exit(77)
    if "--pictures" in sys.argv:
        write_pictures(pathlib.Path(sys.argv[sys.argv.index("--pictures") + 1]))
    elif "--times" in sys.argv:
        print_times()
    else:
        unittest.main(argv=sys.argv[:1] + sys.argv[3:])
