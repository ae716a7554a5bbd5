"""CGAL Mesh_3 (Debian: libcgal-dev, under the GPL), by the program that bench/CMakeLists.txt builds from cgal_mesh.cpp."""
import pathlib
import re

from bench.process import finish, run_measured


def remesh(surface, folder, timeout, size, program):
    """Triangulates `surface` (OFF) anew to `size`, with features, and fills it; then perturbs and exudes. MEDIT."""
    folder = pathlib.Path(folder)
    outcome = run_measured([pathlib.Path(program).resolve(), pathlib.Path(surface).resolve(), "out.mesh", f"{size:.9g}"],
                           folder, timeout)
    stage = re.search(r"meshing CPU seconds: ([\d.]+)", outcome.log)
    if stage:
        outcome.stage_seconds = float(stage[1])
    return finish(outcome, folder / "out.mesh")
