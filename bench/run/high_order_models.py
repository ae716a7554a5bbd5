"""The part of bench/run.sh high_order that meshes many models at three sizes and orders 2 to 4, beside Gmsh (optimised) and Netgen at the middle size.
Elements of all are proven, or not, by `octafront check` of the files. What lies off the true surface of CAD OpenCASCADE says, through Gmsh."""
import json
import math
import pathlib

import gmsh
import numpy as np

from bench.off import read_off
from bench.pages import tables
from bench.pages.origin import ROOT
from bench.peers import gmsh_high_order, netgen_high_order
from bench.process import run_measured

HEAD = ["model", "by", "size", "order", "elements", "not proven", "undecided", "least scaled Jacobian", "mean", "edges curved", "eased", "faces eased", "farthest", "mean distance",
        "CPU s", "CPU s, order", "failed"]
CAD = ["samples/bracket.step", "samples/assembly.step", "samples/bend.step",
       *(f"cad-models/{name}" for name in ("bottle.brep", "screw.step", "linkrods.step", "component8.step", "CrankArm.brep", "hammer.iges", "Pump_Nut.brep", "Ball.brep",
                                           "mal_vis.brep", "SOT23.stp", "frame.step", "MSOP_10.stp"))]
SURFACES = ["samples/bracket.stl", "samples/gear.obj", "samples/torus_knot.ply", "samples/gyroid.ply", "samples/shell.off",
            *(f"models/clean/{name}" for name in ("hinge.stl", "part1.stl", "pinion.off", "rotor.off", "knot1.off", "blobby.off", "3torus.off", "elephant.off", "spool.off",
                                                  "fandisk.off"))]
PARTS = (10, 16, 25)  # of the diagonal, an edge
MIDDLE = PARTS[1]
ORDERS = (2, 3, 4)
SOLID = {1: 4, 2: 11, 3: 29, 4: 30}
FACES_LOOKED_AT, TIMEOUT = 100, 60
IN_FACES = np.array([(1 / 3, 1 / 3, 1 / 3), (0.7, 0.15, 0.15), (0.15, 0.15, 0.7)])


def box_of(program, file, folder):
    """What the lengths of a model are counted in: its diagonal; and the file that the others take."""
    if file in CAD:
        report = folder / "info.json"
        run_measured([program, "info", ROOT / file, "--json", report], ".", TIMEOUT)
        return math.dist(*json.loads(report.read_text())["box"]), ROOT / file
    off = folder / (pathlib.Path(file).stem + ".off")
    run_measured([program, "repair", ROOT / file, "-o", off], ".", TIMEOUT)
    points = np.array(read_off(off)[0])
    return float(np.linalg.norm(points.max(0) - points.min(0))), off


def proven(program, mesh, folder):
    report = folder / "check.json"
    report.unlink(missing_ok=True)
    run_measured([program, "check", mesh, "--json", report], ".", 10 * TIMEOUT)
    return json.loads(report.read_text()).get("second_order") if report.is_file() else None


def boundary_points(mesh, order):
    """Three points in each of some faces that one element alone has, evenly taken, as they are curved."""
    gmsh.clear()
    gmsh.open(str(mesh))
    kind = SOLID[order]
    tags, xyz, _ = gmsh.model.mesh.getNodes()
    place = np.zeros(int(tags.max()) + 1, dtype=np.int64)
    place[tags.astype(np.int64)] = np.arange(len(tags))
    xyz, nodes = xyz.reshape(-1, 3), gmsh.model.mesh.getElementProperties(kind)[3]
    elements = place[gmsh.model.mesh.getElementsByType(kind)[1].astype(np.int64)].reshape(-1, nodes)
    faces = np.sort(np.concatenate([np.delete(elements[:, :4], lacks, axis=1) for lacks in range(4)]), axis=1)
    _, first, count = np.unique(faces, axis=0, return_index=True, return_counts=True)
    outer = np.sort(first[count == 1])
    outer = outer[:: max(1, len(outer) // FACES_LOOKED_AT)]
    points = []
    for lacks in range(4):
        local = np.insert(IN_FACES, lacks, 0, axis=1)[:, 1:]
        values = gmsh.model.mesh.getBasisFunctions(kind, local.ravel(), "Lagrange")[1].reshape(len(local), nodes)
        of = elements[outer[outer // len(elements) == lacks] % len(elements)]
        points.append(np.einsum("kn,enc->ekc", values, xyz[of]).reshape(-1, 3))
    return np.concatenate(points), xyz


def distances(points, xyz, cad, diagonal):
    """Each to the nearest face, in parts of the diagonal; None where the file's unit is not the mesh's."""
    gmsh.clear()
    gmsh.model.occ.importShapes(str(cad))
    gmsh.model.occ.synchronize()
    faces = [tag for _, tag in gmsh.model.getEntities(2)]
    boxes = np.array([gmsh.model.getBoundingBox(2, tag) for tag in faces])
    size = np.linalg.norm(boxes[:, 3:].max(0) - boxes[:, :3].min(0))
    if not 0.9 < size / np.linalg.norm(xyz.max(0) - xyz.min(0)) < 1.1:
        return None
    reach, best = 0.02 * diagonal, np.full(len(points), np.inf)
    for tag, box in zip(faces, boxes):
        near = np.flatnonzero(((points > box[:3] - reach) & (points < box[3:] + reach)).all(axis=1))
        if len(near):
            on = np.array(gmsh.model.getClosestPoint(2, tag, points[near].ravel())[0]).reshape(-1, 3)
            best[near] = np.minimum(best[near], np.linalg.norm(on - points[near], axis=1))
    return best[np.isfinite(best)] / diagonal


def off_the_surface(mesh, order, file, source, diagonal):
    if file not in CAD:
        return ["", ""]
    found = distances(*boundary_points(mesh, order), source, diagonal)
    return ["", ""] if found is None else [f"{found.max():.1e}", f"{found.mean():.1e}"]


def row_of(program, file, by, part, order, mesh, source, diagonal, told, cpu, error, folder):
    name = pathlib.Path(file).name
    found = None if error else proven(program, mesh, folder)
    if not found:
        return [name, by, f"1/{part}", order, *[""] * 10, f"{cpu:.1f}", "", (error or "not read")[:80]]
    off = off_the_surface(mesh, order, file, source, diagonal) if part == MIDDLE else ["", ""]
    elements = told.get("tets") or elements_of(mesh, order)
    orders = sum(s["cpu_seconds"] for s in told.get("stages", []) if s["name"].startswith(("second order", "order")))
    curved = told.get("second_order", {})
    return [name, by, f"1/{part}", order, f"{elements:,}", found["invalid"], found["undecided"], f"{found['least_scaled_jacobian']:.3f}", f"{found['mean_scaled_jacobian']:.4f}",
            curved.get("curved_edges", ""), curved.get("eased_edges", ""), curved.get("eased_faces", ""), *off, f"{cpu:.1f}", f"{orders:.2f}" if told else "", ""]


def elements_of(mesh, order):
    gmsh.clear()
    gmsh.open(str(mesh))
    return len(gmsh.model.mesh.getElementsByType(SOLID[order])[0])


def made_here(made, source, mesh, size, order):
    """(report, CPU s, why there is no mesh)."""
    try:
        return *made(source, mesh, "--size", repr(size), "--order", order), ""
    except SystemExit as why:
        return {}, 0.0, str(why).partition("\n")[2].removeprefix("exit 4: octafront: ")


def run(made, program, folder, kept=()):
    """`made`: makes a mesh of ours, (report, CPU s); raises SystemExit where there is none. `kept`: rows of others that need not be made again."""
    rows, known = [], {tuple(map(str, row[:4])): row for row in kept if row[1] != "Octafront"}
    for file in [*CAD, *SURFACES]:
        diagonal, source = box_of(program, file, folder)
        for part in PARTS:
            for order in ORDERS:
                mesh = folder / "model.msh"
                rows.append(row_of(program, file, "Octafront", part, order, mesh, source, diagonal, *made_here(made, ROOT / file, mesh, diagonal / part, order), folder))
                print(*rows[-1], sep="  ", flush=True)
                for by, peer in (("Gmsh", gmsh_high_order), ("Netgen", netgen_high_order)) if part == MIDDLE else ():
                    key = pathlib.Path(file).name, by, f"1/{part}", str(order)
                    if key not in known:
                        done = peer.mesh(source, folder, TIMEOUT, repr(diagonal / part), order)
                        known[key] = row_of(program, file, by, part, order, done.mesh, source, diagonal, {}, done.cpu_seconds, done.error, folder)
                    rows.append(known[key])
                    print(*rows[-1], sep="  ", flush=True)
        tables.put("high-order-models", HEAD, rows)
    return rows


def median(cells):
    return sorted(cells)[len(cells) // 2] if cells else math.nan


def nearer(rows, by, order):
    """In how many of the models of CAD that both have ours is nearer to the true surface on average, as words."""
    at = HEAD.index
    mean = {(row[at("by")], row[at("model")]): float(row[at("mean distance")]) for row in rows
            if row[at("size")] == f"1/{MIDDLE}" and str(row[at("order")]) == str(order) and row[at("mean distance")]}
    both = [(mean["Octafront", model], theirs) for (mesher, model), theirs in mean.items() if mesher == by and ("Octafront", model) in mean]
    return "" if by == "Octafront" else f"{sum(ours < theirs for ours, theirs in both)} of {len(both)}"


def page(rows):
    """(head, a line for each mesher and order) of the middle size, where all are."""
    lines = []
    at = HEAD.index
    for by in ("Octafront", "Gmsh", "Netgen"):
        for order in ORDERS:
            its = [row for row in rows if row[at("by")] == by and row[at("size")] == f"1/{MIDDLE}" and str(row[at("order")]) == str(order)]
            good = [row for row in its if row[at("elements")]]
            number = lambda row, name: float(str(row[at(name)]).replace(",", ""))
            bad = [row for row in good if number(row, "not proven")]
            least = [number(row, "least scaled Jacobian") for row in good]
            lines.append([by, order, f"{len(good)} of {len(its)}", f"{sum(number(r, 'elements') for r in good):,.0f}", f"{sum(number(r, 'not proven') for r in bad):.0f} in {len(bad)}",
                          f"{min(least):.3f}", f"{median(least):.3f}", f"{median([number(r, 'mean') for r in good]):.4f}", nearer(rows, by, order)])
    return ["by", "order", "meshed", "elements", "not proven, in models", "least scaled Jacobian", "median of least", "median of mean", "ours nearer"], lines
