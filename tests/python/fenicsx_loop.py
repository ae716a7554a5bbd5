#!/usr/bin/python3
"""The loop of docs/use/adapt.md: its lines are those of examples/solve/fenicsx_loop.py, which runs, and whose adapted meshes have
six tenths of the error of uniform ones of as many unknowns. Skipped (77) without DOLFINx."""
import importlib.util
import json
import math
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
EXAMPLE = ROOT / "examples/solve/fenicsx_loop.py"


def slope(rows):
    return math.log(rows[-1]["error"] / rows[0]["error"]) / math.log(rows[-1]["unknowns"] / rows[0]["unknowns"])


def main():
    page = (ROOT / "docs/use/adapt.md").read_text(encoding="utf-8")
    section = page.split("## A loop with FEniCSx")[1].split("## ")[0]
    printed = re.search(r"```python\n(.*?)```", section, re.S).group(1)
    assert printed in EXAMPLE.read_text(encoding="utf-8"), "the page prints other lines than the example has"
    if importlib.util.find_spec("dolfinx") is None:
        return 77
    with tempfile.TemporaryDirectory() as folder:
        done = subprocess.run([sys.executable, EXAMPLE, "--json", "--short"], cwd=folder, check=True, stdout=subprocess.PIPE, text=True)
    found = json.loads(done.stdout.strip().splitlines()[-1])
    uniform, adapted = found["uniform"], found["metric"]
    print(uniform, adapted)
    assert slope(adapted) < -0.3, slope(adapted)
    assert slope(found["sizes"]) < -0.25, slope(found["sizes"])
    last, first = uniform[-1], adapted[0]
    # By their theory a uniform mesh of as many unknowns as the first adapted one has this error.
    as_many = last["error"] * (last["unknowns"] / first["unknowns"]) ** (2 / 9)
    assert first["error"] < 0.6 * as_many, (first, as_many)
    return 0


sys.exit(main())
