"""Label images at sizes coarser than their voxels: elements made against those that the size needs for the volume, and what
that costs in truth. Writes docs/measured/images-needed.md.

Usage: bench/run.sh images_needed [--beside PROGRAM] [--only SUBSTRING] [--timeout SECONDS]
"""
import argparse
import gzip
import pathlib
import tempfile

import meshio
import nibabel
import numpy as np

from bench.models.label_phantoms import phantoms
from bench.ours import cpu_seconds, mesh
from bench.pages import tables
from bench.pages.origin import written_by

VOLUMES = pathlib.Path("volumes")
CROP = "60:123,80:143,60:123"
REGULAR = 0.11785  # the volume of a regular tetrahedron over the cube of its edge
HEAD = ["image, size", "program", "elements", "needed", "times", "mean Dice", "by volume", "worst volume, %", "least angle, °", "mean β",
        "CPU s", "surface front, CPU s"]


def nrrd(file):
    """(voxels by i, j, k, affine) of a file of volumes_as_nrrd.py with spacings."""
    head, _, data = file.read_bytes().partition(b"\n\n")
    keys = dict(line.split(": ", 1) for line in head.decode().splitlines()[1:])
    size = [int(n) for n in keys["sizes"].split()]
    kind = {"float": "<f4", "double": "<f8"}.get(keys["type"], keys["type"])
    return np.frombuffer(gzip.decompress(data), kind).reshape(size[::-1]).T, np.diag([*map(float, keys["spacings"].split()), 1])


def labels_of(file, crop):
    if file.suffix == ".nrrd":
        labels, affine = nrrd(file)
    else:
        image = nibabel.load(file)
        labels, affine = np.asarray(image.dataobj).astype(int), image.affine.copy()
    if crop:
        first, last = zip(*[map(int, axis.split(":")) for axis in crop.split(",")])
        affine[:3, 3] += affine[:3, :3] @ first
        labels = labels[tuple(slice(a, b + 1) for a, b in zip(first, last))]
    return labels, affine


def regions_at_voxels(file, shape, affine):
    """1 + the region that the middle of each voxel lies in; 0: in none."""
    made = meshio.read(file)
    blocks = [k for k, cells in enumerate(made.cells) if cells.type == "tetra"]
    tets = np.vstack([made.cells[k].data for k in blocks])
    region = np.concatenate([made.cell_data["region"][k].ravel() for k in blocks]).astype(int)
    corners = ((made.points - affine[:3, 3]) @ np.linalg.inv(affine[:3, :3]).T)[tets]
    low = np.maximum(np.ceil(corners.min(1) - 1e-9).astype(int), 0)
    high = np.minimum(np.floor(corners.max(1) + 1e-9).astype(int), np.array(shape) - 1)
    span = np.maximum(high - low + 1, 0)
    count = span.prod(1)
    into = np.linalg.inv((corners[:, 1:] - corners[:, :1]).transpose(0, 2, 1))
    found = np.zeros(shape, int)
    for first in range(0, len(tets), 50_000):
        some = count[first:first + 50_000]
        tet = np.repeat(np.arange(first, first + len(some)), some)
        k = np.arange(some.sum()) - np.repeat(np.cumsum(some) - some, some)
        wide = span[tet]
        voxel = low[tet] + np.stack([k // (wide[:, 1] * wide[:, 2]), k // wide[:, 2] % wide[:, 1], k % wide[:, 2]], 1)
        weights = np.einsum("ijk,ik->ij", into[tet], voxel - corners[tet, 0])
        inside = (weights.min(1) >= -1e-9) & (weights.sum(1) <= 1 + 1e-9)
        found[tuple(voxel[inside].T)] = 1 + region[tet[inside]]
    return found


def truth(labels, found):
    """Mean Dice of the labels, the same weighted by volume."""
    dice, voxels = [], []
    for number, value in enumerate((v for v in np.unique(labels) if v), 1):
        of_image, of_mesh = labels == value, found == number
        dice.append(2 * (of_image & of_mesh).sum() / (of_image.sum() + of_mesh.sum()))
        voxels.append(of_image.sum())
    return np.mean(dice), np.average(dice, weights=voxels)


def row_of(name, file, size, crop, program, called, folder, timeout):
    made = mesh(program, file, folder, timeout, "--size", str(size), *(["--crop", crop] if crop else []))
    if made.error:
        return [f"{name}, {size:g}", called, made.error]
    report = made.report
    labels, affine = labels_of(file, crop)
    dice, weighted = truth(labels, regions_at_voxels(pathlib.Path(folder, "out.vtu"), labels.shape, affine))
    wanted = [r["volume"] for r in report["input_regions"]]
    have = [r["volume"] for r in report["regions"]] if report.get("regions") else [report["volume"]]
    needed = sum(wanted) / (REGULAR * size ** 3)
    # A label of a few voxels is nothing to measure percents of.
    worst = max((abs(h / w - 1) for h, w in zip(have, wanted) if w > 30 * abs(np.linalg.det(affine[:3, :3]))), default=0)
    quality = report["quality"]
    return [f"{name}, {size:g}", called, f"{report['tets']:,}", f"{needed:,.0f}", f"{report['tets'] / needed:.2f}", f"{dice:.4f}", f"{weighted:.4f}",
            f"{100 * worst:.2f}", f"{quality['dihedral_min_degrees']:.1f}", f"{quality['beta_mean']:.3f}", f"{report['cpu_seconds']:.1f}",
            f"{cpu_seconds(report, 'surface front'):.1f}"]


def images(folder):
    made = phantoms(folder)
    yield from ((name, made[name], 4, None) for name in made)
    yield "liver", VOLUMES / "liver.nrrd", 6, None
    yield "JHU white matter", VOLUMES / "JHU-WhiteMatter-labels-1mm.nii.gz", 3, None
    yield "jhu189, a crop of 64³", VOLUMES / "jhu189.nii.gz", 4, CROP


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--beside", type=pathlib.Path, help="another octafront, for rows of its own")
    parser.add_argument("--only", default="")
    parser.add_argument("--timeout", type=float, default=900)
    a = parser.parse_args()
    programs = [("before", a.beside)] if a.beside else []
    programs.append(("now", a.build / "cli/octafront"))
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        for name, file, size, crop in images(folder):
            if a.only not in name or not file.exists():
                continue
            rows += [row_of(name, file, size, crop, program, called, folder, a.timeout) for called, program in programs]
            print(*map(tables.row, rows[-len(programs):]), sep="\n", flush=True)
    if not a.only:
        link = tables.put("images-needed", HEAD, rows)
        tables.write("images-needed", ["# Images: elements made and needed", "",
                                       f"{written_by('bench/run.sh images_needed --beside PROGRAM')}, one thread. {ABOUT}", "",
                                       *tables.some(HEAD, rows, [c for c in HEAD if c not in ("mean β", "surface front, CPU s")]), "",
                                       f"With all figures: {link}."])


ABOUT = ("Default options but `--size`. Needed: regular tetrahedra of that edge for the volume. Dice: middles of voxels in the label's elements, "
         "the mean over labels, and by their volume. Volumes of labels of 30 voxels and more.")

if __name__ == "__main__":
    main()
