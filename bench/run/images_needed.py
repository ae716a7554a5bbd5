"""Label images at sizes coarser than their voxels: elements made against those that the size needs for the volume, and what
that costs in truth. Writes docs/measured/images-needed.md.

Usage: bench/run.sh images_needed [--beside PROGRAM] [--only SUBSTRING] [--timeout SECONDS]
"""
import argparse
import pathlib
import tempfile

import nibabel
import numpy as np

from bench.models.label_phantoms import phantoms
from bench.ours import cpu_seconds, mesh
from bench.pages import tables
from bench.pages.origin import written_by
from bench.run.images import judge

VOLUMES = pathlib.Path("volumes")
CROP = ((60, 123), (80, 143), (60, 123))
FEW = 30  # voxels: of smaller labels percents say nothing
REGULAR = 0.11785  # the volume of a regular tetrahedron over the cube of its edge
HEAD = ["image, size", "program", "elements", "needed", "times", "mean Dice", "by volume", "worst volume, %", "least angle, °", "mean β",
        "CPU s", "surface front, CPU s"]


def cropped(file, crop, folder):
    """The part of an image as a file of its own, which the judge reads, too."""
    image = nibabel.load(file)
    (i0, i1), (j0, j1), (k0, k1) = crop
    part = image.slicer[i0:i1 + 1, j0:j1 + 1, k0:k1 + 1]
    nibabel.save(part, pathlib.Path(folder, "crop.nii.gz"))
    return pathlib.Path(folder, "crop.nii.gz")


def row_of(name, file, size, build, program, called, folder, timeout):
    made = mesh(program, file, folder, timeout, "--size", str(size), out="out.msh")
    if made.error:
        return [f"{name}, {size:g}", called, made.error]
    report, found = made.report, judge(build, file, made.mesh, [])
    labels = found["labels"]
    voxels, dice = [l["voxels"] for l in labels], [l["dice"] for l in labels]
    needed = sum(l["volume_in"] for l in labels) / (REGULAR * size ** 3)
    worst = max(abs(l["volume_out"] / l["volume_in"] - 1) for l in labels if l["voxels"] >= FEW)
    return [f"{name}, {size:g}", called, f"{found['elements']:,}", f"{needed:,.0f}", f"{found['elements'] / needed:.2f}", f"{np.mean(dice):.4f}",
            f"{np.average(dice, weights=voxels):.4f}", f"{100 * worst:.2f}", f"{found['dihedral_min']:.1f}", f"{found['beta_mean']:.3f}",
            f"{report['cpu_seconds']:.1f}", f"{cpu_seconds(report, 'surface front'):.1f}"]


def images(folder):
    made = phantoms(folder)
    yield from ((name, made[name], 4) for name in made)
    yield "liver", VOLUMES / "liver.nrrd", 6
    yield "JHU white matter", VOLUMES / "JHU-WhiteMatter-labels-1mm.nii.gz", 3
    yield "jhu189, a crop of 64³", cropped(VOLUMES / "jhu189.nii.gz", CROP, folder), 4


HIDDEN = ("program", "by volume", "mean β", "surface front, CPU s")  # in the file of rows alone


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
        for name, file, size in images(folder):
            if a.only not in name:
                continue
            rows += [row_of(name, file, size, a.build, program, called, folder, a.timeout) for called, program in programs]
            print(*map(tables.row, rows[-len(programs):]), sep="\n", flush=True)
    if not a.only:
        link = tables.put("images-needed", HEAD, rows)
        tables.write("images-needed", ["# Images: elements made and needed", "",
                                       f"{written_by('bench/run.sh images_needed --beside PROGRAM')}, one thread. {ABOUT}", "",
                                       *tables.some(HEAD, [r for r in rows if r[1] == "now"], [c for c in HEAD if c not in HIDDEN]), "",
                                       f"With all figures: {link}."])


ABOUT = ("Default options but `--size`. Needed: regular tetrahedra of that edge for the volume. Judged by octafront_judge_image: Dice as the mean over "
         "labels; volumes against voxels, of labels of 30 and more.")

if __name__ == "__main__":
    main()
