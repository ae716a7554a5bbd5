#!/usr/bin/env python3
"""FreeCAD's workbench of addons/freecad: names, sizes, groups, refusals, and a job up to CalculiX's answer; its panel, where Xvfb is.

    freecad_test.py OCTAFRONT [SHAPES...]

Skipped, with status 77, where freecadcmd, Gmsh or ccx is not installed. freecadcmd ends with status 0 whatever happens, so what counts is the file
that its script leaves.
"""
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
sys.path.insert(0, str(ROOT))
from bench.run import freecad as bench  # noqa: E402

SKIPPED = 77
NEAR = .01  # displacement and stress beside Gmsh's at equal elements
EQUAL = .15  # numbers of elements that count as equal, as for --elements; Gmsh's change from run to run


def start(program, scratch, octafront, script, seconds=600):
    around = {**os.environ, "HOME": str(scratch), "OCTAFRONT": octafront, "OCTAFRONT_SCRATCH": str(scratch), "OCTAFRONT_ROOT": str(ROOT),
              "QTWEBENGINE_DISABLE_SANDBOX": "1"}
    done = subprocess.run([*program, str(HERE / script)], env=around, capture_output=True, text=True, errors="replace", timeout=seconds, check=False)
    told = scratch / "told.json"
    if not told.exists():
        raise SystemExit(f"{script} left nothing: {done.stdout[-3000:]}\n{done.stderr[-3000:]}")
    found = json.loads(told.read_text())
    told.unlink()
    return found


def look(found):
    """Prints what each test said; how many failed."""
    for name, what in found.items():
        print("ok    " if not what else "FAILED", name)
        if what:
            print(what)
    return sum(bool(what) for what in found.values())


def solved(octafront, job):
    """The job meshed both ways; what is wrong."""
    gmsh = bench.run(octafront, name=job, mesher="gmsh")
    ours = bench.run(octafront, name=job, mesher="octafront", count=gmsh["tets"])
    print(job, json.dumps({"gmsh": gmsh, "octafront": ours}, indent=1))
    wrong = [f"{job}: {what} is {ours[what]}, by Gmsh {gmsh[what]}" for what in ("displacement", "hot_displacement", "stress")
             if abs(ours[what] / gmsh[what] - 1) > NEAR]
    if abs(ours["tets"] / gmsh["tets"] - 1) > EQUAL:
        wrong.append(f"{job}: {ours['tets']} elements, by Gmsh {gmsh['tets']}")
    wrong += [f"{job}: {what} is {ours[what]}, by the formula {ours['exact_' + of]}" for what, of in (("hot_displacement", "displacement"), ("stress", "stress"))
              if ours["exact_" + of] and abs(ours[what] / ours["exact_" + of] - 1) > NEAR]
    return wrong


def main():
    octafront = str(pathlib.Path(sys.argv[1]).resolve())
    missing = [name for name in ("freecadcmd", "gmsh", "ccx") if not shutil.which(name)]
    if missing:
        print(f"skipped: {', '.join(missing)} is not installed")
        return SKIPPED
    with tempfile.TemporaryDirectory() as folder:
        scratch = pathlib.Path(folder)
        failed = look(start(["freecadcmd"], scratch, octafront, "freecad_inside.py"))
        if shutil.which("xvfb-run") and shutil.which("freecad"):
            modules = scratch / ".local/share/FreeCAD/Mod"
            modules.mkdir(parents=True, exist_ok=True)
            (modules / "Octafront").symlink_to(ROOT / "addons/freecad")
            failed += look(start(["xvfb-run", "-a", "-s", "-screen 0 1300x900x24", "freecad"], scratch, octafront, "freecad_window.py"))
        else:
            print("the panel is not looked at: Xvfb is not installed")
    wrong = [w for job in ("pipe", "two_metals") for w in solved(octafront, job)]
    print("\n".join(wrong))
    return 1 if failed or wrong else 0


if __name__ == "__main__":
    sys.exit(main())
