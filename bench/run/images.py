"""Images of labels meshed and judged, and beside CGAL's Mesh_3 on the same image.

Usage: bench/run.sh images [--volumes NAME...] [--timeout SECONDS] [--peers] [--beside-only] [--page]
Volumes are those of bench/models/get-volumes.sh. Each is meshed on one thread; octafront_judge_image compares every label of the mesh with
its voxels. Keeps each result in BUILD/images.json as soon as it is there; --page writes docs/measured/images-status.md from all that
are in it. With --peers also CGAL (libcgal-dev), on images turned into INR: labels kept, pieces, volumes, quality, elements per CPU second
of the whole process, reading and writing included.
"""
import argparse
import gzip
import json
import pathlib
import struct
import subprocess
import tempfile

from bench.models.dicom_series import write_series
from bench.models.volumes_as_nrrd import inrimage
from bench.ours import mesh, stage
from bench.pages import tables
from bench.pages.origin import ORIGIN, written_by
from bench.process import finish, run_measured

ROOT = pathlib.Path(__file__).resolve().parents[2]

# Name, file, options, what octafront_judge_image is told.
ALL = ["--ignore", "none"]
TURN = ["--curvature", "24"]
VOLUMES = [("liver, 6 mm", "liver.nrrd", ["--size", "6"], []),
           ("liver, 6 mm, 24 a turn", "liver.nrrd", ["--size", "6", *TURN], []),
           ("liver, 3 mm", "liver.nrrd", ["--size", "3"], []),
           ("KmeansTest, 6 mm", "KmeansTest_T1KmeansPrelimSegmentation.nii.gz", [*ALL, "--size", "6"], ["all"]),
           ("skull strip, 6 mm", "KmeansTest_T1RawSkullStrip.nii.gz", [*ALL, "--size", "6"], ["all"]),
           ("JHU white matter 2 mm, automatic", "JHU-WhiteMatter-labels-2mm.nii.gz", [], []),
           ("JHU white matter 1 mm, 3 mm", "JHU-WhiteMatter-labels-1mm.nii.gz", ["--size", "3"], []),
           ("JHU white matter 1 mm, 3 mm, 24 a turn", "JHU-WhiteMatter-labels-1mm.nii.gz", ["--size", "3", *TURN], []),
           ("natbrainlab, 4 mm", "natbrainlab.nii.gz", ["--size", "4"], []),
           ("HarvardOxford, 4 mm", "HarvardOxford-cort-maxprob-thr0-1mm.nii.gz", ["--size", "4"], []),
           ("jhu189, 4 mm", "jhu189.nii.gz", ["--size", "4"], []),
           ("aal, 4 mm", "aal.nii.gz", ["--size", "4"], []),
           ("inia19, 2 mm", "inia19-NeuroMaps.nii.gz", ["--size", "2"], []),
           ("Cranium, 226 and more", "Cranium.nrrd", ["--iso", "226"], ["iso=226"]),
           ("Cranium, its mask", "Cranium-mask.nrrd", [], []),
           ("Cranium as DICOM", "Cranium.inv3", ["--iso", "226"], ["iso=226"])]
# Volumes above that CGAL meshes too, at this size.
PEERS = {"liver, 6 mm": 6, "liver, 3 mm": 3, "KmeansTest, 6 mm": 6, "HarvardOxford, 4 mm": 4}
LARGE = 1000  # voxels: what labels of so many must keep


def judge(build, image, mesh, words):
    done = subprocess.run([build / "bench/octafront_judge_image", image, mesh, *words],
                          capture_output=True, text=True)
    if done.returncode != 0:
        raise SystemExit(f"{image}: {done.stderr}")
    return json.loads(done.stdout)


def as_inr(source, target):
    """NIfTI with bytes or shorts as INR with the same spacing: CGAL reads no NIfTI, and INR knows no directions."""
    data = gzip.decompress(source.read_bytes())
    n = struct.unpack_from("<3h", data, 42)
    code, = struct.unpack_from("<h", data, 70)
    spacing = struct.unpack_from("<3f", data, 80)
    offset = int(struct.unpack_from("<f", data, 108)[0])
    bits = {2: 8, 4: 16, 512: 16}[code]
    kind = "signed fixed" if code == 4 else "unsigned fixed"
    header = "#INRIMAGE-4#{\n" + "".join(f"{k}={v}\n" for k, v in (
        ("XDIM", n[0]), ("YDIM", n[1]), ("ZDIM", n[2]), ("VDIM", 1), ("TYPE", kind), ("PIXSIZE", f"{bits} bits"), ("CPU", "decm"),
        ("VX", spacing[0]), ("VY", spacing[1]), ("VZ", spacing[2])))
    target.write_bytes(header.encode().ljust(252, b"\n") + b"##}\n" + data[offset:offset + n[0] * n[1] * n[2] * bits // 8])
    return target


def mesh_with_ours(build, image, folder, timeout, options):
    outcome = mesh(build / "cli/octafront", image, folder, timeout, *options, out="out.msh")
    if outcome.mesh:
        outcome.log = improvement(outcome.report)
    return outcome


def improvement(report):
    """What the report says of the elements that stayed below .4."""
    counters = stage(report, "improve")["counters"]
    causes = {"a wedge": "wedges", "a corner": "corners of curves", "thin walls": "thin layers", "kept triangles": "kept triangles"}
    named = [f"{int(counters.get('forced by ' + key, 0))} {words}" for key, words in causes.items() if counters.get("forced by " + key)]
    return {"below_04": int(counters["elements below 0.4"]), "not_forced": int(counters["not forced"]), "forced": named}


def mesh_with_cgal(build, image, folder, timeout, size):
    out = pathlib.Path(folder, "out.mesh")
    return finish(run_measured([build / "bench/peer_cgal_labels", image, out, size], folder, timeout), out)


def row_of(name, outcome, found):
    row = {"name": name, "origin": ORIGIN, "error": outcome.error, "cpu_seconds": outcome.cpu_seconds, "peak_mb": outcome.peak_bytes / 1e6}
    if isinstance(outcome.log, dict):
        row.update(outcome.log)
    return {**row, **found} if found else row


HEAD = ["volume", "labels kept", "elements", "CPU s", "elements/s", "MB", "worst volume error", "labels above 1 %", "least Dice", "below .97", "Hausdorff, voxels",
        "above 1", "pieces in", "pieces out", "Euler number kept", "mean β", "least β", "least angle °", "most °", "below .1 or 8°", "below .4", "forced by",
        "not forced", "origin"]


def cells(row):
    """What the CSV files have of a mesh."""
    if "labels" not in row:
        return [row["name"], row["error"], *[""] * (len(HEAD) - 3), row.get("origin", "")]
    labels = row["labels"]
    kept = [l for l in labels if l["tets"] > 0]
    large = [l for l in kept if l["voxels"] >= LARGE]
    errors = [abs(l["volume_out"] / l["volume_in"] - 1) for l in large] or [0]
    dice = [l["dice"] for l in large] or [1]
    distances = [l["hausdorff"] or 0 for l in kept] or [0]
    return [row["name"], f"{len(kept)} of {len(labels)}", f"{row['elements']:,}", f"{row['cpu_seconds']:.1f}",
            f"{row['elements'] / max(row['cpu_seconds'], 1e-9):,.0f}", f"{row['peak_mb']:.0f}", f"{100 * max(errors):.2f} %",
            f"{sum(e > .01 for e in errors)} of {len(large)}", f"{min(dice):.3f}", sum(d < .97 for d in dice), f"{max(distances):.2f}",
            sum(d > 1 for d in distances), sum(l["pieces"][0] for l in kept), sum(l["pieces"][1] for l in kept),
            sum(l["euler"][0] == l["euler"][1] for l in kept), f"{row['beta_mean']:.3f}", f"{row['beta_min']:.3f}", f"{row['dihedral_min']:.1f}",
            f"{row['dihedral_max']:.1f}", row["poor"], f"{row['below_04']:,}" if "below_04" in row else "", ", ".join(row.get("forced", [])),
            f"{row['not_forced']:,}" if "not_forced" in row else "", row.get("origin", "")]


class Results:
    """Rows by name, kept in a file."""

    def __init__(self, file):
        self.file = file
        self.rows = {"alone": {}, "CGAL": {}, **(json.loads(file.read_text()) if file.is_file() else {})}

    def add(self, kind, row):
        self.rows[kind][row["name"]] = row
        self.file.write_text(json.dumps(self.rows, indent=1))
        print(tables.row(cells(row)), flush=True)

    def of(self, kind, names):
        return [self.rows[kind][name] for name in names if name in self.rows[kind]]


def alone(build, volumes, names, timeout, results):
    for name, file, options, words in VOLUMES:
        if names and name not in names:
            continue
        with tempfile.TemporaryDirectory() as folder:
            image = volumes / file
            if "DICOM" in name:
                image = pathlib.Path(folder, "series")
                write_series(volumes / file, image)
            outcome = mesh_with_ours(build, image, folder, timeout, options)
            found = judge(build, image, outcome.mesh, words) if outcome.mesh else None
        results.add("alone", row_of(name, outcome, found))


def beside(build, volumes, names, timeout, results):
    for name, file, _, _ in VOLUMES:
        if name not in PEERS or (names and name not in names):
            continue
        with tempfile.TemporaryDirectory() as folder:
            image = pathlib.Path(folder, "image.inr")
            if file.endswith(".nrrd"):
                image.write_bytes(gzip.decompress((volumes / file).with_suffix(".inr.gz").read_bytes()))
            else:
                as_inr(volumes / file, image)
            outcome = mesh_with_cgal(build, image, folder, timeout, PEERS[name])
            inrimage(image)
            # To CGAL 0 is outside, always.
            found = judge(build, image.with_suffix(".nrrd"), outcome.mesh, []) if outcome.mesh else None
        results.add("CGAL", row_of(name, outcome, found))


def side_by_side(results):
    rows = []
    for name in PEERS:
        for kind, who in (("alone", "Octafront"), ("CGAL", "CGAL 5.5")):
            rows += [{**row, "name": f"{name}: {who}"} for row in results.of(kind, [name])]
    return rows


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--volumes", nargs="*", default=[])
    parser.add_argument("--timeout", type=float, default=1800)
    parser.add_argument("--peers", action="store_true")
    parser.add_argument("--beside-only", action="store_true")
    parser.add_argument("--page", action="store_true")
    arguments = parser.parse_args()
    build, volumes = arguments.build.resolve(), ROOT / "volumes"
    results = Results(build / "images.json")
    if not arguments.beside_only and not (arguments.page and not arguments.volumes):
        alone(build, volumes, arguments.volumes, arguments.timeout, results)
    if arguments.peers or arguments.beside_only:
        beside(build, volumes, arguments.volumes, arguments.timeout, results)
    if arguments.page:
        write_page(results)


def with_earlier(name, rows, order):
    """The rows, and those of the CSV file of volumes that were not measured now, in order."""
    by_name = {cells[0]: cells for cells in [*tables.rows_of(name), *rows]}
    return [by_name[name] for name in order if name in by_name]


def write_page(results):
    names = [name for name, *_ in VOLUMES]
    both = [f"{name}: {who}" for name in PEERS for who in ("Octafront", "CGAL 5.5")]
    rows = with_earlier("images", map(cells, results.of("alone", names)), names)
    beside = with_earlier("images-beside", map(cells, side_by_side(results)), both)
    origins = {origin for cells in rows for origin in cells[-1].split("; ") if origin}
    tables.write("images-status", ["# Images: what was measured", "", f"{written_by('bench/run.sh images --peers --page', origins)}. {ABOUT}", "", *shown(rows, beside)])


ABOUT = """Volumes of `bench/models/get-volumes.sh`, one thread, each label judged against its voxels (`octafront_judge_image`). Volume errors and Dice are of
labels of 1,000 voxels and more; the two-sided Hausdorff distance, in voxels, is of all labels. Nets alone: `docs/how/image-surfaces.md`."""


NOT_SHOWN = ("skull strip, 6 mm", "natbrainlab, 4 mm", "Cranium, its mask", "Cranium as DICOM", "JHU white matter 1 mm, 3 mm")


def shown(rows, beside):
    """Rows of cells."""
    columns = ["volume", "labels kept", "elements", "CPU s", "worst volume error", "least Dice", "Hausdorff, voxels", "below .1 or 8°"]
    return [*tables.some(HEAD, [r for r in rows if r[0] not in NOT_SHOWN], columns), "", f"With pieces, shapes, how many labels miss 1 % and .97, and what forces elements below .4: {tables.put('images', HEAD, rows)}.", "",
            "CGAL 5.5's Mesh_3 on the same, with the criteria of its manual's example in proportion to the size (facets of 6, distance 4, cells of 8):", "",
            *tables.some(HEAD, [r for r in beside if not r[0].endswith(": Octafront")], columns), "",
            f"Each: {tables.put('images-beside', HEAD, beside)}."]


if __name__ == "__main__":
    main()
