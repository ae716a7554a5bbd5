#!/usr/bin/env python3
"""A CAD assembly meshed, and solved by CalculiX (Debian: calculix-ccx) under its own weight, all of steel, held at its lowest face.

  bench/campaigns/cad-weight.py FILE [PART [OVERLAP]]      PART: the size is this part of the diagonal; OVERLAP: of `--overlap`

For one, bench/campaigns/cad-weight.py cad-models/Motor-c.brep 40 later. Prints regions, nodes, the largest displacement, and
the reaction beside the weight: nodes that are held carry what lies on them themselves.
"""
import json
import math
import pathlib
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "examples" / "solve"))
import ccx  # noqa: E402

OCTAFRONT = "build/release/cli/octafront"
DENSITY, GRAVITY = 7.85e-9, 9810.0  # t/mm^3, mm/s^2


def mesh(file, part, overlap, work):
    info = json.loads(subprocess.run([OCTAFRONT, "info", file, "--json", "-"], check=True, capture_output=True).stdout)
    (x0, y0, z0), (x1, y1, z1) = info["box"]
    diagonal = math.dist((x0, y0, z0), (x1, y1, z1))
    near = 1e-6 * diagonal
    lowest = f"held=box:{x0 - near},{y0 - near},{z0 - near},{x1 + near},{y1 + near},{z0 + near}"
    subprocess.run([OCTAFRONT, "mesh", file, "-o", work / "weight-mesh.inp", "--overlap", overlap, "--group", lowest,
                    "--size", str(diagonal / part), "--json", work / "weight.json", "-q"], check=True)
    return json.loads((work / "weight.json").read_text())


def regions_in(inp):
    names = []
    for line in open(inp):
        if line.startswith("*ELEMENT") and "ELSET=" in line and "C3D4" in line:
            names.append(line.split("ELSET=")[1].split(",")[0].strip())
    return names


def deck(regions):
    sections = "".join(f"*SOLID SECTION, ELSET={r}, MATERIAL=STEEL\n" for r in regions)
    loads = "".join(f"{r}, GRAV, {GRAVITY}, 0., 0., -1.\n" for r in regions)
    return ("*INCLUDE, INPUT=weight-mesh.inp\n*MATERIAL, NAME=STEEL\n*ELASTIC\n210000., 0.3\n*DENSITY\n"
            f"{DENSITY}\n{sections}*BOUNDARY\nheld, 1, 3\n*STEP\n*STATIC, SOLVER=ITERATIVE CHOLESKY\n*DLOAD\n{loads}"
            "*NODE PRINT, NSET=held, TOTALS=ONLY\nRF\n*NODE FILE\nU\n*END STEP\n")


def main():
    file, part = sys.argv[1], float(sys.argv[2]) if len(sys.argv) > 2 else 40
    work = pathlib.Path("out/weight")
    work.mkdir(parents=True, exist_ok=True)
    report = mesh(file, part, sys.argv[3] if len(sys.argv) > 3 else "auto", work)
    regions = regions_in(work / "weight-mesh.inp")
    (work / "weight.inp").write_text(deck(regions))
    ccx.run(work / "weight.inp")
    moved = ccx.frd(work / "weight.frd")["DISP"]
    node, most = max(((n, math.hypot(*u[:3])) for n, u in moved.items()), key=lambda nu: nu[1])
    reaction = float((work / "weight.dat").read_text().split()[-1])
    print(f"{file}: {len(regions)} regions, {report['points']} nodes, {report['tets']} elements")
    print(f"largest displacement {most:.4g} mm at node {node}; reaction {reaction:.4g} N, weight "
          f"{DENSITY * GRAVITY * report['volume']:.4g} N")


main()
