"""`octafront ui` and its page in Chromium, as tests and pictures drive them."""
import pathlib
import re
import shutil
import subprocess
import time

from selenium import webdriver
from selenium.webdriver.chrome.options import Options
from selenium.webdriver.chrome.service import Service


class Program:
    """The program, started; its address."""

    def __init__(self, octafront, *arguments, env=None):
        self.process = subprocess.Popen([octafront, "ui", "--no-browser", *map(str, arguments)], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=env)
        line = self.process.stdout.readline()
        found = re.search(r"http://([\d.]+):(\d+)/([0-9a-f]+)/", line)
        assert found, line + self.process.stderr.read()
        self.address, self.host, self.port, self.token = found.group(0), found.group(1), int(found.group(2)), found.group(3)

    def end(self):
        if self.process.poll() is None:
            self.process.terminate()
        status = self.process.wait(30)
        self.process.stdout.close(), self.process.stderr.close()
        return status


AXE = "axe-core@4.14.1"


def axe(folder):
    """The script of axe-core, which npm puts into a new folder; None: it has none here."""
    folder.mkdir()
    if shutil.which("npm") is None or subprocess.run(["npm", "install", "--ignore-scripts", "--no-audit", "--no-fund", AXE], cwd=folder, capture_output=True, timeout=300).returncode:
        return None
    return (folder / "node_modules/axe-core/axe.min.js").read_text()


def serious(driver, script):
    """What axe-core finds that is serious or worse: [impact, rule, elements]."""
    driver.execute_script(script)
    found = driver.execute_async_script("const done = arguments[0]; axe.run(document, {resultTypes: ['violations']}).then(r => done(r.violations.map(v => [v.impact, v.id, v.nodes.slice(0, 3).map(n => n.html.slice(0, 120) + ' ' + (n.any[0]?.message ?? ''))])))")
    return [violation for violation in found if violation[0] in ("serious", "critical")]


def browser(downloads, width=1280, height=900, logs=("browser",)):
    options = Options()
    options.binary_location = "/usr/bin/chromium"
    # Root may not use the sandbox, and containers have little shared memory.
    for argument in ("--headless=new", "--no-sandbox", "--disable-dev-shm-usage", "--use-angle=swiftshader",
                     "--enable-unsafe-swiftshader", "--hide-scrollbars", f"--window-size={width},{height}"):
        options.add_argument(argument)
    options.set_capability("goog:loggingPrefs", {log: "ALL" for log in logs})
    driver = webdriver.Chrome(service=Service("/usr/bin/chromedriver"), options=options)
    driver.set_script_timeout(60)
    driver.execute_cdp_cmd("Browser.setDownloadBehavior", {"behavior": "allow", "downloadPath": str(pathlib.Path(downloads).resolve())})
    return driver


class Page:
    """The page, open, and what one does in it."""

    def __init__(self, driver, address, size=(1280, 900)):
        self.driver = driver
        driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {"width": size[0], "height": size[1], "deviceScaleFactor": 1, "mobile": size[0] < 500})
        driver.get_log("browser")
        driver.get(address)
        self.wait(lambda: self.js("return performance.getEntriesByName('ready').length"), 60)

    def js(self, script, *arguments):
        return self.driver.execute_script(script, *arguments)

    def wait(self, condition, seconds=30):
        end = time.time() + seconds
        while time.time() < end:
            if (value := condition()):
                return value
            time.sleep(0.05)
        raise AssertionError("waited in vain; " + self.text("trouble"))

    def text(self, id):
        return self.js("return document.getElementById(arguments[0]).textContent", id)

    def shows(self, id):
        return self.js("return document.getElementById(arguments[0]).checkVisibility()", id)

    def put(self, id, value):
        self.js("""const e = document.getElementById(arguments[0]); e.value = arguments[1];
            e.dispatchEvent(new Event('input', {bubbles: true})); e.dispatchEvent(new Event('change', {bubbles: true}))""", id, str(value))

    def click(self, id):
        self.js("document.getElementById(arguments[0]).click()", id)

    def choose(self, name, value):
        self.js("document.querySelector(`[name=${arguments[0]}][value=${arguments[1]}]`).click()", name, value)

    def idle(self, seconds=120):
        self.wait(lambda: not self.shows("busy"), seconds)

    def settle(self):
        self.driver.execute_async_script("const done = arguments[0]; setTimeout(() => requestAnimationFrame(() => requestAnimationFrame(() => done())), 700)")

    def tap(self, x, y):
        """A click of the mouse in the picture, as a person does it."""
        box = self.js("const r = document.getElementById('canvas').getBoundingClientRect(); return [r.left, r.top]")
        for type in ("mouseMoved", "mousePressed", "mouseReleased"):
            self.driver.execute_cdp_cmd("Input.dispatchMouseEvent", {"type": type, "x": box[0] + x, "y": box[1] + y, "button": "left" if type != "mouseMoved" else "none", "clickCount": 1})

    def drag(self, x0, y0, x1, y1, alt=False):
        for type, x, y, buttons in (("mousePressed", x0, y0, 1), ("mouseMoved", (x0 + x1) / 2, (y0 + y1) / 2, 1), ("mouseReleased", x1, y1, 0)):
            self.driver.execute_cdp_cmd("Input.dispatchMouseEvent", {"type": type, "x": x, "y": y, "button": "left", "buttons": buttons, "clickCount": 1, "modifiers": 1 if alt else 0})

    def where(self, kind, name):
        """A point of the picture where this place is seen, turned until it is; None: nowhere."""
        for view in ("", "all", "−x", "+y", "−z", "−y", "+x", "+z"):
            if view:
                self.js("document.querySelector(`#views [aria-label='look from ${arguments[0]}']`).click()", view)
                self.settle()
            if at := self.seen(kind, name):
                return at
        return None

    def seen(self, kind, name):
        return self.js("""const c = document.getElementById('canvas'), [kind, name] = arguments;
            for (let y = 6; y < c.clientHeight; y += 6) for (let x = 6; x < c.clientWidth; x += 6) {
              const there = [[0, 0], [4, 0], [0, 4], [-4, -4]].map(([a, b]) => octafront.placesAt(x + a, y + b, false)[0]);
              const n = kind === 'edge' ? 1 : 4;
              if (there.slice(0, n).every(p => p && p.kind === kind && p.name === name)) return [x, y];
            }
            return null""", kind, name)

    def picked(self):
        return self.js("return [...octafront.now.picked.values()].map(p => p.kind + ':' + p.name)")

    def errors(self):
        return [e["message"] for e in self.driver.get_log("browser") if e["level"] == "SEVERE"]
