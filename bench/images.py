"""Images of labels meshed and judged, and beside CGAL's Mesh_3 on the same image.

Usage: bench/run.sh images [--volumes NAME...] [--timeout SECONDS] [--peers] [--beside-only]
Volumes are those of scripts/get-volumes.sh. Each is meshed on one thread; octafront_judge_image compares every label of the mesh with
its voxels. Prints the tables of docs/images-status.md; writes BUILD/images.json. With --peers also CGAL (libcgal-dev), on images turned
into INR: labels kept, pieces, volumes, quality, elements per CPU second of the whole process, reading and writing included.
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
from peers.process import finish, run_measured  # noqa: E402

# Name, file, options, whether 0 is a label.
VOLUMES = [("liver, 6 mm", "liver.inr.gz", ["--size", "6"], False),
           ("liver", "liver.inr.gz", [], False),
           ("Kmeans", "KmeansTest_T1KmeansPrelimSegmentation.nii.gz", ["--ignore", "none"], True),
           ("skull strip", "KmeansTest_T1RawSkullStrip.nii.gz", ["--ignore", "none"], True),
           ("JHU-WM 2 mm", "JHU-WhiteMatter-labels-2mm.nii.gz", [], False),
           ("JHU-WM 1 mm", "JHU-WhiteMatter-labels-1mm.nii.gz", [], False),
           ("natbrainlab", "natbrainlab.nii.gz", [], False),
           ("HarvardOxford", "HarvardOxford-cort-maxprob-thr0-1mm.nii.gz", [], False),
           ("jhu189", "jhu189.nii.gz", [], False),
           ("aal", "aal.nii.gz", [], False),
           ("inia19", "inia19-NeuroMaps.nii.gz", [], False)]
PEERS = [("liver, 6 mm", "liver.inr.gz", 6, False), ("liver, 3 mm", "liver.inr.gz", 3, False),
         ("Kmeans, 4 mm", "KmeansTest_T1KmeansPrelimSegmentation.nii.gz", 4, True),
         ("HarvardOxford, 3 mm", "HarvardOxford-cort-maxprob-thr0-1mm.nii.gz", 3, False)]
LARGE = 1000  # voxels: what labels of so many must keep


def judge(build, image, mesh, all_labels):
    done = subprocess.run([build / "bench/octafront_judge_image", image, mesh, *(["all"] if all_labels else [])],
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
    out = pathlib.Path(folder, "out.msh")
    outcome = run_measured([build / "cli/octafront", "mesh", image, "-o", out, "--threads", "1", "-q", *options], folder, timeout)
    return finish(outcome, out)


def mesh_with_cgal(build, image, folder, timeout, size):
    out = pathlib.Path(folder, "out.mesh")
    return finish(run_measured([build / "bench/peer_cgal_labels", image, out, size], folder, timeout), out)


def row_of(name, outcome, found):
    row = {"name": name, "error": outcome.error, "cpu_seconds": outcome.cpu_seconds, "peak_mb": outcome.peak_bytes / 1e6}
    return {**row, **found} if found else row


def summary(row):
    """What a table shows of a mesh."""
    labels = row["labels"]
    kept = [l for l in labels if l["tets"] > 0]
    large = [l for l in kept if l["voxels"] >= LARGE]
    worst = max((abs(l["volume_out"] / l["volume_in"] - 1) for l in large), default=0)
    return {"labels": f"{len(kept)} of {len(labels)}", "volume": f"{100 * worst:.2f} %",
            "dice": f"{min((l['dice'] for l in large), default=1):.3f}",
            "hausdorff": f"{max((l['hausdorff'] or 0 for l in kept), default=0):.2f}",
            "pieces": f"{sum(l['pieces'][0] for l in kept)} / {sum(l['pieces'][1] for l in kept)}",
            "euler": f"{sum(l['euler'][0] == l['euler'][1] for l in kept)} of {len(kept)}",
            "beta": f"{row['beta_mean']:.3f}, {row['beta_min']:.3f}",
            "angles": f"{row['dihedral_min']:.1f} - {row['dihedral_max']:.1f}"}


def print_rows(rows):
    print("| volume | labels kept | elements | CPU s | elements/s | MB | volume error | Dice | Hausdorff, voxels | pieces in / out | "
          "Euler number kept | β mean, least | dihedral angles |")
    print("| --- " * 13 + "|")
    for row in rows:
        if "labels" not in row:
            print(f"| {row['name']} | {row['error']} |" + " |" * 11)
            continue
        s = summary(row)
        speed = row["elements"] / max(row["cpu_seconds"], 1e-9)
        print(f"| {row['name']} | {s['labels']} | {row['elements']:,} | {row['cpu_seconds']:.1f} | {speed:,.0f} | {row['peak_mb']:.0f} | "
              f"{s['volume']} | {s['dice']} | {s['hausdorff']} | {s['pieces']} | {s['euler']} | {s['beta']} | {s['angles']} |", flush=True)


def alone(build, volumes, names, timeout):
    rows = []
    for name, file, options, all_labels in VOLUMES:
        if names and not any(n in (name, file.split(".")[0]) for n in names):
            continue
        with tempfile.TemporaryDirectory() as folder:
            outcome = mesh_with_ours(build, volumes / file, folder, timeout, options)
            found = judge(build, volumes / file, outcome.mesh, all_labels) if outcome.mesh else None
        rows.append(row_of(name, outcome, found))
    return rows


def beside(build, volumes, names, timeout):
    rows = []
    for name, file, size, all_labels in PEERS:
        if names and name not in names:
            continue
        with tempfile.TemporaryDirectory() as folder:
            image = volumes / file
            if not re.search(r"\.inr(\.gz)?$", file):
                image = as_inr(image, pathlib.Path(folder, "image.inr"))
            ignore = ["--ignore", "none"] if all_labels else []
            for who, outcome in (("Octafront", mesh_with_ours(build, image, folder, timeout, ["--size", str(size), *ignore])),
                                 ("CGAL 5.5", mesh_with_cgal(build, image, folder, timeout, size))):
                found = judge(build, image, outcome.mesh, all_labels) if outcome.mesh else None
                rows.append(row_of(f"{name}: {who}", outcome, found))
    return rows


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--volumes", nargs="*", default=[])
    parser.add_argument("--timeout", type=float, default=1800)
    parser.add_argument("--peers", action="store_true")
    parser.add_argument("--beside-only", action="store_true")
    arguments = parser.parse_args()
    build, volumes = arguments.build.resolve(), BENCH.parent / "volumes"
    rows = [] if arguments.beside_only else alone(build, volumes, arguments.volumes, arguments.timeout)
    print_rows(rows)
    if arguments.peers or arguments.beside_only:
        side = beside(build, volumes, arguments.volumes, arguments.timeout)
        print("\nBeside CGAL, each to the same size:\n")
        print_rows(side)
        rows += side
    (build / "images.json").write_text(json.dumps(rows, indent=1))


if __name__ == "__main__":
    main()
