"""A CT of InVesalius as the series of DICOM files that a scanner would write: one slice per file, explicit little endian.

    dicom_series.py PROJECT.inv3 FOLDER
"""
import pathlib
import plistlib
import struct
import sys
import tarfile

UID = "1.2.826.0.1.3680043.9.7"  # of nobody: the series leaves no machine


def element(group, number, kind, value):
    if isinstance(value, str):
        value = value.encode()
    if len(value) % 2:
        value += b"\0" if kind == b"UI" else b" "
    head = struct.pack("<HH", group, number) + kind
    if kind == b"OW":
        return head + struct.pack("<HI", 0, len(value)) + value
    return head + struct.pack("<H", len(value)) + value


def slice_file(k, pixels, columns, rows, spacing):
    """Slice k; rows run to the front, as those of the project."""
    uid = f"{UID}.{k + 1}"
    meta = (element(2, 2, b"UI", "1.2.840.10008.5.1.4.1.1.2") + element(2, 3, b"UI", uid)
            + element(2, 0x10, b"UI", "1.2.840.10008.1.2.1"))
    word = lambda value: struct.pack("<H", value)
    data = b"".join((
        element(8, 0x16, b"UI", "1.2.840.10008.5.1.4.1.1.2"), element(8, 0x18, b"UI", uid), element(8, 0x60, b"CS", "CT"),
        element(0x18, 0x50, b"DS", f"{spacing[2]:.10g}"), element(0x20, 0xd, b"UI", f"{UID}.0"),
        element(0x20, 0xe, b"UI", f"{UID}.0.1"), element(0x20, 0x11, b"IS", "1"), element(0x20, 0x13, b"IS", str(k + 1)),
        element(0x20, 0x32, b"DS", f"0\\0\\{k * spacing[2]:.10g}"), element(0x20, 0x37, b"DS", "1\\0\\0\\0\\-1\\0"),
        element(0x28, 2, b"US", word(1)), element(0x28, 4, b"CS", "MONOCHROME2"), element(0x28, 0x10, b"US", word(rows)),
        element(0x28, 0x11, b"US", word(columns)), element(0x28, 0x30, b"DS", f"{spacing[1]:.10g}\\{spacing[0]:.10g}"),
        element(0x28, 0x100, b"US", word(16)), element(0x28, 0x101, b"US", word(16)), element(0x28, 0x102, b"US", word(15)),
        element(0x28, 0x103, b"US", word(1)), element(0x28, 0x1052, b"DS", "0"), element(0x28, 0x1053, b"DS", "1"),
        element(0x7fe0, 0x10, b"OW", pixels)))
    return b"\0" * 128 + b"DICM" + element(2, 0, b"UL", struct.pack("<I", len(meta))) + meta + data


def write_series(project, folder):
    """Returns how many slices there are. They are numbered from the last one: their places tell the order."""
    with tarfile.open(project) as tar:
        files = {pathlib.Path(name).name: name for name in tar.getnames()}
        plist = plistlib.loads(tar.extractfile(files["main.plist"]).read())
        nk, nj, ni = plist["matrix"]["shape"]
        values = tar.extractfile(files[plist["matrix"]["filename"]]).read()
    folder = pathlib.Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    # A right-handed stack: rows run to the front, so slices that ascend would run down.
    for k in range(nk):
        pixels = values[2 * ni * nj * k:2 * ni * nj * (k + 1)]
        (folder / f"IM{nk - k:04}").write_bytes(slice_file(k, pixels, ni, nj, plist["spacing"]))
    return nk


if __name__ == "__main__":
    print(write_series(sys.argv[1], sys.argv[2]), "slices")
