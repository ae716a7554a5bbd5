"""Clean surfaces of a million triangles at coarse sizes: what a triangle of the input costs, and one that is made.

Usage: bench/run.sh coarse_input [--beside PROGRAM]
Writes docs/measured/coarse-input.md. The inputs are clean models triangulated anew at small sizes, and one whose triangles are
divided in their planes. `--beside`: another build of octafront, on the same inputs.
"""
import argparse
import json
import math
import pathlib
import tempfile

from bench.pages.origin import ROOT, written_by
from bench.pages.tables import put, table, write
from bench.process import waited

TRIANGLES = 1_000_000
REMESHED = ["bunny00.off", "fandisk_large.off", "elephant.off"]
DIVIDED = ["armadillo.off"]
SETTINGS = [("automatic", []), ("50,000 elements", ["--elements", 50_000]), ("500,000 elements", ["--elements", 500_000])]
ON_PAGE = "50,000 elements"
STAGES = ["repair", "coarsen", "detail", "features", "size field", "surface front"]
SECONDS = 600


def read_off(path):
    words = path.read_text().split()
    points, faces = int(words[1]), int(words[2])
    at = [tuple(map(float, words[4 + 3 * i:7 + 3 * i])) for i in range(points)]
    begin = 4 + 3 * points
    return at, [tuple(map(int, words[begin + 4 * i + 1:begin + 4 * i + 4])) for i in range(faces)]


def divided(points, triangles):
    """Each triangle in four, in its plane."""
    points, middles, made = list(points), {}, []

    def middle(a, b):
        key = (min(a, b), max(a, b))
        if key not in middles:
            middles[key] = len(points)
            points.append(tuple((x + y) / 2 for x, y in zip(points[a], points[b])))
        return middles[key]

    for a, b, c in triangles:
        ab, bc, ca = middle(a, b), middle(b, c), middle(c, a)
        made += [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
    return points, made


def write_off(path, points, triangles):
    with path.open("w") as file:
        file.write(f"OFF\n{len(points)} {len(triangles)} 0\n")
        file.writelines("%.17g %.17g %.17g\n" % p for p in points)
        file.writelines("3 %d %d %d\n" % t for t in triangles)


def area(points, triangles):
    total = 0
    for a, b, c in triangles:
        u, v = ([points[i][k] - points[a][k] for k in range(3)] for i in (b, c))
        total += math.sqrt(sum((u[i - 2] * v[i - 1] - u[i - 1] * v[i - 2]) ** 2 for i in range(3))) / 2
    return total


def fine_input(program, name, folder):
    points, triangles = read_off(ROOT / "models/clean" / name)
    path = folder / f"{pathlib.Path(name).stem}.off"
    if name in DIVIDED:
        while 4 * len(triangles) < 1.5 * TRIANGLES:
            points, triangles = divided(points, triangles)
        write_off(path, points, triangles)
    else:
        size = math.sqrt(4 / math.sqrt(3) * area(points, triangles) / TRIANGLES)
        done = waited([program, "surface", ROOT / "models/clean" / name, "--size", size, "-o", path], SECONDS)
        assert done[0] == 0, done[4]
    return path


def run(program, path, given, folder):
    status, _, usage, _, told = waited([program, "mesh", path, *given, "--threads", 1, "--json", folder / "report.json", "-o", folder / "mesh.vtu"],
                                       SECONDS)
    assert status == 0, told
    report = json.loads((folder / "report.json").read_text())
    return report, usage.ru_utime + usage.ru_stime


HEAD = ["model", "sizes", "build", "input triangles", "output triangles", "tetrahedra", "CPU s", "reading and mending", *STAGES, "rest",
        "us per input triangle", "us per output triangle", "mean beta", "least beta", "least angle", "volume off, %", "Hausdorff, % of diagonal"]
SHORT = ["model", "build", "tetrahedra", "CPU s", "reading and mending", "coarsen", "size field", "surface front", "mean beta",
         "least angle", "volume off, %", "Hausdorff, % of diagonal"]


def row(model, sizes, build, told):
    report, cpu, judged = told
    stage, inside = dict.fromkeys(STAGES, 0.0), 0.0
    for s in report["stages"]:
        inside += s["cpu_seconds"]
        name = next((k for k in STAGES if s["name"].startswith(k)), None)  # several tries for a number of elements belong to one
        if name:
            stage[name] += s["cpu_seconds"]
    triangles, made = report["stages"][0]["counters"]["triangles"], report["boundary_faces"]
    quality, volume = report["quality"], report["input_volume"]
    before = cpu - inside
    of_input = before + sum(stage[s] for s in ["repair", "coarsen", "detail", "features"])
    return [model, sizes, build, f"{triangles:,.0f}", f"{made:,}", f"{report['tets']:,}", f"{cpu:.2f}", f"{before:.2f}",
            *(f"{stage[s]:.2f}" for s in STAGES), f"{inside - sum(stage.values()):.2f}", f"{1e6 * of_input / triangles:.2f}",
            f"{1e6 * (stage['size field'] + stage['surface front']) / made:.1f}", f"{quality['beta_mean']:.3f}", f"{quality['beta_min']:.2f}",
            f"{quality['dihedral_min_degrees']:.1f}", f"{100 * (report['volume'] / volume - 1):.2f}",
            f"{judged['hausdorff_percent']:.2f}"]


def judge(build, mesh, surface):
    status, _, _, _, told = waited([build / "bench/octafront_evaluate", mesh, surface], SECONDS)
    assert status == 0, told
    return json.loads(told)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--beside", type=pathlib.Path)
    parser.add_argument("--only", default="")
    parser.add_argument("--skip-page", action="store_true")
    a = parser.parse_args()
    programs = {"now": a.build / "cli/octafront"} | ({"before": a.beside} if a.beside else {})
    rows = []
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for model in REMESHED + DIVIDED:
            if a.only not in model:
                continue
            path = fine_input(programs["now"], model, folder)
            for sizes, given in SETTINGS:
                for build, program in programs.items():
                    report, cpu = run(program, path, given, folder)
                    rows.append(row(model, sizes, build, (report, cpu, judge(a.build, folder / "mesh.vtu", path))))
                    print(" | ".join(rows[-1]), flush=True)
            path.unlink()
    if not a.skip_page:
        text = (ROOT / "bench/pages/coarse-input.md.in").read_text()
        lines = [*table(SHORT, [[cells[HEAD.index(c)] for c in SHORT] for cells in rows if cells[1] == ON_PAGE]), "",
                 f"Automatic sizes and 500,000 elements, all stages, by input and by output triangle: {put('coarse-input', HEAD, rows)}."]
        said = f"{written_by('bench/run.sh coarse_input')}: files of about a million triangles, one thread, CPU seconds of the process."
        write("coarse-input", [text.replace("@SAID@", said).replace("@TABLE@", "\n".join(lines))])


if __name__ == "__main__":
    main()
