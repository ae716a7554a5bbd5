"""Octafront as a program: run in a process of its own, its report read, its meshes judged by octafront_evaluate."""
import argparse
import json
import pathlib

from bench.process import finish, run_measured


def asked_program():
    """Of a benchmark's command line, BUILD [--program FILE]: the octafront to run."""
    arguments = argparse.ArgumentParser()
    arguments.add_argument("build", type=pathlib.Path)
    arguments.add_argument("--program", type=pathlib.Path)
    a = arguments.parse_args()
    return (a.program or a.build / "cli/octafront").resolve()


def mesh(program, source, folder, timeout, *options, out="out.vtu", threads=1):
    """An Outcome with the mesh, FOLDER/OUT, and the report. `source`: a file as seen from here, or a formula."""
    made, report = (pathlib.Path(folder).resolve() / name for name in (out, "report.json"))
    report.unlink(missing_ok=True)
    outcome = run_measured([program, "mesh", source, "-o", made, "--json", report, "--threads", threads, "-q", *options], ".", timeout)
    if not outcome.error:
        outcome.report = json.loads(report.read_text())
    return finish(outcome, made)


class Runs:
    """Commands of ours on one thread, whose files are in one folder."""

    def __init__(self, build, folder):
        self.program, self.folder = build / "cli/octafront", pathlib.Path(folder)

    def run(self, *words, timeout=1200):
        """(report, Outcome); SystemExit says what failed."""
        report = self.folder / "report.json"
        report.unlink(missing_ok=True)
        done = run_measured([self.program, *words, "-q", "--threads", 1, "--json", report], ".", timeout)
        if done.error:
            raise SystemExit(f"{done.command}: {done.log.strip() or done.error}")
        return json.loads(report.read_text()), done


def evaluated(build, file, *more, timeout=600):
    """What octafront_evaluate says of a mesh, or in words why it cannot read it: (figures or None, words)."""
    done = run_measured([build / "bench/octafront_evaluate", file, *more], ".", timeout)
    return (None, done.log.strip()[:120] or done.error) if done.error else (json.loads(done.log), "")


def stage(report, name):
    return next(s for s in report["stages"] if s["name"] == name)


def stages(report, *names):
    """Those whose names begin so: tries that were not kept stand by themselves."""
    return [s for s in report["stages"] if s["name"].startswith(names)]


def cpu_seconds(report, *names):
    return sum(s["cpu_seconds"] for s in stages(report, *names))


def counter(report, name, key):
    return next((s["counters"][key] for s in report["stages"] if s["name"] == name and key in s["counters"]), 0)
