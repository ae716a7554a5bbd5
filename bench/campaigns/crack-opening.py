#!/usr/bin/env python3
"""A penny-shaped crack in a block under tension, by CalculiX (Debian: calculix-ccx): how far does it open?

Usage: bench/campaigns/crack-opening.py [SIZE [PROGRAM]]
SIZE: edge length on the crack, whose radius is 1 [0.2]; the block measures 16. PROGRAM: octafront [build/release/cli/octafront].
An infinite body opens by 8 (1 - nu^2) s sqrt(a^2 - r^2) / (pi E) at a distance r from the middle (I. N. Sneddon, 1946).
"""
import math
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT), str(ROOT / "examples/solve")]
import ccx  # noqa: E402
from bench.off import write_off  # noqa: E402

YOUNG, POISSON = 1000.0, 0.3
HALF = 8.0
# Corners of the sides of C3D10: S1 = 123, S2 = 124, S3 = 234, S4 = 134.
SIDES = ((0, 1, 2), (0, 1, 3), (1, 2, 3), (0, 2, 3))


def write_bodies(folder):
    ends = (-HALF, HALF)
    corners = [(x, y, z) for z in ends for y in ends for x in ends]
    write_off(folder / "block.off", corners,
              [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)])
    count = 64
    rim = [(math.cos(2 * math.pi * i / count), math.sin(2 * math.pi * i / count), 0.0) for i in range(count)]
    write_off(folder / "crack.off", [(0.0, 0.0, 0.0), *rim], [(0, 1 + i, 1 + (i + 1) % count) for i in range(count)])


def write_deck(folder, mesh):
    points, elements = mesh.nodes, mesh.elements
    top = {n for n, p in points.items() if p[2] == HALF}
    bottom = [n for n, p in points.items() if p[2] == -HALF]
    corner = {p: n for n, p in points.items() if abs(p[0]) == abs(p[1]) == HALF and p[2] == -HALF}
    loads = [f"{e}, P{side + 1}, -1." for e, nodes in elements.items() for side, corners in enumerate(SIDES)
             if all(nodes[c] in top for c in corners)]
    lines = ["*INCLUDE, INPUT=mesh.inp", "*MATERIAL, NAME=M", "*ELASTIC", f"{YOUNG}, {POISSON}",
             "*SOLID SECTION, ELSET=body, MATERIAL=M", "*NSET, NSET=BOTTOM", *(f"{n}," for n in bottom), "*BOUNDARY", "BOTTOM, 3, 3",
             f"{corner[(-HALF, -HALF, -HALF)]}, 1, 2", f"{corner[(HALF, -HALF, -HALF)]}, 2, 2", "*STEP",
             "*STATIC, SOLVER=ITERATIVE CHOLESKY", "*DLOAD", *loads, "*NODE PRINT, NSET=crack_plus", "U",
             "*NODE PRINT, NSET=crack_minus", "U", "*END STEP"]
    (folder / "deck.inp").write_text("\n".join(lines) + "\n")


def main():
    size = float(sys.argv[1]) if len(sys.argv) > 1 else 0.2
    program = pathlib.Path(sys.argv[2] if len(sys.argv) > 2 else "build/release/cli/octafront").resolve()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        write_bodies(folder)
        subprocess.run([program, "mesh", "block.off", "--sheet", "crack.off", "--split", "crack", "--size", "2.5", "--size-of",
                        f"crack={size}", "--order", "2", "-o", "mesh.inp", "-q"], cwd=folder, check=True)
        mesh = ccx.Mesh(folder / "mesh.inp")
        write_deck(folder, mesh)
        ccx.run(folder / "deck.inp")
        moved = {int(row[0]): row[3] for row in ccx.dat_rows(folder / "deck.dat", "displacements")}
        points = mesh.nodes
        behind = {points[n]: n for n in mesh.node_sets["crack_minus"]}
        opening = sorted((math.hypot(*points[n][:2]), moved[n] - moved[behind[points[n]]]) for n in mesh.node_sets["crack_plus"])
    print(f"{len(mesh.elements)} elements, {len(points)} nodes")
    for r, found in (opening[0], opening[len(opening) // 2]):
        theory = 8 * (1 - POISSON**2) * math.sqrt(1 - r * r) / (math.pi * YOUNG)
        print(f"at r = {r:.3f} it opens by {found:.6f}, in an infinite body by {theory:.6f}: {found / theory:.4f}")


if __name__ == "__main__":
    main()
