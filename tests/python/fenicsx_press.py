#!/usr/bin/python3
"""The loop of docs/use/move.md: its lines are those of examples/solve/fenicsx_press.py, which runs; the force on a mesh that moves
and is mended is that of a fine Lagrangian one, and its elements stay sound. Skipped (77) without DOLFINx."""
import importlib.util
import json
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
EXAMPLE = ROOT / "examples/solve/fenicsx_press.py"


def main():
    page = (ROOT / "docs/use/move.md").read_text(encoding="utf-8")
    section = page.split("## With FEniCSx")[1].split("\n## ")[0]
    printed = re.search(r"```python\n(.*?)```", section, re.S).group(1)
    assert printed in EXAMPLE.read_text(encoding="utf-8"), "the page prints other lines than the example has"
    if importlib.util.find_spec("dolfinx") is None:
        return 77
    with tempfile.TemporaryDirectory() as folder:
        done = subprocess.run([sys.executable, EXAMPLE, "--compare", "--short", "--json"], cwd=folder, check=True, stdout=subprocess.PIPE, text=True)
    found = json.loads(done.stdout.strip().splitlines()[-1])
    fine = {round(height, 6): force for height, force, _, _ in found["lagrangian"]}
    moved = found["moved"]
    assert abs(moved[-1][0] - 0.4) < 1e-12, moved[-1]
    assert len({elements for _, _, elements, _ in moved}) > 1, "it was never mended"
    compared = 0
    for height, force, _, quality in moved:
        assert quality > 0.15, (height, quality)
        if round(height, 6) in fine:
            assert abs(force / fine[round(height, 6)] - 1) < 0.04, (height, force, fine[round(height, 6)])
            compared += 1
    assert compared > 15, compared
    return 0


sys.exit(main())
