#!/usr/bin/env python3
"""The solved examples: solve.py OCTAFRONT WORK [CASE ...] [--json FILE].

Each one writes a body, or two that touch, as OBJ files with named groups, has octafront mesh it with second-order elements, solves the deck
beside this script with CalculiX (Debian package calculix-ccx), and compares one number with theory. Exits with 1 if one
of them is beyond its bound.
"""
import argparse
import json
import math
import pathlib
import shutil
import subprocess
import sys

import bodies
import ccx

SKIPPED = 77
HERE = pathlib.Path(__file__).resolve().parent


class Case:
    """One example: its files in the work folder, and what came out."""

    def __init__(self, octafront, work, name):
        self.octafront, self.work, self.name = octafront, work, name

    def file(self, ending):
        return self.work / (self.name + ending)

    def mesh(self, body, *options, name=None):
        """The body meshed; the sets have the names of its groups."""
        stem = name or self.name
        surface = self.work / f"{stem}.obj"
        body.write(surface)
        return self._run([surface], self.work / f"{stem}-mesh.inp", options)

    def mesh_together(self, parts, *options):
        """Bodies by name, a region each, in one mesh."""
        folder = self.work / self.name
        folder.mkdir(exist_ok=True)
        for name, body in parts.items():
            body.write(folder / f"{name}.obj")
        return self._run([folder / f"{name}.obj" for name in parts], self.file("-mesh.inp"), options)

    def _run(self, surfaces, mesh, options):
        subprocess.run([self.octafront, "mesh", *surfaces, "-o", mesh, "--order", "2", "-q", *options], check=True)
        return ccx.Mesh(mesh)

    def solve(self):
        shutil.copy(HERE / f"{self.name}.inp", self.file(".inp"))
        ccx.run(self.file(".inp"))

    def fields(self):
        return ccx.frd(self.file(".frd"))


def result(case, mesh, what, found, expected, bound, error=None):
    error = abs(found / expected - 1) if error is None else error
    return {"case": case.name, "elements": len(mesh.elements), "nodes": len(mesh.nodes), "what": what, "found": found,
            "expected": expected, "error": error, "bound": bound, "good": error <= bound}


def cantilever(case):
    length, side, force, young, poisson = 200.0, 10.0, 1000.0, 210000.0, 0.3
    mesh = case.mesh(bodies.box((0, 0, 0), (length, side, side), ["clamped", "tip"] + ["sides"] * 4), "--size", "4")
    case.solve()
    deflections = [row[3] for row in ccx.dat_rows(case.file(".dat"), "displacements")]
    found = -sum(deflections) / len(deflections)
    inertia, shear = side**4 / 12, young / (2 * (1 + poisson))
    kappa = 10 * (1 + poisson) / (12 + 11 * poisson)  # Cowper 1966
    expected = force * length**3 / (3 * young * inertia) + force * length / (kappa * shear * side**2)
    return result(case, mesh, "tip deflection, mm (Timoshenko)", found, expected, 0.01)


def pipe(case):
    inner, outer, pressure = 10.0, 20.0, 100.0
    mesh = case.mesh(bodies.quarter_pipe(inner, outer, 5.0, 64), "--size", "1.2")
    case.solve()
    expected = pressure * (outer**2 + inner**2) / (outer**2 - inner**2)
    stress, worst, total = case.fields()["STRESS"], 0.0, 0.0
    nodes = mesh.node_sets["inner"]
    for node in nodes:
        x, y, _ = mesh.nodes[node]
        r = math.hypot(x, y)
        sx, sy, _, sxy = stress[node][:4]
        hoop = (y * y * sx + x * x * sy - 2 * x * y * sxy) / (r * r)
        total += hoop
        worst = max(worst, abs(hoop / expected - 1))
    return result(case, mesh, "hoop stress inside, MPa, and the worst node's error (Lame)", total / len(nodes), expected,
                  0.02, worst)


def patch(case):
    young = 210000.0
    strains = (-1e-3, 2e-3, 3e-3)
    mesh = case.mesh(bodies.box((0, 0, 0), (10, 10, 10), ["left", "right", "front", "back", "bottom", "top"]), "--size", "3")
    # The axes of *ORIENTATION: x along the first vector, z across both.
    x, b = (2.0, 1.0, 0.5), (-1.0, 2.0, 0.3)
    z = (x[1] * b[2] - x[2] * b[1], x[2] * b[0] - x[0] * b[2], x[0] * b[1] - x[1] * b[0])
    y = (z[1] * x[2] - z[2] * x[1], z[2] * x[0] - z[0] * x[2], z[0] * x[1] - z[1] * x[0])
    axes = [[c / math.hypot(*axis) for c in axis] for axis in (x, y, z)]
    with open(case.work / "patch-boundary.inp", "w") as out:
        out.write("*NSET, NSET=everything\n" + "".join(f"{n},\n" for n in mesh.nodes))
        boundary = sorted(set().union(*(mesh.node_sets[s] for s in ("left", "right", "front", "back", "bottom", "top"))))
        out.write("*BOUNDARY\n")
        for node in boundary:
            p = mesh.nodes[node]
            local = [e * sum(a * c for a, c in zip(axis, p)) for e, axis in zip(strains, axes)]
            for i in range(3):
                moved = sum(l * axis[i] for l, axis in zip(local, axes))
                out.write(f"{node}, {i + 1}, {i + 1}, {moved:.13e}\n")
    case.solve()
    largest = max(abs(s) for row in ccx.dat_rows(case.file(".dat"), "stresses") for s in row[2:8])
    inside = len(mesh.nodes) - len(boundary)
    if inside < 50:
        raise SystemExit("the patch test has no nodes inside to speak of")
    return result(case, mesh, f"largest stress over E times strain ({inside} nodes inside)",
                  largest / (young * max(strains)), 0.0, 1e-9, largest / (young * max(strains)))


def merge(case, parts):
    """Two meshes that share triangles exactly become one, node by node."""
    ids, lines, sets, sides = {}, [], {}, {}
    nodes, elements = {}, {}
    for name, mesh in parts:
        here = {}
        for node, p in mesh.nodes.items():
            here[node] = ids.setdefault(p, len(ids) + 1)
            nodes[here[node]] = p
        first = len(elements)
        for k, corners in enumerate(mesh.elements.values()):
            elements[first + k + 1] = [here[n] for n in corners]
        lines.append((name, range(first + 1, len(elements) + 1)))
        numbers = {e: first + k + 1 for k, e in enumerate(mesh.elements)}
        for patch, members in mesh.node_sets.items():
            sets.setdefault(patch, set()).update(here[n] for n in members)
        for patch, members in mesh.sides.items():
            sides.setdefault(patch, []).extend((numbers[e], side) for e, side in members)
    with open(case.file("-mesh.inp"), "w") as out:
        out.write("*NODE\n")
        for node, p in sorted(nodes.items()):
            out.write("{}, {:.12e}, {:.12e}, {:.12e}\n".format(node, *p))
        for name, numbers in lines:
            out.write(f"*ELEMENT, TYPE=C3D10, ELSET={name}\n")
            for e in numbers:
                out.write(f"{e}, " + ", ".join(map(str, elements[e])) + "\n")
        for patch, members in sets.items():
            out.write(f"*NSET, NSET={patch}\n" + "".join(f"{n},\n" for n in sorted(members)))
        for patch, members in sides.items():
            out.write(f"*SURFACE, NAME={patch}, TYPE=ELEMENT\n" + "".join(f"{e}, {side}\n" for e, side in members))
    return ccx.Mesh(case.file("-mesh.inp"))


def heat(case):
    good, poor, k_good, k_poor = 30.0, 20.0, 400.0, 50.0
    side, n = 10.0, 4
    parts = []
    for name, x, x2, names in (("copper", 0.0, good, ["hot", "joint"]), ("steel", good, good + poor, ["joint", "cold"])):
        divisions = (round(n * (x2 - x) / side), n, n)
        body = bodies.box((x, 0, 0), (x2, side, side), names + ["sides"] * 4, divisions)
        if name == "steel":  # the same triangles from the other side: polygons are divided from their first corner
            body.groups["joint"] = [[ids[0], *reversed(ids[1:])] for ids in mirrored_joint(body, parts_joint)]
        else:
            parts_joint = joint_places(body)
        parts.append((name, case.mesh(body, "--keep-surface", name=name)))
    mesh = merge(case, parts)
    shared = len(parts[0][1].nodes) + len(parts[1][1].nodes) - len(mesh.nodes)
    if shared != len(parts[0][1].node_sets["joint"]):
        raise SystemExit(f"the two meshes share {shared} nodes, not all of their joint")
    case.solve()
    temperature = case.fields()["NDTEMP"]
    expected_at_joint = 100 * (poor / k_poor) / (good / k_good + poor / k_poor)
    worst = 0.0
    for node, (x, _, _) in mesh.nodes.items():
        exact = (100 + (expected_at_joint - 100) * x / good if x <= good else
                 expected_at_joint * (good + poor - x) / poor)
        worst = max(worst, abs(temperature[node][0] - exact) / 100)
    at_joint = [temperature[n][0] for n in mesh.node_sets["joint"]]
    return result(case, mesh, "temperature where the materials meet, degrees, and the worst node's error",
                  sum(at_joint) / len(at_joint), expected_at_joint, 1e-5, worst)


def joint_places(body):
    return [[body.points[v - 1] for v in ids] for ids in body.groups["joint"]]


def mirrored_joint(body, places):
    return [[body.point(*p) for p in polygon] for polygon in places]


def plate(case):
    side, thickness, young, poisson, density = 100.0, 2.0, 210000.0, 0.3, 7.85e-9
    mesh = case.mesh(bodies.box((0, 0, 0), (side, side, thickness), ["rim"] * 4 + ["faces"] * 2), "--size", "2")
    case.solve()
    rows = ccx.dat_rows(case.file(".dat"), "(rad/time)")
    found = next(row[3] for row in rows if len(row) >= 4 and row[0] == 1)
    rigidity = young * thickness**3 / (12 * (1 - poisson**2))
    expected = 35.9852 / (2 * math.pi * side**2) * math.sqrt(rigidity / (density * thickness))  # Leissa 1973
    return result(case, mesh, "first eigenfrequency, Hz (Kirchhoff, clamped)", found, expected, 0.02)


def must_share(mesh, one, other, joint):
    """What two regions have in common must be the nodes of their joint, or nothing holds them together."""
    shared = mesh.nodes_of(one) & mesh.nodes_of(other)
    if not shared or shared != set(mesh.node_sets[joint]):
        raise SystemExit(f"{one} and {other} share {len(shared)} nodes, their joint has {len(mesh.node_sets[joint])}")


def bar(case):
    steel, alloy, pull = (30.0, 200000.0), (20.0, 50000.0), 100.0  # lengths, Young's moduli
    end, side = steel[0] + alloy[0], 10.0
    sides = ["plane_y", "free", "plane_z", "free"]
    mesh = case.mesh_together({
        "steel": bodies.box((0, 0, 0), (steel[0], side, side), ["fixed", "joint", *sides], (6, 3, 3)),
        "alloy": bodies.box((steel[0], 0, 0), (end, side, side), ["joint", "pulled", *sides], (4, 4, 4))}, "--size", "3")
    must_share(mesh, "steel", "alloy", "steel_alloy_joint")
    case.solve()
    moved = case.fields()["DISP"]
    strains = [pull / young for _, young in (steel, alloy)]
    expected, worst = steel[0] * strains[0] + alloy[0] * strains[1], 0.0
    for node, (x, _, _) in mesh.nodes.items():
        exact = strains[0] * min(x, steel[0]) + strains[1] * max(x - steel[0], 0.0)
        worst = max(worst, abs(moved[node][0] - exact) / expected)
    tip = [moved[n][0] for n in mesh.node_sets["alloy_pulled"]]
    return result(case, mesh, "elongation, mm, and the worst node's error over it", sum(tip) / len(tip), expected, 1e-5, worst)


class Layer:
    """A thick-walled sphere (Lame): pressures inside and outside, and what follows from them."""

    def __init__(self, inner, outer, young, poisson):
        self.inner, self.outer = inner, outer
        self.bulk3, self.shear4 = young / (1 - 2 * poisson), 2 * young / (1 + poisson)

    def displacement(self, r, inside, outside):
        a3, b3 = self.inner**3, self.outer**3
        swell = (inside * a3 - outside * b3) / (self.bulk3 * (b3 - a3))
        return swell * r + (inside - outside) * a3 * b3 / (self.shear4 * (b3 - a3)) / r**2


def sphere(case):
    pressure, (a, b, c) = 100.0, (10.0, 15.0, 20.0)
    steel, alloy = Layer(a, b, 210000.0, 0.3), Layer(b, c, 70000.0, 0.33)
    point = {r: ",".join([repr(r / math.sqrt(3))] * 3) for r in ((a + b) / 2, (b + c) / 2)}
    mesh = case.mesh(bodies.octant_shells((a, b, c), ("inner", "joint", "outer"), 32), "--size", "1.5",
                     "--region", f"steel={point[(a + b) / 2]}", "--region", f"alloy={point[(b + c) / 2]}")
    must_share(mesh, "steel", "alloy", "joint")
    case.solve()
    # The pressure between the layers for which they move alike; both sides are linear in it.
    gap = [steel.displacement(b, pressure, q) - alloy.displacement(b, q, 0.0) for q in (0.0, 1.0)]
    between = gap[0] / (gap[0] - gap[1])
    expected = alloy.displacement(b, between, 0.0)
    moved, worst = case.fields()["DISP"], 0.0
    radial = lambda n: sum(x * u for x, u in zip(mesh.nodes[n], moved[n])) / math.hypot(*mesh.nodes[n])
    for name in mesh.element_sets:
        layer, pressures = (steel, (pressure, between)) if name == "steel" else (alloy, (between, 0.0))
        for node in mesh.nodes_of(name):
            exact = layer.displacement(math.hypot(*mesh.nodes[node]), *pressures)
            worst = max(worst, abs(radial(node) / exact - 1))
    at_joint = [radial(n) for n in mesh.node_sets["joint"]]
    return result(case, mesh, "displacement where the layers meet, mm, and the worst node's error (Lame)",
                  sum(at_joint) / len(at_joint), expected, 0.01, worst)


def pressed(case):
    pressure, young, poisson = 100.0, 210000.0, 0.3
    corners = {"origin": "0,0,0", "along_x": "10,0,0", "along_y": "0,10,0"}
    groups = [f for name, p in corners.items() for f in ("--group", f"{name}=sphere:{p},.01")]
    mesh = case.mesh_together({"cube": bodies.box((0, 0, 0), (10, 10, 10), ["cube"] * 6)}, "--size", "4",
                              "--region", "cube=5,5,5", *groups)
    case.solve()
    moved, shrink = case.fields()["DISP"], pressure * (1 - 2 * poisson) / young
    worst = max(abs(u + shrink * x) for n, p in mesh.nodes.items() for u, x in zip(moved[n], p)) / (10 * shrink)
    found = -sum(moved[mesh.node_sets["along_x"][0]])
    return result(case, mesh, "shortening under pressure, mm, and the worst node's error over it", found, 10 * shrink, 1e-5, worst)


def scan(case):
    """A block of bone whose stiffness rises with its grey value, 10 E = HU, from k = 0 to the other end."""
    size, pressure = (8, 8, 40), 10.0
    grey, labels = case.file("-ct.nii"), case.file("-labels.nii")
    bodies.voxels(grey, size, lambda i, j, k: 400 + 20 * k)
    bodies.voxels(labels, size, lambda i, j, k: 1)
    mesh = case._run([labels], case.file("-mesh.inp"), [
        "--image", "labels", "--size", "2", "--sample", f"{grey}=HU", "--field", "E=10*HU", "--material-bins", "40",
        "--poisson", "0", "--group", "FIXED=patches:box_k0"])
    case.solve()
    # Linear between the middles of voxels, and constant over half a voxel at both ends.
    expected = pressure / 10 * (0.5 / 400 + math.log(1180 / 400) / 20 + 0.5 / 1180)
    moved = case.fields()["DISP"]
    end = [-moved[n][2] for n in mesh.node_sets["box_k1"]]
    return result(case, mesh, "shortening of a scanned block, mm", sum(end) / len(end), expected, 0.005)


CASES = {f.__name__: f for f in (cantilever, pipe, patch, heat, plate, bar, sphere, pressed, scan)}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("octafront", type=pathlib.Path)
    parser.add_argument("work", type=pathlib.Path)
    parser.add_argument("cases", nargs="*", metavar="CASE", help=", ".join(CASES))
    parser.add_argument("--json", type=pathlib.Path)
    args = parser.parse_args()
    unknown = set(args.cases) - set(CASES)
    if unknown:
        parser.error(f"no such case: {', '.join(sorted(unknown))}")
    if not shutil.which("ccx"):
        print("skipped: there is no ccx; install the Debian package calculix-ccx")
        sys.exit(SKIPPED)
    args.work.mkdir(parents=True, exist_ok=True)
    results = []
    for name in args.cases or CASES:
        r = CASES[name](Case(args.octafront.resolve(), args.work.resolve(), name))
        results.append(r)
        print(f"{r['case']:<11}{r['elements']:>7} elements{r['nodes']:>8} nodes  {r['what']}: {r['found']:.6g}"
              f" (theory {r['expected']:.6g}), error {r['error']:.2e}, bound {r['bound']:g}"
              f"{'' if r['good'] else '  BEYOND ITS BOUND'}", flush=True)
    if args.json:
        args.json.write_text(json.dumps(results, indent=2) + "\n")
    sys.exit(0 if all(r["good"] for r in results) else 1)


if __name__ == "__main__":
    main()
