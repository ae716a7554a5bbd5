"""Thin and many-fold but legal solids: needles, rods, rings, springs, chains, brushes, perforated plates, screws, foams, shells, fractals.

Like `nasty_solids.py`, whose Solid and building blocks these use: closed, outward, free of crossings, nothing but the standard library.
"""
import itertools
import math

from bench.models.nasty_solids import drawn, log_between, moved, prism, scaled, Solid, sphere, star_ring, together, turned, turned_inside_out

# ------------------------------------------------------------------------------------------------- building blocks


def swept(path, radius, sides, closed=False):
    """A tube around the points of a path, its rings turned as little as can be; closed: the last point leads to the first."""
    def minus(a, b):
        return [x - y for x, y in zip(a, b)]

    def unit(a):
        n = math.sqrt(sum(x * x for x in a))
        return [x / n for x in a]

    def cross(a, b):
        return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    n = len(path)
    points, up = [], None
    for i in range(n):
        before, after = (path[i - 1], path[(i + 1) % n]) if closed else (path[max(0, i - 1)], path[min(n - 1, i + 1)])
        along = unit(minus(after, before))
        first = up or min(([1.0, 0, 0], [0, 1.0, 0], [0, 0, 1.0]), key=lambda e: abs(sum(x * y for x, y in zip(e, along))))
        part = sum(x * y for x, y in zip(first, along))
        up = unit([x - part * y for x, y in zip(first, along)])
        other = cross(along, up)
        for k in range(sides):
            c, s = radius * math.cos(2 * math.pi * k / sides), radius * math.sin(2 * math.pi * k / sides)
            points.append(tuple(p + c * u + s * o for p, u, o in zip(path[i], up, other)))
    triangles, shift = [], 0
    if closed:  # the last ring meets the first where they fit best
        shift = min(range(sides), key=lambda k: math.dist(points[(n - 1) * sides], points[k]))
    for i in range(n if closed else n - 1):
        turn = shift if i == n - 1 else 0
        for k in range(sides):
            a, b = i * sides + k, i * sides + (k + 1) % sides
            c, d = (i + 1) % n * sides + (k + turn) % sides, (i + 1) % n * sides + (k + 1 + turn) % sides
            triangles += [(a, b, d), (a, d, c)]
    if not closed:
        for ring, middle in ((range(sides), path[0]), (range(n * sides - 1, (n - 1) * sides - 1, -1), path[-1])):
            ring = list(ring)
            triangles += [(ring[(k + 1) % sides], ring[k], len(points)) for k in range(sides)]
            points.append(tuple(middle))
    return Solid(points, triangles)


def tiled(n, m, thick, ring, high):
    """A plate of n x m tiles; in the middle of each a ring of 4 k points (radius `ring[0]`, `ring[1]` points): a hole (`high` 0) or
    a bristle on the top."""
    radius, sides = ring
    points, number, triangles = [], {}, []

    def at(*p):
        if p not in number:
            number[p] = len(points)
            points.append(p)
        return number[p]

    def face(i, j, z, down):
        quarter = sides // 4
        corners = [at(i + x, j + y, z) for x, y in ((1.0, 1.0), (0.0, 1.0), (0.0, 0.0), (1.0, 0.0))]
        inner = []
        for k in range(sides):
            a = 2 * math.pi * k / sides
            inner.append(at(i + 0.5 + radius * math.cos(a), j + 0.5 + radius * math.sin(a), z))
        made = []
        for q in range(4):
            for k in range(q * quarter, (q + 1) * quarter):
                made.append((inner[k], corners[q], inner[(k + 1) % sides]))
            made.append((inner[(q + 1) * quarter % sides], corners[q], corners[(q + 1) % 4]))
        triangles.extend([(a, c, b) for a, b, c in made] if down else made)
        return inner

    for i, j in itertools.product(range(n), range(m)):
        top = face(i, j, thick, False)
        if high == 0:
            other = face(i, j, 0.0, True)
        else:
            a, b, c, d = at(i, j, 0.0), at(i + 1.0, j, 0.0), at(i + 1.0, j + 1.0, 0.0), at(i, j + 1.0, 0.0)
            triangles += [(a, c, b), (a, d, c)]
            other = [at(points[v][0], points[v][1], thick + high) for v in top]
            middle = at(i + 0.5, j + 0.5, thick + high)
            triangles += [(other[k], other[(k + 1) % sides], middle) for k in range(sides)]
        for k in range(sides):
            a, b, c, d = top[k], top[(k + 1) % sides], other[k], other[(k + 1) % sides]
            triangles += [(a, b, d), (a, d, c)] if high else [(a, d, c), (a, b, d)]
    rim = [((i, 0.0), (i + 1.0, 0.0)) for i in range(n)] + [((i + 1.0, float(m)), (i, float(m))) for i in range(n)]
    rim += [((float(n), j), (float(n), j + 1.0)) for j in range(m)] + [((0.0, j + 1.0), (0.0, j)) for j in range(m)]
    for p, q in rim:
        a, b, c, d = at(*p, 0.0), at(*q, 0.0), at(*q, thick), at(*p, thick)
        triangles += [(a, b, c), (a, c, d)]
    return Solid(points, triangles)


def cells(full, xs, ys, zs):
    """The boundary of boxes of a grid of planes."""
    points, number, triangles = [], {}, []

    def at(i, j, k):
        if (i, j, k) not in number:
            number[i, j, k] = len(points)
            points.append((xs[i], ys[j], zs[k]))
        return number[i, j, k]
    for cell in sorted(full):
        for axis in range(3):
            for side in (0, 1):
                beyond = list(cell)
                beyond[axis] += 2 * side - 1
                if tuple(beyond) in full:
                    continue
                u, v = [0, 0, 0], [0, 0, 0]
                u[(axis + 1) % 3] = v[(axis + 2) % 3] = 1
                o = list(cell)
                o[axis] += side
                quad = [at(*(x + a * y + b * z for x, y, z in zip(o, u, v))) for a, b in ((0, 0), (1, 0), (1, 1), (0, 1))]
                if not side:
                    quad.reverse()
                triangles += [tuple(quad[:3]), (quad[0], quad[2], quad[3])]
    return Solid(points, triangles)


def level_set(f, n):
    """Where f < 0 in the unit cube: marching tetrahedra on n^3 cells; f shall be above 0 at the rim."""
    value = {}

    def of(v):
        if v not in value:
            value[v] = f(*(c / n for c in v)) or 1e-9
        return value[v]
    points, number, triangles = [], {}, []

    def cut(a, b):
        key = (a, b) if a < b else (b, a)
        if key not in number:
            number[key] = len(points)
            t = min(0.9, max(0.1, of(key[0]) / (of(key[0]) - of(key[1]))))
            points.append(tuple((x + t * (y - x)) / n for x, y in zip(*key)))
        return number[key]
    for cell in itertools.product(range(n), repeat=3):
        for order in itertools.permutations(range(3)):
            v = [cell]
            for axis in order:
                v.append(tuple(c + (i == axis) for i, c in enumerate(v[-1])))
            if order in ((0, 2, 1), (1, 0, 2), (2, 1, 0)):
                v[0], v[1] = v[1], v[0]
            low = [x for x in v if of(x) < 0]
            high = [x for x in v if of(x) >= 0]
            odd = sum(v.index(x) > v.index(y) for x, y in itertools.combinations(low + high, 2)) % 2
            if len(low) in (1, 3):
                one, three = (low[0], high) if len(low) == 1 else (high[0], low)
                t = [cut(one, x) for x in three]
                triangles.append(tuple(t) if odd == 0 else (t[0], t[2], t[1]))
            elif len(low) == 2:
                a, b, c, d = cut(low[0], high[0]), cut(low[0], high[1]), cut(low[1], high[1]), cut(low[1], high[0])
                made = [(a, b, c), (a, c, d)]
                triangles += made if odd == 0 else [(p, r, q) for p, q, r in made]
    return Solid(points, triangles)


# --------------------------------------------------------------------------------------------------------- families


def long_cone(rng):
    return turned([(0, 1.0), (log_between(rng, 0.003, 0.05), 0.0), (0, 0.0)], rng.choice((12, 24, 48)))


def rod(rng):
    r = log_between(rng, 0.001, 0.05)
    return turned([(0, 1.0), (r, 1.0), (r, 0.0), (0, 0.0)], rng.choice((6, 12, 24, 48)))


def thin_ring(rng):
    r, n, m = log_between(rng, 0.003, 0.1), rng.choice((24, 48, 96)), rng.choice((6, 12, 24))
    return turned([(1 + r * math.cos(2 * math.pi * k / m), -r * math.sin(2 * math.pi * k / m)) for k in range(m)], n)


def spring(rng):
    turns, steps, wire = rng.randint(2, 12), rng.choice((12, 24, 36)), log_between(rng, 0.02, 0.35)
    path = [(math.cos(2 * math.pi * k / steps), math.sin(2 * math.pi * k / steps), k / steps) for k in range(turns * steps + 1)]
    return swept(path, wire, rng.choice((6, 8, 16)))


def chain(rng):
    wire, sides, links = log_between(rng, 0.05, 0.2), rng.choice((6, 8, 12)), []
    for k in range(rng.randint(2, 12)):
        n = 24
        round_it = [(math.cos(2 * math.pi * i / n), math.sin(2 * math.pi * i / n)) for i in range(n)]
        links.append(moved(swept([(x, y, 0.0) if k % 2 else (x, 0.0, y) for x, y in round_it], wire, sides, True), (1.3 * k, 0.0, 0.0)))
    return together(*links)


def brush(rng):
    n = rng.choice((3, 6, 10, 16))
    return tiled(n, n, 0.5, (log_between(rng, 0.03, 0.3), rng.choice((4, 8))), log_between(rng, 0.5, 10))


def perforated(rng):
    n = rng.choice((3, 10, 30, 71))
    return tiled(n, n, log_between(rng, 0.03, 1), (rng.uniform(0.1, 0.45), 4 if n > 30 else rng.choice((4, 8, 16))), 0)


def screw(rng):
    turns, steps, deep = rng.randint(3, 12), rng.choice((16, 24, 36)), rng.uniform(0.05, 0.3)
    rows = turns * 8
    points, triangles = [], []
    for j in range(rows + 1):
        for i in range(steps):
            phase = (j / 8 + i / steps) % 1
            r = 1 - deep * (0 if j in (0, rows) else abs(2 * phase - 1))
            points.append((r * math.cos(2 * math.pi * i / steps), r * math.sin(2 * math.pi * i / steps), j * 0.05))
    for j in range(rows):
        for i in range(steps):
            a, b = j * steps + i, j * steps + (i + 1) % steps
            triangles += [(a, b, b + steps), (a, b + steps, a + steps)]
    for ring, z in ((range(steps - 1, -1, -1), 0.0), (range(rows * steps, (rows + 1) * steps), rows * 0.05)):
        ring = list(ring)
        triangles += [(ring[k], ring[(k + 1) % steps], len(points)) for k in range(steps)]
        points.append((0.0, 0.0, z))
    return Solid(points, triangles)


def struts(rng):
    n, d = rng.randint(1, 4), log_between(rng, 0.01, 0.3)
    planes = [x for k in range(n + 1) for x in (k, k + d)]
    full = {c for c in itertools.product(range(2 * n + 1), repeat=3) if sum(x % 2 for x in c) <= 1}
    return cells(full, planes, planes, planes)


def foam(rng):
    n, sides = rng.randint(2, 5), rng.choice((8, 12))
    parts = [cells({(0, 0, 0)}, (0.0, float(n)), (0.0, float(n)), (0.0, float(n)))]
    for cell in itertools.product(range(n), repeat=3):
        r = rng.uniform(0.2, 0.499)
        parts.append(turned_inside_out(moved(sphere(r, sides), [c + 0.5 for c in cell])))
    return together(*parts)


def gyroid(rng):
    waves, thick, n = rng.choice((1, 1.5, 2)), rng.uniform(0.2, 0.7), rng.choice((16, 24))
    w = 2 * math.pi * waves

    def f(x, y, z):
        x, y, z = ((c - 0.5) * 1.15 + 0.5 for c in (x, y, z))
        g = math.sin(w * x) * math.cos(w * y) + math.sin(w * y) * math.cos(w * z) + math.sin(w * z) * math.cos(w * x)
        return max(abs(g) - thick, w * max(abs(c - 0.5) - 0.5 for c in (x, y, z)))
    return level_set(f, n)


def sponge(rng):
    level = rng.choice((1, 2, 2, 3))
    n = 3 ** level

    def is_full(c):
        while any(c):
            if sum(x % 3 == 1 for x in c) >= 2:
                return False
            c = [x // 3 for x in c]
        return True
    planes = [k / n for k in range(n + 1)]
    return cells({c for c in itertools.product(range(n), repeat=3) if is_full(c)}, planes, planes, planes)


def snowflake(rng):
    """Koch's, of sharp or blunt spikes."""
    ring, high = [(math.cos(a), math.sin(a)) for a in (math.pi / 2 + 2 * math.pi * k / 3 for k in range(3))], rng.uniform(0.3, 0.95)
    for _ in range(rng.randint(1, 4)):
        finer = []
        for (ax, ay), (bx, by) in zip(ring, ring[1:] + ring[:1]):
            x, y = bx - ax, by - ay
            finer += [(ax, ay), (ax + x / 3, ay + y / 3), (ax + x / 2 + y * high / 3, ay + y / 2 - x * high / 3),
                      (ax + 2 * x / 3, ay + 2 * y / 3)]
        ring = finer
    return prism(ring, log_between(rng, 0.05, 1))


def deep_star(rng):
    points, inner = rng.randint(5, 24), log_between(rng, 0.02, 0.2)
    return prism(star_ring(points, inner), rng.uniform(0.5, 4))


FAMILIES = {f.__name__: f for f in (
    long_cone, rod, thin_ring, spring, chain, brush, perforated, screw, struts, foam, gyroid, sponge, snowflake, deep_star)}


def make(number, seed=0):
    name, solid, rng = drawn(FAMILIES, number, seed)
    return name, scaled(solid, [log_between(rng, 1e-3, 1e6)] * 3)
