"""Meshes in parts: bench/run.sh parts [ELEMENTS]. A bunny, whose surface is smooth, and a machine part, whose elements differ in
size. The tables go to docs/measured/parts.md."""
import pathlib
import subprocess
import sys
import tempfile

from pages.origin import written_by

MODELS = {"bunny00": "models/clean/bunny00.off", "anchor": "models/clean/anchor.off"}
build, elements = pathlib.Path(sys.argv[1]), sys.argv[2] if len(sys.argv) > 2 else "2e6"
tables = []
with tempfile.TemporaryDirectory(dir=build) as folder:
    for name, model in MODELS.items():
        mesh = pathlib.Path(folder) / f"{name}.vtu"
        subprocess.run([build / "cli/octafront", "mesh", model, "-o", mesh, "--elements", elements, "-q"], check=True)
        run = subprocess.run([build / "bench/octafront_write_parts", mesh, pathlib.Path(folder) / "out", "8"], check=True, text=True,
                             stdout=subprocess.PIPE)
        tables.append(f"## {name}\n\n{run.stdout}")
        print(tables[-1], flush=True)
page = pathlib.Path("docs/measured/parts.md")
page.write_text(f"""# Meshes in parts

{written_by(f'bench/run.sh parts {elements}')}: what the division by the curve is worth beside METIS, and what writing eight parts costs
beside one file ([how](../use/parts.md)). CPU seconds are those of all threads. "Least" and "most" are the elements of the smallest and largest part; ghosts
are counted once for each part that has them. Memory is the highest while it lasts, the mesh included.

{chr(10).join(tables)}""")
