"""Volumes of formats that Octafront does not read, as NRRD beside them: volumes_as_nrrd.py FOLDER

InVesalius projects (.inv3, a tar of property lists and raw arrays) with their first mask, INRIMAGE-4 (.inr, .inr.gz).
"""
import gzip
import pathlib
import plistlib
import re
import sys
import tarfile

import numpy as np


def write(file, voxels, spacing, space=""):
    """`voxels` by slice, row, column."""
    kind = {"f4": "float", "f8": "double"}.get(voxels.dtype.str[1:], voxels.dtype.name)
    head = (f"NRRD0004\ntype: {kind}\ndimension: 3\nsizes: {' '.join(map(str, voxels.shape[::-1]))}\n"
            + (space or f"spacings: {' '.join(map(str, spacing))}\n") + "endian: little\nencoding: gzip\n\n")
    file.write_bytes(head.encode() + gzip.compress(voxels.astype(voxels.dtype.newbyteorder("<")).tobytes(), 1))


def project(file):
    with tarfile.open(file) as tar:
        members = {pathlib.Path(name).name: name for name in tar.getnames()}
        bytes_of = lambda name: tar.extractfile(members[name]).read()
        main = plistlib.loads(bytes_of("main.plist"))
        mask = plistlib.loads(bytes_of(main["masks"]["0"]))
        x, y, z = main["spacing"]
        # Rows run from the back of the patient to the front.
        space = f"space: left-posterior-superior\nspace directions: ({x},0,0) (0,{-y},0) (0,0,{z})\nspace origin: (0,0,0)\n" \
                'space units: "mm" "mm" "mm"\n'
        matrix = main["matrix"]
        write(file.with_suffix(".nrrd"), np.frombuffer(bytes_of(matrix["filename"]), matrix["dtype"]).reshape(matrix["shape"]), (x, y, z), space)
        # A plane, a row and a column of flags come before the voxels.
        flagged = np.frombuffer(bytes_of(mask["mask_file"]), np.uint8).reshape(mask["mask_shape"])
        write(file.with_name(file.stem + "-mask.nrrd"), (flagged[1:, 1:, 1:] >= 128).astype(np.uint8), (x, y, z), space)


def inrimage(file):
    data = file.read_bytes()
    data = gzip.decompress(data) if file.suffix == ".gz" else data
    end = data.index(b"##}\n") + 4
    keys = dict(re.findall(r"^(\w+)\s*=\s*(.*?)\s*$", data[:end].decode("latin1"), re.M))
    size = [int(keys[k]) for k in ("ZDIM", "YDIM", "XDIM")]
    kind = {"float": "f", "signed fixed": "i", "unsigned fixed": "u"}[keys["TYPE"]]
    order = ">" if keys.get("CPU") in ("sun", "sgi") else "<"
    voxels = np.frombuffer(data[end:], f"{order}{kind}{int(keys['PIXSIZE'].split()[0]) // 8}", size[0] * size[1] * size[2])
    write(file.with_name(file.name.split(".inr")[0] + ".nrrd"), voxels.reshape(size), [float(keys.get(k, 1)) for k in ("VX", "VY", "VZ")])


if __name__ == "__main__":
    folder = pathlib.Path(sys.argv[1])
    for archive in folder.glob("*.inv3"):
        project(archive)
    for image in (*folder.glob("*.inr"), *folder.glob("*.inr.gz")):
        inrimage(image)
