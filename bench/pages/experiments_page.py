"""Writes docs/measured/experiments.md and peers.md from what experiments.py measured. Every figure in the text comes from the data."""
import csv
import json
import pathlib

from bench.pages import tables
from bench.pages.origin import written_by
from bench.run import peers

METHODS = ["octree-aft", "aft", "octree"]
CLASSES = ["0 - 0.2", "0.2 - 0.4", "0.4 - 0.6", "0.6 - 0.8", "0.8 - 1"]
SMOOTH = ["bunny00", "bear", "elephant", "armadillo", "knot1", "dragon"]
# Section VI of the paper; it gives no more figures than these. A minute of its program makes 60,000 elements.
PAPER = {"octree-aft": {0: ".14"}, "aft": {0: ".38", 4: "35.8"}, "octree": {0: "1.3", 4: "12.9"}}
CLASS_KEYS = ["beta_below_0.2", "beta_0.2_0.4", "beta_0.4_0.6", "beta_0.6_0.8", "beta_from_0.8"]


def table(head, rows):
    return "\n".join(tables.table(head, rows))


MODEL_HEAD = ["model", "faces", "method", "elements", "filling s", "all s", "filled/s", "mean β", "min β", "β < .2", "% β ≥ .8", "least angle °", "most °",
              "volume, %"]
SKULL_HEAD = ["size", "elements", "boundary triangles", "CPU s", "MB", "mean β", "min β", "β < .2", "% β ≥ .8", "volume, %", "file judged"]


def runs_of(folder):
    path = folder / "compare.csv"
    return list(csv.DictReader(path.open())) if path.exists() else []


def made(runs, method):
    return [r for r in runs if r["method"] == method and not r["failure"]]


def share(rows, k):
    """Percent of all elements of the rows in class k, and their number."""
    elements = sum(int(r["elements"]) for r in rows)
    count = sum(int(r[CLASS_KEYS[k]]) for r in rows)
    return (100 * count / elements if elements else 0.0), count


def quality_table(runs):
    rows = []
    for k, name in enumerate(CLASSES):
        cells = [name]
        for method in METHODS:
            percent, count = share(made(runs, method), k)
            cells += [f"{percent:.4f} ({count:,})" if k == 0 else f"{percent:.2f}", PAPER[method].get(k, "-")]
        rows.append(cells)
    head = ["β"] + [cell for m in METHODS for cell in (f"{m}, %", f"paper's {m.replace('octree-aft', 'method')}, %")]
    return table(head, rows)


def model_rows(runs):
    rows = []
    for r in runs:
        if r["failure"]:
            rows.append([r["model"], f"{int(r['faces']):,}", r["method"], "no mesh: " + r["failure"][:100]] + [""] * 10)
            continue
        n = int(r["elements"])
        rows.append([r["model"], f"{int(r['faces']):,}", r["method"], f"{n:,}", f"{float(r['filling_cpu_s']):.2f}",
                     f"{float(r['total_cpu_s']):.2f}", f"{n / float(r['filling_cpu_s']) / 1e3:,.0f} k",
                     f"{float(r['beta_mean']):.3f}", f"{float(r['beta_min']):.3f}", r[CLASS_KEYS[0]],
                     f"{100 * int(r[CLASS_KEYS[4]]) / n:.1f}",
                     f"{float(r['dihedral_min_degrees']):.1f}", f"{float(r['dihedral_max_degrees']):.1f}",
                     f"{100 * float(r['volume_over_input']) - 100:+.2f}"])
    return rows


def exponent(folder, method):
    path = folder / "compare.json"
    if not path.exists():
        return None
    return json.loads(path.read_text())["methods"].get(method, {}).get("exponent")


def at_a_million(runs, method):
    rows = [r for r in made(runs, method) if r["elements_wanted"] == "1000000"]
    return rows[0] if rows else None


def rate(row, key="filling_cpu_s"):
    return int(row["elements"]) / float(row[key])


def verdict(holds):
    return "met" if holds else "**not met**"


def not_forced(folder, method):
    """Elements below β = .4 that no boundary explains, as the reports of all runs count them."""
    path = folder / "compare.json"
    runs = json.loads(path.read_text())["runs"] if path.exists() else []
    return int(sum(stage["counters"].get("not forced", 0) for r in runs if r["method"] == method and not r["failure"]
                   for stage in r["report"]["stages"]))


TARGET_HEAD = ["what", "wanted", "measured", "verdict"]


def target_rows(work):
    compared, grown = runs_of(work / "compare"), runs_of(work / "growth")
    percent, count = share(made(compared, "octree-aft"), 0)
    free = not_forced(work / "compare", "octree-aft")
    smooth = [r for r in made(compared, "octree-aft") if r["model"] in SMOOTH and r["elements_wanted"] == "100000"]
    good = {r["model"]: 100 * int(r[CLASS_KEYS[4]]) / int(r["elements"]) for r in smooth}
    rows = [["octree-aft: elements with β < .2", "none that the surface does not force (paper: .14 %)",
             f"{count} in all runs ({percent:.4f} %); below .4 and not forced: {free}", verdict(count == 0 or free == 0) if made(compared, "octree-aft") else "not run"],
            ["octree-aft: share with β ≥ .8, smooth models, 100 k elements", "90 % on each",
             ", ".join(f"{m} {g:.1f} %" for m, g in good.items()), verdict(min(good.values()) >= 90) if good else "not run"]]
    ours, classic = at_a_million(grown, "octree-aft"), at_a_million(grown, "aft")
    if ours and classic:
        times = rate(ours) / rate(classic)
        rows.append(["octree-aft against aft at 1 M elements, filling", "5 times as fast (paper: 1.2 times)",
                     f"{times:.1f} times", verdict(times >= 5)])
        whole = rate(ours, "total_cpu_s") / rate(classic, "total_cpu_s")
        rows.append(["the same, the whole run", "-", f"{whole:.1f} times", "-"])
    power = exponent(work / "growth", "octree-aft")
    if power:
        rows.append(["exponent of octree-aft's filling time over the number of elements", "at most 1.05 (paper: near linear)",
                     f"{power:.2f}", verdict(power <= 1.05)])
    if ours:
        rows.append(["elements a minute at 1 M, filling, one thread", "30 million (paper: 60,000)",
                     f"{60e-6 * rate(ours):.1f} million", verdict(60 * rate(ours) >= 30e6)])
        rows.append(["elements a minute at 1 M, the whole run, one thread", "-",
                     f"{60e-6 * rate(ours, 'total_cpu_s'):.1f} million", "-"])
    return rows


def skull_table(work):
    path = work / "skull-runs.json"
    if not path.exists():
        return "Not run.\n"
    rows = []
    for name, run in json.loads(path.read_text()).items():
        if run is None:
            rows.append([name, "**no mesh**"] + [""] * 9)
            continue
        report, q = run["report"], run["report"]["quality"]
        n = report["tets"]
        rows.append([name, f"{n:,}", f"{report['boundary_faces']:,}", f"{report['cpu_seconds']:.0f}",
                     f"{report['peak_memory_bytes'] / 1e6:,.0f}", f"{q['beta_mean']:.3f}", f"{q['beta_min']:.3f}",
                     f"{q['beta_classes'][0]} ({100 * q['beta_classes'][0] / n:.4f} %)",
                     f"{100 * q['beta_classes'][4] / n:.1f}", f"{100 * report['volume'] / report['input_volume'] - 100:+.3f}",
                     "valid" if not run["judged"]["defect"] else "**not valid**: " + run["judged"]["defect"][:80]])
    return table(SKULL_HEAD, rows)


def peer_rows(work):
    path = work / "peers.json"
    if not path.exists():
        return []
    return [peers.line(row) for row in json.loads(path.read_text())["rows"]]


def page(work):
    compared, grown = runs_of(work / "compare"), runs_of(work / "growth")
    origins = json.loads((work / "origins.json").read_text()).values()
    fill({"written": written_by("bench/run.sh experiments", origins), "models": len({r["model"] for r in compared}),
          "targets": table(TARGET_HEAD, target_rows(work)), "quality": quality_table(compared), "skull": skull_table(work)},
         model_rows(compared), model_rows(grown), peer_rows(work))


def fill(values, compared, grown, beside):
    """Writes the pages, and the rows of cells that go to CSV files."""
    shown = [c for c in MODEL_HEAD[4:] if c != "most °"]
    values |= {"runs": "\n".join(tables.spread_by("method", MODEL_HEAD, compared, shown)), "each": tables.put("experiments", MODEL_HEAD, compared),
               "growth": tables.put("experiments-growth", MODEL_HEAD, grown), "peers": tables.put("peers", peers.HEAD, beside)}
    values |= {surface: "\n".join(peers.shown(beside, surface)) for surface in ("kept", "anew")}
    for name in ("experiments", "peers"):
        text = pathlib.Path(__file__).with_name(f"{name}.md.in").read_text(encoding="utf-8")
        for key, value in values.items():
            text = text.replace("{{" + key + "}}", str(value))
        tables.write(name, [text])
