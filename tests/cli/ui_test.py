"""`octafront ui`, asked by requests and by a browser: ui_test.py OCTAFRONT SAMPLES_DIR [--pictures FOLDER]

Needs the page that scripts/ui.sh makes; the part in the browser Chromium and its driver (python3-selenium), that on accessibility
axe-core from npm: what is not here is skipped.
  --pictures FOLDER   writes the pictures of docs/use/workbench.md there, and tests nothing
"""
import http.client
import json
import pathlib
import shutil
import socket
import subprocess
import sys
import tempfile
import time
import unittest

try:
    from workbench import Page, Program, axe, browser, serious
except ImportError:
    print("no python3-selenium here: skipped; scripts/test.sh --all installs it")
    sys.exit(77)

# The page is made by scripts/ui.sh, of what npm has.
started = subprocess.run([sys.argv[1], "ui", "--no-browser", "no-such-file.stl"], capture_output=True, text=True)
if "no such file" not in started.stderr:
    print(started.stderr.strip() + ": skipped")
    sys.exit(77)

OCTAFRONT, SAMPLES = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
HOSTILE = "<img src=x onerror=alert(1)>.stl"


class Requests(unittest.TestCase):
    """What comes in over the wire, without a page."""

    @classmethod
    def setUpClass(cls):
        cls.scratch = tempfile.TemporaryDirectory()
        cls.all = pathlib.Path(cls.scratch.name).resolve()
        cls.dir, cls.outside = cls.all / "inside", cls.all / "outside"
        cls.dir.mkdir(), cls.outside.mkdir()
        for folder in (cls.dir, cls.outside):
            shutil.copy(SAMPLES / "bracket.stl", folder)
        (cls.dir / "link.stl").symlink_to(cls.outside / "bracket.stl")
        cls.program = Program(OCTAFRONT, cls.dir / "bracket.stl")
        cls.at = f"/{cls.program.token}/"

    @classmethod
    def tearDownClass(cls):
        assert cls.program.end() == 0
        cls.scratch.cleanup()

    def ask(self, method, path, body=None, **headers):
        """Status, body, headers; names of headers with _ for -."""
        connection = http.client.HTTPConnection(self.program.host, self.program.port, timeout=60)
        connection.request(method, path, body, {name.replace("_", "-"): value for name, value in headers.items()})
        response = connection.getresponse()
        answer = response.read()
        connection.close()
        return response.status, answer, response.headers

    def raw(self, data, wait=8, ends=True):
        """What is answered to bytes, after which nothing comes if this side `ends`; empty: the connection was closed, as the
        server does to who seems to have gone."""
        with socket.create_connection((self.program.host, self.program.port), timeout=wait) as wire:
            wire.sendall(data)
            if ends:
                wire.shutdown(socket.SHUT_WR)
            answer = b""
            while part := wire.recv(65536):
                answer += part
        return answer

    def run_tool(self, tool, **arguments):
        status, body, _ = self.ask("POST", self.at + "run", json.dumps({"tool": tool, "arguments": arguments}))
        if status != 200:
            return {"http": status, **json.loads(body)}
        return json.loads([line for line in body.decode().splitlines() if line][-1])["done"]

    def files(self):
        return {p: p.read_bytes() for p in sorted(self.all.rglob("*")) if p.is_file()}

    def refused(self, answer, *statuses):
        status, body, _ = answer
        self.assertIn(status, statuses, body)
        error = json.loads(body)["error"]
        self.assertTrue(error["kind"] and error["code"] and error["message"], error)
        self.assertNotIn(b"bracket", body)
        return error["code"]

    def test_who_has_no_token_gets_nothing(self):
        token, before = self.program.token, self.files()
        paths = ["/", "/about", "/run", "/index.html", "/favicon.ico", "/open/", "/open/" + token, "//" + token + "/", "/" + token, "/" + token[:-1] + "/", "/" + token[1:] + "/about", f"/{token.upper()}x/",
                 f"/{'0' * len(token)}/about", f"/x/{token}/about", f"/?{token}", f"/about?token={token}", f"/{token}x/about", "/made/1/input.ply", "/upload/x.stl", "/..%2f" + token + "/about", "/%00/" + token]
        for path in paths:
            for method in ("GET", "POST", "PUT"):
                self.assertEqual(self.refused(self.ask(method, path, b"{}" if method != "GET" else None), 403), "no_token", path)
        self.assertEqual(self.files(), before)

    def test_other_pages_and_names_of_this_machine_get_nothing(self):
        here = f"127.0.0.1:{self.program.port}"
        for host in ("evil.example", "evil.example:" + str(self.program.port), "127.0.0.1", "0.0.0.0:" + str(self.program.port), here + ".evil.example", "[::1]:" + str(self.program.port), "", here + "@evil"):
            self.assertEqual(self.refused(self.ask("GET", self.at, Host=host), 403), "bad_host", host)
        for origin in ("http://evil.example", "null", "https://" + here, "http://127.0.0.1", "http://127.0.0.1:1", f"http://localhost:{self.program.port}", "file://"):
            self.assertEqual(self.refused(self.ask("POST", self.at + "run", b"{}", Origin=origin), 403), "bad_origin", origin)
        for site in ("cross-site", "same-site", "none"):
            self.assertEqual(self.refused(self.ask("POST", self.at + "run", b"{}", Sec_Fetch_Site=site), 403), "bad_origin", site)
        self.assertEqual(self.ask("GET", self.at, Origin="http://" + here, Sec_Fetch_Site="same-origin")[0], 200)
        two = f"GET {self.at} HTTP/1.1\r\nHost: {here}\r\nHost: evil.example\r\nConnection: close\r\n\r\n".encode()
        self.assertIn(b" 403 ", self.raw(two, ends=False).split(b"\r\n")[0])

    def test_the_page_says_what_it_may_load(self):
        status, body, headers = self.ask("GET", self.at)
        self.assertEqual(status, 200)
        self.assertIn(b"default-src 'none'", body)
        self.assertNotIn(self.program.token.encode(), body)
        for name, value in {"Cache-Control": "no-store", "X-Content-Type-Options": "nosniff", "X-Frame-Options": "DENY", "Referrer-Policy": "no-referrer", "Cross-Origin-Resource-Policy": "same-origin"}.items():
            self.assertEqual(headers[name], value)
        self.assertNotIn("Access-Control-Allow-Origin", headers)

    def test_calls_that_are_none(self):
        before = self.files()
        good = json.dumps({"tool": "plan", "arguments": {"input": str(self.dir / "bracket.stl")}})
        bodies = [b"", b"{", b"null", b"[]", b"7", b'"x"', b"{}", b'{"tool": 1, "arguments": {}}', b'{"tool": "mesh"}', b'{"tool": "mesh", "arguments": []}', b'{"tool": "rm", "arguments": {}}',
                  b'{"tool": "explain", "arguments": {}}', b"\xff\xfe\x00", b"[" * 100000, b'{"tool": "mesh", "arguments": ' + b'{"a":' * 200 + b"1" + b"}" * 201, good.encode()[:-1], b"\x00" * 100]
        for body in bodies:
            self.refused(self.ask("POST", self.at + "run", body), 400)
        self.assertEqual(self.refused(self.ask("POST", self.at + "run", b" " * (1 << 21)), 413), "too_large")
        for method in ("GET", "PUT", "DELETE", "OPTIONS", "PATCH"):
            self.refused(self.ask(method, self.at + "run"), 400, 404)
        for path in ("nothing", "run/", "about/x", "made/", "made/1/", "made/x/input.ply", "made/99999/input.ply", "made/1/../../x", "made/1/%2e%2e%2fx", "made/-1/x", "upload/", ".%2e/x"):
            self.refused(self.ask("GET", self.at + path), 400, 403, 404)
        self.assertEqual(self.files(), before)

    def test_arguments_that_are_none(self):
        before, part = self.files(), str(self.dir / "bracket.stl")
        for arguments in ({}, {"input": 3}, {"input": ""}, {"input": "-"}, {"input": part, "output": "m.msh", "options": 7}, {"input": part, "output": "m.msh", "options": {"nonsense": 1}}, {"input": part, "output": "m.msh", "options": {"json": "x"}},
                          {"input": part, "output": "m.msh", "options": {"within": "/"}}, {"input": part, "output": "m.msh", "shell": "x"}, {"input": part, "output": "m.msh", "options": {"size": ""}}, {"input": part, "output": "m.msh", "options": {"size": {}}}):
            self.assertEqual(self.run_tool("mesh", **arguments)["http"], 400, arguments)
        for size in ("-1", "0", "nan", "1e999", "--output=/tmp/x", "; touch x", "$(touch x)"):
            done = self.run_tool("mesh", input=part, output="m.msh", options={"size": size})
            self.assertEqual(done["error"]["kind"], "usage", done)
            self.assertEqual(done["files"], [])
        self.assertEqual(self.files(), before)

    def test_no_file_outside_its_folders(self):
        before, part = self.files(), str(self.dir / "bracket.stl")
        for file in ("/etc/passwd", str(self.outside / "bracket.stl"), "../../../../../../etc/passwd", str(self.dir / "../outside/bracket.stl"), str(self.dir / "link.stl"), "/proc/self/environ", "//etc/passwd"):
            self.assertEqual(self.run_tool("inspect", input=file)["error"]["code"], "outside_folders", file)
        for output in ("/tmp/x.msh", "../x.msh", "a/b.msh", str(self.outside / "x.msh"), str(self.dir / "x.msh"), ".x.msh", "-", "", 3, ["m.msh", "../x.msh"], "a\\b.msh", "a\nb.msh", "x" * 300 + ".msh"):
            self.assertEqual(self.run_tool("mesh", input=part, output=output)["http"], 400, output)
        for option in ({"report": str(self.outside / "r.html")}, {"labels": str(self.outside / "l.txt")}, {"sheet": str(self.outside / "bracket.stl")}, {"regions": "/etc/passwd"}, {"materials": "/etc/passwd"}):
            done = self.run_tool("mesh", input=part, output="m.msh", options=option)
            self.assertTrue(done["error"]["message"], option)
            self.assertNotIn("root:", json.dumps(done))
        for name in ("..", ".", "..%2fx.stl", "%2e%2e%2fx.stl", "a%2fb.stl", "%2fetc%2fx", "a%5cb.stl", ".hidden", "-x.stl", "a%00b.stl", "a%0ab.stl", "x" * 250):
            self.refused(self.ask("PUT", self.at + "upload/" + name, b"solid"), 400, 404)
        self.assertEqual(self.files(), before)

    def test_bytes_that_are_no_requests(self):
        here = f"Host: 127.0.0.1:{self.program.port}\r\n".encode()
        at = self.at.encode()
        for data in (b"", b"\r\n\r\n", b"GET\r\n\r\n", b"GET /\r\n\r\n", b"GET / HTTP/9.9\r\n\r\n", b"\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03", b"A" * 100000, b"GET " + b"/a" * 9000 + b" HTTP/1.1\r\n" + here + b"\r\n", b"GET / HTTP/1.1\r\n" + b"X: y\r\n" * 3000 + b"\r\n",
                     b"GET " + at + b" HTTP/1.1\r\n" + here + b"A: " + b"b" * 20000 + b"\r\n\r\n", b"POST " + at + b"run HTTP/1.1\r\n" + here + b"Content-Length: -1\r\n\r\n{}", b"POST " + at + b"run HTTP/1.1\r\n" + here + b"Content-Length: 99\r\n\r\n{}",
                     b"POST " + at + b"run HTTP/1.1\r\n" + here + b"Transfer-Encoding: chunked\r\n\r\nzz\r\n", b"POST " + at + b"run HTTP/1.1\r\n" + here + b"Content-Length: 99999999999999999999\r\n\r\n", b"GET\x00/\x00HTTP/1.1\r\n\r\n", b"PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n"):
            answer = self.raw(data)
            self.assertNotIn(b" 200 ", answer.split(b"\r\n")[0], data[:60])
        self.assertEqual(self.ask("GET", self.at)[0], 200, "it goes on")

    def test_a_job_over_the_wire(self):
        body = (SAMPLES / "gear.obj").read_bytes()
        status, answer, _ = self.ask("PUT", self.at + "upload/gear%20one.obj", body)
        file = json.loads(answer)
        self.assertEqual((status, file["name"], file["bytes"]), (200, "gear one.obj", len(body)))
        made = self.run_tool("mesh", input=file["path"], output="m.msh", options={"patches": True, "size": 4})
        self.assertEqual([f["name"] for f in made["files"]], ["m.msh"])
        status, mesh, _ = self.ask("GET", self.at + f"made/{made['run']}/m.msh")
        self.assertEqual((status, len(mesh)), (200, made["files"][0]["bytes"]))
        alone = subprocess.run([OCTAFRONT, "mesh", SAMPLES / "gear.obj", "-o", "/dev/null", "--format", "msh", "--patches", "--size", "4", "--json", "-"], check=True, capture_output=True, text=True)
        self.assertEqual(made["reports"][0]["hash"], json.loads(alone.stdout)["hash"])

    def test_only_some_runs_at_a_time_and_who_leaves_ends_them(self):
        wires = []
        call = json.dumps({"tool": "mesh", "arguments": {"input": str(self.dir / "bracket.stl"), "output": "m.msh", "options": {"elements": 5000000}}})
        for _ in range(4):
            wire = http.client.HTTPConnection(self.program.host, self.program.port, timeout=60)
            wire.request("POST", self.at + "run", call)
            wires.append((wire, wire.getresponse()))
        self.assertEqual(self.refused(self.ask("POST", self.at + "run", call), 503), "busy")
        for wire, response in wires:
            response.close(), wire.close()
        end = time.time() + 20
        while self.run_tool("check", input=str(self.dir / "bracket.stl")).get("http") == 503:
            self.assertLess(time.time(), end, "who leaves ends the run")
            time.sleep(0.2)

    def test_it_ends_with_its_page_and_leaves_nothing(self):
        program = Program(OCTAFRONT, SAMPLES / "bracket.stl")
        wire = http.client.HTTPConnection(program.host, program.port, timeout=60)
        wire.request("GET", f"/{program.token}/alive")
        response = wire.getresponse()
        response.read(1)
        folders = [p for p in pathlib.Path(tempfile.gettempdir()).glob("octafront-ui-*") if p.stat().st_mode & 0o077 == 0]
        self.assertTrue(folders)
        response.close(), wire.close()
        self.assertEqual(program.process.wait(20), 0)
        program.end()
        self.assertLess(len([p for p in folders if p.exists()]), len(folders))


class Workbench(unittest.TestCase):
    """The page in a browser."""

    @classmethod
    def setUpClass(cls):
        cls.scratch = tempfile.TemporaryDirectory()
        cls.dir = pathlib.Path(cls.scratch.name)
        cls.program = Program(OCTAFRONT, SAMPLES / "bracket.step")
        cls.driver = browser(cls.dir)

    @classmethod
    def tearDownClass(cls):
        cls.driver.quit()
        cls.program.end()
        cls.scratch.cleanup()

    def open(self, size=(1280, 900)):
        page = Page(self.driver, self.program.address, size)
        if "octafront-cad" in page.text("trouble"):
            self.skipTest("no octafront-cad was built")
        page.settle()
        return page

    def tearDown(self):
        self.assertEqual([e["message"] for e in self.driver.get_log("browser") if e["level"] == "SEVERE"], [])

    def pick(self, page, kind, name):
        page.choose("kind", kind)
        page.click("do-clear")
        at = page.where(kind, name)
        self.assertIsNotNone(at, name)
        page.tap(*at)
        self.assertEqual(page.picked(), [f"{kind}:{name}"])

    def mesh(self, page):
        page.click("go")
        page.idle()
        self.assertFalse(page.shows("trouble"), page.text("trouble"))
        page.settle()

    def test_a_job_from_the_part_to_the_deck(self):
        page = self.open()
        for name in ("wall", "face 9"):
            self.pick(page, "face", name)
            page.put("name", "on " + name)
            page.click("do-name")
        self.pick(page, "face", "fillet")
        page.put("local-size", "1.5")
        page.click("do-size")
        self.pick(page, "face", "face 9")
        page.click("do-walls")
        page.put("layers-n", "2")
        page.put("order", "2")
        page.wait(lambda: "elements" in page.text("estimate"))
        self.mesh(page)
        report = page.js("return octafront.now.made.report")
        self.assertGreater(report["tets"], 3000)
        self.assertEqual(report["layers"][0]["patch"], "face 9")
        page.click("next")
        page.click("next")
        page.settle()
        worst = report["worst_elements"][1]
        self.assertIn(f"2 of {len(report['worst_elements'])}", page.text("worst"))
        self.assertIn(str(worst["number"]), page.text("element"))
        self.assertTrue(page.js("return octafront.look.clip.on"))
        page.put("format", "abaqus")
        page.click("save")
        page.idle()
        deck = self.dir / "bracket.inp"
        page.wait(lambda: deck.exists() and deck.stat().st_size == page.js("return octafront.now.saved?.bytes"))
        text = deck.read_text()
        self.assertIn("C3D10", text)
        self.assertRegex(text, r"(?i)on_wall")
        info = json.loads(subprocess.run([OCTAFRONT, "check", deck, "--json", "-", "-q"], check=True, capture_output=True, text=True).stdout)
        self.assertTrue(info["valid"])
        # What the page says is the same by hand is.
        command = page.text("repeat").replace("octafront ", "", 1)
        alone = subprocess.run(f"{OCTAFRONT} {command} --json - -q", shell=True, cwd=SAMPLES, check=True, capture_output=True, text=True)
        (SAMPLES / "bracket.inp").unlink()
        self.assertEqual(json.loads(alone.stdout)["hash"], report["hash"])
        page.choose("language", "json")
        self.assertEqual(json.loads(page.text("repeat"))["arguments"]["options"]["order"], "2")

    def test_edges_regions_and_what_goes_on_smoothly(self):
        page = self.open()
        page.choose("kind", "edge")
        edges = page.js("return [...document.querySelectorAll('#places .place')].map(row => row.dataset.key.slice(5))")
        seen = next(e for e in edges if page.where("edge", e))
        self.pick(page, "edge", seen)
        page.put("name", "rim")
        page.click("do-name")
        self.pick(page, "region", "bracket")
        page.choose("kind", "face")
        page.click("do-clear")
        page.put("spread", "20")
        page.tap(*page.where("face", "fillet"))
        self.assertEqual(set(page.picked()) >= {"face:fillet", "face:face 9", "face:face 11"}, True, page.picked())
        page.put("spread", "0")
        page.click("do-clear")
        page.drag(5, 5, 800, 850, alt=True)
        seen = set(page.picked())
        self.assertTrue({"face:fillet", "face:face 9", "face:face 11"} <= seen < {"face:" + p for p in page.js("return octafront.now.surface.patches")}, seen)
        page.choose("kind", "set")
        self.assertIn("color #d03030", page.text("places"))
        page.choose("kind", "face")
        page.put("search", "hole")
        self.assertEqual(page.js("return document.querySelectorAll('#places .place').length"), 2)
        page.put("search", "")
        page.choose("by", "size")
        page.put("size", "6")
        self.mesh(page)
        page.put("format", "msh")
        page.click("save")
        page.idle()
        file = self.dir / "bracket.msh"
        page.wait(lambda: file.exists() and file.stat().st_size == page.js("return octafront.now.saved?.bytes"))
        self.assertIn("rim", subprocess.run([OCTAFRONT, "info", file], check=True, capture_output=True, text=True).stdout)

    def test_a_browser_that_cannot_draw_picks_by_the_list(self):
        script = self.driver.execute_cdp_cmd("Page.addScriptToEvaluateOnNewDocument", {"source": "HTMLCanvasElement.prototype.getContext = () => null"})
        try:
            page = Page(self.driver, self.program.address)
            if "octafront-cad" in page.text("trouble"):
                self.skipTest("no octafront-cad was built")
            self.assertIn("no WebGL 2", page.text("trouble"))
            page.js("document.querySelector(`[data-key='face:wall'] input`).click()")
            page.put("name", "held")
            page.click("do-name")
            page.choose("by", "size")
            page.put("size", "6")
            page.click("go")
            page.wait(lambda: "elements" in page.text("made"))
            self.assertIn("held", page.text("repeat"))
        finally:
            self.driver.execute_cdp_cmd("Page.removeScriptToEvaluateOnNewDocument", script)
            self.driver.get_log("browser")  # where three.js complains

    def test_two_faces_become_a_pair(self):
        page = self.open()
        page.choose("by", "size")
        page.put("size", "6")
        for name in ("face 3", "face 4"):
            page.js("document.querySelector(`[data-key='face:${arguments[0]}'] input`).click()", name)
        page.click("do-pair")
        self.assertIn("--periodic 'face 3:face 4=0,40,0'", page.text("repeat"))
        self.mesh(page)

    def test_steps_can_be_undone(self):
        page = self.open()
        start = page.js("return octafront.job")
        page.choose("by", "elements")
        page.put("elements", "2000")
        self.pick(page, "face", "wall")
        page.put("name", "a")
        page.click("do-name")
        last = page.js("return octafront.job")
        for _ in range(3):
            page.js("document.body.dispatchEvent(new KeyboardEvent('keydown', {key: 'z', ctrlKey: true, bubbles: true}))")
        self.assertEqual(page.js("return octafront.job"), start)
        self.assertTrue(page.js("return document.getElementById('undo').disabled"))
        for _ in range(3):
            page.click("redo")
        self.assertEqual(page.js("return octafront.job"), last)
        page.js("document.querySelector('#job li button:last-child').click()")
        self.assertEqual(page.js("return octafront.job.names"), [])

    def test_the_picture_shows_cut_filter_and_colours(self):
        page = self.open()
        page.choose("by", "size")
        page.put("size", "5")
        self.mesh(page)
        drawn = """const s = octafront.stage; s.draw(); const c = document.createElement('canvas'), canvas = document.getElementById('canvas'); c.width = canvas.width; c.height = canvas.height;
            const x = c.getContext('2d', {willReadFrequently: true}); x.drawImage(canvas, 0, 0); const d = x.getImageData(0, 0, c.width, c.height).data; let sum = 0, lit = 0;
            for (let i = 0; i < d.length; i += 4) { sum = (sum * 31 + d[i] + 7 * d[i + 1] + 13 * d[i + 2]) % 1e9; if (Math.abs(d[i] - d[0]) + Math.abs(d[i + 2] - d[2]) > 20) ++lit; } return [sum, lit / (d.length / 4)]"""
        whole, share = page.js(drawn)
        self.assertGreater(share, 0.1)
        seen = {whole}
        for do in ("document.querySelector('[data-axis=y]').click()", "document.getElementById('smooth').click()", "document.getElementById('flip').click()",
                   "document.getElementById('clip').click(); document.getElementById('filter').click()", "document.getElementById('filter').click(); document.getElementById('edges').click()", "octafront.stage.camera.turn(.4, .1)"):
            page.js(do)
            now = page.js(drawn)[0]
            self.assertNotIn(now, seen, do)
            seen.add(now)
        page.put("quantity", "patch")
        self.assertNotIn(page.js(drawn)[0], seen)
        page.put("quantity", "beta")
        page.js("octafront.now.worst = -1")
        self.assertRegex(page.js("document.getElementById('filter').click(); return document.getElementById('filter-text').textContent"), r"\d+ elements")

    def test_a_run_can_be_cancelled(self):
        page = self.open()
        page.choose("by", "elements")
        page.put("elements", "4000000")
        page.click("go")
        page.wait(lambda: "meshing" not in page.text("busy-text"))
        page.click("cancel")
        page.idle(10)
        self.assertFalse(page.shows("trouble"))
        page.put("elements", "3000")
        self.mesh(page)

    def test_files_come_from_the_browser_and_names_are_never_markup(self):
        page = self.open()
        part = self.dir / HOSTILE
        part.write_bytes((SAMPLES / "bracket.stl").read_bytes())
        page.driver.find_element("id", "files").send_keys(str(part))
        page.wait(lambda: HOSTILE in page.text("part"))
        page.idle()
        self.assertEqual(page.js("return document.querySelectorAll('img').length"), 0)
        page.settle()
        # Faces of a surface are what sharp edges part: the place that is named is the place that was clicked.
        at = page.js("""for (let y = 200; y < 700; y += 10) for (let x = 200; x < 700; x += 10) { const p = octafront.placesAt(x, y, false)[0]; if (p) return [x, y, p.name, octafront.now.surface.patches.length]; }""")
        self.assertGreater(at[3], 5)
        page.tap(at[0], at[1])
        page.put("name", "here")
        page.click("do-name")
        self.mesh(page)
        sets = page.js("return octafront.now.mesh.facts.patches")
        counts = page.js("const c = {}; for (const p of octafront.now.mesh.boundary.number) c[p] = (c[p] ?? 0) + 1; return c")
        number = int(at[2].split("_")[1]) - 1
        low, high = page.js("""const [name] = arguments, s = octafront.now.surface, low = [1e9, 1e9, 1e9], high = [-1e9, -1e9, -1e9];
            for (let t = 0; t < s.patch.length; ++t) if (s.patches[s.patch[t]] === name) for (let k = 0; k < 3; ++k) for (let i = 0; i < 3; ++i) {
              const x = s.points[3 * s.triangles[3 * t + k] + i] + s.middle[i]; low[i] = Math.min(low[i], x); high[i] = Math.max(high[i], x); }
            return [low, high]""", at[2])
        mesh_low, mesh_high = page.js("""const [number] = arguments, m = octafront.now.mesh, F = [1, 2, 3, 0, 3, 2, 0, 1, 3, 0, 2, 1], low = [1e9, 1e9, 1e9], high = [-1e9, -1e9, -1e9];
            for (let f = 0; f < m.boundary.low.length; ++f) if (m.boundary.number[f] === number) for (let k = 0; k < 3; ++k) for (let i = 0; i < 3; ++i) {
              const h = m.boundary.low[f], v = m.tets[4 * (h >>> 2) + F[3 * (h & 3) + k]], x = m.facts.origin[i] + m.facts.step * m.steps[3 * v + i]; low[i] = Math.min(low[i], x); high[i] = Math.max(high[i], x); }
            return [low, high]""", number)
        for a, b in zip(low + high, mesh_low + mesh_high):
            self.assertAlmostEqual(a, b, delta=0.5, msg=f"{at[2]} of {sets}, {counts}")
        bad = self.dir / "bad.stl"
        bad.write_text("nothing of the kind")
        page.driver.find_element("id", "files").send_keys(str(bad))
        page.wait(lambda: page.shows("trouble"))
        self.assertIn("bad.stl", page.text("trouble"))
        self.assertIn("here", page.text("job"), "the part that was there stays")

    def test_what_is_wrong_is_said(self):
        page = self.open()
        page.choose("by", "size")
        page.put("size", "-3")
        page.click("go")
        page.idle()
        self.assertIn("above 0", page.text("trouble"))
        page.put("size", "6")
        page.click("go")
        page.idle()
        self.assertFalse(page.shows("trouble"))
        self.pick_after_input(page)
        page.put("name", "a=b")
        page.click("do-name")
        self.assertIn("no =", page.text("trouble"))

    def pick_after_input(self, page):
        page.choose("shown", "input")
        self.pick(page, "face", "wall")

    def test_a_mesh_is_looked_at_and_saved(self):
        page = self.open()
        made = self.dir / "given.msh"
        subprocess.run([OCTAFRONT, "mesh", SAMPLES / "bracket.stl", "-o", made, "--size", "6", "-q"], check=True)
        page.driver.find_element("id", "files").send_keys(str(made))
        page.wait(lambda: page.shows("step-save") and "given" in page.text("part"))
        page.idle()
        self.assertFalse(page.shows("step-pick"))
        page.click("next")
        self.assertIn("1 of", page.text("worst"))

    def test_it_reads_on_a_phone_and_by_the_keyboard(self):
        page = self.open((390, 844))
        try:
            self.assertLessEqual(page.js("return document.documentElement.scrollWidth"), 390)
            self.pick(page, "face", "wall")
            page.choose("by", "size")
            page.put("size", "6")
            self.mesh(page)
            self.assertLessEqual(page.js("return document.documentElement.scrollWidth"), 390)
            keys = "const c = document.getElementById('canvas'); for (const key of arguments[0]) c.dispatchEvent(new KeyboardEvent('keydown', {key, bubbles: true}))"
            page.js(keys, ["c", "x", "]", "ArrowLeft", "+", "n"])
            self.assertTrue(page.js("return octafront.look.clip.on && octafront.now.worst === 0"))
        finally:
            self.driver.execute_cdp_cmd("Emulation.clearDeviceMetricsOverride", {})

    def test_axe_finds_nothing_serious(self):
        script = axe(self.dir / "axe")
        if script is None:
            self.skipTest("npm has no axe-core here")
        for size in ((1280, 900), (390, 844)):
            for theme in ("light", "dark"):
                page = self.open(size)
                page.js("document.documentElement.dataset.theme = arguments[0]; document.getElementById('more').open = true", theme)
                self.pick(page, "face", "wall")
                page.put("name", "held")
                page.click("do-name")
                page.click("do-walls")
                page.wait(lambda: "elements" in page.text("estimate"))
                self.assertEqual(serious(self.driver, script), [], (size, theme, "set up"))
                page.click("go")
                page.idle()
                page.js("for (const d of document.querySelectorAll('#numbers details')) d.open = true; document.querySelector('[data-axis=y]').click(); document.getElementById('filter').click()")
                page.click("next")
                page.settle()
                self.assertEqual(serious(self.driver, script), [], (size, theme, "looked at"))


def pictures(folder):
    """Of each step, as the page of the documentation tells it, at two widths."""
    from io import BytesIO

    from PIL import Image

    with tempfile.TemporaryDirectory() as scratch:
        program, driver = Program(OCTAFRONT, SAMPLES / "bracket.step"), browser(scratch)
        test = Workbench()
        for width, height in ((1280, 800), (390, 844)):
            page = Page(driver, program.address, (width, height))
            page.settle()

            def keep(step):
                page.settle()
                image = Image.open(BytesIO(driver.get_screenshot_as_png())).convert("RGB")
                image = image.resize((image.width * 3 // 4, image.height * 3 // 4), Image.LANCZOS)
                image.quantize(160, dither=Image.Dither.NONE).save(folder / f"workbench-{step}-{width}.png", optimize=True)

            def see(id):
                page.js("document.getElementById(arguments[0]).scrollIntoView({block: 'start'})", id)

            for face, name in (("wall", "held"), ("face 9", "loaded")):
                test.pick(page, "face", face)
                page.put("name", name)
                page.click("do-name")
            see("step-pick")
            keep("pick")
            test.pick(page, "face", "fillet")
            page.put("local-size", "1.5")
            page.click("do-size")
            test.pick(page, "face", "face 9")
            page.click("do-walls")
            page.put("layers-n", "2")
            page.put("order", "2")
            page.wait(lambda: "elements" in page.text("estimate") and "--size-of" in page.text("estimate"))
            page.click("preview")
            page.idle()
            page.js("document.getElementById('go').scrollIntoView({block: 'end'})")
            keep("sizes")
            page.click("go")
            page.idle()
            keep("mesh")
            page.click("next")
            keep("worst")
            page.put("format", "abaqus")
            page.click("save")
            page.idle()
            see("step-save")
            keep("save")
        driver.quit()
        program.end()


if "--pictures" in sys.argv:
    pictures(pathlib.Path(sys.argv[sys.argv.index("--pictures") + 1]))
else:
    unittest.main(argv=sys.argv[:1] + sys.argv[3:])
