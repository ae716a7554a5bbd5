#!/usr/bin/env python3
"""Generates the sample models that stand beside this script. Needs nothing but Python.

    samples/generate.py [FOLDER]

All are closed, 2-manifold, oriented outward and free of self-intersections by construction; `check` makes sure of what
can be counted. Lengths are in millimetres.
"""
import math
import os
import struct
import sys


class Surface:
    """Points, triangles (counter-clockwise from outside) and a patch name for each triangle."""

    def __init__(self):
        self.points, self.triangles, self.patches = [], [], []

    def add_point(self, p):
        self.points.append(tuple(p))
        return len(self.points) - 1

    def add_triangle(self, a, b, c, patch="surface"):
        self.triangles.append((a, b, c))
        self.patches.append(patch)

    def add_quad(self, a, b, c, d, patch="surface"):
        """Divided along the shorter diagonal."""
        p = self.points
        if math.dist(p[a], p[c]) <= math.dist(p[b], p[d]):
            self.add_triangle(a, b, c, patch)
            self.add_triangle(a, c, d, patch)
        else:
            self.add_triangle(a, b, d, patch)
            self.add_triangle(b, c, d, patch)

    def append(self, other, inside_out=False):
        shift = len(self.points)
        self.points += other.points
        for (a, b, c), patch in zip(other.triangles, other.patches):
            if inside_out:
                b, c = c, b
            self.add_triangle(a + shift, b + shift, c + shift, patch)


def volume(s):
    total = 0
    for a, b, c in s.triangles:
        (ax, ay, az), (bx, by, bz), (cx, cy, cz) = s.points[a], s.points[b], s.points[c]
        total += ax * (by * cz - bz * cy) + ay * (bz * cx - bx * cz) + az * (bx * cy - by * cx)
    return total / 6


def check(s):
    """Closed, 2-manifold at edges and vertices, outward, every point used."""
    edges = set()
    around = {}
    for t in s.triangles:
        for k in range(3):
            a, b, c = t[k], t[(k + 1) % 3], t[(k + 2) % 3]
            assert a != b and (a, b) not in edges, "an edge is used twice in one direction"
            edges.add((a, b))
            around.setdefault(a, {})[b] = c
    assert all((b, a) in edges for a, b in edges), "the surface is open"
    for fan in around.values():
        start = at = next(iter(fan))
        length = 0
        while True:
            at = fan[at]
            length += 1
            if at == start:
                break
        assert length == len(fan), "the triangles at a vertex form more than one fan"
    assert len(around) == len(s.points), "a point is unused"
    assert len(set(s.points)) == len(s.points), "two points are equal"
    assert volume(s) > 0, "the surface is inside out"


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
    long_leg, short_leg, width = 3 * block, 2 * block, 2 * block
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


# ------------------------------------------------------------------------------------------------------- torus knot


def sub(a, b):
    return tuple(x - y for x, y in zip(a, b))


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def unit(a):
    length = math.sqrt(dot(a, a))
    return tuple(x / length for x in a)


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


# ----------------------------------------------------------------------------------------------------------- gyroid


class GyroidBlock:
    """The sheet |gyroid| <= level, cut to a cube: marching tetrahedra inside, clipped triangles on the sides, then
    smoothing that keeps every vertex on its surface, side or edge."""

    def __init__(self, side=30.0, periods=1.0, cells=16, level=0.6, phase=math.pi / 4):
        self.side, self.cells, self.level = side, cells, level
        self.wave = 2 * math.pi * periods / side
        self.step, self.phase = side / cells, phase
        self.surface = Surface()
        self.vertex_of, self.value_of = {}, {}
        self.on_sheet = []

    def value(self, p):
        """Negative inside."""
        x, y, z = (self.wave * c + self.phase for c in p)
        g = math.sin(x) * math.cos(y) + math.sin(y) * math.cos(z) + math.sin(z) * math.cos(x)
        return abs(g) - self.level

    def gradient(self, p):
        x, y, z = (self.wave * c + self.phase for c in p)
        g = math.sin(x) * math.cos(y) + math.sin(y) * math.cos(z) + math.sin(z) * math.cos(x)
        sign = self.wave if g > 0 else -self.wave
        return (sign * (math.cos(x) * math.cos(y) - math.sin(z) * math.sin(x)),
                sign * (math.cos(y) * math.cos(z) - math.sin(x) * math.sin(y)),
                sign * (math.cos(z) * math.cos(x) - math.sin(y) * math.sin(z)))

    def place(self, node):
        return tuple(self.step * c for c in node)

    def node_value(self, node):
        if node not in self.value_of:
            self.value_of[node] = self.value(self.place(node))
        return self.value_of[node]

    def inner_vertex(self, node):
        if node not in self.vertex_of:
            self.vertex_of[node] = self.surface.add_point(self.place(node))
            self.on_sheet.append(False)
        return self.vertex_of[node]

    def cut_vertex(self, a, b):
        key = (min(a, b), max(a, b))
        if key not in self.vertex_of:
            p, q = self.place(key[0]), self.place(key[1])
            f, g = self.node_value(key[0]), self.node_value(key[1])
            t = min(0.85, max(0.15, f / (f - g)))  # not too near to the nodes: no needles
            self.vertex_of[key] = self.surface.add_point(tuple(x + t * (y - x) for x, y in zip(p, q)))
            self.on_sheet.append(True)
        return self.vertex_of[key]

    def cut_tetrahedron(self, nodes):
        """nodes: a positive tetrahedron."""
        inside = [self.node_value(n) < 0 for n in nodes]
        count = sum(inside)
        if count in (0, 4):
            return
        cut = self.cut_vertex
        if count in (1, 3):
            apex = inside.index(count == 1)
            # The other corners, counter-clockwise seen from the apex's far side.
            b, c, d = ([1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1])[apex]
            t = [cut(nodes[apex], nodes[k]) for k in (b, c, d)]
            if count == 3:
                t.reverse()
            self.surface.add_triangle(*t, "sheet")
        else:
            i, j = (k for k in range(4) if inside[k])
            k, m = {(0, 1): (2, 3), (0, 2): (3, 1), (0, 3): (1, 2), (1, 2): (0, 3), (1, 3): (2, 0), (2, 3): (0, 1)}[i, j]
            n = nodes
            self.surface.add_quad(cut(n[i], n[m]), cut(n[j], n[m]), cut(n[j], n[k]), cut(n[i], n[k]), "sheet")

    def cut_side(self, nodes, patch):
        """nodes: a triangle of the cube's side, counter-clockwise from outside; keeps the part inside the sheet."""
        polygon = []
        for k in range(3):
            a, b = nodes[k], nodes[(k + 1) % 3]
            a_in, b_in = self.node_value(a) < 0, self.node_value(b) < 0
            if a_in:
                polygon.append(self.inner_vertex(a))
            if a_in != b_in:
                polygon.append(self.cut_vertex(a, b))
        if len(polygon) == 3:
            self.surface.add_triangle(*polygon, patch)
        elif len(polygon) == 4:
            self.surface.add_quad(*polygon, patch)

    def march(self):
        n = self.cells
        orders = {(0, 1, 2): 1, (1, 2, 0): 1, (2, 0, 1): 1, (0, 2, 1): -1, (1, 0, 2): -1, (2, 1, 0): -1}
        for i in range(n):
            for j in range(n):
                for k in range(n):
                    for order, sign in orders.items():
                        g = [i, j, k]
                        nodes = [tuple(g)]
                        for axis in order:
                            g[axis] += 1
                            nodes.append(tuple(g))
                        if sign < 0:
                            nodes[2], nodes[3] = nodes[3], nodes[2]
                        self.cut_tetrahedron(nodes)
                        self.cut_sides_of(nodes)

    def cut_sides_of(self, nodes):
        for b, c, d in ((1, 2, 3), (0, 3, 2), (0, 1, 3), (0, 2, 1)):
            face = (nodes[b], nodes[c], nodes[d])
            for axis in range(3):
                for end, name in ((0, "low"), (self.cells, "high")):
                    if all(node[axis] == end for node in face):
                        self.cut_side(face, f"{name} {'xyz'[axis]}")

    def smooth(self, sweeps=15):
        s = self.surface
        star = [[] for _ in s.points]
        for t in s.triangles:
            for k in range(3):
                star[t[k]].append((t[(k + 1) % 3], t[(k + 2) % 3]))
        fixed = [[axis for axis in range(3) if min(p[axis], self.side - p[axis]) < 1e-9] for p in s.points]
        for _ in range(sweeps):
            for v, p in enumerate(s.points):
                # A vertex of a side, or an edge of the block, only looks at those of the same side or edge; a vertex where
                # the sheet meets a side only at those on that curve.
                like = [s.points[w] for w, _ in star[v]
                        if set(fixed[v]) <= set(fixed[w]) and (self.on_sheet[w] or not self.on_sheet[v])]
                if len(fixed[v]) == 3 or len(like) < 2 or (len(fixed[v]) == 2 and self.on_sheet[v]):
                    goal = p
                else:
                    goal = tuple(x + 0.5 * (sum(q[a] for q in like) / len(like) - x) for a, x in enumerate(p))
                goal = self.back(goal, p, fixed[v]) if self.on_sheet[v] else \
                    tuple(p[a] if a in fixed[v] else goal[a] for a in range(3))
                if self.keeps_shape(star[v], p, goal):
                    s.points[v] = goal

    def keeps_shape(self, star, old, new):
        """No triangle turns by more than 60 degrees, or loses more than two thirds of its area."""
        for b, c in star:
            q, r = self.surface.points[b], self.surface.points[c]
            m, n = cross(sub(q, old), sub(r, old)), cross(sub(q, new), sub(r, new))
            if dot(m, n) < 0.5 * math.sqrt(dot(m, m) * dot(n, n)) or dot(n, n) < 0.1 * dot(m, m):
                return False
        return True

    def back(self, goal, old, fixed):
        """Newton's way to the sheet's surface within the side or edge of the vertex."""
        p = [old[a] if a in fixed else goal[a] for a in range(3)]
        for _ in range(8):
            g = [0 if a in fixed else x for a, x in enumerate(self.gradient(p))]
            square = dot(g, g)
            if square < 1e-12:
                return old
            f = self.value(p)
            p = [x - f / square * y for x, y in zip(p, g)]
        if math.dist(p, old) > 0.5 * self.step or any(x < 0 or x > self.side for x in p):
            return old
        return tuple(p)


def gyroid():
    block = GyroidBlock()
    block.march()
    block.smooth()
    return block.surface


# ------------------------------------------------------------------------------------------------------------ shell


def rounded_box(half, radius, flat_cells, arc_cells):
    """Half sizes per axis; edges and corners rounded."""
    s = Surface()
    lines = []
    for h in half:
        flat = h - radius
        arc = [radius * math.tan(math.pi / 4 * k / arc_cells) for k in range(1, arc_cells + 1)]
        lines.append([-flat - x for x in reversed(arc)] + [flat * (2 * k / flat_cells - 1) for k in range(flat_cells + 1)] +
                     [flat + x for x in arc])
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


# ------------------------------------------------------------------------------------------------------------ files


def number(x):
    """Five decimals are a hundredth of a micrometre."""
    text = f"{x:.5f}".rstrip("0").rstrip(".")
    return "0" if text == "-0" else text


def write_stl(s, name):
    with open(name, "wb") as f:
        f.write(b"bracket, millimetres".ljust(80) + struct.pack("<I", len(s.triangles)))
        for t in s.triangles:
            a, b, c = (s.points[v] for v in t)
            n = cross(sub(b, a), sub(c, a))
            f.write(struct.pack("<12fH", *unit(n), *a, *b, *c, 0))


def write_obj(s, name):
    with open(name, "w") as f:
        f.write("# millimetres\n")
        for p in s.points:
            f.write("v " + " ".join(map(number, p)) + "\n")
        for patch in dict.fromkeys(s.patches):
            f.write(f"g {patch}\n")
            for t, its in zip(s.triangles, s.patches):
                if its == patch:
                    f.write("f " + " ".join(str(v + 1) for v in t) + "\n")


def write_off(s, name):
    with open(name, "w") as f:
        f.write(f"OFF\n# millimetres\n{len(s.points)} {len(s.triangles)} 0\n")
        for p in s.points:
            f.write(" ".join(map(number, p)) + "\n")
        for t in s.triangles:
            f.write("3 " + " ".join(map(str, t)) + "\n")


def write_ply(s, name, byte_order="little"):
    order = "<" if byte_order == "little" else ">"
    names = list(dict.fromkeys(s.patches))
    with open(name, "wb") as f:
        header = ["ply", f"format binary_{byte_order}_endian 1.0", "comment millimetres"]
        header += [f"comment patch {k} {patch}" for k, patch in enumerate(names)] if len(names) > 1 else []
        header += [f"element vertex {len(s.points)}", "property float x", "property float y", "property float z",
                   f"element face {len(s.triangles)}", "property list uchar ushort vertex_indices"]
        header += ["property uchar patch"] if len(names) > 1 else []
        f.write(("\n".join(header + ["end_header"]) + "\n").encode())
        for p in s.points:
            f.write(struct.pack(order + "3f", *p))
        for t, patch in zip(s.triangles, s.patches):
            f.write(struct.pack(order + "B3H", 3, *t))
            if len(names) > 1:
                f.write(bytes([names.index(patch)]))


def main():
    folder = sys.argv[1] if len(sys.argv) > 1 else os.path.dirname(os.path.abspath(__file__))
    for model, name, write in ((bracket, "bracket.stl", write_stl), (gear, "gear.obj", write_obj),
                               (torus_knot, "torus_knot.ply", write_ply), (gyroid, "gyroid.ply", lambda s, n: write_ply(s, n, "big")),
                               (shell, "shell.off", write_off)):
        s = model()
        check(s)
        path = os.path.join(folder, name)
        write(s, path)
        print(f"{name}: {len(s.triangles)} triangles, {volume(s):.0f} mm^3, {os.path.getsize(path) / 1000:.0f} kB")


if __name__ == "__main__":
    main()
