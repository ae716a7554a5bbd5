"""Fields brought from mesh to mesh: are integrals and bounds kept, how large are errors, what does it cost? 30 pairs of meshes of ten
bodies; a cube on refined pairs, for the order; a million elements. Writes docs/measured/carry.md.

Usage: bench/run.sh carry [--only SUBSTRING] [--quick]
"""
import argparse
import math
import pathlib
import tempfile

from bench.models.cube import CUBE
from bench.ours import Runs
from bench.pages import tables
from bench.pages.origin import written_by

MODELS = ["bunny00.off", "armadillo.off", "couplingdown.off", "fandisk.off", "femur.off", "joint.off", "elephant.off", "rotor.off", "double-torus-example.off"]
HEAD_IMAGE = "samples/head_labels.nii.gz"
SMOOTH = "sin(6.3*(x-({x}))/{d})*cos(5*(y-({y}))/{d})+(z-({z}))/{d}"
STEP = "max(0,min(1,1e6*((x-({x}))/{d}+(y-({y}))/{d})))"
PAIRS = ["body", "pair", "old", "new", "regions", "volume changed", "uncovered", "lost", "integral error", "beyond the range", "mean error", "mean error, linear", "CPU s", "CPU s, linear"]
ORDERS = ["old size", "elements", "of elements", "of elements, linear", "at points", "at points, quadratic"]
COSTS = ["what", "old", "new", "both have", "CPU s", "of them reading and writing", "memory MB"]


class Carries(Runs):
    def meshed(self, name, source, *options):
        """The mesh, with the two fields on it, and how to write them."""
        file = self.folder / f"{name}.vtu"
        self.run("mesh", source, "-o", file, *options)
        return file

    def with_fields(self, file, place):
        self.run("convert", file, "-o", self.folder / "old.vtu", "--field", "smooth=" + SMOOTH.format(**place), "--field", "steep=" + STEP.format(**place))
        return self.folder / "old.vtu"

    def carried(self, old, new, exact, *options):
        """The report, the run, and the mean error of the smooth field of elements and at points."""
        out = self.folder / "new.vtu"
        report, done = self.run("carry", old, new, "-o", out, "--field", f"error=abs(smooth-({exact}))", *options)
        told, _ = self.run("carry", out, out, "-o", self.folder / "again.vtu", "--carry", "error")
        means = {f["of"]: f["after"]["integral"][0] / report["carry"]["volume_after"] for f in told["carried"]}
        return report, done, means


def place_of(runs, file):
    box = runs.run("info", file)[0]["box"]
    middle = [(a + b) / 2 for a, b in zip(*box)]
    return dict(zip("xyz", middle), d=max(b - a for a, b in zip(*box)))


def pair_row(runs, body, pair, old, new):
    place = place_of(runs, old)
    exact = SMOOTH.format(**place)
    source = runs.with_fields(old, place)
    report, done, means = runs.carried(source, new, exact)
    linear, done_linear, means_linear = runs.carried(source, new, exact, "--linear-elements")
    fields = [f for made in (report, linear) for f in made["carried"] if f["of"] == "elements"]
    mesh, regions = report["carry"], len(runs.run("info", new)[0]["places"]["regions"])
    of_volume = lambda v: f"{100 * v / mesh['volume_before']:.4f} %" if abs(v) > 1e-12 * mesh["volume_before"] else "0"
    outside = [max(0, f["after"]["greatest"][0] - f["before"]["greatest"][0], f["before"]["least"][0] - f["after"]["least"][0]) for f in fields]
    points = [f for f in report["carried"] if f["of"] == "points"]
    assert all(f["after"]["least"][0] >= f["before"]["least"][0] and f["after"]["greatest"][0] <= f["before"]["greatest"][0] for f in points)
    return [body, pair, f"{runs.run('info', source)[0]['tets']:,}", f"{mesh['elements']:,}", regions, of_volume(mesh["volume_after"] - mesh["volume_before"]),
            of_volume(mesh["uncovered"]), of_volume(mesh["lost"]), f"{max(f['integral_error'] for f in fields):.1e}", f"{max(outside):.1e}" if max(outside) else "0",
            f"{means['elements']:.4f}", f"{means_linear['elements']:.4f}", f"{done.cpu_seconds:.2f}", f"{done_linear.cpu_seconds:.2f}"]


def meshes_of(runs, model, quick):
    if model == HEAD_IMAGE:
        sized = lambda name, size: runs.meshed(name, model, "--size", size)
        return [("finer", sized("a", 8), sized("b", 5)), ("coarser", runs.folder / "b.vtu", runs.folder / "a.vtu"), ("as fine", sized("c", 6), sized("d", 6.3))]
    n = 3000 if quick else 20000
    source = pathlib.Path("models/clean", model)
    a, b = runs.meshed("a", source, "--elements", n), runs.meshed("b", source, "--elements", 3 * n)
    surface = runs.folder / "surface.ply"
    runs.run("surface", source, "-o", surface, "--elements", n)
    kept, other = runs.meshed("c", surface, "--keep-surface"), runs.meshed("d", surface, "--keep-surface", "--gradation", .4)
    return [("finer", a, b), ("coarser", b, a), ("same triangles", kept, other)]


def pair_rows(runs, only, quick):
    rows = []
    for model in [*MODELS, HEAD_IMAGE]:
        if only not in model:
            continue
        for pair, old, new in meshes_of(runs, model, quick):
            rows.append(pair_row(runs, pathlib.Path(model).name, pair, old, new))
            print(tables.row(rows[-1]), flush=True)
    return rows


def order_rows(runs, quick):
    """With the exponents between lines."""
    cube = runs.folder / "cube.off"
    cube.write_text(CUBE)
    place = {"x": .5, "y": .5, "z": .5, "d": 1}
    exact, rows, before = SMOOTH.format(**place), [], None
    for size in (.2, .1, .05) if quick else (.2, .1, .05, .025):
        old, new = runs.meshed("old_cube", cube, "--size", size), runs.meshed("new_cube", cube, "--size", .93 * size)
        source = runs.with_fields(old, place)
        report, _, means = runs.carried(source, new, exact)
        linear = runs.carried(source, new, exact, "--linear-elements")[2]
        quadratic = runs.carried(source, new, exact, "--quadratic-nodes")[2]
        errors = [means["elements"], linear["elements"], means["points"], quadratic["points"]]
        shown = [f"{e:.2e}" + (f" ({math.log2(b / e):.2f})" if before else "") for e, b in zip(errors, before or errors)]
        rows.append([f"{size:g}", f"{report['carry']['elements']:,}", *shown])
        before = errors
        print(tables.row(rows[-1]), flush=True)
    return rows


def cost_rows(runs, quick):
    rows, n = [], 50_000 if quick else 1_000_000
    source = pathlib.Path("models/clean/bunny00.off")
    old = runs.with_fields(runs.meshed("old_million", source, "--elements", n), {"x": 0, "y": 0, "z": 0, "d": 1})
    new = runs.meshed("new_million", source, "--elements", n, "--gradation", .19)
    reading = runs.run("convert", old, "-o", runs.folder / "out.vtu")[1].cpu_seconds + runs.run("info", new)[1].cpu_seconds
    for what, onto, options in (("another mesh", new, []), ("another mesh, linear", new, ["--linear-elements"]), ("another mesh, quadratic at points", new, ["--quadratic-nodes"]), ("the same mesh", old, [])):
        report, done = runs.run("carry", old, onto, "-o", runs.folder / "out.vtu", *options)
        mesh = report["carry"]
        rows.append([what, f"{runs.run('info', old)[0]['tets']:,}", f"{mesh['elements']:,}", f"{mesh['copied_elements']:,}", f"{done.cpu_seconds:.1f}",
                     f"{reading:.1f}", f"{done.peak_bytes / 1e6:.0f}"])
        print(tables.row(rows[-1]), flush=True)
    return rows


ABOUT = """one thread; CPU seconds are those of the whole command, reading and writing included, while others used the machine. Each old mesh has two fields, at points
and of elements: *smooth*, a product of a sine and a cosine with about one period over the body, and *steep*, 0 on one side of a plane through the middle and 1 on the other. *Finer* and *coarser*: 20 thousand elements and three times as many; *same
triangles*: the same surface kept, another gradation inside; the head is an image of labels at 5, 6, 6.3 and 8 mm. *Integral error*: the greatest relative change of a region's integral, of both fields, constant and linear. *Mean error*: of the smooth field of
elements, against its value in their middles, over the volume."""


def page(pairs, orders, costs):
    head = f"{written_by('bench/run.sh carry')}, {ABOUT}"
    return ["# Carried fields", "", head, "", "## Pairs", "", *tables.spread(PAIRS, pairs, ["old", "new", "integral error", "beyond the range", "mean error", "mean error, linear", "CPU s", "CPU s, linear"]),
            "", f"Each: {tables.put('carry', PAIRS, pairs)}.", "", "## Order", "", "A unit cube with elements of a size, onto one of .93 of it; in brackets the power of the size by which errors fall.", "",
            *tables.table(ORDERS, orders), "", f"Rows: {tables.put('carry-order', ORDERS, orders)}.", "", "## Cost", "", *tables.table(COSTS, costs), "", f"Rows: {tables.put('carry-cost', COSTS, costs)}."]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--only", default="")
    parser.add_argument("--quick", action="store_true", help="small meshes, to try; no page")
    a = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        runs = Carries(a.build, folder)
        pairs, orders, costs = pair_rows(runs, a.only, a.quick), order_rows(runs, a.quick), cost_rows(runs, a.quick)
    if not a.only and not a.quick:
        tables.write("carry", page(pairs, orders, costs))


if __name__ == "__main__":
    main()
