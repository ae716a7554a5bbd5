"""Runs the experiments of docs/measured/experiments.md and peers.md, and writes these pages. Do not use the machine meanwhile.

Usage: bench/run.sh experiments [STEP...]    steps: dragon compare growth skull peers pictures page
Each step leaves its results in BUILD/experiments, so that single steps can be repeated.
"""
import argparse
import json
import pathlib
import shutil
import subprocess
import sys
import time

from bench.off import write_off
from bench.ours import evaluated, mesh
from bench.pages import experiments_page
from bench.pages.origin import ORIGIN
from bench.peers import surfaces

CLEAN = pathlib.Path("models/clean")
MODELS = [CLEAN / f"{name}.off" for name in ("bunny00", "armadillo", "elephant", "bear", "fandisk_large", "dino", "homer",
                                             "knot1", "femur", "turbine", "anchor_dense")]
DRAGON_SCAN = pathlib.Path("models/dirty/dragon_vrip_res2.ply")
SKULL = pathlib.Path("models/ct/skull_534k.off")
COUNTS = "30000,100000"
GROWTH = "10000,30000,100000,300000,1000000"
SKULL_RUNS = {"automatic": [], "1 M": ["--elements", "1000000"], "5 M": ["--elements", "5000000"]}
IMAGES = pathlib.Path("docs/images")


class Experiments:
    def __init__(self, build):
        self.build = build.resolve()
        self.work = self.build / "experiments"
        self.work.mkdir(exist_ok=True)
        self.octafront = self.build / "cli/octafront"

    def run(self, *command):
        print("+", " ".join(str(c).replace(str(self.build), "BUILD") for c in command), flush=True)
        return subprocess.run([str(c) for c in command])

    def dragon(self):
        """A clean dragon: the scan has holes and crossings, so the boundary of its mesh by the octree method is taken."""
        mesh = self.work / "dragon.mesh"
        self.run(self.octafront, "mesh", DRAGON_SCAN, "-o", mesh, "--method", "octree", "--elements", "400000", "--improve",
                 "none", "-q")
        write_off(self.work / "dragon.off", *surfaces.boundary_of_medit(mesh))

    def compare(self):
        self.run(sys.executable, "bench/run/compare.py", self.octafront, *MODELS, self.work / "dragon.off", "-o", self.work / "compare", "--elements",
                 COUNTS, "--threads", "1")

    def growth(self):
        self.run(sys.executable, "bench/run/compare.py", self.octafront, CLEAN / "bunny00.off", "-o", self.work / "growth", "--elements", GROWTH,
                 "--threads", "1")

    def skull(self):
        rows = {}
        for name, options in SKULL_RUNS.items():
            run = mesh(self.octafront, SKULL, self.work, 3600, *options, out=f"skull-{name[0]}.vtu")
            if run.error:
                rows[name] = None
                continue
            found, why = evaluated(self.build, run.mesh)
            rows[name] = {"report": run.report, "judged": found or {"defect": why}}
        (self.work / "skull-runs.json").write_text(json.dumps(rows))

    def peers(self):
        self.run(sys.executable, "-m", "bench.run.peers", self.build, "--data", self.work / "peers.json")

    def render(self, mesh, name, *options):
        self.run("xvfb-run", "-a", "/usr/bin/python3", "bench/pages/render.py", mesh, IMAGES / f"experiments-{name}.png",
                 "--size", "900", "700", *options)

    def pictures(self):
        IMAGES.mkdir(exist_ok=True)
        for method in ("octree-aft", "aft", "octree"):
            mesh = self.work / f"bunny-{method}.vtu"
            self.run(self.octafront, "mesh", CLEAN / "bunny00.off", "-o", mesh, "--method", method, "--elements", "30000",
                     "-q")
            self.render(mesh, f"bunny-{method}", "--cut", "0,0,1", "--keep", "0.5")
        # The patient's z points up; a cut beside the middle shows the skull's wall from within.
        for name in SKULL_RUNS:
            options = ["--cut", "1,0,0", "--up", "0,0,1", "--view", "1,-0.6,0.35"]
            edges = [] if name == "1 M" else ["--no-edges"]
            self.render(self.work / f"skull-{name[0]}.vtu", f"skull-{name[0]}", "--keep",
                        "1" if name == "automatic" else "0.6", *options, *edges)
        for run in ("compare", "growth"):
            for chart in ("beta_classes", "time_elements", "stages"):
                for ending in ("png", "svg"):
                    made = self.work / run / f"{chart}.{ending}"
                    if made.exists():
                        shutil.copy(made, IMAGES / f"experiments-{run}-{chart}.{ending}")

    def keep_origin(self, step):
        """Which build a step measured: the page may be made later, of steps of several days."""
        if step in MEASURING:
            kept = self.work / "origins.json"
            origins = json.loads(kept.read_text()) if kept.exists() else {}
            kept.write_text(json.dumps(origins | {step: ORIGIN}))

    def page(self):
        experiments_page.page(self.work)
        print("written: docs/measured/experiments.md")


MEASURING = {"compare", "growth", "skull", "peers"}
STEPS = ["dragon", "compare", "growth", "skull", "peers", "pictures", "page"]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("steps", nargs="*", default=STEPS)
    args = parser.parse_args()
    experiments = Experiments(args.build)
    for step in args.steps or STEPS:
        if step not in STEPS:
            parser.error(f"no step {step}")
        start = time.monotonic()
        getattr(experiments, step)()
        experiments.keep_origin(step)
        print(f"{step}: {time.monotonic() - start:.0f} s", flush=True)


if __name__ == "__main__":
    main()
