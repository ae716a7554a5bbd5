"""Bodies whose boundary layers are known, generated as OBJ files: a group for each patch. Needs NumPy.

A body is a dict: name of a patch -> (points (n, 3), triangles (m, 3)), counter-clockwise from outside of what is meshed.
"""
import math

import numpy as np

from bench.models.solids import grid, merged, sphere, together, torus, voxels


def write_obj(path, body):
    with open(path, "w") as out:
        shift = 1
        for name, (points, triangles) in body.items():
            out.write(f"g {name}\n")
            out.writelines(f"v {x!r} {y!r} {z!r}\n" for x, y, z in points.tolist())
            out.writelines(f"f {a} {b} {c}\n" for a, b, c in (np.asarray(triangles) + shift).tolist())
            shift += len(points)


def read_obj(path):
    """A body of triangles; each patch has all points."""
    points, triangles, name = [], {}, ""
    for kind, *words in (line.split() for line in open(path) if line.strip()):
        if kind == "v":
            points.append([float(w) for w in words[:3]])
        elif kind == "g":
            name = " ".join(words)
        elif kind == "f":
            triangles.setdefault(name, []).append([int(w.split("/")[0]) - 1 for w in words])
    return {patch: (np.array(points), np.array(faces)) for patch, faces in triangles.items()}


def welded(body):
    """The same with points that agree to the last digit: patches that were made apart share them."""
    seen = {}
    return {name: (np.array([seen.setdefault(tuple(np.round(p, 9)), tuple(p)) for p in points]), triangles)
            for name, (points, triangles) in body.items()}


def mapped(body, function):
    return {name: (np.array([function(p) for p in points]), triangles) for name, (points, triangles) in body.items()}


def inside_out(body):
    return {name: (points, np.asarray(triangles)[:, ::-1]) for name, (points, triangles) in body.items()}


def in_box(body, low, high):
    """The body as a hollow of a box whose patch is called far."""
    box = voxels([(0, 0, 0)], 1.0, 1)
    low, high = np.array(low, float), np.array(high, float)
    return inside_out(body) | {"far": (low + box.points * (high - low), box.triangles)}


def cube():
    return {"wall": tuple(voxels([(0, 0, 0)], 1.0, 1))}


def ball(n=48):
    return {"wall": tuple(sphere(n))}


def ring():
    return {"wall": tuple(torus(160, 80))}


def prism(outline, depth):
    """A convex outline (counter-clockwise) drawn out along z: `wall` around, `low` and `high` at its flat ends."""
    n = len(outline)
    low, high = (np.array([(x, y, z) for x, y in outline], float) for z in (0, depth))
    fan = np.array([(0, i, i + 1) for i in range(1, n - 1)])
    side = np.array([t for i in range(n) for j in [(i + 1) % n] for t in ((i, j, j + n), (i, j + n, i + n))])
    return {"wall": (np.concatenate([low, high]), side), "low": (low, fan[:, ::-1]), "high": (high, fan)}


def wedge(degrees):
    """A triangular prism with an edge of so many degrees, layers on all of it."""
    h = math.tan(math.radians(degrees) / 2)
    return {"wall": tuple(merged(*together(prism([(0, 0), (1, -h), (1, h)], 1.0).values())))}


def circle(n, radius=1.0):
    return [(radius * math.cos(2 * math.pi * i / n), radius * math.sin(2 * math.pi * i / n)) for i in range(n)]


def pipe(around=96, length=6.0):
    return prism(circle(around), length)


def turned_pipe():
    """No coordinate of its ends is round."""
    c, s = math.cos(0.7), math.sin(0.7)
    return mapped(pipe(), lambda p: (c * p[0] - s * p[1], 0.6 * (s * p[0] + c * p[1]) - 0.8 * p[2], 0.8 * (s * p[0] + c * p[1]) + 0.6 * p[2]))


def u_bend(around=96, along=120, radius=2.5, leg=3.0):
    """A pipe of radius 1: straight, half a turn, straight; ends in the plane z = 0."""
    total = 2 * leg + math.pi * radius

    def place(p):
        s = total * p[2]
        if s < leg:
            return -radius + p[0], p[1], s
        if s > total - leg:
            return radius - p[0], p[1], total - s
        a = (s - leg) / radius
        return -(radius - p[0]) * math.cos(a), p[1], leg + (radius - p[0]) * math.sin(a)
    side = grid(lambda u, v: (math.cos(2 * math.pi * (u % 1)), math.sin(2 * math.pi * (u % 1)), v), around, along)
    straight = prism(circle(around), 1.0)
    straight["wall"] = tuple(merged(*side))
    return mapped(welded(straight), place)


def naca_0012(points=120):
    """Outline of chord 1, counter-clockwise from the trailing edge, which is sharp (last coefficient -.1036)."""
    upper = []
    for i in range(points + 1):
        x = 0.5 * (1 + math.cos(math.pi * i / points))
        upper.append((x, 0.6 * (0.2969 * math.sqrt(x) - 0.126 * x - 0.3516 * x**2 + 0.2843 * x**3 - 0.1036 * x**4)))
    upper[0], upper[-1] = (1.0, 0.0), (0.0, 0.0)
    return upper + [(x, -y) for x, y in upper[-2:0:-1]]


def wing(span=2.0):
    """Both tips flat, all of it one patch."""
    parts = prism(naca_0012(), span)
    middle = {"low": 0.0, "high": span}
    n = len(naca_0012())
    for name, z in middle.items():  # strips from the upper to the lower side, no fan from the trailing edge
        strip = []
        for i in range(n // 2):
            a, b, c, d = i, i + 1, (n - i - 1) % n, (n - i) % n
            strip += [t for t in ((a, b, c), (a, c, d)) if len(set(t)) == 3]
        strip = np.array(strip)
        parts[name] = (parts[name][0], strip if z else strip[:, ::-1])
    return {"body": tuple(merged(*together(parts.values())))}
