"""docs/measured/cad.md, of what bench/run/cad.py found."""
import math
import pathlib
import re
import statistics

from bench.pages.origin import written_by
from bench.pages.tables import put, table, write as write_page

TEXT = pathlib.Path(__file__).resolve().parent / "cad.md.in"
MESHERS = ("ours", "Gmsh", "Gmsh's HXT", "Netgen")
ORDER = {40: 1, 100: 2}
COLUMNS = ("file", "solids, faces", "size, order", "mesher", "elements", "volume, %", "area, %", "box, %", "astray", "beta mean, least",
           "least angle", "poor: what the shape forces", "CPU s")


def faces_left_out(log):
    """How many faces have no elements of their own, by the notes of a run: closed because they are tiny, of no solid; all of them."""
    said = {"closed": r"(\d+) faces? and \d+ edges? that are tiny", "loose": r"(\d+) faces? of no solid left out",
            "without": r"(\d+) of \d+ faces have no elements of their own"}
    return {name: sum(int(n) for n in re.findall(pattern, log)) for name, pattern in said.items()}


def without_folders(sentence):
    return re.sub(r"/\S*/", "", sentence)


def number(made, key, form):
    value = made.get(key, math.nan)
    return "" if value is None or math.isnan(value) else format(value, form)


def astray(made):
    if "astray" not in made:
        return ""
    return f"{made['astray']:,} of {made['nodes']:,}" + (f" ({made['farthest']:.1g})" if made["astray"] else "")


def narrow(made):
    """What is narrow at the worst of the poor elements; how many of those that were looked at nothing forces."""
    poor = made.get("poor")
    if not poor or not poor["elements"]:
        return ""
    found = [f"{kind} {poor[kind]:.2g}" for kind, most in (("wedge", 20), ("corner", 20), ("edge", .1), ("gap", .1))
             if poor.get(kind) is not None and poor[kind] < most]
    unforced = [f"{poor['unforced']} of {poor['judged']} not"] if poor["unforced"] else []
    return f"{poor['elements']:,}: " + "; ".join(found[:2] + unforced)


def counts(made, info):
    """Solids and faces of the file; in brackets what came of them, where that differs, with the faces that were left out."""
    text = f"{len(info['solids'])}, {info['faces']}"
    if "patches" not in made:
        return text
    regions = f" ({made['regions']})" if made["regions"] != len(info["solids"]) else ""
    left = {name: made[name] for name in ("closed", "loose") if made[name]}
    others = made["without"] - sum(left.values())
    left = "".join(f" + {n} {name}" for name, n in (left | ({"narrow": others} if others > 0 else {})).items())
    patches = f" ({made['patches']}{left})" if made["patches"] != info["faces"] else ""
    return f"{len(info['solids'])}{regions}, {info['faces']}{patches}"


def row(made, info):
    start = [made["file"], counts(made, info) if made["who"] == "ours" else "", f"1/{made['part']}, {ORDER[made['part']]}", made["who"]]
    if "error" in made:
        cells = [*start, without_folders(made["error"])[:90], *[""] * 7, f"{made['cpu']:.1f}"]
    else:
        cells = [*start, f"{made['tets']:,}", number(made, "off", "+.3f"), number(made, "area", "+.3f"), number(made, "box", ".3f"),
                 astray(made), f"{made['beta']:.3f}, {made['least']:.3f}", f"{made['angle']:.1f}", narrow(made), f"{made['cpu']:.1f}"]
    return cells


def refused_row(name, info):
    return [name, without_folders(info["why"])]


def within(values, most):
    known = [abs(v) for v in values if v is not None and not math.isnan(v)]
    return f"{sum(v <= most for v in known)} of {len(known)}"


def all_faces(made, info):
    """Of no solid may be closed ones too."""
    return made["patches"] + max(made["closed"] + made["loose"], made["without"]) >= info["faces"]


SUMMARY = ("files, diagonal", "meshed", "volume within .1 %", "1 %", "area within .2 %", "box within .1 %", "regions", "groups", "nodes off", "poor, forced",
           "least angle: median", "below 10°", "mean beta", "elements", "CPU s")


def judged_cells(done, files):
    """What only octafront_judge_cad says."""
    judged = [m for m in done if "area" in m]
    if not judged:
        return [""] * 6
    info = [files[m["file"]] for m in judged]
    poor = [m for m in judged if m["poor"]["elements"]]
    return [within([m["area"] for m in judged], .2), within([m["box"] for m in judged], .1),
            str(sum(m["regions"] == len(i["solids"]) for m, i in zip(judged, info))), f"{sum(map(all_faces, judged, info))} of {len(judged)}",
            f"{sum(m['astray'] for m in judged):,} of {sum(m['nodes'] for m in judged):,} ({sum(m['astray'] > 0 for m in judged)})",
            f"{len(poor)}, {sum(m['poor']['unforced'] == 0 for m in poor)}"]


def summary(name, runs, files):
    done = [m for m in runs if "error" not in m]
    if not done:
        return [name, f"none of {len(runs)}", *[""] * 13]
    off = [m["off"] for m in done]
    return [name, f"{len(done)} of {len(runs)}", within(off, .1), within(off, 1), *judged_cells(done, files),
            f"{statistics.median(m['angle'] for m in done):.1f}", str(sum(m["angle"] < 10 for m in done)), f"{statistics.mean(m['beta'] for m in done):.3f}",
            f"{sum(m['tets'] for m in done):,}", f"{sum(m['cpu'] for m in runs):.0f}"]


def runs_of(kept, who, part):
    return [m for m in kept.runs.values() if m["who"] == who and m["part"] == part]


def summaries(kept, whose=""):
    asked = [(who, part) for who in MESHERS for part in ORDER]
    return [summary(f"{whose}{who}, {part}", runs_of(kept, who, part), kept.files) for who, part in asked if runs_of(kept, who, part)]


def name_counts(made, kind):
    """How many names of a kind each format of a run has."""
    found = [arrived[kind] for arrived in made.get("names", {}).values() if kind in arrived]
    return " / ".join(str(n) for n, _ in found) if found else ""


NAMES = ("file", "names of", "in the file", "ours: .msh / .inp", *MESHERS[1:])


def names_rows(kept):
    """One row for each kind of name of a file."""
    rows = []
    for file in sorted(kept.files):
        runs = {who: kept.runs.get(f"{file}|{who}|40", {}) for who in MESHERS}
        for kind, (_, wanted) in runs["ours"].get("names", {}).get("msh", {}).items():
            rows.append([file, kind, wanted, *(name_counts(runs[who], kind) for who in MESHERS)])
    return rows


def rows_of(kept):
    order = {(who, part): n for n, (who, part) in enumerate([("ours", 40), ("ours", 100)] + [(who, 40) for who in MESHERS[1:]])}
    runs = sorted(kept.runs.values(), key=lambda m: (m["file"], order[m["who"], m["part"]]))
    return [row(m, kept.files[m["file"]]) for m in runs]


REFUSED = ("file", "why")


def refused(kept):
    return [refused_row(f, i) for f, i in sorted(kept.files.items()) if "why" in i]


def origins(kept, whose):
    return {m["origin"] for m in kept.runs.values() if m["who"] in whose}


def write(debian, others, timeout):
    fine = " --fine" if runs_of(others, "ours", 100) else ""
    fill({
        "written": written_by("bench/run.sh cad --fine --peers --page", origins(debian, ["ours"])),
        "others_written": written_by(f"bench/run.sh cad --models FOLDER{fine} --timeout {timeout:.0f} --page", origins(others, ["ours"])),
        "peers": "; ".join(sorted(origins(debian, MESHERS[1:]))),
        "timeout": f"{timeout:.0f}",
        "summaries": "\n".join(table(SUMMARY, summaries(debian) + summaries(others, "others: "))),
    }, {"": (rows_of(debian), refused(debian)), "others_": (rows_of(others), refused(others))}, names_rows(debian))


def fill(parts, rows, names):
    """Writes the page of the words, and the rows of cells that go to CSV files."""
    for whose, (made, left) in rows.items():
        parts |= {f"{whose}rows": put(f"cad-{whose.rstrip('_')}".rstrip("-"), COLUMNS, made),
                  f"{whose}refused": put(f"cad-{whose.replace('_', '-')}refused", REFUSED, left)}
    parts["names"] = put("cad-names", NAMES, names)
    page = TEXT.read_text(encoding="utf-8")
    for name, text in parts.items():
        page = page.replace("{{" + name + "}}", text)
    write_page("cad", [page])
