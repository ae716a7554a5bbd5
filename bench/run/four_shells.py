"""Four concentric spheres as a head: meshed from voxels and from surfaces of spheres, solved for the potential of currents between two electrodes
on the skin, against the series. Writes docs/measured/four-shells.md.

Usage: bench/run.sh four_shells [--program OCTAFRONT] [--only SUBSTRING] [--timeout SECONDS]
"""
import argparse
import pathlib
import tempfile

import meshio
import numpy as np

from bench.judges import layered_sphere as judge
from bench.models import concentric_spheres as spheres
from bench.ours import mesh
from bench.pages import tables
from bench.pages.origin import written_by

RADII = [radius for _, _, radius in spheres.TISSUES]
CONDUCTIVITIES = (0.33, 1.0, 0.0042, 0.33)  # S/m
SKULL = 2
AXIS = (0.62, 0.5, 0.6)
FIELD_AT = 20000  # elements of the brain where the field is compared
CASES = [("4.2", 20), ("10", 20), ("4.2", 6)]  # the skull's conductivity, mS/m, radius of the electrodes, mm
MESHES = [("voxels of 1 mm", "head", 100_000), ("voxels of 1 mm", "head", 250_000), ("voxels of 1 mm", "head", 500_000),
          ("spheres", "head", 100_000), ("spheres", "head", 250_000), ("spheres", "head", 500_000),
          ("voxels of 1 mm", "default", 100_000), ("voxels of 1 mm", "default", 500_000),
          ("voxels of 2 mm", "head", 100_000), ("voxels of 2 mm", "head", 500_000)]
AT = [("brain", 0, 1), ("fluid", 1, 2), ("skin", 3, 4)]  # the sphere around it, between these layers
HEAD = ["from", "sizes", "elements", "in the fluid", "in the skull", "skull, mS/m", "electrodes, mm", "nodes off the spheres, mm",
        *(f"{name}: {what}, %" for name, _, _ in AT for what in ("error", "rms of most", "RDM", "magnitude")), "field in the brain, %",
        "mesh, CPU s", "iterations"]
SHOWN = ["from", "sizes", "elements", "nodes off the spheres, mm", "brain: error, %", "brain: RDM, %", "brain: magnitude, %",
         "skin: error, %", "field in the brain, %"]


def source(kind, folder):
    """What Octafront is given."""
    if kind == "spheres":
        return [*spheres.surfaces(folder), "--keep-volumes"]
    image, names = spheres.labels(folder, float(kind.split()[2]))
    return [image, "--image", "labels", "--labels", names]


class Head:
    """A mesh, its tetrahedra numbered by layers from the inside."""

    def __init__(self, file):
        read = meshio.read(file)
        self.points, self.tets = read.points, read.cells_dict["tetra"].astype(np.int64)
        tags, layer = np.unique(read.cell_data_dict["gmsh:physical"]["tetra"], return_inverse=True)
        away = np.linalg.norm(self.middles(), axis=1)
        self.layers = np.argsort(np.argsort([away[layer == k].mean() for k in range(len(tags))]))[layer]
        faces, lesser, greater = judge.faces_of(self.tets, self.layers + 1)
        outside = lesser == 0
        lesser[outside], greater[outside] = greater[outside], len(RADII) + 1
        self.interfaces = [faces[(lesser == i + 1) & (greater == j + 1)] for _, i, j in AT]

    def middles(self):
        return self.points[self.tets].mean(axis=1)


def measure(weights):
    return lambda values: float(np.sqrt((weights * values**2).sum()))


def compared(found, exact, weights):
    """Relative error, root mean square over the greatest value, RDM, and magnitude, of potentials of mean 0; all in percent."""
    found, exact = (v - np.average(v, weights=weights) for v in (found, exact))
    size = measure(weights / weights.sum())
    apart = size(found - exact)
    return [100 * apart / size(exact), 100 * apart / np.abs(exact).max(), 100 * size(found / size(found) - exact / size(exact)),
            100 * (size(found) / size(exact) - 1)]


def error_of_field(head, potential, gradients, volumes, sphere):
    """Of elements of the brain, drawn by their volumes, at their middles, %."""
    inside = np.flatnonzero(head.layers == 0)
    drawn = np.random.default_rng(1).choice(inside, FIELD_AT, p=volumes[inside] / volumes[inside].sum())
    found = np.einsum("tid,ti->td", gradients[drawn], potential[head.tets[drawn]])
    at, step = head.points[head.tets[drawn]].mean(axis=1), 1e-3
    exact = np.stack([(sphere.potential(at + step * axis) - sphere.potential(at - step * axis)) / (2 * step) for axis in np.eye(3)], 1)
    return 100 * float(np.linalg.norm(found - exact) / np.linalg.norm(exact))


def solve(head, skull, electrode):
    conductivities = list(CONDUCTIVITIES)
    conductivities[SKULL] = float(skull) / 1000
    sphere = judge.LayeredSphere(RADII, conductivities, np.arcsin(electrode / RADII[-1]), AXIS)
    gradients, volumes = judge.gradients_of(head.points, head.tets)
    matrix = judge.stiffness(len(head.points), head.tets, gradients, volumes * np.array(conductivities)[head.layers])
    skin = head.interfaces[-1]
    load = judge.through_cap(head.points, skin, sphere, 1) - judge.through_cap(head.points, skin, sphere, -1)
    potential, iterations = judge.solved(matrix, load)
    figures = []
    for (_, layer, _), faces in zip(AT, head.interfaces):
        weights = judge.shared_areas(head.points, faces)
        on = np.flatnonzero(weights)
        figures += compared(potential[on], sphere.potential(head.points[on], RADII[layer]), weights[on])
    return figures, error_of_field(head, potential, gradients, volumes, sphere), iterations


def off_spheres(head):
    """Root mean square over the inner interfaces."""
    apart = [np.linalg.norm(head.points[np.unique(faces)], axis=1) - RADII[layer] for (_, layer, _), faces in zip(AT, head.interfaces) if layer < 3]
    return float(np.sqrt(np.mean(np.concatenate(apart) ** 2)))


def rows_of(kind, sizes, elements, program, timeout):
    with tempfile.TemporaryDirectory() as folder:
        first, *more = source(kind, folder)
        made = mesh(program, first, folder, timeout, *more, *(["--preset", "head"] if sizes == "head" else []), "--elements", elements, out="out.msh")
        if made.error:
            raise SystemExit(f"{kind}, {sizes}, {elements}: {made.error}")
        head = Head(made.mesh)
    count = np.bincount(head.layers)
    for skull, electrode in CASES:
        figures, field, iterations = solve(head, skull, electrode)
        yield [kind, sizes, f"{len(head.tets):,}", f"{count[1]:,}", f"{count[2]:,}", skull, electrode, f"{off_spheres(head):.3f}",
               *(f"{figure:+.2f}" if i % 4 == 3 else f"{figure:.2f}" for i, figure in enumerate(figures)), f"{field:.1f}",
               f"{made.report['cpu_seconds']:.0f}", iterations]


ABOUT = ("Spheres of 79, 81, 85 and 88 mm: brain, fluid, skull and scalp of .33, 1, .0042 and .33 S/m. 1 A in through an even electrode of 20 mm radius on the skin and out "
         "through one opposite, on no axis of the voxels. Finite elements of first order beside a series of Legendre's polynomials. *Error*: of the potential, root mean square over the sphere around brain, fluid or skin, beside that of the potential itself. *RDM*: the same when "
         "both have the size 1; *magnitude*: how the sizes differ. *Field*: of gradients in the middles of the brain's elements. *head*: `--preset head`; "
         "*default*: `--elements` alone. *Spheres*: surfaces of 81,920 triangles each, `--keep-volumes`.")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--program", type=pathlib.Path)
    parser.add_argument("--only", default="", help="meshes whose names have this in them")
    parser.add_argument("--timeout", type=float, default=600)
    a = parser.parse_args()
    rows = []
    for kind, sizes, elements in MESHES:
        if a.only in f"{kind}, {sizes}, {elements}":
            rows += rows_of(kind, sizes, elements, a.program or a.build / "cli/octafront", a.timeout)
            print(*map(tables.row, rows[-len(CASES):]), sep="\n", flush=True)
    if a.only:
        return
    shown = [row for row, (*_, elements) in zip(rows[::len(CASES)], MESHES) if elements != 250_000]
    link = tables.put("four-shells", HEAD, rows)
    tables.write("four-shells", ["# Four shells", "", f"{written_by('bench/run.sh four_shells')}, one thread. {ABOUT}", "",
                                 *tables.some(HEAD, shown, SHOWN), "", f"With 250,000 elements, a skull of 10 mS/m, electrodes of 6 mm, and all figures: {link}."])


if __name__ == "__main__":
    main()
