"""Meshes in parts: bench/run.sh parts [ELEMENTS]. A bunny, whose surface is smooth, and a machine part, whose elements differ in
size. Writes docs/measured/parts.md."""
import pathlib
import subprocess
import sys
import tempfile

from bench.pages import tables
from bench.pages.origin import written_by

MODELS = {"bunny00": "models/clean/bunny00.off", "anchor": "models/clean/anchor.off"}


def measured(build, elements):
    """What octafront_write_parts prints, by model."""
    told = {}
    with tempfile.TemporaryDirectory(dir=build) as folder:
        for name, model in MODELS.items():
            mesh = pathlib.Path(folder) / f"{name}.vtu"
            subprocess.run([build / "cli/octafront", "mesh", model, "-o", mesh, "--elements", elements, "-q"], check=True)
            told[name] = subprocess.run([build / "bench/octafront_write_parts", mesh, pathlib.Path(folder) / "out", "8"], check=True, text=True,
                                        stdout=subprocess.PIPE).stdout
            print(told[name], flush=True)
    return told


def shown(told):
    lines, every = [], []
    for name, text in told.items():
        for what, (head, rows) in zip(("divided", "written"), tables.parsed(text)):
            every.append((what, ["model", *head], [[name, *row] for row in rows]))
        lines += [] if lines else [f"{name}: {text.splitlines()[0]}."]
    for what in ("divided", "written"):
        head = next(head for kind, head, _ in every if kind == what)
        rows = [row for kind, _, its in every if kind == what for row in its]
        first = [row for row in rows if row[0] == rows[0][0] and str(row[1]) != "2"]
        lines += ["", *tables.some(head, first, [c for c in head if c not in ("model", "least", "most", "CPU s" if what == "written" else "")]), "",
                  f"Each, with another model: {tables.put(f'parts-{what}', head, rows)}."]
    return lines


def main():
    build, elements = pathlib.Path(sys.argv[1]), sys.argv[2] if len(sys.argv) > 2 else "2e6"
    tables.write("parts", ["# Meshes in parts", "", f"""{written_by(f'bench/run.sh parts {elements}')}: what the division by the curve is worth beside METIS, and what writing eight parts
costs beside one file ([how](../use/parts.md)). CPU seconds are those of all threads.
Ghosts are counted once for each part that has them. Memory is the highest while it lasts, the mesh included.""", "", *shown(measured(build, elements))])


if __name__ == "__main__":
    main()
