"""The bodies of bench/run/answers.py meshed from STEP, by whole processes of one thread: by Octafront, Gmsh and Netgen."""
import os
import pathlib
import tempfile

import meshio
import numpy as np

from bench.judges.answers_solved import Mesh
from bench.peers import netgen
from bench.process import finish, run_measured

KINDS = {1: "tetra", 2: "tetra10"}


def octafront(program, *options):
    def mesh(step, folder, order, timeout):
        out = pathlib.Path(folder) / "out.msh"
        return finish(run_measured([program, "mesh", step, "-o", out, "--format", "msh22", "--order", order, "--threads", 1, "-q", *options], folder, timeout), out)
    return mesh


def gmsh(*options):
    """As its users run it: elements for curvature, all else as it comes."""
    def mesh(step, folder, order, timeout):
        out = pathlib.Path(folder) / "out.msh"
        return finish(run_measured(["gmsh", "-3", step, "-o", out, "-format", "msh22", "-order", order, "-nt", 1, *options], folder, timeout), out)
    return mesh


def by_netgen(size):
    def mesh(step, folder, order, timeout):
        return netgen.mesh_cad_for_solver(step, folder, timeout, repr(float(size)), order)
    return mesh


def read(file, order):
    mesh = meshio.read(file)
    return Mesh(mesh.points, np.concatenate([block.data for block in mesh.cells if block.type == KINDS[order]]))


def meshed(mesher, step, order, timeout):
    """(Outcome, Mesh or None)."""
    with tempfile.TemporaryDirectory() as folder:
        outcome = mesher(step, folder, order, timeout)
        return outcome, None if outcome.error else read(outcome.mesh, order)


os.environ["OMP_NUM_THREADS"] = "1"  # of CalculiX and of whoever else asks
