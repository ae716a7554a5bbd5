"""A gyroid sheet of finite thickness, cut to a cube."""
import math

from surface import Surface, cross, dot, sub


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
