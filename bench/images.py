"""Images of labels meshed and judged, and beside CGAL's Mesh_3 on the same image.

Usage: bench/run.sh images [--volumes NAME...] [--timeout SECONDS] [--peers] [--beside-only] [--page]
Volumes are those of scripts/get-volumes.sh. Each is meshed on one thread; octafront_judge_image compares every label of the mesh with
its voxels. Keeps each result in BUILD/images.json as soon as it is there; --page writes the tables of docs/measured/images-status.md from all that
are in it. With --peers also CGAL (libcgal-dev), on images turned into INR: labels kept, pieces, volumes, quality, elements per CPU second
of the whole process, reading and writing included.
"""
import argparse
import gzip
import json
import pathlib
import re
import struct
import subprocess
import sys
import tempfile

BENCH = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(BENCH))
from dicom_series import write_series  # noqa: E402
from pages.origin import ORIGIN, written_by  # noqa: E402
from peers.process import finish, run_measured  # noqa: E402

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
PAGE = BENCH.parent / "docs/measured/images-status.md"
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
    out, report = pathlib.Path(folder, "out.msh"), pathlib.Path(folder, "out.json")
    outcome = run_measured([build / "cli/octafront", "mesh", image, "-o", out, "--threads", "1", "-q", "--json", report, *options],
                           folder, timeout)
    outcome = finish(outcome, out)
    if outcome.mesh:
        outcome.log = improvement(json.loads(report.read_text()))
    return outcome


def improvement(report):
    """What the report says of the elements that stayed below .4."""
    counters = next(s for s in report["stages"] if s["name"] == "improve")["counters"]
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


def summary(row):
    """What a table shows of a mesh."""
    labels = row["labels"]
    kept = [l for l in labels if l["tets"] > 0]
    large = [l for l in kept if l["voxels"] >= LARGE]
    errors = sorted((abs(l["volume_out"] / l["volume_in"] - 1) for l in large), reverse=True) or [0]
    dice = sorted(l["dice"] for l in large) or [1]
    distances = sorted((l["hausdorff"] or 0 for l in kept), reverse=True) or [0]
    return {"labels": f"{len(kept)} of {len(labels)}",
            "volume": f"{100 * errors[0]:.2f} % ({sum(e > .01 for e in errors)} of {len(large)})",
            "dice": f"{dice[0]:.3f} ({sum(d < .97 for d in dice)})",
            "hausdorff": f"{distances[0]:.2f} ({sum(d > 1 for d in distances)})",
            "pieces": f"{sum(l['pieces'][0] for l in kept)} / {sum(l['pieces'][1] for l in kept)}",
            "euler": f"{sum(l['euler'][0] == l['euler'][1] for l in kept)}",
            "beta": f"{row['beta_mean']:.3f}, {row['beta_min']:.3f}",
            "angles": f"{row['dihedral_min']:.1f} - {row['dihedral_max']:.1f}",
            "poor": f"{row['poor']}"}


def table(rows):
    lines = ["| volume | labels kept | elements | CPU s | elements/s | MB | volume error (above 1 %) | Dice (below .97) | Hausdorff, voxels (above 1) "
             "| pieces in / out | Euler number kept | β mean, least | dihedral angles | below .1 or 8° |", "| --- " * 14 + "|"]
    for row in rows:
        if "labels" not in row:
            lines.append(f"| {row['name']} | {row['error']} |" + " |" * 12)
            continue
        s = summary(row)
        speed = row["elements"] / max(row["cpu_seconds"], 1e-9)
        lines.append(f"| {row['name']} | {s['labels']} | {row['elements']:,} | {row['cpu_seconds']:.1f} | {speed:,.0f} | {row['peak_mb']:.0f} | "
                     f"{s['volume']} | {s['dice']} | {s['hausdorff']} | {s['pieces']} | {s['euler']} | {s['beta']} | {s['angles']} | {s['poor']} |")
    return lines


def poor_elements(rows):
    lines = ["| volume | below .4 | forced by | not forced |", "| --- " * 4 + "|"]
    for row in rows:
        if "below_04" in row:
            lines.append(f"| {row['name']} | {row['below_04']:,} | {', '.join(row['forced']) or '-'} | {row['not_forced']:,} |")
    return lines


class Results:
    """Rows by name, kept in a file."""

    def __init__(self, file):
        self.file = file
        self.rows = {"alone": {}, "CGAL": {}, **(json.loads(file.read_text()) if file.is_file() else {})}

    def add(self, kind, row):
        self.rows[kind][row["name"]] = row
        self.file.write_text(json.dumps(self.rows, indent=1))
        print("\n".join(table([row])[2:]), flush=True)

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
            # To CGAL 0 is outside, always.
            found = judge(build, image, outcome.mesh, []) if outcome.mesh else None
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
    build, volumes = arguments.build.resolve(), BENCH.parent / "volumes"
    results = Results(build / "images.json")
    if not arguments.beside_only and not (arguments.page and not arguments.volumes):
        alone(build, volumes, arguments.volumes, arguments.timeout, results)
    if arguments.peers or arguments.beside_only:
        beside(build, volumes, arguments.volumes, arguments.timeout, results)
    if arguments.page:
        write_page(results)


def part_of_page(command, shown, lines, old, names):
    """Origin and table, with the rows of the old part whose volumes were not measured now, all in the order of `names`."""
    def by_name(rows):
        return {row.split(" | ")[0].removeprefix("| "): row for row in rows if row.startswith("| ")}
    before, now = by_name(old.splitlines()), by_name(lines[2:])
    origins = {row["origin"] for row in shown if "origin" in row}
    if any(name in before and name not in now for name in names):
        origins.update(re.search(r"\((commit .*)\)", old)[1].split("; "))
    rows = before | now
    return "\n".join([f"{written_by(command, origins)}.", "", *lines[:2], *(rows[name] for name in names if name in rows)])


def write_page(results):
    """Each table stands between its marks; the text around them is written by hand."""
    page, names = PAGE.read_text(), [name for name, *_ in VOLUMES]
    rows, beside = results.of("alone", names), side_by_side(results)
    both = [f"{name}: {who}" for name in PEERS for who in ("Octafront", "CGAL 5.5")]
    alone = "bench/run.sh images --page"
    for mark, *part, order in (("volumes", alone, rows, table(rows), names),
                               ("poor elements", alone, rows, poor_elements(rows), names),
                               ("beside CGAL", "bench/run.sh images --peers --page", beside, table(beside), both)):
        before, rest = page.split(f"<!-- {mark} -->\n")
        old, behind = rest.split("<!-- end -->", 1)
        page = before + f"<!-- {mark} -->\n" + part_of_page(*part, old, order) + "\n<!-- end -->" + behind
    PAGE.write_text(page)


if __name__ == "__main__":
    main()
