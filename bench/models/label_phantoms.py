"""Label images that anybody can make: a ball, thick cells, a femur with a thin cortex, a head with a folded one.

    phantoms(folder): writes NAME.nii.gz with voxels of 1 mm, and returns the files
"""
import pathlib

import nibabel
import numpy as np


def middles(size):
    return np.meshgrid(*[np.arange(n) + 0.5 for n in size], indexing="ij")


def ball_of(radius=24.3):
    x, y, z = middles((64, 64, 64))
    return np.sqrt((x - 32) ** 2 + (y - 32) ** 2 + (z - 32) ** 2) < radius


def cells(count=12):
    """A ball in cells around points that keep their distance."""
    random, seeds = np.random.default_rng(5), []
    while len(seeds) < count:
        p = random.uniform(-20, 20, 3)
        if np.linalg.norm(p) < 21 and all(np.linalg.norm(p - q) > 11 for q in seeds):
            seeds.append(p)
    x, y, z = middles((64, 64, 64))
    away = np.stack([(x - 32 - p[0]) ** 2 + (y - 32 - p[1]) ** 2 + (z - 32 - p[2]) ** 2 for p in seeds])
    return np.where(ball_of(), away.argmin(0) + 1, 0)


def femur():
    """Cortex (1) of 3.5 to 1.2 mm around what is inside (2), cut flat at the image's edge."""
    x, y, z = middles((72, 80, 160))

    def cone(p, q, first, last):
        p, v = np.array(p, float), np.subtract(q, p).astype(float)
        t = np.clip(((x - p[0]) * v[0] + (y - p[1]) * v[1] + (z - p[2]) * v[2]) / (v @ v), 0, 1)
        return np.sqrt((x - p[0] - t * v[0]) ** 2 + (y - p[1] - t * v[1]) ** 2 + (z - p[2] - t * v[2]) ** 2) - (first + (last - first) * t)

    def joined(a, b, width):
        t = np.clip(0.5 + 0.5 * (b - a) / width, 0, 1)
        return b * (1 - t) + a * t - width * t * (1 - t)

    d = joined(cone((30, 34, -5), (30, 38, 115), 13.5, 14.5), cone((30, 38, 115), (47, 40, 140), 14, 12), 8)
    d = joined(d, np.sqrt((x - 50) ** 2 + (y - 41) ** 2 + (z - 143) ** 2) - 16, 5)
    d = joined(d, np.sqrt((x - 24) ** 2 + (y - 38) ** 2 + (z - 128) ** 2) - 12, 6)
    cortex = np.where(z < 100, 3.5, 3.5 - 2.3 * np.clip((z - 100) / 25, 0, 1))
    return np.where(d < -cortex, 2, np.where(d < 0, 1, 0))


def head():
    """Scalp, skull, fluid of about two voxels, a folded layer of grey, white: 1 to 5."""
    x, y, z = middles((128, 144, 128))
    x, y, z = (x - 64) / 54, (y - 72) / 62, (z - 64) / 54
    r = np.sqrt(x * x + y * y + z * z)
    around, up, away = np.arctan2(y, x), np.arcsin(np.clip(z / np.maximum(r, 1e-9), -1, 1)), 56 * r
    folds = (np.sin(9 * around + 2 * np.sin(4 * up)) * np.cos(up) + 0.8 * np.sin(11 * up + 1.5 * np.sin(5 * around))
             + 0.5 * np.sin(17 * around * np.cos(up) + 7 * up))
    pial = 43 - 3.38 * np.clip(folds, -0.4, 3)
    labels = np.zeros(r.shape)
    for label, radius in enumerate((55, 50.5, 45.2, pial, pial - 3.2), 1):
        labels[away < radius] = label
    return labels


PHANTOMS = {"ball": ball_of, "cells": cells, "femur": femur, "head": head}


def phantoms(folder):
    files = {}
    for name, make in PHANTOMS.items():
        files[name] = pathlib.Path(folder) / f"{name}.nii.gz"
        nibabel.save(nibabel.Nifti1Image(make().astype(np.uint8), np.eye(4)), files[name])
    return files
