"""Are the formulas of answers_cases.py right, and the loads of answers_solved.py? bench/run/answers.py looks before it begins.

A field of stress that is right leaves free sides free and carries the load where it is put; a bar that is pulled has one stress everywhere, in first and in
second order, whatever its mesh.
"""
import pathlib
import tempfile

import numpy as np

from bench.judges.answers_solved import solve
from bench.models import answers_cases as cases
from bench.models.answers_planar import write_step
from bench.run import answers_meshers as meshers

ROUNDING = 1e-9  # of stresses of 100
WRITTEN = 1e-4  # CalculiX writes six digits


def near(what, found, right, bound=ROUNDING):
    off = np.abs(np.asarray(found) - right).max()
    if off > bound * cases.LOAD:
        raise SystemExit(f"{what} is off by {off:.3g}")


def directions(count=50):
    p = np.random.default_rng(1).normal(size=(count, 3))
    return p / np.linalg.norm(p, axis=1)[:, None]


def check_cavity():
    n = directions()
    near("traction on the cavity", cases.cavity_load(cases.CAVITY * n, n), 0)
    near("stress at the equator", cases.stress_of(cases.around_cavity, np.array([[cases.CAVITY, 0, 0]]))[0, 2, 2], cases.cavity().answer[2])


def check_beam():
    x = np.linspace(0, cases.LONG, 9)
    top = np.stack([x, 0 * x + cases.HALF, 0 * x], axis=1)
    def moved(p):
        return np.stack([*cases.beam(p), 0 * p[:, 0]], axis=1)
    free = cases.stress_of(moved, top)
    near("traction on the beam's top", free[:, :2, 1], 0)
    near("bending stress at the wall", abs(free[-1, 0, 0]), cases.cantilever().answer[2])
    end = np.stack([0 * x, np.linspace(-1, 1, 9) * cases.HALF, 0 * x], axis=1)
    near("load at the beam's end", -cases.stress_of(moved, end)[:, 0], cases.beam_end(end, None))


def check_torsion():
    y, weights = np.polynomial.legendre.leggauss(40)
    u, v = (g.ravel() for g in np.meshgrid(*[(y + 1) * cases.BAR / 2] * 2))
    xz, yz = cases.torsion_shear(np.stack([u, v, 0 * u], axis=1))
    torque = (np.outer(weights, weights).ravel() * cases.BAR**2 / 4 * (u * yz - v * xz)).sum()
    near("torque", torque * cases.TWIST * cases.BAR_LONG / 2, cases.torsion().answer[1], 1e-6)


def check_loads():
    """A beam pulled at its end."""
    case = cases.cantilever()
    case.held = [(cases.plane(cases.X, cases.LONG), cases.X, 0), (cases.plane(cases.Y, -cases.HALF), cases.Y, 0), (cases.plane(cases.Z, 0), cases.Z, 0)]
    case.loads = [(cases.plane(cases.X, 0), cases.pressure(-cases.LOAD))]
    with tempfile.TemporaryDirectory() as folder:
        step = pathlib.Path(folder) / "body.step"
        write_step(case.build, step)
        for order in (1, 2):
            outcome, mesh = meshers.meshed(meshers.gmsh(), step, order, 60)
            solved, _, stress = solve(case.problem(mesh), 60)
            near(f"order {order}: {outcome.error or solved.error or 'stress of a bar that is pulled'}", stress, [cases.LOAD, 0, 0, 0, 0, 0], WRITTEN)


def check():
    for one in (check_cavity, check_beam, check_torsion, check_loads):
        one()


if __name__ == "__main__":
    check()
