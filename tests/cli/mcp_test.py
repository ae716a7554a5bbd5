"""`octafront serve --mcp`, spoken to line by line: mcp_test.py OCTAFRONT SAMPLES_DIR."""
import base64
import ctypes
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time
import unittest

from mcp_client import Client
from report_schema import breaches

OCTAFRONT, SAMPLES = sys.argv[1], pathlib.Path(sys.argv[2])
TOOLS = ["inspect", "plan", "mesh", "check", "improve", "adapt", "carry", "move", "convert", "explain", "picture"]


class WithServer(unittest.TestCase):
    arguments = ()

    def setUp(self):
        self.scratch = tempfile.TemporaryDirectory()
        self.all = pathlib.Path(self.scratch.name).resolve()
        self.dir, self.outside = self.all / "inside", self.all / "outside"
        self.dir.mkdir(), self.outside.mkdir()
        for name in ("bracket.stl", "gear.obj", "torus_knot.ply"):
            shutil.copy(SAMPLES / name, self.dir)
            shutil.copy(SAMPLES / name, self.outside)
        self.client = Client(OCTAFRONT, *self.arguments, cwd=self.dir)

    def tearDown(self):
        self.assertEqual(self.client.close(), 0)
        self.scratch.cleanup()

    def call(self, tool, **arguments):
        answer = self.client.call(tool, **arguments)
        if not hasattr(self, "schemas"):
            self.schemas = {t["name"]: t["outputSchema"] for t in self.client.request("tools/list")["result"]["tools"]}
        self.assertEqual(breaches(answer, self.schemas[tool]), [], (tool, answer))
        return answer

    def good(self, tool, **arguments):
        answer = self.call(tool, **arguments)
        self.assertNotIn("error", answer)
        self.assertEqual(answer["status"], 0)
        return answer

    def refused(self, tool, code, **arguments):
        answer = self.call(tool, **arguments)
        self.assertIn("error", answer, answer)
        self.assertEqual(answer["error"]["code"], code, answer)
        self.assertNotEqual(answer["status"], 0)
        self.assertTrue(answer["error"]["message"])
        self.assertTrue(answer["next"], "a call that fails says which may help")
        self.assertTrue(all(n["tool"] in TOOLS and n["why"] for n in answer["next"]))
        return answer


class Conversation(WithServer):
    def test_begins_in_every_version_that_it_knows(self):
        self.assertEqual(self.client.hello["protocolVersion"], "2025-06-18")
        self.assertEqual(self.client.hello["serverInfo"]["name"], "octafront")
        for asked, agreed in (("2025-03-26", "2025-03-26"), ("2024-11-05", "2024-11-05"), ("1999-01-01", "2025-06-18")):
            other = Client(OCTAFRONT, cwd=self.dir, protocol=asked)
            self.assertEqual(other.hello["protocolVersion"], agreed)
            self.assertEqual(other.request("ping")["result"], {})
            result = other.request("tools/call", {"name": "check", "arguments": {"input": "bracket.stl"}})["result"]
            self.assertEqual("structuredContent" in result, agreed == "2025-06-18")
            self.assertEqual(json.loads(result["content"][0]["text"])["clean"], True)
            self.assertEqual(other.close(), 0)

    def test_lists_its_tools_with_what_goes_in_and_comes_out(self):
        tools = self.client.request("tools/list")["result"]["tools"]
        self.assertEqual([t["name"] for t in tools], TOOLS)
        for tool in tools:
            self.assertIn(str(self.dir), tool["description"])
            for schema in (tool["inputSchema"], tool["outputSchema"]):
                self.assertEqual(schema["type"], "object")
                try:
                    import jsonschema
                except ImportError:
                    continue
                jsonschema.Draft202012Validator.check_schema(schema)
        mesh = next(t for t in tools if t["name"] == "mesh")["inputSchema"]["properties"]["options"]
        self.assertEqual(mesh["properties"]["order"]["enum"], ["1", "2", "3", "4", 1, 2, 3, 4])
        self.assertIn("max-deviation", mesh["description"])
        self.assertLess(len(json.dumps(tools)), 100_000)

    def test_a_job_from_the_file_to_the_deck(self):
        seen = self.good("inspect", input="bracket.stl")
        self.assertEqual((seen["kind"], seen["clean"]), ("surface", True))
        plan = self.good("plan", input="bracket.stl", options={"size": 5})
        self.assertGreater(plan["dry_run"]["expected_tets"], 1000)
        self.assertAlmostEqual(sum(s["percent_of_elements"] for s in plan["sources"]), 100, delta=1)
        made = self.good("mesh", input="bracket.stl", output=["b.inp", "b.msh"], options={"size": 5, "order": 2, "patches": True})
        self.assertTrue((self.dir / "b.inp").read_text(errors="replace").count("C3D10"))
        self.assertLess(abs(made["tets"] / plan["dry_run"]["expected_tets"] - 1), 0.3)
        self.assertEqual(self.good("check", input="b.msh", options={"solver": "calculix"})["valid"], True)
        self.assertGreater(self.good("improve", input="b.msh", output="c.vtu")["quality"]["beta_min"], 0.2)
        self.good("adapt", input="b.msh", output="d.msh", options={"size": 8})
        self.good("convert", input="c.vtu", output="c.bdf")
        self.assertTrue((self.dir / "c.bdf").exists())
        self.assertIn("beta", " ".join(self.good("explain", file="b.msh")["advice"]))

    def test_what_is_small_is_told_with_places(self):
        seen = self.good("inspect", input="bracket.stl")
        self.assertAlmostEqual(seen["thickness"]["least"], 5, delta=.05)  # the wall of the bracket
        self.assertEqual(len(seen["thickness"]["at"]), 3)
        self.assertLessEqual(seen["thickness"]["least"], seen["thickness"]["tenth"])
        self.assertGreater(seen["shortest_edge"]["length"], 0)
        self.assertIn("thickness", json.dumps(next(t for t in self.client.request("tools/list")["result"]["tools"] if t["name"] == "inspect")["outputSchema"]))

    def with_field(self, mesh, field):
        """An old VTK file, ASCII, with three numbers at each point."""
        text = (self.dir / mesh).read_text()
        count = int(text.split("POINTS ")[1].split()[0])
        numbers = [float(n) for n in text.split("POINTS ")[1].split()[2:2 + 3 * count]]
        rows = [field(*numbers[3 * i:3 * i + 3]) for i in range(count)]
        text = text.partition("POINT_DATA")[0].partition("CELL_DATA")[0]
        (self.dir / mesh).write_text(f"{text}POINT_DATA {count}\nVECTORS u double\n" + "\n".join("%r %r %r" % row for row in rows) + "\n")

    def test_fields_are_carried_and_move_a_mesh(self):
        self.good("mesh", input="bracket.stl", output="old.vtk", options={"size": 8, "ascii": True})
        self.with_field("old.vtk", lambda x, y, z: (0.01 * z, 0.0, 0.002 * x))
        new = self.good("mesh", input="bracket.stl", output="new.vtu", options={"size": 6})
        carried = self.good("carry", input=["old.vtk", "new.vtu"], output="both.vtu", options={"carry": "u"})
        self.assertEqual((carried["carried"][0]["name"], carried["carried"][0]["components"]), ("u", 3))
        self.assertEqual(carried["carry"]["elements"], new["tets"])
        self.assertIn(b'Name="u"', (self.dir / "both.vtu").read_bytes())
        moved = self.good("move", input="both.vtu", output="moved.vtu", options={"displacement": "u"})
        self.assertEqual(moved["history"][-1]["fraction"], 1)
        self.assertEqual(self.good("check", input="moved.vtu")["valid"], True)
        self.refused("carry", "bad_arguments", input="old.vtk", output="x.vtu")
        self.refused("carry", "bad_arguments", input=["old.vtk", "new.vtu", "new.vtu"], output="x.vtu")
        self.refused("carry", "outside_folders", input=["old.vtk", "../outside/gear.obj"], output="x.vtu")
        self.refused("move", "input", input="both.vtu", output="x.vtu", options={"displacement": "nothing"})
        self.refused("move", "usage", input="both.vtu", output="x.vtu")
        self.assertFalse((self.dir / "x.vtu").exists())

    def test_pictures_are_in_the_answer_or_in_a_file(self):
        answer = self.client.request("tools/call", {"name": "picture", "arguments": {"input": "bracket.stl", "options": {"size": "300x200", "cut": "-x"}}})
        text, image = answer["result"]["content"]
        self.assertEqual((text["type"], image["type"], image["mimeType"]), ("text", "image", "image/png"))
        png = base64.b64decode(image["data"])
        self.assertEqual(png[:8], b"\x89PNG\r\n\x1a\n")
        self.assertEqual(int.from_bytes(png[16:20], "big"), 300)
        written = self.good("picture", input="gear.obj", output="g.png", options={"names": True, "size": "300x200"})
        self.assertEqual(written["picture"]["width"], 300)
        self.assertTrue((self.dir / "g.png").read_bytes().startswith(b"\x89PNG"))

    def test_progress_is_told_who_asks(self):
        id = self.client.start("tools/call", {"name": "mesh", "arguments": {"input": "torus_knot.ply", "output": "k.vtu", "options": {"elements": 200000}},
                                              "_meta": {"progressToken": "t1"}})
        self.assertFalse(self.client.answer_to(id)["result"]["isError"])
        told = [n["params"] for n in self.client.notifications if n["method"] == "notifications/progress"]
        self.assertGreater(len(told), 1)
        self.assertTrue(all(n["progressToken"] == "t1" and n["message"] for n in told))
        numbers = [n["progress"] for n in told]
        self.assertEqual(numbers, sorted(set(numbers)), "each is more than the one before")

    def test_a_call_that_is_cancelled_leaves_nothing(self):
        id = self.client.start("tools/call", {"name": "mesh", "arguments": {"input": "torus_knot.ply", "output": "k.vtu", "options": {"elements": 3000000}}})
        waiting = self.client.start("tools/call", {"name": "check", "arguments": {"input": "bracket.stl"}})
        time.sleep(0.7)
        self.assertEqual(self.client.request("ping")["result"], {}, "it listens while it works")
        begun = time.time()
        self.client.notify("notifications/cancelled", {"requestId": id, "reason": "test"})
        self.assertFalse(self.client.answer_to(waiting)["result"]["isError"])
        self.assertLess(time.time() - begun, 15)
        self.assertNotIn(id, [n.get("id") for n in self.client.notifications])
        self.assertFalse((self.dir / "k.vtu").exists())
        self.client.notify("notifications/cancelled", {"requestId": 12345})
        self.assertEqual(self.client.request("ping")["result"], {})

    def test_limits_of_a_call_hold(self):
        self.refused("mesh", "max_elements", input="bracket.stl", output="m.vtu", options={"size": 1}, limits={"elements": 1000})
        begun = time.time()
        self.refused("mesh", "seconds", input="torus_knot.ply", output="m.vtu", options={"elements": 5000000}, limits={"seconds": 1})
        self.assertLess(time.time() - begun, 10)
        self.refused("mesh", "memory", input="torus_knot.ply", output="m.vtu", options={"elements": 2000000}, limits={"memory_mb": 80})
        self.assertEqual(sorted(p.name for p in self.dir.iterdir()), ["bracket.stl", "gear.obj", "torus_knot.ply"])

    def test_a_failed_call_says_what_may_help(self):
        bad = self.refused("mesh", "unknown_option", input="bracket.stl", output="m.vtu", options={"sise": 2})
        self.assertIn("did you mean size?", bad["error"]["message"])
        self.assertIn("sise", self.good("explain")["text"])
        self.assertIn("Edge length", self.good("explain", option="--size")["text"])
        (self.dir / "open.stl").write_text("solid o\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid\n")
        open_one = self.refused("mesh", "input", input="open.stl", output="m.vtu")
        self.assertEqual(open_one["next"][0], {"tool": "inspect", "why": open_one["next"][0]["why"], "arguments": {"input": "open.stl"}})
        self.assertEqual(self.good("inspect", input="open.stl")["clean"], False)
        self.assertTrue(self.good("explain", file="open.stl")["advice"])
        self.refused("inspect", "input", input="missing.stl")
        self.refused("mesh", "output", input="bracket.stl", output="no/such/folder/m.vtu")
        self.refused("mesh", "usage", input="bracket.stl", output="m.vtu", options={"size": -1})

    def test_lists_of_messages_in_the_version_that_has_them(self):
        other = Client(OCTAFRONT, cwd=self.dir, protocol="2025-03-26")
        other.send(json.dumps([{"jsonrpc": "2.0", "id": "a", "method": "ping"}, {"jsonrpc": "2.0", "method": "notifications/x"},
                               {"jsonrpc": "2.0", "id": "b", "method": "tools/call", "params": {"name": "check", "arguments": {"input": "bracket.stl"}}}]))
        answers = other.receive()
        self.assertEqual(sorted(a["id"] for a in answers), ["a", "b"])
        self.assertEqual(other.close(), 0)

    def test_who_goes_away_leaves_no_process(self):
        other = Client(OCTAFRONT, cwd=self.dir)
        other.start("tools/call", {"name": "mesh", "arguments": {"input": "torus_knot.ply", "output": "gone.vtu", "options": {"elements": 5000000}}})
        time.sleep(0.7)
        children = subprocess.run(["ps", "-o", "pid=", "--ppid", str(other.process.pid)], capture_output=True, text=True).stdout.split()
        self.assertEqual(len(children), 1)
        self.assertEqual(other.close(), 0)
        self.assertFalse(pathlib.Path(f"/proc/{children[0]}").exists())


class Hostile(WithServer):
    """Whatever comes in: an error with a type, and nothing outside of the folder is read or written."""

    def state_outside(self):
        return sorted((str(p), p.stat().st_mtime_ns, p.read_bytes() if p.is_file() else b"") for p in self.outside.rglob("*"))

    def malformed(self):
        """Lines, and the code of the error; None: no answer at all."""
        request = {"jsonrpc": "2.0", "id": 1, "method": "ping"}
        without = lambda key: {k: v for k, v in request.items() if k != key}
        yield from ((text, -32700) for text in (b"{", b"nonsense", b'{"jsonrpc":"2.0"', b"\xff\xfe\x00", b'{"a":}', b"'", b'{"id":1}}', b"[1,", b'"\\ud800"x', b"\x00"))
        yield from ((text, -32600) for text in (b"1", b"null", b'"text"', b"true", b"[]", b"[1]", b"{}", b"-0", b'[{"jsonrpc":"2.0","id":1,"method":"ping"}]'))
        yield from ((json.dumps(m).encode(), -32600) for m in (without("jsonrpc"), without("method"), {**request, "jsonrpc": "1.0"}, {**request, "jsonrpc": 2},
                    {**request, "method": 7}, {**request, "method": None}, {**request, "id": None}, {**request, "id": {}}, {**request, "id": []},
                    {**request, "id": 1.5}, {**request, "id": True}))
        yield from ((json.dumps({**request, "method": m}).encode(), -32601) for m in ("", "pong", "tools", "tools/call/x", "resources/list", "prompts/list", "x" * 5000,
                    "../../etc/passwd", "tools/call\u0000", "__proto__", "logging/setLevel", "\u202e"))
        yield from ((json.dumps({**request, "method": "tools/call", "params": p}).encode(), -32602) for p in (
            {}, [], "text", 7, {"name": 7}, {"name": None}, {"name": ""}, {"name": "rm"}, {"name": "mesh\n"}, {"name": ["mesh"]}, {"name": "x" * 100000}))
        yield b"[" * 200000, -32600
        yield b'{"jsonrpc":"2.0","id":1,"method":"ping","params":' + b"[" * 50000 + b"]" * 50000 + b"}", -32600
        yield b'{"a":"' + b"x" * (5 << 20) + b'"}', -32600
        yield from ((json.dumps(m).encode(), None) for m in (without("id"), {"jsonrpc": "2.0", "method": "notifications/cancelled", "params": 7},
                    {"jsonrpc": "2.0", "method": "notifications/cancelled", "params": {"requestId": {"a": []}}}, {"jsonrpc": "2.0", "id": 9, "result": {}}))
        yield b"   ", None

    def test_malformed_messages(self):
        count = 0
        for line, code in self.malformed():
            self.client.send(line)
            if code is not None:
                answer = self.client.receive(20)
                self.assertEqual(answer.get("error", {}).get("code"), code, line[:200])
                self.assertTrue(answer["error"]["message"])
                self.assertEqual(answer["jsonrpc"], "2.0")
            count += 1
            self.assertEqual(self.client.request("ping", seconds=20)["result"], {}, line[:200])
        self.assertGreater(count, 55)

    def bad_calls(self):
        """(tool, arguments, code)"""
        inside = {"input": "bracket.stl"}
        for arguments in ({}, {"input": 7}, {"input": None}, {"input": ""}, {"input": []}, {"input": ["a", 7]}, {"input": "-"}, {"input": "a\0b"}, {"input": {"a": 1}},
                          {**inside, "outptu": "x"}, {**inside, "options": []}, {**inside, "options": {"size": {}}}, {**inside, "options": {"size": ""}},
                          {**inside, "options": {"size": True}}, {**inside, "options": {"patches": 3}}, {**inside, "limits": 3}, {**inside, "limits": {"elements": -1}},
                          {**inside, "limits": {"seconds": "1"}}, {**inside, "limits": {"memory_mb": 1}}):
            yield "plan", arguments, "bad_arguments"
        yield "mesh", inside, "bad_arguments"
        yield "mesh", {**inside, "output": "-"}, "bad_arguments"
        yield "mesh", {**inside, "output": []}, "bad_arguments"
        for option in ("json", "output", "within", "threads", "memory", "quiet", "help", "-o", "--size", "size=3 --output", "o", "dry-run"):
            yield "mesh", {**inside, "output": "m.vtu", "options": {option: str(self.outside / "x.json")}}, "unknown_option"
        out = str(self.outside)
        os.symlink(self.outside, self.dir / "link"), os.symlink(self.outside / "bracket.stl", self.dir / "linked.stl")
        os.symlink(self.outside / "new.vtu", self.dir / "new.vtu"), os.symlink("..", self.dir / "up")
        for name in (out + "/bracket.stl", "../outside/bracket.stl", "link/bracket.stl", "linked.stl", "up/outside/bracket.stl", "./x/../../outside/bracket.stl",
                     "/etc/passwd", "/dev/stdin", "/proc/self/environ", "..", "/", "/root", "link", out):
            for tool in ("inspect", "picture", "check"):
                yield tool, {"input": name}, "outside_folders"
            yield "explain", {"file": name}, "outside_folders"
        for name in (out + "/m.vtu", "../outside/m.vtu", "link/m.vtu", "new.vtu", "/dev/stdout", "/dev/full", "/tmp/octafront-mcp-test.vtu", "up/m.vtu", "../m.vtu"):
            yield "mesh", {**inside, "output": name}, "outside_folders"
            yield "mesh", {**inside, "output": ["good.vtu", name]}, "outside_folders"
        yield "picture", {**inside, "output": "../p.png"}, "outside_folders"
        yield "mesh", {"input": ["bracket.stl", "../outside/gear.obj"], "output": "m.vtu"}, "outside_folders"

    def test_calls_that_cannot_be(self):
        before, count = self.state_outside(), 0
        for tool, arguments, code in self.bad_calls():
            self.refused(tool, code, **arguments)
            count += 1
        self.assertGreater(count, 100)
        self.assertEqual(self.state_outside(), before)
        self.assertFalse((self.dir / "good.vtu").exists())
        self.assertFalse(os.path.exists("/tmp/octafront-mcp-test.vtu"))

    def test_files_that_name_files_outside(self):
        """Options that take a file, and files that lead to others."""
        before = self.state_outside()
        os.symlink(self.outside, self.dir / "link")
        here = {"input": "bracket.stl", "output": "m.vtu"}
        (self.outside / "names.txt").write_text("3 secret-word\n")
        (self.outside / "rules.txt").write_text("secret-word\n")
        before = self.state_outside()
        for options in ({"surface-of": "1=link/gear.obj"}, {"sheet": "link/gear.obj"}, {"wire": "../outside/gear.obj"}, {"points": "link/gear.obj"},
                        {"regions": "../outside/rules.txt"}, {"point-sizes": str(self.outside / "rules.txt")}, {"size-field": "link/rules.txt"},
                        {"contact": "link/rules.txt"}, {"report": "../outside/page.html"}, {"defects": "link/d.ply"}, {"material": "link/rules.txt"}):
            answer = self.call("mesh", **here, options=options)
            self.assertIn("error", answer, options)
            self.assertNotIn("secret-word", json.dumps(answer), options)
            self.assertEqual(self.state_outside(), before, options)
        (self.dir / "image.mhd").write_text("ObjectType = Image\nNDims = 3\nDimSize = 2 2 2\nElementType = MET_UCHAR\nElementSpacing = 1 1 1\nElementDataFile = ../outside/bracket.stl\n")
        (self.dir / "image.nrrd").write_text("NRRD0004\ntype: uchar\ndimension: 3\nsizes: 2 2 2\nencoding: raw\ndata file: ../outside/bracket.stl\n\n")
        (self.dir / "mesh.xdmf").write_text('<?xml version="1.0"?><Xdmf Version="3.0"><Domain><Grid><Topology TopologyType="Tetrahedron" NumberOfElements="1">'
                                            '<DataItem Dimensions="1 4" Format="HDF" NumberType="Int">../outside/a.h5:/t</DataItem></Topology><Geometry GeometryType="XYZ">'
                                            '<DataItem Dimensions="4 3" Format="HDF">../outside/a.h5:/p</DataItem></Geometry></Grid></Domain></Xdmf>')
        for name in ("image.mhd", "image.nrrd", "mesh.xdmf"):
            answer = self.call("inspect", input=name)
            self.assertIn("error", answer, name)
            self.assertIn("outside", answer["error"]["message"], name)
        self.assertEqual(self.state_outside(), before)

    def test_what_is_run_cannot_leave_the_folders(self):
        """By the kernel: a reader of CAD that tries."""
        if ctypes.CDLL(None).syscall(444, None, 0, 1) < 1:
            self.skipTest("this kernel has no Landlock")
        tools = self.all / "tools"
        tools.mkdir()
        reader = tools / "reader"
        reader.write_text(f"#!/bin/sh\ncat {self.outside}/bracket.stl > {self.dir}/stolen\necho x > {self.outside}/made\necho y > {self.dir}/allowed\n")
        reader.chmod(0o755)
        shutil.copy(SAMPLES / "bracket.step", self.dir)
        other = Client(OCTAFRONT, cwd=self.dir, env={**os.environ, "OCTAFRONT_CAD": str(reader)})
        self.assertIn("error", other.call("inspect", input="bracket.step"))
        self.assertEqual(other.close(), 0)
        self.assertTrue((self.dir / "allowed").exists(), "it ran")
        self.assertFalse((self.outside / "made").exists())
        self.assertEqual((self.dir / "stolen").read_text(), "")

    def test_calls_of_the_same_id_and_too_many(self):
        for _ in range(70):
            self.client.start("tools/call", {"name": "check", "arguments": {"input": "bracket.stl"}}, id="same")
        answers = [self.client.receive() for _ in range(70)]
        self.assertGreater(sum("error" in a for a in answers), 0, "an id that waits is not given again")
        self.assertGreater(sum("result" in a for a in answers), 0)


class Within(unittest.TestCase):
    """`--within` of every command, which the server gives to what it runs."""

    def test_holds_for_what_is_read_and_written(self):
        with tempfile.TemporaryDirectory() as folder:
            inside, outside = pathlib.Path(folder) / "in", pathlib.Path(folder) / "out"
            inside.mkdir(), outside.mkdir()
            shutil.copy(SAMPLES / "bracket.stl", inside)
            def status(*arguments):
                return subprocess.run([OCTAFRONT, *map(str, arguments), "--within", inside, "-q"], capture_output=True, timeout=60).returncode
            self.assertEqual(status("check", inside / "bracket.stl"), 0)
            self.assertEqual(status("check", SAMPLES / "bracket.stl"), 7)
            self.assertEqual(status("mesh", inside / "bracket.stl", "-o", inside / "m.vtu", "--size", 8), 0)
            self.assertEqual(status("mesh", inside / "bracket.stl", "-o", outside / "m.vtu", "--size", 8), 7)
            self.assertEqual(status("convert", inside / "m.vtu", "-o", outside / "m.xdmf"), 7)
            os.symlink(outside / "new.vtu", inside / "new.vtu")
            self.assertEqual(status("convert", inside / "m.vtu", "-o", inside / "new.vtu"), 7)
            self.assertEqual(list(outside.iterdir()), [])


unittest.main(argv=sys.argv[:1])
