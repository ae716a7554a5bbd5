"""TetGen (Debian: tetgen), boundary kept, quality bound, volumes bounded by the surface's own size."""
import pathlib
import re
import shutil

from bench.off import read_off
from bench.peers import complexes, surfaces
from bench.process import finish, run_measured

# TetGen fills up to the bound it is given: with this multiple of the regular tetrahedron's volume the number of
# elements comes out near the one of a mesh of the surface's size.
VOLUME_FACTOR = 1.5


def fill(surface, folder, timeout, quality=True):
    """Keeps the triangles of `surface` (OFF). The mesh is MEDIT; writing it is not part of the times."""
    folder = pathlib.Path(folder)
    shutil.copy(surface, folder / "in.off")
    h = surfaces.mean_edge(*read_off(surface))
    flags = f"-pY{'q' if quality else ''}a{VOLUME_FACTOR * h**3 / 72**0.5:.9g}"
    outcome = run_measured(["tetgen", flags, "in.off"], folder, timeout)
    total = re.search(r"Total running seconds:\s*([\d.]+)", outcome.log)
    writing = re.search(r"Output seconds:\s*([\d.]+)", outcome.log)
    if total:
        outcome.stage_seconds = float(total[1]) - (float(writing[1]) if writing else 0.0)
    if not outcome.error:
        to_medit(folder / "in.1", folder / "out.mesh")
    return finish(outcome, folder / "out.mesh")


def fill_complex(complex_file, folder, timeout, size, keep):
    """A complex (PLY) with its triangles kept or divided, every region a number of its own. The mesh is MEDIT."""
    folder = pathlib.Path(folder)
    points, triangles, _ = complexes.read_ply(complex_file)
    complexes.write_poly(folder / "in.poly", points, triangles)
    flags = f"-p{'Y' if keep else ''}qAa{VOLUME_FACTOR * size**3 / 72**0.5:.9g}"
    outcome = run_measured(["tetgen", flags, "in.poly"], folder, timeout)
    if not outcome.error:
        to_medit(folder / "in.1", folder / "out.mesh")
    return finish(outcome, folder / "out.mesh")


def to_medit(stem, mesh):
    """TetGen's own MEDIT files (1.5.0) announce more triangles than they hold; these come from .node, .face and .ele.
    The reference of a tetrahedron is its region's number, where there is one."""
    first = None
    with open(mesh, "w") as out:
        out.write("MeshVersionFormatted 2\nDimension 3\n")
        for suffix, name, columns in ((".node", "Vertices", 3), (".face", "Triangles", 3), (".ele", "Tetrahedra", 4)):
            with open(f"{stem}{suffix}") as lines:
                count = int(next(lines).split()[0])
                out.write(f"{name}\n{count}\n")
                for _ in range(count):
                    words = next(lines).split()
                    if first is None:
                        first = int(words[0])
                    values = words[1:columns + 1]
                    if first == 0 and name != "Vertices":
                        values = [str(int(v) + 1) for v in values]
                    region = words[columns + 1] if name == "Tetrahedra" and len(words) > columns + 1 else "1"
                    out.write(" ".join(values) + f" {region}\n")
        out.write("End\n")
