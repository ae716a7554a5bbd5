"""Speed of the writers of meshes: bench/run.sh formats [MILLIONS]. Linear meshes in every format, binary ones of second order
too. Writes docs/measured/formats-bench.md."""
import pathlib
import subprocess
import sys
import tempfile

from bench.pages import tables
from bench.pages.origin import written_by

SECOND = ["vtu", "vtk", "msh", "med", "xdmf", "exodus", "abaqus"]


def shown(first, second):
    """What octafront_write_formats prints of meshes of both orders."""
    lines = []
    for title, name, text in (("Linear", "formats", first), ("Second order", "formats-second-order", second)):
        (head, rows), = tables.parsed(text)
        lines += [f"## {title}", "", text.splitlines()[0], "", *tables.some(head, rows, [c for c in head if c not in ("s", "MB/s", "of a plain write", "peak MB")]), "", f"With seconds and memory: {tables.put(name, head, rows)}.", ""]
    return lines


def main():
    build, millions = pathlib.Path(sys.argv[1]), sys.argv[2] if len(sys.argv) > 2 else "10"
    with tempfile.TemporaryDirectory(dir=build) as folder:
        told = [subprocess.run([build / "bench/octafront_write_formats", size, folder, order, *formats], check=True, text=True, stdout=subprocess.PIPE).stdout
                for size, order, formats in ((millions, "1", []), (str(float(millions) / 4), "2", SECOND))]
    tables.write("formats-bench", ["# How fast meshes are written", "", f"""{written_by(f'bench/run.sh formats {millions}')}: a bent box of two regions and six patches. In the files of rows: speed beside a plain write of as many bytes, flushed to the disk both. VTU is compressed: its megabytes are a fifth of what the others write.""", "", *shown(*told)])


if __name__ == "__main__":
    main()
