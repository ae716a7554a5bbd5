"""Clean closed surfaces to be damaged: read, generated, and what is known of them. Needs NumPy.

A Solid has points (n, 3) in its own units and triangles (m, 3), counter-clockwise from outside, cavities inward.
"""
import collections
import math
import pathlib
import sys

import numpy as np

from bench import off

ROOT = pathlib.Path(__file__).resolve().parents[2]
Solid = collections.namedtuple("Solid", "points triangles")


# ------------------------------------------------------------------------------------------------------- files


def read_off(path):
    points, triangles = off.read_off(path)
    return Solid(np.array(points, float).reshape(-1, 3), np.array(triangles, int).reshape(-1, 3))


def write_stl(path, solid):
    """Binary: coordinates are rounded to 24 bits, and every triangle has corners of its own."""
    record = np.zeros(len(solid.triangles), np.dtype([("normal", "<3f4"), ("corners", "<9f4"), ("tag", "<u2")]))
    record["corners"] = solid.points[solid.triangles].reshape(-1, 9)
    with open(path, "wb") as f:
        f.write(b"damaged".ljust(80) + np.uint32(len(record)).tobytes() + record.tobytes())


# ------------------------------------------------------------------------------------------------------ shapes


def merged(points, triangles):
    """Equal points become one, flat triangles that come of it go."""
    points, index = np.unique(np.round(points, 12), axis=0, return_inverse=True)
    triangles = index.reshape(-1)[np.asarray(triangles)]
    a, b, c = triangles.T
    return Solid(points, triangles[(a != b) & (b != c) & (c != a)])


def grid(function, n, m):
    """The image of the unit square in n x m squares."""
    u, v = np.meshgrid(np.linspace(0, 1, n + 1), np.linspace(0, 1, m + 1), indexing="ij")
    points = np.array([function(a, b) for a, b in zip(u.flat, v.flat)])
    corner = np.arange((n + 1) * (m + 1)).reshape(n + 1, m + 1)
    a, b, c, d = corner[:-1, :-1].ravel(), corner[1:, :-1].ravel(), corner[1:, 1:].ravel(), corner[:-1, 1:].ravel()
    return points, np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)])


def together(parts):
    """Point lists and triangle lists one after the other."""
    shift, points, triangles = 0, [], []
    for p, t in parts:
        points.append(p)
        triangles.append(np.asarray(t) + shift)
        shift += len(p)
    return np.concatenate(points), np.concatenate(triangles)


def voxels(full, size=1.0, divide=4):
    """The boundary of cubes: `full` (i, j, k) cells, each side in divide x divide squares."""
    full, parts = set(full), []
    for cell in full:
        for axis in range(3):
            for side in (0, 1):
                step = [0, 0, 0]
                step[axis] = 2 * side - 1
                if tuple(np.add(cell, step)) in full:
                    continue
                u, v = np.eye(3)[(axis + 1) % 3], np.eye(3)[(axis + 2) % 3]
                if not side:
                    u, v = v, u
                origin = np.array(cell, float) + side * np.eye(3)[axis]
                parts.append(grid(lambda a, b: size * (origin + a * u + b * v), divide, divide))
    return merged(*together(parts))


def sphere(n=16, radius=1.0):
    """A cube's grid blown up: no poles."""
    box = voxels([(0, 0, 0)], 2.0, n)
    p = np.tan((box.points - 1) * math.pi / 4)
    return Solid(radius * p / np.linalg.norm(p, axis=1)[:, None], box.triangles)


def icosphere(levels):
    """Radius 1: the triangles of an icosahedron in four, so many times."""
    t = (1 + 5**0.5) / 2
    points = [(-1, t, 0), (1, t, 0), (-1, -t, 0), (1, -t, 0), (0, -1, t), (0, 1, t), (0, -1, -t), (0, 1, -t), (t, 0, -1), (t, 0, 1),
              (-t, 0, -1), (-t, 0, 1)]
    points = [np.array(p) / np.linalg.norm(p) for p in points]
    faces = [(0, 11, 5), (0, 5, 1), (0, 1, 7), (0, 7, 10), (0, 10, 11), (1, 5, 9), (5, 11, 4), (11, 10, 2), (10, 7, 6), (7, 1, 8),
             (3, 9, 4), (3, 4, 2), (3, 2, 6), (3, 6, 8), (3, 8, 9), (4, 9, 5), (2, 4, 11), (6, 2, 10), (8, 6, 7), (9, 8, 1)]
    for _ in range(levels):
        middles, finer = {}, []

        def middle(a, b):
            key = (min(a, b), max(a, b))
            if key not in middles:
                p = points[a] + points[b]
                points.append(p / np.linalg.norm(p))
                middles[key] = len(points) - 1
            return middles[key]

        for a, b, c in faces:
            x, y, z = middle(a, b), middle(b, c), middle(c, a)
            finer += [(a, x, z), (x, b, y), (z, y, c), (x, y, z)]
        faces = finer
    return np.array(points), faces


def torus(n=48, m=24, thickness=0.35):
    def at(u, v):
        u, v = 2 * math.pi * (u % 1), 2 * math.pi * (v % 1)
        r = 1 + thickness * math.cos(v)
        return r * math.cos(u), r * math.sin(u), thickness * math.sin(v)
    return merged(*grid(at, n, m))


def cylinder(sides=36, height=2.0, rings=8):
    def wall(u, v):
        a = 2 * math.pi * (u % 1)
        return math.cos(a), math.sin(a), height * v

    def lid(z, turn):
        return lambda u, v: (v * math.cos(turn * 2 * math.pi * (u % 1)), v * math.sin(turn * 2 * math.pi * (u % 1)), z)
    parts = [grid(wall, sides, rings), grid(lid(0.0, 1), sides, 4), grid(lid(height, -1), sides, 4)]
    return merged(*together(parts))


def hollow_sphere():
    outer, inner = sphere(14), sphere(8, 0.6)
    return Solid(*together([outer, (inner.points, inner.triangles[:, ::-1])]))


def two_parts():
    a, b = sphere(10), voxels([(0, 0, 0), (1, 0, 0)], 0.9, 4)
    return Solid(*together([a, (b.points + (1.5, 0.2, -0.4), b.triangles)]))


def bumps():
    ball = sphere(20)
    x, y, z = ball.points.T
    r = 1 + 0.2 * np.sin(5 * x + 1) * np.sin(4 * y) * np.cos(6 * z)
    return Solid(ball.points * r[:, None], ball.triangles)


def sample(name):
    """A shape of samples/generate.py."""
    sys.path.insert(0, str(ROOT / "samples"))
    import generate
    s = getattr(generate, name)()
    return Solid(np.array(s.points, float), np.array(s.triangles, int))


RING = [(i, j, 0) for i in range(3) for j in range(3) if (i, j) != (1, 1)]
GENERATED = {
    "box": lambda: voxels([(0, 0, 0)], 1.0, 8), "slab": lambda: voxels([(i, j, 0) for i in range(4) for j in range(3)], 1, 3),
    "angle": lambda: voxels([(0, 0, 0), (1, 0, 0), (2, 0, 0), (0, 0, 1), (0, 0, 2)], 1, 5),
    "frame": lambda: voxels(RING, 1, 4), "steps": lambda: voxels([(i, 0, k) for i in range(4) for k in range(i + 1)], 1, 3),
    "sphere": sphere, "torus": torus, "cylinder": cylinder, "bumps": bumps, "hollow_sphere": hollow_sphere,
    "two_parts": two_parts, "bracket": lambda: sample("bracket"), "gear": lambda: sample("gear"),
    "torus_knot": lambda: sample("torus_knot"), "shell": lambda: sample("shell")}


# --------------------------------------------------------------------------------------------- what is known


def components(count, pairs):
    """A label for each of `count` items that pairs (k, 2) join, numbered from 0."""
    parent = list(range(count))

    def root(i):
        while parent[i] != i:
            parent[i] = parent[parent[i]]
            i = parent[i]
        return i
    for i, j in np.asarray(pairs).tolist():
        parent[root(i)] = root(j)
    return np.unique([root(i) for i in range(count)], return_inverse=True)[1]


def volume(solid):
    a, b, c = (solid.points[solid.triangles[:, k]] - solid.points.mean(axis=0) for k in range(3))
    return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6)


def areas(solid):
    a, b, c = (solid.points[solid.triangles[:, k]] for k in range(3))
    return np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2


def normals(solid):
    a, b, c = (solid.points[solid.triangles[:, k]] for k in range(3))
    n = np.cross(b - a, c - a)
    return n / np.maximum(np.linalg.norm(n, axis=1), 1e-300)[:, None]


def diagonal(solid):
    return float(np.linalg.norm(np.ptp(solid.points, axis=0)))


def shells_of(solid):
    """A label for each triangle: its connected shell."""
    t = solid.triangles
    label = components(len(solid.points), np.concatenate([t[:, :2], t[:, 1:]]))
    return np.unique(label[t[:, 0]], return_inverse=True)[1]


def topology(solid):
    """components: shells that face outward; shells; genus: handles of all shells."""
    label = shells_of(solid)
    shells = [Solid(solid.points, solid.triangles[label == s]) for s in range(label.max() + 1)]
    edges = 3 * len(solid.triangles) // 2
    euler = len(np.unique(solid.triangles)) - edges + len(solid.triangles)
    return {"components": sum(volume(s) > 0 for s in shells), "shells": len(shells), "genus": len(shells) - euler // 2}


def twins(triangles):
    """The triangle beyond each half-edge (t, t + 1 mod 3 corners): an array (m, 3), or None if the surface is not closed
    and oriented, two triangles at every edge."""
    edges = {}
    for t, corners in enumerate(triangles.tolist()):
        for k in range(3):
            if edges.setdefault((corners[k], corners[(k + 1) % 3]), 3 * t + k) != 3 * t + k:
                return None
    beyond = [edges.get((b, a)) for a, b in edges]
    if None in beyond:
        return None
    out = np.empty(3 * len(triangles), int)
    for half, other in zip(edges.values(), beyond):
        out[half] = other // 3
    return out.reshape(-1, 3)


def is_strictly_clean(solid):
    """Nothing for repair to do, as far as can be counted: closed, oriented outward, 2-manifold, no equal or unused
    points, no flat triangles. Self-intersections are not looked for."""
    p, t = solid
    if len(np.unique(t)) != len(p) or len(np.unique(p, axis=0)) != len(p) or twins(t) is None:
        return False
    if volume(solid) <= 0 or areas(solid).min() <= 1e-12 * diagonal(solid) ** 2:
        return False
    follows = {(a, b): c for x, y, z in t.tolist() for a, b, c in ((x, y, z), (y, z, x), (z, x, y))}
    degree = np.bincount(t.ravel())
    for x, y, _ in t.tolist():
        at, length = follows[x, y], 1
        while at != y:
            at, length = follows[x, at], length + 1
        if length != degree[x]:
            return False
    return True


def is_convex(solid):
    a = solid.points[solid.triangles[:, 0]]
    n = normals(solid)
    height = solid.points @ n.T - np.einsum("ij,ij->i", a, n)
    return bool(height.max() <= 1e-9 * diagonal(solid))


def divided(solid, least):
    """Every triangle in four until there are at least that many: the same set of points."""
    while len(solid.triangles) < least:
        p, t = solid
        edges = np.sort(np.concatenate([t[:, [0, 1]], t[:, [1, 2]], t[:, [2, 0]]]), axis=1)
        pairs, index = np.unique(edges, axis=0, return_inverse=True)
        m = len(p) + index.reshape(3, -1)
        a, b, c = t.T
        ab, bc, ca = m
        solid = Solid(np.concatenate([p, (p[pairs[:, 0]] + p[pairs[:, 1]]) / 2]),
                      np.concatenate([np.stack(x, 1) for x in ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))]))
    return solid


def winding(solid, queries):
    """The generalised winding number at each query (k, 3), by solid angles (Van Oosterom & Strackee 1983)."""
    out = np.empty(len(queries))
    corners = solid.points[solid.triangles]
    for i, q in enumerate(queries):
        u, v, w = (corners[:, k] - q for k in range(3))
        lu, lv, lw = (np.linalg.norm(x, axis=1) for x in (u, v, w))
        det = np.einsum("ij,ij->i", u, np.cross(v, w))
        dots = (np.einsum("ij,ij->i", x, y) for x, y in ((u, v), (v, w), (w, u)))
        uv, vw, wu = dots
        out[i] = 2 * np.arctan2(det, lu * lv * lw + uv * lw + vw * lu + wu * lv).sum() / (4 * math.pi)
    return out


def distance(solid, q):
    """From the point q to the nearest triangle."""
    a, b, c = (solid.points[solid.triangles[:, k]] for k in range(3))
    n = normals(solid)
    height = np.einsum("ij,ij->i", q - a, n)
    foot = q - height[:, None] * n
    inside = np.ones(len(a), bool)
    nearest = np.full(len(a), np.inf)
    for s, e in ((a, b), (b, c), (c, a)):
        along = e - s
        inside &= np.einsum("ij,ij->i", np.cross(along, foot - s), n) >= 0
        share = np.einsum("ij,ij->i", q - s, along) / np.maximum(np.einsum("ij,ij->i", along, along), 1e-300)
        nearest = np.minimum(nearest, np.linalg.norm(s + np.clip(share, 0, 1)[:, None] * along - q, axis=1))
    return float(np.where(inside, np.abs(height), nearest).min())
