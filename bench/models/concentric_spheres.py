"""Four concentric spheres as a head: brain, fluid, skull and scalp of Cuffin and Cohen (1979), as labels of voxels or as surfaces.

    labels(folder, voxel): writes a NIfTI image and its names, and returns both files
    surfaces(folder): writes a file for each sphere, the largest first, and returns them
"""
import pathlib

import nibabel
import numpy as np

from bench.models.solids import icosphere
from bench.off import write_off

TISSUES = (("brain", 1, 79.0), ("csf", 3, 81.0), ("skull", 4, 85.0), ("scalp", 5, 88.0))  # name, label as SimNIBS counts, radius in mm
MIDDLE = np.array([0.3, 0.1, -0.2])  # of the spheres on the grid of voxels: on no plane of symmetry


def labels(folder, voxel):
    count = int(np.ceil(2 * (TISSUES[-1][2] + 2) / voxel))
    first = (0.5 - count / 2) * voxel - MIDDLE * voxel
    x, y, z = np.meshgrid(*(f + voxel * np.arange(count) for f in first), indexing="ij")
    away = np.sqrt(x * x + y * y + z * z)
    image = np.zeros(away.shape, np.uint8)
    for _, label, radius in reversed(TISSUES):
        image[away < radius] = label
    affine = np.diag([voxel, voxel, voxel, 1.0])
    affine[:3, 3] = first
    file, names = pathlib.Path(folder) / "four.nii.gz", pathlib.Path(folder) / "names.txt"
    nibabel.save(nibabel.Nifti1Image(image, affine), file)
    names.write_text("".join(f"{label} {name}\n" for name, label, _ in TISSUES))
    return file, names


def surfaces(folder, levels=6):
    """Triangles that lie within .005 mm, with the volumes of the spheres."""
    points, faces = icosphere(levels)
    corners = points[np.array(faces)]
    volume = np.einsum("ij,ij->", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])) / 6
    files = []
    for name, _, radius in reversed(TISSUES):
        files.append(pathlib.Path(folder) / f"{name}.off")
        write_off(files[-1], points * radius * (4 / 3 * np.pi / volume) ** (1 / 3), faces)
    return files
