"""A head of ellipsoids as images: labels of its layers, and what a CT would show. Used by generate.py; nothing but Python."""
import gzip
import math
import random
import struct

SIZE, SPACING = (44, 56, 46), (4.0, 4.0, 4.0)
# The half axes of each layer in mm, from the outside; the neck leaves the image at its bottom.
# Numbers are those of SimNIBS, the brain all grey matter; the lesion has one that it leaves to users.
LAYERS = (("skin", 5, (76, 98, 88)), ("skull", 4, (68, 90, 80)), ("csf", 3, (60, 82, 72)), ("brain", 2, (54, 76, 66)))
LESION = (11, (20, 14, 10), 9)  # label, middle, radius
NECK = (5, 44)  # label, radius
HOUNSFIELD = {0: -1000, 5: 40, 4: 900, 3: 5, 2: 35, 11: 60}


def label_at(x, y, z):
    """Of a point in mm, the head's middle being the origin."""
    label = NECK[0] if z < 0 and math.hypot(x, y) < NECK[1] else 0
    for _, value, half in LAYERS:
        if sum((p / h) ** 2 for p, h in zip((x, y, z), half)) < 1:
            label = value
    if math.dist((x, y, z), LESION[1]) < LESION[2]:
        label = LESION[0]
    return label


def place(i, j, k):
    return tuple((n - (size - 1) / 2) * step for n, size, step in zip((i, j, k), SIZE, SPACING))


def nifti(values, code, pack):
    """NIfTI-1 with an sform, in RAS millimetres."""
    header = bytearray(352)
    struct.pack_into("<i", header, 0, 348)
    struct.pack_into("<8h", header, 40, 3, *SIZE, 1, 1, 1, 1)
    struct.pack_into("<hh", header, 70, code, 8 * struct.calcsize(pack))
    struct.pack_into("<8f", header, 76, 1, *SPACING, 1, 1, 1, 1)
    struct.pack_into("<f", header, 108, 352)
    header[123] = 2  # mm
    struct.pack_into("<h", header, 254, 1)
    first = place(0, 0, 0)
    for row in range(3):
        struct.pack_into("<4f", header, 280 + 16 * row, *(SPACING[row] if a == row else 0 for a in range(3)), first[row])
    header[344:348] = b"n+1\0"
    return gzip.compress(bytes(header) + struct.pack(f"<{len(values)}{pack}", *values), 9, mtime=0)


def voxels():
    return ((i, j, k) for k in range(SIZE[2]) for j in range(SIZE[1]) for i in range(SIZE[0]))


def labels():
    return nifti([label_at(*place(*v)) for v in voxels()], 2, "B")


def ct():
    """Means over each voxel of 27 points, as a scanner sees them: values lie between where layers meet. With noise."""
    steps = (-4 / 3, 0, 4 / 3)
    noise = random.Random(1)
    values = []
    for voxel in voxels():
        x, y, z = place(*voxel)
        seen = [HOUNSFIELD[label_at(x + a, y + b, z + c)] for c in steps for b in steps for a in steps]
        values.append(round(sum(seen) / len(seen) + noise.gauss(0, 6)))
    return nifti(values, 4, "h")


def names():
    return "".join(f"{value} {name}\n" for name, value, _ in reversed(LAYERS)) + f"{LESION[0]} lesion\n"
