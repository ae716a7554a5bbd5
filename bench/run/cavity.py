"""A lid-driven cavity at Reynolds number 400, solved by OpenFOAM's simpleFoam on tetrahedra, on their polyhedral dual and on polyDualMesh's: beside the
table of Ghia, Ghia and Shin, and beside hexahedra far finer than any of them.

Usage: bench/run.sh cavity [--program OCTAFRONT]
Writes docs/measured/cavity.md.
"""
import pathlib
import re
import shutil
import subprocess
import tempfile

import numpy as np

from bench.judges.foam_mesh import check_mesh, environment, FoamMesh, new_case, verdict, write_dictionary
from bench.models import layers_bodies as bodies
from bench.models.solids import grid, merged
from bench.ours import asked_program
from bench.pages import tables
from bench.pages.origin import written_by
from bench.process import run_measured
from bench.run import layers_solved as flow

REYNOLDS, THICK, FINE = 400, 0.1, 160
SIZES = (0.05, 0.035, 0.025)
# U. Ghia, K. N. Ghia, C. T. Shin, J. Comput. Phys. 48 (1982), table I: y, and u on the line x = 1/2; walls left out.
GHIA = np.array([(0.9766, 0.75837), (0.9688, 0.68439), (0.9609, 0.61756), (0.9531, 0.55892), (0.8516, 0.29093), (0.7344, 0.16256), (0.6172, 0.02135),
                 (0.5, -0.11477), (0.4531, -0.17119), (0.2813, -0.32726), (0.1719, -0.24299), (0.1016, -0.14612), (0.0703, -0.10338),
                 (0.0625, -0.09266), (0.0547, -0.08186)])
PROBES = "\n".join(f"(0.5 {y} {THICK / 2})" for y, _ in GHIA)
CONTROL = f"""application simpleFoam; startFrom startTime; startTime 0; stopAt endTime; endTime 3000; deltaT 1; writeControl timeStep;
writeInterval 3000; writePrecision 12; writeFormat ascii; runTimeModifiable false;
functions {{ line {{ type probes; libs (sampling); interpolationScheme cellPoint; fields (U); writeControl writeTime; probeLocations ({PROBES}); }} }}
"""
WALLS, ENDS = ("lid", "walls"), ("front", "back")


def cavity():
    """Patches lid, walls, front, back of the square slab."""
    flat = lambda corner, u, v: tuple(merged(*grid(lambda s, t: np.array(corner) + s * np.array(u) + t * np.array(v), 1, 1)))
    x, y, z = (1, 0, 0), (0, 1, 0), (0, 0, THICK)
    sides = [flat((0, 0, 0), z, y), flat((1, 0, 0), y, z), flat((0, 0, 0), x, z)]
    points = np.concatenate([p for p, _ in sides])
    shifts = np.cumsum([0, *(len(p) for p, _ in sides[:-1])])
    walls = points, np.concatenate([np.asarray(t) + shift for (_, t), shift in zip(sides, shifts)])
    return bodies.welded({"lid": flat((0, 1, 0), z, x), "walls": walls, "back": flat((0, 0, 0), y, x), "front": flat((0, 0, THICK), x, y)})


def run(command, folder):
    done = run_measured([*map(str, command)], folder, 900)
    if done.error:
        raise SystemExit(f"{done.command}\n{done.error}")
    return done.cpu_seconds


def retype(case, ends):
    """Sides of the slab let the flow slip."""
    boundary = case / "constant/polyMesh/boundary"
    text = boundary.read_text()
    for names, kind in ((WALLS, "wall"), (ENDS, ends)):
        for name in names:
            text = re.sub(rf"(\b{name}\s*{{\s*type)\s+\w+;", rf"\1 {kind};", text)
    boundary.write_text(text)


def write_case(case, ends):
    symmetry = {name: f"type {ends};" for name in ENDS}
    def field(name, kind, dimensions, start, **patches):
        path = case / "0" / name
        path.parent.mkdir(exist_ok=True)
        path.write_text(flow.FIELD.format(name=name, kind=kind, dimensions=dimensions, start=start,
                                          patches="".join(f"  {patch} {{ {what} }}\n" for patch, what in (patches | symmetry).items())))
    field("U", "volVectorField", "[0 1 -1 0 0 0 0]", "(0 0 0)", lid="type fixedValue; value uniform (1 0 0);", walls="type noSlip;")
    field("p", "volScalarField", "[0 2 -2 0 0 0 0]", 0, lid="type zeroGradient;", walls="type zeroGradient;")
    write_dictionary(case, "constant/transportProperties", f"transportModel Newtonian; nu {1 / REYNOLDS!r};\n")
    write_dictionary(case, "constant/turbulenceProperties", "simulationType laminar;\n")
    write_dictionary(case, "system/controlDict", CONTROL)
    write_dictionary(case, "system/fvSchemes", flow.SCHEMES)
    write_dictionary(case, "system/fvSolution", flow.SOLUTION.replace("consistent yes;", "consistent yes; pRefCell 0; pRefValue 0;"))


def solve(case, ends="symmetryPlane"):
    """Middles and volumes of cells, their velocity, that on the line, iterations, CPU seconds."""
    retype(case, ends)
    write_case(case, ends)
    done = subprocess.run(["simpleFoam", "-case", case], capture_output=True, text=True, env=environment(), timeout=1800)
    if "SIMPLE solution converged" not in done.stdout:
        raise SystemExit(done.stdout[-1500:] + done.stderr[-1500:])
    last = max((p for p in case.iterdir() if p.name.isdigit() and p.name != "0"), key=lambda p: int(p.name))
    line = (case / "postProcessing/line/0/U").read_text().splitlines()[-1]
    on_line = np.array(re.findall(r"\((\S+) \S+ \S+\)", line), float)
    _, _, centres, volumes = flow.geometry(FoamMesh(case))
    return {"centres": centres, "volumes": volumes, "U": flow.values_of((last / "U").read_text(), 3), "line": on_line, "iterations": int(last.name),
            "cpu": float(re.findall(r"ExecutionTime = ([\d.]+)", done.stdout)[-1])}


def fine_solution(folder):
    """On hexahedra, one of them thick, as a grid of U by x and y."""
    case = folder / "fine"
    corners = " ".join(f"({x} {y} {z})" for z in (0, THICK) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1)))
    write_dictionary(case, "system/blockMeshDict", f"vertices ({corners}); blocks (hex (0 1 2 3 4 5 6 7) ({FINE} {FINE} 1) simpleGrading (1 1 1)); "
                     "boundary (lid { type wall; faces ((3 7 6 2)); } walls { type wall; faces ((0 4 7 3) (2 6 5 1) (1 5 4 0)); } "
                     "back { type patch; faces ((0 3 2 1)); } front { type patch; faces ((4 5 6 7)); });\n")
    new_case(case)
    subprocess.run(["blockMesh", "-case", case], check=True, capture_output=True, env=environment())
    found = solve(case, "empty")
    order = np.lexsort(np.round(found["centres"][:, :2].T, 9))
    return found, found["U"][order].reshape(FINE, FINE, 3)


def at(fine, points):
    """Linear between the middles of the fine cells."""
    x, y = (np.clip(points[:, k] * FINE - 0.5, 0, FINE - 1.000001) for k in (0, 1))
    i, j = x.astype(int), y.astype(int)
    s, t = (x - i)[:, None], (y - j)[:, None]
    return (1 - t) * ((1 - s) * fine[j, i] + s * fine[j, i + 1]) + t * ((1 - s) * fine[j + 1, i] + s * fine[j + 1, i + 1])


def meshes(program, folder, size):
    """(kind, case, CPU seconds of meshing) on one set of tetrahedra."""
    bodies.write_obj(folder / "in.obj", cavity())
    begun = run([program, "mesh", folder / "in.obj", "--size", size, "-q", "--threads", 1, "-o", folder / "mesh.vtu"], folder)
    for kind, more in (("tetrahedra", []), ("dual", ["--polyhedral"])):
        case = folder / kind
        (case / "constant").mkdir(parents=True)
        yield kind, case, begun + run([program, "convert", folder / "mesh.vtu", *more, "-q", "--threads", 1, "-o", case / "constant/polyMesh"], folder)
    case = folder / "polyDualMesh"
    (case / "constant").mkdir(parents=True)
    shutil.copytree(folder / "tetrahedra/constant/polyMesh", case / "constant/polyMesh")
    for zones in (case / "constant/polyMesh").glob("*Zones"):
        zones.unlink()
    new_case(case)
    with_foam = ["env", f"WM_PROJECT_DIR={environment()['WM_PROJECT_DIR']}"]
    yield "polyDualMesh", case, begun + run([*with_foam, "polyDualMesh", 40, "-overwrite", "-case", case], case)


HEAD = ["edges", "mesh", "cells", "checkMesh", "n-o", "off the table", "off the fine solution, %", "iterations", "meshing, CPU s", "simpleFoam, CPU s"]


def errors(found, fine):
    exact, volumes = at(fine, found["centres"]), found["volumes"]
    off = flow.weighted(np.linalg.norm((found["U"] - exact)[:, :2], axis=1), volumes) / flow.weighted(np.linalg.norm(exact, axis=1), volumes)
    return float(np.sqrt(np.mean((found["line"] - GHIA[:, 1]) ** 2))), off


def rows_of(program, folder, size, fine):
    for kind, case, cpu in meshes(program, folder, size):
        found, foam = solve(case), check_mesh(case)
        table, off = errors(found, fine)
        yield [size, kind, f"{foam['cells']:,}", verdict(foam), f"{foam['non_orthogonality']:.0f}", f"{table:.4f}", f"{100 * off:.2f}", found["iterations"],
               f"{cpu:.1f}", f"{found['cpu']:.1f}"]


ABOUT = (f"A square of side 1 and a slab of it {THICK:g} thick, its front and back planes of symmetry; the lid moves at speed 1, Reynolds number {REYNOLDS}. "
         "`octafront mesh` makes tetrahedra of one size; `convert --polyhedral` their dual, and OpenFOAM's polyDualMesh (v1912) its own of the same. simpleFoam, laminar, second order "
         "throughout, until residuals fall below 1e-6, one core. *Off the table*: root mean square beside u at the 15 inner points of the line x = 1/2 of U. Ghia, K. N. Ghia, "
         f"C. T. Shin, J. Comput. Phys. 48 (1982), of a lid's speed 1; *off the fine solution*: of the velocity over the volume, beside {FINE} x {FINE} hexahedra, linear between "
         "their middles. *n-o*: most non-orthogonality, degrees. ")


def main():
    program = asked_program()
    rows = []
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(temporary)
        found, fine = fine_solution(folder)
        rows.append([1 / FINE, "hexahedra", f"{FINE**2:,}", "OK", "0", f"{errors(found, fine)[0]:.4f}", "", found["iterations"], "", f"{found['cpu']:.1f}"])
        print(tables.row(rows[-1]), flush=True)
        for size in SIZES:
            (folder / str(size)).mkdir()
            for row in rows_of(program, folder / str(size), size, fine):
                rows.append(row)
                print(tables.row(row), flush=True)
    tables.write("cavity", ["# A lid-driven cavity", "", f"{written_by('bench/run.sh cavity')}. {ABOUT}", "", *tables.table(HEAD, rows), "",
                            f"As a file: {tables.put('cavity', HEAD, rows)}.", ""])


if __name__ == "__main__":
    main()
