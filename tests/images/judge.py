#!/usr/bin/env python3
"""What other readers make of the volumes that bench/models/get-volumes.sh --readers fetched: nibabel of NIfTI, pydicom of DICOM.

    judge.py OCTAFRONT VOLUMES_DIR

Compares the map from indices to the world, and how often each value occurs, with what `octafront info` says. Files that
we refuse must be such that they hold no volume of numbers. Status 77 if volumes or readers are missing.
"""
import json
import pathlib
import subprocess
import sys
import tempfile

SKIPPED = 77


def info(octafront, path, *options):
    """The findings of `octafront info`, or None and why it refuses."""
    with tempfile.NamedTemporaryFile(suffix=".json") as out:
        done = subprocess.run([octafront, "info", path, "--json", out.name, "-q", *options], capture_output=True, text=True)
        if done.returncode == 3:
            return None, done.stderr
        if done.returncode != 0:
            raise SystemExit(f"{path}: status {done.returncode}: {done.stderr}")
        return json.loads(pathlib.Path(out.name).read_text()), ""


def check_values(found, values, numpy):
    """What is wrong with counts of values, or None."""
    values = values[numpy.isfinite(values)]
    if found["voxels"] == "labels":
        expected = dict(zip(*(a.tolist() for a in numpy.unique(values, return_counts=True))))
        counted = {entry["value"]: entry["voxels"] for entry in found["labels"]}
        return None if counted == expected else f"counts {counted} but {expected}"
    close = numpy.allclose([found["least"], found["largest"]], [values.min(), values.max()], rtol=1e-6, atol=1e-30)
    return None if close else f"values {found['least']} to {found['largest']} but {values.min()} to {values.max()}"


def judge_nifti(octafront, path, nibabel, numpy):
    image = nibabel.load(path)
    if image.ndim < 3:
        return None if info(octafront, path)[0] is None else "a flat image was taken for a volume"
    many = image.ndim > 3 and int(numpy.prod(image.shape[3:])) > 1
    found, refused = info(octafront, path, *(["--series", "2"] if many else []))
    if found is None:
        return f"refused: {refused}"
    values = image.get_fdata()
    if many:
        values = values.reshape(image.shape[:3] + (-1,), order="F")[..., 1]
    ours = numpy.column_stack([*found["axes"], found["origin"]])
    code = int(image.header["sform_code"]) > 0 or int(image.header["qform_code"]) > 0
    # Without a form nibabel puts the middle of the image at 0, as SPM does; we say that nothing is known.
    if code and not numpy.allclose(ours, image.affine[:3], atol=1e-4):
        return f"affine {ours.tolist()} but {image.affine[:3].tolist()}"
    return check_values(found, values, numpy)


def judge_dicom(octafront, path, pydicom, numpy):
    found, refused = info(octafront, path)
    data = pydicom.dcmread(path, force=True)
    if found is None:
        return None if len(refused) > 40 else f"refused without a reason: {refused}"
    try:
        pixels = data.pixel_array
    except (RuntimeError, NotImplementedError):
        return None  # compressed, and pydicom alone reads none of that
    values = pixels * float(data.get("RescaleSlope", 1)) + float(data.get("RescaleIntercept", 0))
    if list(found["size"][:2]) != [data.Columns, data.Rows]:
        return f"size {found['size']}"
    if "ImagePositionPatient" in data and not numpy.allclose(found["origin"], data.ImagePositionPatient):
        return f"origin {found['origin']} but {data.ImagePositionPatient}"
    return check_values(found, values, numpy)


def main(octafront, volumes):
    volumes = pathlib.Path(volumes)
    if not (volumes / "nibabel").is_dir():
        print("bench/models/get-volumes.sh --readers fetches the volumes")
        return SKIPPED
    try:
        import nibabel
        import numpy
        import pydicom
    except ImportError as error:
        print(f"{error}: install python3-nibabel and python3-pydicom")
        return SKIPPED
    wrong, judged, read = [], 0, 0
    nifti = [*sorted(volumes.glob("*.nii.gz")), *sorted((volumes / "nibabel").glob("*.nii*"))]
    for path, judge, reader in [*((p, judge_nifti, nibabel) for p in nifti),
                                *((p, judge_dicom, pydicom) for p in sorted((volumes / "pydicom").glob("*.dcm")))]:
        judged += 1
        what = judge(octafront, path, reader, numpy)
        read += info(octafront, path)[0] is not None
        if what:
            wrong.append(f"{path.name}: {what[:300]}")
    print(*wrong, sep="\n")
    print(f"{judged} files judged, {read} of them read, {len(wrong)} wrong")
    return 1 if wrong or read < 25 else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
