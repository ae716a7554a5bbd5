"""Fetched models through the command line: models_test.py OCTAFRONT MODELS_DIR [--slow].

Clean models must give a mesh (the tool checks it before it writes); dirty ones a refusal with a reason, or a mesh, and as
they are with `--repair none`. With --slow those that take 4 s or more, else all others.
"""
import concurrent.futures
import os
import pathlib
import subprocess
import sys
import tempfile

SKIPPED = 77
SECONDS_PER_MODEL = 300
SLOW = set("""3torus armadillo bear bunny00 cheese couplingdown dino elephant femur homer knot knot1 mpi_triang
              refined_elephant triceratops turbine""".split())


def run(octafront, model, *options):
    """None if all is well, else what went wrong."""
    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder, "mesh.vtu")
        try:
            done = subprocess.run([octafront, "mesh", model, "-o", out, "--threads", "1", "-q", *options],
                                  capture_output=True, text=True, timeout=SECONDS_PER_MODEL)
        except subprocess.TimeoutExpired:
            return "no end"
        dirty = model.parent.name == "dirty"
        if done.returncode == 0:
            return None if out.exists() else "status 0 but no mesh"
        if dirty and done.returncode == 3 and len(done.stderr) > 30 and not out.exists():
            return None
        return f"status {done.returncode}: {done.stderr.strip()[:300]}"


def main(octafront, models, *options):
    models = pathlib.Path(models)
    slow = "--slow" in options
    jobs = [(m,) for m in sorted(models.glob("clean/*")) if (m.stem in SLOW) == slow]
    # Where only robustness counts, a coarse mesh is enough.
    jobs += [(m, "--elements", "20000", "--repair", "none") for m in sorted(models.glob("dirty/*")) if not slow]
    if not jobs:
        print(f"no models in {models}: run bench/models/get-models.sh to fetch them")
        return SKIPPED
    failures = 0
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for job, wrong in zip(jobs, pool.map(lambda j: run(octafront, *j), jobs)):
            if wrong:
                failures += 1
                print(f"{job[0].parent.name}/{job[0].name}: {wrong}", flush=True)
    print(f"{len(jobs) - failures} passed, {failures} failed")
    return 1 if failures else 0


sys.exit(main(*sys.argv[1:]))
