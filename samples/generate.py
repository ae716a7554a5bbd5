#!/usr/bin/env python3
"""Generates the sample models and images that stand beside this script. Needs nothing but Python.

    samples/generate.py [FOLDER]

All are closed, 2-manifold, oriented outward and free of self-intersections by construction; `check` makes sure of what
can be counted. Lengths are in millimetres.
"""
import math
import os
import sys

import head
from gyroid import GyroidBlock
from surface import Surface, check, cross, dot, sub, unit, volume, write_obj, write_off, write_ply, write_stl


# ---------------------------------------------------------------------------------------------------- flat patterns


class Pattern:
    """A plane mesh of quadrangles, counter-clockwise, that shares its points by position."""

    def __init__(self):
        self.points, self.index, self.quads = [], {}, []

    def point(self, u, v):
        key = (round(u, 7), round(v, 7))
        if key not in self.index:
            self.index[key] = len(self.points)
            self.points.append((u, v))
        return self.index[key]

    def quad(self, *corners):
        self.quads.append(tuple(self.point(u, v) for u, v in corners))

    def grid(self, us, vs):
        for u0, u1 in zip(us, us[1:]):
            for v0, v1 in zip(vs, vs[1:]):
                self.quad((u0, v0), (u1, v0), (u1, v1), (u0, v1))

    def square_with_hole(self, u, v, side, radius, cells, rings):
        """A square about (u, v) with `cells` cells along each side and a round hole."""
        rim = []
        for k in range(4 * cells):
            leg, step = divmod(k, cells)
            along = -side / 2 + side * step / cells
            x, y = [(along, -side / 2), (side / 2, along), (-along, side / 2), (-side / 2, -along)][leg]
            rim.append((x, y))

        def at(k, ring):
            x, y = rim[k % len(rim)]
            angle = 2 * math.pi * (k / len(rim)) - 3 * math.pi / 4
            w = (ring / rings) ** 1.2
            return (u + (1 - w) * radius * math.cos(angle) + w * x, v + (1 - w) * radius * math.sin(angle) + w * y)

        for k in range(len(rim)):
            for r in range(rings):
                self.quad(at(k, r), at(k, r + 1), at(k + 1, r + 1), at(k + 1, r))


def thickened(pattern, place, layers, wall_patch):
    """The solid between layer 0 and layer `layers` of a pattern; place(u, v, layer) is the point in space, and the
    direction of growing layers is that of the pattern's normal. wall_patch(u, v) names a wall by its middle."""
    s = Surface()
    boundary = set()
    for q in pattern.quads:
        for k in range(4):
            e = (q[k], q[(k + 1) % 4])
            if (e[1], e[0]) in boundary:
                boundary.remove((e[1], e[0]))
            else:
                boundary.add(e)
    vertex = {}

    def at(i, layer):
        if (i, layer) not in vertex:
            vertex[i, layer] = s.add_point(place(*pattern.points[i], layer))
        return vertex[i, layer]

    for q in pattern.quads:
        s.add_quad(*(at(i, layers) for i in q), "top")
        s.add_quad(*(at(i, 0) for i in reversed(q)), "bottom")
    for i, j in sorted(boundary):
        (u0, v0), (u1, v1) = pattern.points[i], pattern.points[j]
        patch = wall_patch((u0 + u1) / 2, (v0 + v1) / 2)
        for layer in range(layers):
            s.add_quad(at(i, layer), at(j, layer), at(j, layer + 1), at(i, layer + 1), patch)
    return s


def bracket():
    """A plate of 5 mm bent by a right angle with an inner radius of 6 mm; two bolt holes in each leg."""
    block, cells, thickness, inner = 20.0, 6, 5.0, 6.0
    width = 2 * block
    bend_steps = 7
    pattern = Pattern()
    steps = [block * k / cells for k in range(cells + 1)]
    holes = {(-3, 0): 4.5, (-3, 1): 4.5, (1, 0): 3.5, (1, 1): 3.5}
    for column in (-3, -2, -1, 0, 1):
        for row in (0, 1):
            # The bend takes the strip 0 <= u < 1 of the pattern, the short leg lies behind it.
            u0, v0 = column * block + (1 if column >= 0 else 0), row * block - width / 2
            radius = holes.get((column, row), 0)
            if radius > 0:
                pattern.square_with_hole(u0 + block / 2, v0 + block / 2, block, radius, cells, 3)
            else:
                pattern.grid([u0 + x for x in steps], [v0 + x for x in steps])
    rows = [-width / 2 + width * k / (2 * cells) for k in range(2 * cells + 1)]
    pattern.grid([k / bend_steps for k in range(bend_steps + 1)], rows)

    def place(u, v, layer):
        height = thickness * layer / 2
        if u <= 0:
            return (u, v, height)
        radius = inner + thickness - height
        if u < 1:
            angle = u * math.pi / 2
            return (radius * math.sin(angle), v, thickness + inner - radius * math.cos(angle))
        return (radius, v, thickness + inner + (u - 1))

    return thickened(pattern, place, 2, lambda u, v: "wall")


def gear():
    """Twenty involute teeth of module 2.5 mm and 20 degrees pressure angle, with a bore of 16 mm."""
    teeth, module, bore, height, layers = 20, 2.5, 8.0, 10.0, 5
    pitch = teeth * module / 2
    base, tip, root = pitch * math.cos(math.radians(20)), pitch + module, pitch - 1.25 * module
    across, gap, rows, rings = 2, 2, 5, 9

    def half_angle(r):
        """Of a tooth at radius r; below the base circle the flanks are radial."""
        turn = math.acos(min(1, base / r))
        involute = math.tan(math.radians(20)) - math.radians(20)
        return math.pi / (2 * teeth) + involute - (math.tan(turn) - turn)

    def polar(r, angle):
        return (r * math.cos(angle), r * math.sin(angle))

    pattern = Pattern()
    root_angles = []
    for k in range(teeth):
        middle = 2 * math.pi * k / teeth
        half = half_angle(root)
        for r in range(rows):
            r0, r1 = (root + (tip - root) * x / rows for x in (r, r + 1))
            for c in range(across):
                x0, x1 = 2 * c / across - 1, 2 * (c + 1) / across - 1
                pattern.quad(polar(r0, middle + x0 * half_angle(r0)), polar(r1, middle + x0 * half_angle(r1)),
                             polar(r1, middle + x1 * half_angle(r1)), polar(r0, middle + x1 * half_angle(r0)))
        root_angles += [middle - half + 2 * half * c / across for c in range(across)]
        free = 2 * math.pi / teeth - 2 * half
        root_angles += [middle + half + free * c / gap for c in range(gap)]
    root_angles.append(root_angles[0] + 2 * math.pi)
    for ring in range(rings):
        r0, r1 = (bore * (root / bore) ** (x / rings) for x in (ring, ring + 1))
        for a0, a1 in zip(root_angles, root_angles[1:]):
            pattern.quad(polar(r0, a0), polar(r1, a0), polar(r1, a1), polar(r0, a1))

    def wall_patch(x, y):
        return "bore" if math.hypot(x, y) < bore + 1 else "teeth"

    return thickened(pattern, lambda x, y, layer: (x, y, height * layer / layers), layers, wall_patch)


# ---------------------------------------------------------------------------------------------------- curved shapes


def torus_knot():
    """A tube of 9 mm about the trefoil knot."""
    rings, sides, radius, scale = 240, 18, 4.5, 10.0

    def centre(k):
        t = 2 * math.pi * k / rings
        rho = 2 + math.cos(3 * t)
        return (scale * rho * math.cos(2 * t), scale * rho * math.sin(2 * t), scale * math.sin(3 * t))

    def tangent(k):
        return unit(sub(centre(k + 1e-4), centre(k - 1e-4)))

    # A frame carried along without twist does not close: the angle that is left over is spread over the whole length.
    normal = unit(cross(tangent(0), (0, 0, 1)))
    normals = [normal]
    for k in range(1, rings + 1):
        t = tangent(k)
        along = dot(normals[-1], t)
        normals.append(unit(tuple(n - along * x for n, x in zip(normals[-1], t))))
    left_over = math.atan2(dot(cross(normals[-1], normals[0]), tangent(0)), dot(normals[-1], normals[0]))
    s = Surface()
    for k in range(rings):
        c, n = centre(k), normals[k]
        b = cross(tangent(k), n)
        for j in range(sides):
            angle = 2 * math.pi * j / sides + left_over * k / rings
            s.add_point(tuple(x + radius * (math.cos(angle) * y + math.sin(angle) * z) for x, y, z in zip(c, n, b)))
    for k in range(rings):
        for j in range(sides):
            at = lambda i, m: (i % rings) * sides + m % sides
            s.add_quad(at(k, j), at(k, j + 1), at(k + 1, j + 1), at(k + 1, j))
    return s


def gyroid():
    block = GyroidBlock()
    block.march()
    block.smooth()
    return block.surface


def rounded_box(half, radius, flat_cells, arc_cells):
    """Half sizes per axis; edges and corners rounded."""
    s = Surface()
    lines = []
    for h in half:
        flat = h - radius
        arc = [radius * math.tan(math.pi / 4 * k / arc_cells) for k in range(1, arc_cells + 1)]
        middle = [flat * (2 * k / flat_cells - 1) for k in range(flat_cells + 1)]
        lines.append([-flat - x for x in reversed(arc)] + middle + [flat + x for x in arc])
    index = {}

    def vertex(grid):
        if grid not in index:
            q = [lines[a][grid[a]] for a in range(3)]
            core = [min(half[a] - radius, max(radius - half[a], q[a])) for a in range(3)]
            n = unit(sub(q, core))
            index[grid] = s.add_point(tuple(c + radius * x for c, x in zip(core, n)))
        return index[grid]

    last = [len(line) - 1 for line in lines]
    for axis in range(3):
        u, v = (axis + 1) % 3, (axis + 2) % 3
        for end in (0, last[axis]):
            for i in range(last[u]):
                for j in range(last[v]):
                    corners = []
                    for du, dv in ((0, 0), (1, 0), (1, 1), (0, 1)):
                        grid = [0, 0, 0]
                        grid[axis], grid[u], grid[v] = end, i + du, j + dv
                        corners.append(vertex(tuple(grid)))
                    if end == 0:
                        corners.reverse()
                    s.add_quad(*corners, "outside")
    return s


def ellipsoid(half, levels):
    """An icosahedron divided and stretched."""
    g = (1 + math.sqrt(5)) / 2
    points = [unit(p) for p in ((-1, g, 0), (1, g, 0), (-1, -g, 0), (1, -g, 0), (0, -1, g), (0, 1, g),
                                (0, -1, -g), (0, 1, -g), (g, 0, -1), (g, 0, 1), (-g, 0, -1), (-g, 0, 1))]
    triangles = [(0, 11, 5), (0, 5, 1), (0, 1, 7), (0, 7, 10), (0, 10, 11), (1, 5, 9), (5, 11, 4),
                 (11, 10, 2), (10, 7, 6), (7, 1, 8), (3, 9, 4), (3, 4, 2), (3, 2, 6), (3, 6, 8),
                 (3, 8, 9), (4, 9, 5), (2, 4, 11), (6, 2, 10), (8, 6, 7), (9, 8, 1)]
    for _ in range(levels):
        middle = {}

        def mid(a, b):
            key = (min(a, b), max(a, b))
            if key not in middle:
                middle[key] = len(points)
                points.append(unit(tuple(x + y for x, y in zip(points[a], points[b]))))
            return middle[key]

        finer = []
        for a, b, c in triangles:
            ab, bc, ca = mid(a, b), mid(b, c), mid(c, a)
            finer += [(a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca)]
        triangles = finer
    s = Surface()
    for p in points:
        s.add_point(tuple(h * x for h, x in zip(half, p)))
    for t in triangles:
        s.add_triangle(*t, "cavity")
    return s


def shell():
    """A rounded box of 60 x 40 x 30 mm with an ellipsoidal cavity."""
    s = rounded_box((30, 20, 15), 8, 8, 4)
    s.append(ellipsoid((20, 12, 9), 3), inside_out=True)
    return s


def main():
    folder = sys.argv[1] if len(sys.argv) > 1 else os.path.dirname(os.path.abspath(__file__))
    # One model per reader.
    for model, name, write in ((bracket, "bracket.stl", write_stl),
                               (gear, "gear.obj", write_obj),
                               (torus_knot, "torus_knot.ply", write_ply),
                               (gyroid, "gyroid.ply", lambda s, n: write_ply(s, n, "big")),
                               (shell, "shell.off", write_off)):
        s = model()
        check(s)
        path = os.path.join(folder, name)
        write(s, path)
        print(f"{name}: {len(s.triangles)} triangles, {volume(s):.0f} mm^3, {os.path.getsize(path) / 1000:.0f} kB")
    for name, data in (("head_labels.nii.gz", head.labels()), ("head_ct.nii.gz", head.ct()),
                       ("head_labels.txt", head.names().encode())):
        with open(os.path.join(folder, name), "wb") as out:
            out.write(data)
        print(f"{name}: {len(data) / 1000:.1f} kB")


if __name__ == "__main__":
    main()
