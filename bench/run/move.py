"""Meshes cut along level sets, and meshes that move: a ball through a box in twenty places, two fields at a time; blocks and bars
stretched, flattened, bent and twisted. Are they valid, how good are elements, are volumes kept? Writes docs/measured/move.md.

Usage: bench/run.sh move [--quick]
"""
import argparse
import math
import pathlib
import tempfile

from bench.ours import Runs
from bench.pages import tables
from bench.pages.origin import written_by

BOX = [(0, 2, 3), (0, 3, 1), (4, 5, 7), (4, 7, 6), (0, 1, 5), (0, 5, 4), (2, 6, 7), (2, 7, 3), (0, 4, 6), (0, 6, 2), (1, 3, 7), (1, 7, 5)]
CUTS = ["place", "elements", "ball's volume, of the true one", "least β", "mean β", "angles °", "points moved", "edges divided", "CPU s"]
MOTIONS = ["motion", "old elements", "elements", "steps", "of them improved", "of them adapted", "least β on the way", "least β", "mean β", "volume", "volume of the motion", "CPU s"]


class Boxes(Runs):
    def box(self, name, size, length, *options):
        """A box from the origin, `length` along x and 1 across."""
        surface, mesh = self.folder / f"{name}.off", self.folder / f"{name}.vtk"
        corners = "".join(f"{length * ((i >> 2) & 1)} {(i >> 1) & 1} {i & 1}\n" for i in range(8))
        surface.write_text(f"OFF\n8 12 0\n{corners}" + "".join("3 %d %d %d\n" % (a, b, c) for a, b, c in BOX))
        self.run("mesh", surface, "-o", mesh, "--ascii", "--size", size, *options)
        return mesh


def ball_in_box(runs, quick):
    rows, mesh, places = [], runs.box("cube", .1 if quick else .05, 1), 4 if quick else 20
    for i in range(places):
        angle = 2 * math.pi * i / places
        x, y, z = .5 + .25 * math.cos(angle), .5 + .25 * math.sin(angle), .5 + .02 * i / places
        field = runs.folder / "field.vtu"
        runs.run("convert", mesh, "-o", field, "--field", f"ball=sqrt((x-{x})^2+(y-{y})^2+(z-{z})^2)-.2")
        report, done = runs.run("adapt", field, "--level-set", "ball", "-o", runs.folder / "cut.vtu")
        runs.run("check", runs.folder / "cut.vtu")
        quality, cut = report["quality"], report["level_sets"][0]
        volume = next(r["volume"] for r in report["regions"] if r["name"] == "ball") / (4 / 3 * math.pi * .008)
        rows.append([f"{360 * i / places:.0f}°", f"{report['tets']:,}", f"{volume:.4f}", f"{quality['beta_min']:.3f}", f"{quality['beta_mean']:.3f}",
                     f"{quality['dihedral_min_degrees']:.1f}–{quality['dihedral_max_degrees']:.1f}", cut["moved"], cut["divided"], f"{done.cpu_seconds:.2f}"])
        print(tables.row(rows[-1]), flush=True)
    return rows


def bent(turns, length):
    radius = length / (2 * math.pi * turns)

    def place(x, y, z):
        a, r = x / radius, radius + .5 - y
        return r * math.sin(a), radius + .5 - r * math.cos(a), z
    return place


def twisted(turns, length):
    def place(x, y, z):
        a = 2 * math.pi * turns * x / length
        c, s = math.cos(a), math.sin(a)
        return x, .5 + c * (y - .5) - s * (z - .5), .5 + s * (y - .5) + c * (z - .5)
    return place


def motions():
    """(name, length of the box, place of a point afterwards, volume afterwards)"""
    return [("stretched 4 times", 1, lambda x, y, z: (4 * x, y, z), 4), ("flattened to a tenth", 1, lambda x, y, z: (.1 * x, 3 * y, 3 * z), .9),
            ("pressed to 40 %, as rubber", 1, lambda x, y, z: (.4 * x, y / math.sqrt(.4), z / math.sqrt(.4)), 1),
            ("bent by 180°", 8, bent(.5, 8), 8), ("twisted by 360°", 8, twisted(1, 8), 8),
            ("sheared by 3", 1, lambda x, y, z: (x + 3 * y, y, z), 1)]


def with_displacement(runs, mesh, place):
    text = mesh.read_text()
    count = int(text.split("POINTS ")[1].split()[0])
    xyz = [float(w) for w in text.split("POINTS ")[1].split()[2:2 + 3 * count]]
    rows = []
    for i in range(0, 3 * count, 3):
        p = xyz[i:i + 3]
        rows.append("%r %r %r" % tuple(a - b for a, b in zip(place(*p), p)))
    file = runs.folder / "moving.vtk"
    file.write_text(text.partition("POINT_DATA")[0] + f"POINT_DATA {count}\nFIELD f 1\nu 3 {count} double\n" + "\n".join(rows) + "\n")
    return file


def motion_rows(runs, quick):
    rows = []
    for name, length, place, volume in motions():
        mesh = runs.box("bar", (.2 if quick else .1) * (1 if length == 1 else 1.5), length)
        old = runs.run("info", mesh)[0]["tets"]
        report, done = runs.run("move", with_displacement(runs, mesh, place), "--displacement", "u", "-o", runs.folder / "moved.vtu")
        runs.run("check", runs.folder / "moved.vtu")
        history = report["history"]
        last, count = history[-1], lambda change: sum(step["change"] == change for step in history)
        rows.append([name, f"{old:,}", f"{last['elements']:,}", len(history), count("improved"), count("adapted"), f"{min(s['beta_min'] for s in history):.3f}", f"{last['beta_min']:.3f}",
                     f"{last['beta_mean']:.3f}", f"{last['volume']:.4f}", f"{volume:g}", f"{done.cpu_seconds:.2f}"])
        print(tables.row(rows[-1]), flush=True)
    return rows


def page(cuts, motion):
    head = f"""{written_by('bench/run.sh move')}, one thread; CPU seconds are those of the whole command, while others used the machine. Each result is judged by `octafront check`:
all are valid. *Ball*: of a fifth of the box's edge, in twenty places of a circle, as the level set of its distance on one mesh of size .05, cut and adapted with the sizes kept. *Motions*: a unit cube of size .1, or a bar of
1 × 1 × 8 of size .15, by the displacement of all points in one call."""
    return ["# Level sets and motion", "", head, "", "## A ball in a box", "", *tables.spread(CUTS, cuts, [c for c in CUTS if c not in ("place", "angles °")]), "", f"Each: {tables.put('move-ball', CUTS, cuts)}.", "", "## Motions", "",
            *tables.some(MOTIONS, motion, [c for c in MOTIONS if c not in ("old elements", "of them improved")]), "", f"With all figures: {tables.put('move', MOTIONS, motion)}."]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--quick", action="store_true", help="small meshes, to try; no page")
    a = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        runs = Boxes(a.build, folder)
        cuts, motion = ball_in_box(runs, a.quick), motion_rows(runs, a.quick)
    if not a.quick:
        tables.write("move", page(cuts, motion))


if __name__ == "__main__":
    main()
