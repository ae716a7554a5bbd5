#!/usr/bin/env python3
"""Attacks the command line, and judges how it takes it: attack.py OCTAFRONT [--only PART] [--runs N] [--seed S] [-v]

Whatever the input, the options and the moment of a signal: no crash, no status of a bug (1), no end later than a limit says, nothing
on standard error or output that moves a cursor, no half-written file and none left behind, JSON of a failed run with status,
kind, code and message. Parts: options, files, mutated, places, names, signals, disks, memory. A run is drawn by its seed.
Prints what it found, and ends with status 1 if there was anything.
"""
import argparse
import json
import os
import pathlib
import random
import re
import resource
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import time

STATUSES = {0: None, 2: "usage", 3: "input", 4: "meshing", 5: "output", 6: "memory", 7: "limit", 130: "interrupted"}
CONTROLS = re.compile("[\x00-\x08\x0b-\x1f\x7f\x80-\x9f\u2028-\u202e\u2066-\u2069]")
CUBE = [(0, 2, 3), (0, 3, 1), (4, 5, 7), (4, 7, 6), (0, 1, 5), (0, 5, 4), (2, 6, 7), (2, 7, 3), (0, 4, 6), (0, 6, 2), (1, 3, 7),
        (1, 7, 5)]
SECONDS = 20  # of one run; the limits that runs are given are far below
MESH_ENDINGS = ("vtu", "vtk", "msh", "inp", "bdf", "unv", "med", "xdmf", "e", "cdb", "k", "feb", "su2", "foam", "cgns", "mesh",
                "meshb", "vol", "ele", "pvtu", "vtkhdf")


def box_off(n=1, size=1.0):
    corners = [(x * size, y * size, z * size) for z in (0, 1) for y in (0, 1) for x in (0, 1)]
    return "\n".join(["OFF", f"8 {len(CUBE)} 0", *("{} {} {}".format(*c) for c in corners),
                      *("3 {} {} {}".format(*f) for f in CUBE)]) + "\n"


class Attack:
    def __init__(self, program, seed, verbose):
        self.program, self.random, self.verbose = program, random.Random(seed), verbose
        self.found, self.runs, self.by_status = [], 0, {}
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="attack-"))
        (self.folder / "box.off").write_text(box_off())

    def fresh(self):
        place = self.folder / "run"
        shutil.rmtree(place, ignore_errors=True)
        place.mkdir()
        return place

    def blame(self, what, arguments, done=None):
        words = " ".join(ascii(str(a))[1:-1] for a in arguments)
        self.found.append(f"{what}: {words[:400]}")
        print("FOUND", self.found[-1], flush=True)
        if done is not None:
            print("     ", ascii(done.stderr[-600:]), flush=True)

    def run(self, *arguments, json_to_stdout=True, may=None, seconds=SECONDS, **options):
        """Runs the program and judges all that holds for every run; `may`: the statuses that are right."""
        arguments = [str(a) for a in arguments]
        if json_to_stdout and "-" not in arguments:
            arguments += ["--json", "-"]
        command = [self.program, *arguments]
        self.runs += 1
        started, also = time.time(), options.pop("preexec_fn", None)

        def limited():
            # Of the processor, for other work may have the machine; who comes to it is ended by SIGXCPU.
            resource.setrlimit(resource.RLIMIT_CPU, (6 * seconds, 6 * seconds + 5))
            if also is not None:
                also()

        try:
            done = subprocess.run(command, capture_output=True, timeout=3600, stdin=subprocess.DEVNULL, preexec_fn=limited, **options)
        except subprocess.TimeoutExpired:
            self.blame("no end within an hour", arguments)
            return None
        except (ValueError, OSError):  # the system takes no such argument
            return None
        done.stdout, done.stderr = done.stdout.decode(errors="replace"), done.stderr.decode(errors="replace")
        status = done.returncode
        self.by_status[status] = self.by_status.get(status, 0) + 1
        if self.verbose:
            print(status, f"{time.time() - started:.1f}", ascii(" ".join(arguments))[:160], flush=True)
        if status not in STATUSES:
            self.blame(f"status {status}", arguments, done)
        elif may is not None and status not in may:
            self.blame(f"status {status}, not {may}", arguments, done)
        if status != 0 and not done.stderr.strip():
            self.blame("fails without a word", arguments, done)
        if "bug of ours" in done.stderr:
            self.blame("a bug by its own words", arguments, done)
        if CONTROLS.search(done.stderr) or (json_to_stdout and CONTROLS.search(done.stdout)):
            self.blame("control characters", arguments, done)
        if json_to_stdout and arguments[-1] == "-" and arguments[-2] == "--json" and arguments[:1] not in (["help"], ["completion"]):
            self.judge_json(done, arguments)
        return done

    def judge_json(self, done, arguments):
        try:
            told = json.loads(done.stdout)
        except ValueError:
            return self.blame("no JSON", arguments, done)
        if told.get("status") != done.returncode:
            self.blame(f"JSON says status {told.get('status')} of {done.returncode}", arguments, done)
        error = told.get("error")
        if done.returncode == 0:
            if error is not None:
                self.blame("an error of a run that did what it should", arguments, done)
            return None
        if not isinstance(error, dict) or not {"status", "kind", "code", "message"} <= set(error):
            return self.blame("JSON of a failure lacks keys", arguments, done)
        if error["kind"] != STATUSES.get(done.returncode, error["kind"]) or not error["message"].strip():
            self.blame("JSON of a failure does not fit", arguments, done)
        return None

    def judge_folder(self, place, known, arguments):
        """Nothing is there that was not, but for outputs that are whole."""
        for path in place.rglob("*"):
            if path.name.startswith(".octafront") and path not in known:
                self.blame(f"left behind: {path.name}", arguments)

    # --- parts ---

    def options(self, runs):
        """Every option of every command with values that nobody means."""
        values = ["nan", "inf", "-inf", "-1", "0", "1e308", "-1e308", "1e-320", "1e999", "99999999999999999999", "0x10", "1,2", "=", ",",
                  ";", ":", "@", "1e5", "2", ".5", "\x1b[31m", "\u202e", "a\nb", "x" * 5000, "%s%n", "/", "..", "-", "--", "1 2", "nan,nan,nan",
                  "box:0,0,0,1,1,1", "box:nan,0,0,1,1,1", "a=1", "a=nan", "a=box:0,0,0,1,1,1", "0,0,0=1:1", "0,0,0", "1e300,1e300,1e300", "xyz",
                  "360/0@z", "1e-300@z", "0,0,0,0,0,0", "first", "2mm", "2parsec", "9" * 400]
        commands = {}
        for command in ("mesh", "surface", "repair", "size", "improve", "adapt", "convert", "info", "check", "report"):
            text = subprocess.run([self.program, "help", command, "all"], capture_output=True, text=True).stdout
            commands[command] = sorted(set(re.findall(r"(?<![\w-])--[a-z][a-z-]+", text)) - {"--json", "--help", "--man"})
        mesh = self.folder / "mesh.msh"
        subprocess.run([self.program, "mesh", self.folder / "box.off", "-o", mesh, "--size", "0.5", "-q"], check=True)
        likely = ["0.5", "2", "1e5", "10", "0.01", "1", "a=1", "0,0,0=1:1", "xyz", "fast", "box:0,0,0,1,1,1", "30"]
        for _ in range(runs):
            command = self.random.choice(sorted(commands))
            place = self.fresh()
            outputs = {"mesh": "o.vtu", "surface": "o.ply", "repair": "o.ply", "improve": "o.vtu", "adapt": "o.vtu", "convert": "o.vtu",
                       "report": "o.html"}
            words = [command, mesh if command in ("improve", "adapt", "convert", "report") else self.folder / "box.off"]
            if command in outputs:
                words += ["-o", place / outputs[command]]
            for _ in range(self.random.choice((1, 1, 1, 2, 3))):
                option = self.random.choice(commands[command])
                words += [option, *([self.random.choice(self.random.choice((values, likely)))] if self.random.random() < 0.9 else [])]
            if not {"--cpu-seconds", "--max-elements"} & set(map(str, words)):
                words += ["--cpu-seconds", "5", "--max-elements", "200000"]
            if self.run(*words, cwd=place):
                self.judge_folder(place, (), words)

    def files(self, runs):
        """Things that are no files, and such that hold nothing."""
        place = self.fresh()
        (place / "empty").write_text("")
        (place / "folder").mkdir()
        os.mkfifo(place / "pipe")
        (place / "loop").symlink_to(place / "loop")
        (place / "gone").symlink_to(place / "nowhere")
        (place / "zeros").write_bytes(bytes(100_000))
        (place / "closed").write_text(box_off())
        (place / "closed").chmod(0)
        (place / "text").write_text("hello\n")
        endings = ("off", "stl", "obj", "ply", "msh", "vtu", "vtk", "inp", "bdf", "unv", "med", "xdmf", "mesh", "meshb", "vol", "ele", "nii",
                   "nii.gz", "nrrd", "mhd", "mha", "raw", "json", "dcm", "step", "stpz", "iges", "brep", "poly", "")
        for ending in endings:
            for name in ("empty", "zeros", "text", "gone", "loop"):
                at = place / f"{name}.{ending}" if ending else place / name
                if not at.exists() and not at.is_symlink():
                    shutil.copy(place / name, at) if (place / name).exists() else at.symlink_to(place / name)
                for command in (["info"], ["check"]):
                    self.run(*command, at, may=(3,), cwd=place)
        for name in ("/dev/null", "/dev/zero", "/dev/full", "/dev/stdin", "/proc/self/mem", "/", place / "folder", "nofile", "-"):
            for command in ("info", "check", "mesh", "convert", "improve", "repair"):
                self.run(command, name, *(() if command in ("info", "check") else ("-o", place / "o.vtu")), cwd=place)
        for header in ("scan.mhd", "scan.nhdr", "scan.json", "scan.hdr"):
            for named in ("pipe", "/dev/zero", "../../../../../../etc/passwd", "/etc/passwd", "folder", "loop", ".", ""):
                (place / header).write_text({
                    "scan.mhd": f"NDims = 3\nDimSize = 2 2 2\nElementType = MET_UCHAR\nElementDataFile = {named}\n",
                    "scan.nhdr": f"NRRD0004\ntype: uchar\ndimension: 3\nsizes: 2 2 2\nencoding: raw\ndata file: {named}\n",
                    "scan.json": f'{{"size": [2, 2, 2], "type": "uint8", "file": "{named}"}}', "scan.hdr": "x"}[header])
                self.run("info", place / header, may=(3,), cwd=place)
        # A pipe that nobody writes to is waited for, and a signal ends that.
        waiting = subprocess.Popen([self.program, "info", place / "pipe"], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        time.sleep(0.5)
        waiting.send_signal(signal.SIGINT)
        if waiting.wait(timeout=20) != 130:
            self.blame("a pipe is not left", ["info", "pipe"])

    def mutated(self, runs):
        """Files of every kind with some bytes changed, cut, doubled; read as what they are and under other names."""
        place = self.folder / "seeds"
        place.mkdir()
        seeds = []
        source = self.folder / "small.msh"
        subprocess.run([self.program, "mesh", self.folder / "box.off", "-o", source, "--size", "0.6", "--patches", "-q"], check=True)
        for ending in MESH_ENDINGS:
            for text in ([], ["--ascii"]):
                at = place / f"seed{len(seeds)}.{ending}"
                done = subprocess.run([self.program, "convert", source, "-o", at, *text, "-q"], capture_output=True)
                if done.returncode == 0 and at.is_file():
                    seeds.append(at)
        for ending in ("stl", "obj", "ply", "off"):
            at = place / f"surface.{ending}"
            subprocess.run([self.program, "surface", self.folder / "box.off", "-o", at, "--size", "0.5", "-q"], check=True)
            seeds.append(at)
        samples = pathlib.Path(__file__).resolve().parents[2] / "samples"
        seeds += [p for p in sorted(samples.iterdir()) if p.is_file() and p.stat().st_size < 300_000 and p.suffix not in (".txt", ".md")]
        for _ in range(runs):
            seed = self.random.choice(seeds)
            bytes_ = bytearray(seed.read_bytes())
            for _ in range(self.random.choice((1, 1, 2, 5, 30))):
                at = self.random.randrange(max(1, len(bytes_)))
                kind = self.random.randrange(6)
                if kind == 0:
                    bytes_[at:at + 1] = bytes([self.random.randrange(256)])
                elif kind == 1:
                    del bytes_[at:at + self.random.choice((1, 4, 100))]
                elif kind == 2:
                    bytes_[at:at] = bytes_[at:at + self.random.choice((1, 8, 200))]
                elif kind == 3:
                    bytes_[at:at + 8] = struct.pack("<q", self.random.choice((-1, 0, 2**31, 2**32 - 1, 2**63 - 1, 1 << 40)))
                elif kind == 4:
                    bytes_[at:at] = self.random.choice((b"nan ", b"-1 ", b"1e999 ", b"99999999999 ", b"\x1b[2J", b"\0", b"\n", b"<", b'"'))
                else:
                    del bytes_[at:]
            work = self.fresh()
            at = work / seed.name
            at.write_bytes(bytes_)
            command = self.random.choice((["info"], ["check"], ["mesh", "-o", work / "o.vtu"], ["convert", "-o", work / "o.inp"],
                                          ["repair", "-o", work / "o.ply"]))
            self.run(command[0], at, *command[1:], "--cpu-seconds", "10", "--max-elements", "300000", "--memory", "2GB", cwd=work)
            self.judge_folder(work, (), command)

    def places(self, runs):
        """Outputs where none can be."""
        place = self.fresh()
        box = place / "in.off"
        box.write_text(box_off())
        (place / "closed").mkdir(mode=0o555)
        (place / "folder").mkdir()
        os.mkfifo(place / "pipe.vtu")
        (place / "link.off").symlink_to(box)
        os.link(box, place / "hard.off")
        (place / "chain.vtu").symlink_to(place / "chain2.vtu")
        (place / "chain2.vtu").symlink_to(place / "chain.vtu")
        long = "/".join(["d" * 200] * 20)
        common = ("--size", "0.5")
        for target, may in ((box, (2,)), (place / "link.off", (2, 5)), (place / "hard.off", (2, 5)), (place / "folder", (2, 5)), (place / "pipe.vtu", (5,)),
                            (place / "chain.vtu", (5,)), (place / "no" / "o.vtu", (5,)), (place / ("n" * 300 + ".vtu"), (5,)), (place / long / "o.vtu", (5,)),
                            ("/dev/full", (2, 5)), ("/proc/o.vtu", (5,)), (place / "o", (2, 5)), (place / ".vtu", None), ("", (2,)), (place, (2, 5))):
            done = self.run("mesh", box, "-o", target, *common, may=may, cwd=place)
            if done and box.read_text() != box_off():
                self.blame("the input is overwritten", ["mesh", target])
                box.write_text(box_off())
        with open("/dev/full", "w") as full:
            for words in (["mesh", box, "-o", "-", "--format", "vtu"], ["info", box, "--json", "-"], ["report", box, "-o", "-"], ["help", "mesh"],
                          ["completion", "bash"], ["info", box]):
                code = subprocess.run([self.program, *map(str, words)], stdout=full, stderr=subprocess.DEVNULL).returncode
                if code not in (5, 3, 2):
                    self.blame(f"a full standard output is status {code}", words)
        for closed in ("<&-", ">&-", "2>&-", "<&- >&- 2>&-"):
            out = place / "std.vtu"
            subprocess.run(["bash", "-c", f'"{self.program}" mesh "{box}" -o "{out}" --size 0.5 {closed}'], capture_output=True)
            if not out.exists() or out.stat().st_size < 1000:
                self.blame("no output with a closed stream", [closed])
            out.unlink(missing_ok=True)
        if os.geteuid() != 0:
            self.run("mesh", box, "-o", place / "closed" / "o.vtu", *common, may=(5,), cwd=place)
        self.judge_folder(place, (), ["places"])

    def names(self, runs):
        """Names that no terminal should see."""
        place = self.fresh()
        odd = ["a\nb", "\x1b[31mred", "\x1b]0;title\x07", "\u202ertl", "\x7f", "\x9b31m", "back\\slash", "quo'te\"", "-dash", "--size", "%s%n%x",
               " blank ", "tab\t", "ünï", "日本", "a\rb", "e" * 240, "`size`", "$(reboot)", "{}", "{0}", "\u2028"]
        raw = [b"\xff\xfe", b"\xc0\x80", b"\xed\xa0\x80", b"\xf4\x90\x80\x80", b"ok\xc3"]
        for name in [os.fsencode(n) for n in odd] + raw:
            file = os.fsencode(place) + b"/" + name + b".off"
            with open(file, "w") as out:
                out.write(box_off())
            name = os.fsdecode(file)
            for words in (["info", name], ["check", name], ["check", name + "x"], ["mesh", name, "-o", name + ".vtu", "--size", "0.5"],
                          ["mesh", name, name, "-o", name + ".msh", "--size", "0.5", "--report", name + ".html"], ["convert", name, "-o", name + "o"],
                          ["mesh", name, "-o", name + ".inp", "--size-of", name + "=1"], [name], ["mesh", name, name + "=", "--" + name]):
                self.run(*words, cwd=place)
                plain = self.run(*words, json_to_stdout=False, cwd=place)
                if plain and CONTROLS.search(plain.stdout):
                    self.blame("control characters on standard output", words, plain)
        # Names inside of files: solids, groups, physical names.
        for title in odd[:7] + ["a" * 10000, ""]:
            lines = [f"solid {title}"]
            corners = [(x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1)]
            for face in CUBE:
                lines += ["facet normal 0 0 0", "outer loop", *("vertex {} {} {}".format(*corners[c]) for c in face), "endloop", "endfacet"]
            (place / "named.stl").write_bytes("\n".join(lines + [f"endsolid {title}"]).encode(errors="replace") + b"\n")
            for ending in MESH_ENDINGS:
                done = self.run("mesh", place / "named.stl", "-o", place / f"n.{ending}", "--size", "0.6", json_to_stdout=False, cwd=place)
                if done and CONTROLS.search(done.stdout):
                    self.blame("control characters on standard output", ["named.stl", ending], done)
        (place / "many.obj").write_text(self.many_patches(5000))
        self.run("mesh", place / "many.obj", "-o", place / "many.vtu", "--cpu-seconds", "60", seconds=60, cwd=place)
        self.run("info", place / "many.obj", cwd=place)

    @staticmethod
    def many_patches(count):
        """A box whose faces are cut into strips, a group each."""
        n = count // 4
        lines = []
        for i in range(n + 1):
            lines += [f"v {i / n * 40} {y} {z}" for y, z in ((0, 0), (1, 0), (1, 1), (0, 1))]
        for i in range(n):
            for k in range(4):
                a, b = 4 * i + k + 1, 4 * i + (k + 1) % 4 + 1
                lines += [f"g strip_{i}_{k}", f"f {a} {a + 4} {b + 4}", f"f {a} {b + 4} {b}"]
        lines += ["g ends", "f 1 2 3", "f 1 3 4", f"f {4 * n + 1} {4 * n + 3} {4 * n + 2}", f"f {4 * n + 1} {4 * n + 4} {4 * n + 3}"]
        return "\n".join(lines) + "\n"

    def signals(self, runs):
        """Killed at any moment: old outputs stay, new ones are whole, and the next run clears away what was left."""
        for _ in range(runs):
            place = self.fresh()
            ending = self.random.choice(MESH_ENDINGS)
            box, out = self.folder / "box.off", place / f"o.{ending}"
            parts = ["--parts", "5"] if ending in ("pvtu", "msh", "vtkhdf", "foam") and self.random.random() < 0.7 else []
            words = ["mesh", box, "-o", out, "--size", "0.07", "--improve", "none", *parts, "--threads", "1"]
            if not self.whole(place, words):
                continue
            before = self.contents(place)
            how = self.random.choice((signal.SIGKILL, signal.SIGTERM, signal.SIGINT, signal.SIGHUP))
            running = subprocess.Popen([self.program, *map(str, words), "--json", place / "r.json"], stdout=subprocess.DEVNULL,
                                       stderr=subprocess.PIPE, cwd=place)
            time.sleep(self.random.random() * self.took * 1.1)
            running.send_signal(how)
            running.communicate(timeout=600)
            if how != signal.SIGKILL and running.returncode not in (130, 0, -how):
                self.blame(f"signal {how}: status {running.returncode}", words)
            now = {n: b for n, b in self.contents(place).items() if n != "r.json" and ".octafront" not in n}
            if now != before:
                self.blame(f"signal {how} changed {sorted(set(now) ^ set(before)) or 'bytes'}", words)
            if how != signal.SIGKILL:
                self.judge_folder(place, (), words)
            self.whole(place, words)
            self.judge_folder(place, (), ["after", how, *words])

    def whole(self, place, words):
        begun = time.time()
        done = subprocess.run([self.program, *map(str, words), "-q"], capture_output=True, cwd=place)
        self.took, self.runs = time.time() - begun, self.runs + 1
        return done.returncode == 0

    @staticmethod
    def contents(place):
        return {str(p.relative_to(place)): p.read_bytes() for p in place.rglob("*") if p.is_file()}

    def disks(self, runs):
        """Disks that fill up: by a limit on the size of files, and by a small disk where one may be mounted."""
        small = self.folder / "small-disk"
        small.mkdir(exist_ok=True)
        mounted = subprocess.run(["mount", "-t", "tmpfs", "-o", "size=100k", "none", small], capture_output=True).returncode == 0
        try:
            for ending in MESH_ENDINGS:
                for place in [self.fresh()] + [small] * mounted:
                    words = ["mesh", self.folder / "box.off", "-o", place / f"o.{ending}", "--size", "0.06", "--improve", "none"]
                    if place == small:
                        limit = None
                    else:
                        limit = lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (20000, resource.RLIM_INFINITY))
                    done = self.run(*words, preexec_fn=limit, cwd=self.folder)
                    left = [p for p in place.rglob("*") if p.is_file()]
                    if done and done.returncode != 0 and left:
                        self.blame(f"left on a full disk: {[p.name for p in left][:3]}", words)
                    if done and done.returncode not in (0, 5, 2):
                        self.blame(f"a full disk is status {done.returncode}", words, done)
                    for p in place.iterdir():
                        shutil.rmtree(p) if p.is_dir() else p.unlink()
        finally:
            if mounted:
                subprocess.run(["umount", small], check=True)

    def memory(self, runs):
        """Memory that ends at any moment: a status, never a crash."""
        for _ in range(runs):
            place = self.fresh()
            megabytes = self.random.choice((64, 70, 80, 90, 100, 120, 150, 200))
            words = ["mesh", self.folder / "box.off", "-o", place / f"o.{self.random.choice(MESH_ENDINGS)}", "--size",
                     self.random.choice(("0.02", "0.03", "0.015")), "--memory", f"{megabytes}MB", "--cpu-seconds", "30",
                     "--improve", self.random.choice(("none", "fast"))]
            if self.random.random() < 0.3:
                words += ["--order", "2"]
            self.run(*words, may=(0, 2, 6, 7), cwd=place, seconds=30)
            self.judge_folder(place, (), words)
            limit = int((megabytes + 150 + 300 * self.random.random()) * 1e6)
            self.run(*words[:-4], may=(0, 2, 6, 7), cwd=place, seconds=30,
                     preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (limit, limit)))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("--only", action="append", help="these parts alone")
    parser.add_argument("--runs", type=int, default=100, help="of parts that draw by chance")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("-v", action="store_true", help="a line for each run")
    asked = parser.parse_args()
    attack = Attack(os.path.abspath(asked.program), asked.seed, asked.v)
    try:
        for part in asked.only or ("options", "files", "mutated", "places", "names", "signals", "disks", "memory"):
            before = attack.runs
            getattr(attack, part)(asked.runs)
            print(f"{part}: {attack.runs - before} runs, {len(attack.found)} found so far", flush=True)
    finally:
        shutil.rmtree(attack.folder, ignore_errors=True)
    print(f"{attack.runs} runs, by status {dict(sorted(attack.by_status.items()))}, {len(attack.found)} found")
    return 1 if attack.found else 0


if __name__ == "__main__":
    sys.exit(main())
