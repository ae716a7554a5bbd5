"""The judge of known answers is judged: right results pass, and each wrong one fails for what is wrong with it.

judge_test.py BUILD
"""
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))
import numpy as np  # noqa: E402
from bench.models import damages, solids  # noqa: E402
from bench.models.solids import Solid  # noqa: E402
from bench.off import write_off  # noqa: E402
from bench.run import known_answers  # noqa: E402

BUILD = pathlib.Path(sys.argv[1])
FOLDER = tempfile.TemporaryDirectory()
SHAPES = {name: make() for name, make in solids.GENERATED.items() if name not in ("gear", "torus_knot")}
failures = []


def surface(made):
    path = pathlib.Path(FOLDER.name, "made.off")
    write_off(path, *made)
    return path


def mesh(solid, *options):
    path = pathlib.Path(FOLDER.name, "made.mesh")
    subprocess.run([BUILD / "cli/octafront", "mesh", surface(solid), "-o", path, "-q", "--threads", "1", *options], check=True)
    return path


def expect(what, case, result, wrong, kind="turned"):
    """`wrong` is part of what the judge says, "" if it should say nothing."""
    known = known_answers.damage.write(FOLDER.name, 1, kind, what, case, 0)
    distances = {".mesh": (known_answers.MESH_DISTANCE, known_answers.MESH_AT_DAMAGE)}.get(result.suffix, (known_answers.TOLERANCE,) * 2)
    measured = known_answers.measure(BUILD, pathlib.Path(FOLDER.name, "0001.json"), result)
    said = "; ".join(known_answers.wrong(known, measured, *distances, result.suffix == ".off"))
    if (wrong not in said) if wrong else said:
        failures.append(f"{what}: should say '{wrong}', says '{said}'")


def case_of(name):
    return damages.case(SHAPES[name], SHAPES[name], "as it is")


def moved(solid, vertex, by):
    points = solid.points.copy()
    points[vertex] += by
    return Solid(points, solid.triangles)


def without_a_tet(path):
    """The mesh with one of its inner tetrahedra taken away."""
    lines = path.read_text().split("\n")
    start = lines.index("Tetrahedra") + 1
    count = int(lines[start])
    boundary = {v for line in lines[lines.index("Triangles") + 2:][:int(lines[lines.index("Triangles") + 1])] for v in line.split()[:3]}
    inner = next(k for k in range(count) if not boundary & set(lines[start + 1 + k].split()[:4]))
    lines[start] = str(count - 1)
    del lines[start + 1 + inner]
    path.write_text("\n".join(lines))
    return path


def right_results():
    for name, solid in SHAPES.items():
        expect(f"{name} itself", case_of(name), surface(solid), "")
    for name in ("box", "torus", "hollow_sphere", "two_parts", "frame"):
        shape = SHAPES[name]
        # As repair keeps what it changed.
        within = known_answers.TOLERANCE * np.linalg.norm(np.ptp(shape.points, axis=0))
        expect(f"mesh of {name}", case_of(name), mesh(shape, "--max-deviation", str(within)), "")
    box = SHAPES["box"]
    for shift in ((0.5, 0, 0), (0.3, 0.4, 0.25)):
        case = damages.Case(soup=box, truth=[box, Solid(box.points + shift, box.triangles)])
        case.expected = {"components": 1, "shells": 1, "genus": 0}
        if not shift[1]:
            long = Solid(box.points * (1.5, 1, 1), box.triangles)
            expect("two boxes united", case, surface(long), "")
            expect("two boxes united, one too long", case, surface(Solid(long.points * (1.002, 1, 1), long.triangles)), "to truth")
        expect("only one of two boxes", case, surface(box), "from truth")
        expect("two boxes not united", case, surface(Solid(*solids.together(case.truth))), "components 2")


def holes():
    """Whatever lies in a hole's zone is right, but no more than that."""
    case = damages.holes(SHAPES["sphere"], np.random.default_rng(5), 0.1, 1)
    gone = set(map(tuple, SHAPES["sphere"].triangles.tolist())) - set(map(tuple, case.soup.triangles.tolist()))
    region = [t for t, corners in enumerate(SHAPES["sphere"].triangles.tolist()) if tuple(corners) in gone]
    edges = damages.rim(SHAPES["sphere"], region)
    n = len(case.soup.points)
    closed = damages.add(case.soup, case.soup.points[edges[:, 0]].mean(axis=0)[None], np.empty((0, 3), int))
    closed = Solid(closed.points, np.concatenate([closed.triangles, np.column_stack([edges, np.full(len(edges), n)])]))
    expect("hole closed flat", case, surface(closed), "", "hole-10")
    expect("hole closed flat, as small as others", case, surface(closed), "volume", "hole-1")
    far = int(np.argmax(np.linalg.norm(closed.points - closed.points[n], axis=1)))
    expect("hole closed flat, dent elsewhere", case, surface(moved(closed, far, -0.02 * closed.points[far])), "to truth", "hole-10")
    expect("hole left open", case, surface(case.soup), "bad edges", "hole-10")


def wrong_surfaces():
    sphere, box, torus, parts = (SHAPES[n] for n in ("sphere", "box", "torus", "two_parts"))
    top = int(np.argmax(sphere.points[:, 2]))
    expect("a bump", case_of("sphere"), surface(moved(sphere, top, (0, 0, 0.005))), "to truth")
    bumpy = solids.sphere(16, 1.0005)
    expect("half the tolerance off", case_of("sphere"), surface(bumpy), "")
    expect("a filled ring", case_of("torus"), surface(Solid(sphere.points * (1.35, 1.35, 0.35), sphere.triangles)), "genus 0, not 1")
    label = solids.shells_of(parts)
    expect("a part lost", case_of("two_parts"), surface(Solid(parts.points, parts.triangles[label == 0])), "components 1, not 2")
    expect("a part lost, seen by points", case_of("two_parts"), surface(Solid(parts.points, parts.triangles[label == 0])), "wrong side")
    hollow = SHAPES["hollow_sphere"]
    expect("a cavity filled", case_of("hollow_sphere"), surface(Solid(hollow.points, hollow.triangles[solids.shells_of(hollow) == 0])), "shells 1, not 2")
    expect("inside out", case_of("torus"), surface(Solid(torus.points, torus.triangles[:, ::-1])), "wrong side")
    expect("a triangle missing", case_of("torus"), surface(Solid(torus.points, torus.triangles[1:])), "3 bad edges")
    expect("a triangle twice", case_of("torus"), surface(Solid(torus.points, np.concatenate([torus.triangles, torus.triangles[:1]]))), "bad edges")
    expect("a triangle turned", case_of("torus"), surface(Solid(torus.points, np.concatenate([torus.triangles[1:], torus.triangles[:1, ::-1]]))), "bad edges")
    a, b = (parts.triangles[label == s] for s in (0, 1))
    pinched = Solid(parts.points, np.concatenate([a, np.where(b == b[0, 0], a[0, 0], b)]))
    expect("parts that meet in a point", case_of("two_parts"), surface(pinched), "1 bad vertices")
    corner = int(np.argmax(box.points.sum(axis=1)))
    expect("a corner a little off", case_of("box"), surface(moved(box, corner, -1e-5)), "sharp edges")
    touched = damages.case(box, box, "a corner touched", touched=damages.boxes([box.points[[corner]]], 20))
    expect("a touched corner a little off", touched, surface(moved(box, corner, -1e-5)), "")
    expect("one percent too large", case_of("angle"), surface(Solid(SHAPES["angle"].points * 1.002, SHAPES["angle"].triangles)), "volume +0.60")
    expect("nothing", case_of("box"), surface(Solid(box.points, box.triangles[:0])), "no result")


def wrong_meshes():
    expect("mesh without a tetrahedron", case_of("box"), without_a_tet(mesh(SHAPES["box"])), "shells 2, not 1")
    expect("mesh of another shape", case_of("torus"), mesh(SHAPES["sphere"]), "wrong side")
    expect("mesh of a part", case_of("two_parts"), mesh(SHAPES["sphere"]), "components 1, not 2")


def meshes_at_damage():
    """What a mesh may be off is less where the model was damaged."""
    box = SHAPES["box"]
    off = Solid(box.points + (0.003 * solids.diagonal(box), 0, 0), box.triangles)
    expect("mesh beside its place", case_of("box"), mesh(off), "")
    for name, moves in (("all moved", np.ones(len(box.points))), ("one corner moved", np.arange(len(box.points)) == 0)):
        soup = Solid(box.points + 1e-5 * moves[:, None], box.triangles)
        expect(f"mesh beside its place, {name}", damages.case(box, soup, name), mesh(off), "damage")


def untouched():
    box = SHAPES["box"]
    nudged = moved(box, 3, 0)
    nudged.points[3, 0] = np.nextafter(nudged.points[3, 0], 9)
    for what, made, said in (("same", box, ""), ("one bit", nudged, "points changed"),
                             ("order", Solid(box.points, box.triangles[::-1]), "triangles changed"),
                             ("less", Solid(box.points, box.triangles[1:]), "triangles changed")):
        if known_answers.changed(box, made) != said:
            failures.append(f"untouched, {what}: says '{known_answers.changed(box, made)}'")


for test in (right_results, holes, wrong_surfaces, wrong_meshes, meshes_at_damage, untouched):
    test()
print("\n".join(failures) or "the judge sees what is wrong")
sys.exit(1 if failures else 0)
