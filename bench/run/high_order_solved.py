"""The part of bench/run.sh high_order that solves: Poisson's equation with a known solution on a ball and on a plate with a hole (STEP files), at
orders 1 to 4, by DOLFINx and by MFEM. What falls with which power of h, the cube root of the mean volume of elements?"""
import json
import math
import os
import subprocess

import gmsh

from bench.pages.origin import ROOT
from bench.process import run_measured

HEAD = ["body", "order", "size", "elements", "unknowns", "error, DOLFINx", "falls", "error, MFEM", "falls, MFEM", "CPU s, DOLFINx", "CPU s, MFEM"]
SIZES = {"ball": {1: (0.3, 0.2, 0.1), 2: (0.3, 0.2, 0.1), 3: (0.3, 0.2, 0.15), 4: (0.3, 0.2, 0.15)},
         "plate": {1: (0.3, 0.2, 0.1), 2: (0.3, 0.2, 0.1), 3: (0.4, 0.3, 0.2), 4: (0.4, 0.3, 0.2)}}
NOT_HERE = "not installed"


def write_step(file):
    gmsh.clear()
    occ = gmsh.model.occ
    if file.stem == "ball":
        occ.addSphere(0, 0, 0, 1)
    else:
        occ.cut([(3, occ.addBox(0, 0, 0, 4, 4, 1))], [(3, occ.addCylinder(2, 2, -1, 0, 0, 3, 1))])
    occ.synchronize()
    gmsh.write(str(file))


def mfem_program(folder):
    """Built against MFEM where it was built ($MFEM_DIR) or where Debian has it (libmfem-dev); None where it is not."""
    source, program = ROOT / "bench/judges/poisson_mfem.cpp", folder / "poisson_mfem"
    own = os.environ.get("MFEM_DIR")
    places = [f"-I{own}", f"-L{own}"] if own else []
    done = subprocess.run(["g++", "-O1", "-std=c++17", *places[:1], source, "-o", program, *places[1:], "-lmfem", "-lrt"], capture_output=True, check=False)
    return program if done.returncode == 0 else None


def judged(command):
    """What a judge printed last, or None where it does not run."""
    done = run_measured(command, ROOT, 600)
    lines = [line for line in done.log.splitlines() if line.startswith("{")]
    return json.loads(lines[-1]) if lines and not done.error else None


def fall(points):
    """The slope of log error over log h, by least squares."""
    if len(points) < 2:
        return ""
    x, y = [[math.log(p[k]) for p in points] for k in (0, 1)]
    mx, my = sum(x) / len(x), sum(y) / len(y)
    return f"{sum((a - mx) * (b - my) for a, b in zip(x, y)) / sum((a - mx) ** 2 for a in x):.2f}"


def run(made, folder):
    """`made`: makes a mesh and returns its report. The rows."""
    rows, mfem = [], mfem_program(folder)
    for body, of_order in SIZES.items():
        step = folder / f"{body}.step"
        write_step(step)
        for order, sizes in of_order.items():
            seen = {"dolfinx": [], "mfem": []}
            for size in sizes:
                mesh = folder / "solved.msh"
                report, _ = made(step, mesh, "--size", size, "--order", order, "--format", "msh22")
                found = {"dolfinx": judged(["/usr/bin/python3", "-m", "bench.judges.poisson_dolfinx", body, mesh]),
                         "mfem": judged([mfem, body, mesh, order]) if mfem else None}
                for judge, told in found.items():
                    if told:
                        seen[judge].append((report["tets"] ** (-1 / 3), told["error"] / told["of"]))
                first = found["dolfinx"] or found["mfem"] or {"unknowns": ""}
                cells = []
                for judge, told in found.items():
                    cells += [f"{seen[judge][-1][1]:.2e}" if told else NOT_HERE, fall(seen[judge]) if size == sizes[-1] else ""]
                rows.append([body, order, size, f"{report['tets']:,}", f"{first['unknowns']:,}", *cells, *(f"{told['cpu']:.1f}" if told else "" for told in found.values())])
                print(*rows[-1], sep="  ", flush=True)
    return rows


def page(rows):
    """The finest row of each order: its slope is that of all."""
    return [row for row in rows if row[HEAD.index("falls")] or row[HEAD.index("falls, MFEM")]]
