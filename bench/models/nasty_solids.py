"""Nasty but legal solids: closed, outward, free of crossings, and awkward: cones, needles, wedges, plates, combs, ...

A Solid has points and triangles, counter-clockwise from outside, cavities inward. Nothing but the standard library.
"""
import collections
import math
import random

Solid = collections.namedtuple("Solid", "points triangles")


def together(*solids):
    points, triangles = [], []
    for s in solids:
        shift = len(points)
        points += s.points
        triangles += [tuple(v + shift for v in t) for t in s.triangles]
    return Solid(points, triangles)


def turned_inside_out(s):
    return Solid(s.points, [(a, c, b) for a, b, c in s.triangles])


def moved(s, by):
    return Solid([tuple(x + d for x, d in zip(p, by)) for p in s.points], s.triangles)


def scaled(s, by):
    return Solid([tuple(x * f for x, f in zip(p, by)) for p in s.points], s.triangles)


def rotated(s, rng):
    """By a random rotation: nothing stays parallel to an axis."""
    q = [rng.gauss(0, 1) for _ in range(4)]
    n = math.sqrt(sum(x * x for x in q))
    w, x, y, z = (c / n for c in q)
    m = ((1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)),
         (2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)),
         (2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)))
    return Solid([tuple(sum(a * b for a, b in zip(row, p)) for row in m) for p in s.points], s.triangles)


def volume(s):
    o = s.points[0]
    total = []
    for t in s.triangles:
        (a, b, c) = ([x - y for x, y in zip(s.points[v], o)] for v in t)
        total.append(a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) + a[2] * (b[0] * c[1] - b[1] * c[0]))
    return math.fsum(total) / 6


def area(s):
    total = []
    for t in s.triangles:
        a, b, c = (s.points[v] for v in t)
        u, v = [y - x for x, y in zip(a, b)], [y - x for x, y in zip(a, c)]
        total.append(math.hypot(u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]))
    return math.fsum(total) / 2


def diagonal(s):
    return math.dist([min(c) for c in zip(*s.points)], [max(c) for c in zip(*s.points)])


# ------------------------------------------------------------------------------------------------- building blocks


def outline(ring):
    """A simple polygon in the plane, counter-clockwise, as triangles: ears are cut, the best shaped first."""
    def turn(a, b, c):
        return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
    left, triangles = list(range(len(ring))), []
    while len(left) > 3:
        best, at = -1.0, None
        for i, v in enumerate(left):
            u, w = left[i - 1], left[(i + 1) % len(left)]
            a, b, c = ring[u], ring[v], ring[w]
            if turn(a, b, c) <= 0:
                continue
            shape = turn(a, b, c) / (math.dist(a, b) ** 2 + math.dist(b, c) ** 2 + math.dist(c, a) ** 2)
            if shape <= best:
                continue
            if any(x not in (u, v, w) and turn(a, b, ring[x]) >= 0 and turn(b, c, ring[x]) >= 0 and turn(c, a, ring[x]) >= 0
                   for x in left):
                continue
            best, at = shape, i
        if at is None:
            raise ValueError("the outline crosses itself")
        triangles.append((left[at - 1], left[at], left[(at + 1) % len(left)]))
        del left[at]
    return triangles + [tuple(left)]


def prism(ring, height):
    """The outline lifted."""
    n, flat = len(ring), outline(ring)
    points = [(x, y, 0.0) for x, y in ring] + [(x, y, height) for x, y in ring]
    triangles = [(c, b, a) for a, b, c in flat] + [(a + n, b + n, c + n) for a, b, c in flat]
    for i in range(n):
        j = (i + 1) % n
        triangles += [(i, j, j + n), (i, j + n, i + n)]
    return Solid(points, triangles)


def turned(profile, sides):
    """A profile (radius, z), downward outside, turned around the z axis: poles where the radius is 0, which it is at both ends
    or nowhere, in which case it is closed."""
    points, rows = [], []
    for r, z in profile:
        if r == 0:
            rows.append([len(points)] * sides)
            points.append((0.0, 0.0, z))
        else:
            rows.append(range(len(points), len(points) + sides))
            points += [(r * math.cos(2 * math.pi * k / sides), r * math.sin(2 * math.pi * k / sides), z) for k in range(sides)]
    if profile[0][0] != 0:
        rows.append(rows[0])
    triangles = []
    for up, low in zip(rows, rows[1:]):
        for k in range(sides):
            m = (k + 1) % sides
            quad = (up[k], low[k], low[m], up[m])
            triangles += [t for t in (quad[:3], (quad[0], quad[2], quad[3])) if len(set(t)) == 3]
    return Solid(points, triangles)


def box(x, y, z, n=1):
    """Each pair of sides divided into n squares along their edges, but the thin ones only across the wide."""
    points, number, triangles = [], {}, []

    def at(i, j, k):
        if (i, j, k) not in number:
            number[i, j, k] = len(points)
            points.append((x * i / n, y * j / n, z * k))
        return number[i, j, k]
    for i in range(n):
        for j in range(n):
            a, b, c, d = at(i, j, 1), at(i + 1, j, 1), at(i + 1, j + 1, 1), at(i, j + 1, 1)
            triangles += [(a, b, c), (a, c, d)]
            a, b, c, d = at(i, j, 0), at(i + 1, j, 0), at(i + 1, j + 1, 0), at(i, j + 1, 0)
            triangles += [(c, b, a), (d, c, a)]
    for i in range(n):
        for (a, b) in (((i, 0), (i + 1, 0)), ((n, i), (n, i + 1)), ((n - i, n), (n - i - 1, n)), ((0, n - i), (0, n - i - 1))):
            p, q, r, s = at(*a, 0), at(*b, 0), at(*b, 1), at(*a, 1)
            triangles += [(p, q, r), (p, r, s)]
    return Solid(points, triangles)


def sphere(radius, sides, squash=1.0):
    rings = max(2, sides // 2)
    profile = [(0, radius * squash)]
    profile += [(radius * math.sin(math.pi * k / rings), squash * radius * math.cos(math.pi * k / rings)) for k in range(1, rings)]
    return turned(profile + [(0, -radius * squash)], sides)


def log_between(rng, low, high):
    return math.exp(rng.uniform(math.log(low), math.log(high)))


# --------------------------------------------------------------------------------------------------------- families


def cone(rng):
    return turned([(0, 1.0), (log_between(rng, 0.003, 0.6), 0.0), (0, 0.0)], rng.choice((3, 5, 8, 16, 32, 64, 128)))


def bicone(rng):
    return turned([(0, 1.0), (log_between(rng, 0.01, 0.5), rng.uniform(0.2, 0.8)), (0, 0.0)], rng.choice((3, 6, 12, 24, 48, 96)))


def frustum(rng):
    base = log_between(rng, 0.05, 0.5)
    tip = base * log_between(rng, 1e-5, 1e-1)
    return turned([(0, 1.0), (tip, 1.0), (base, 0.0), (0, 0.0)], rng.choice((3, 6, 12, 24, 48, 96)))


def needle(rng):
    """A rod that tapers at both ends."""
    r, t = log_between(rng, 0.002, 0.05), rng.uniform(0.05, 0.45)
    return turned([(0, 1.0), (r, 1 - t), (r, t), (0, 0.0)], rng.choice((4, 8, 16, 32)))


def flat_tetrahedron(rng):
    """With one dihedral or plane angle down to a thousandth of a degree."""
    angle = math.radians(log_between(rng, 1e-3, 10))
    if rng.random() < 0.5:  # between two faces
        points = [(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.5, 0.9, 0.0), (0.5, 0.9 * math.cos(angle), 0.9 * math.sin(angle))]
    else:  # at one corner
        points = [(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (math.cos(angle), math.sin(angle), 0.0), (0.4, 0.2 * angle, rng.uniform(0.2, 0.8))]
    return Solid(points, [(0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)])


def wedge(rng):
    angle = math.radians(log_between(rng, 1e-2, 30))
    return prism([(0.0, 0.0), (1.0, 0.0), (math.cos(angle), math.sin(angle))], rng.uniform(0.2, 1.5))


def plate(rng):
    return box(1.0, rng.choice((1.0, 0.6, 0.1)), log_between(rng, 1e-6, 0.1), rng.choice((1, 2, 5, 10, 20)))


def comb(rng):
    teeth, deep = rng.randint(2, 14), rng.uniform(0.2, 2)
    gap = log_between(rng, 0.01, 0.6)
    ring, x = [(0.0, 0.0), (float(teeth) - gap, 0.0)], float(teeth) - gap
    for k in range(teeth - 1, -1, -1):
        ring += [(k + 1.0 - gap, 0.2 + deep), (float(k), 0.2 + deep)]
        if k > 0:
            ring += [(float(k), 0.2), (k - gap, 0.2)]
    return scaled(prism(ring, rng.uniform(0.05, 1)), [1 / teeth] * 3)


def sharp_comb(rng):
    """Teeth that end in edges, gaps that end in notches."""
    teeth, deep, foot = rng.randint(2, 12), log_between(rng, 0.3, 10), 0.3
    ring = [(0.0, 0.0), (float(teeth), 0.0)]
    for k in range(teeth - 1, -1, -1):
        ring += [(k + 1.0, foot), (k + 0.5, foot + deep)]
    return scaled(prism(ring + [(0.0, foot)], rng.uniform(0.1, 2)), [1 / teeth] * 3)


def spiral(rng):
    turns, steps, thick = rng.uniform(1, 3.5), rng.randint(16, 40), log_between(rng, 0.02, 0.6)
    n = int(turns * steps)
    inner, outer = [], []
    for k in range(n + 1):
        a = 2 * math.pi * k / steps
        r = 0.5 + a / (2 * math.pi)
        inner.append((r * math.cos(a), r * math.sin(a)))
        outer.append(((r + thick) * math.cos(a), (r + thick) * math.sin(a)))
    return scaled(prism(outer + inner[::-1], rng.uniform(0.2, 3)), [0.2] * 3)


def nested_spheres(rng):
    """Shells within shells, the gaps down to a thousandth."""
    parts, r, sides = [], 1.0, rng.choice((12, 20, 32))
    shape = math.cos(math.pi / sides) ** 2  # of the polyhedron, at its narrowest
    for k in range(rng.randint(2, 5)):
        s = sphere(r, sides)
        parts.append(s if k % 2 == 0 else turned_inside_out(s))
        r *= 1 - log_between(rng, 1e-3, 0.3) if rng.random() < 0.7 else shape * (1 - log_between(rng, 1e-3, 0.1))
    return together(*parts)


def gear(rng):
    teeth, deep, slope = rng.randint(5, 30), rng.uniform(0.05, 0.4), rng.uniform(0.02, 0.4)
    ring = []
    for k in range(teeth):
        for part, r in ((0, 1 - deep), (slope, 1), (0.5, 1), (0.5 + slope, 1 - deep)):
            a = 2 * math.pi * (k + part) / teeth
            ring.append((r * math.cos(a), r * math.sin(a)))
    return prism(ring, log_between(rng, 0.01, 1))


def star_ring(points, inner):
    """A star of so many points, in the unit circle."""
    radii = [inner if k % 2 else 1.0 for k in range(2 * points)]
    return [(r * math.cos(math.pi * k / points), r * math.sin(math.pi * k / points)) for k, r in enumerate(radii)]


def star(rng):
    points, inner = rng.randint(3, 24), log_between(rng, 0.02, 0.5)
    return prism(star_ring(points, inner), log_between(rng, 0.01, 1))


def star_pyramid(rng):
    """A star with a tip above its middle."""
    points, inner, n = rng.randint(3, 16), rng.uniform(0.1, 0.5), 0
    ring = []
    for k in range(2 * points):
        a, r = math.pi * k / points, inner if k % 2 else 1.0
        ring.append((r * math.cos(a), r * math.sin(a), 0.0))
    n = len(ring)
    triangles = [(k, (k + 1) % n, n) for k in range(n)] + [((k + 1) % n, k, n + 1) for k in range(n)]
    return Solid(ring + [(0.0, 0.0, log_between(rng, 0.01, 3)), (0.0, 0.0, 0.0)], triangles)


def tube(rng):
    thick, long, sides = log_between(rng, 1e-4, 0.3), log_between(rng, 0.1, 10), rng.choice((8, 16, 32, 64))
    inner = 1 - thick
    s = turned([(1.0, long), (1.0, 0.0), (inner, 0.0), (inner, long)], sides)
    return scaled(s, [1 / max(1, long)] * 3)


def ring(rng):
    """A torus, down to wire."""
    r, n, m = log_between(rng, 0.01, 0.9), rng.choice((12, 24, 48)), rng.choice((3, 6, 12, 24))
    profile = [(1 + r * math.cos(2 * math.pi * k / m), -r * math.sin(2 * math.pi * k / m)) for k in range(m)]
    return turned(profile, n)


def lens(rng):
    """Two caps that meet in a sharp rim."""
    sides, high, n = rng.choice((8, 16, 32, 64)), log_between(rng, 1e-3, 0.5), rng.choice((1, 3, 6))
    up = [(k / n, high * (1 - (k / n) ** 2)) for k in range(n + 1)]
    profile = [(0 if k == 0 else r, z) for k, (r, z) in enumerate(up)]
    profile += [(r, -z) for r, z in up[-2:0:-1]] + [(0, -high)]
    return turned(profile, sides)


def spindle(rng):
    """Beads on a thread: waists down to a thousandth."""
    beads, waist = rng.randint(2, 6), log_between(rng, 1e-3, 0.2)
    profile = [(0, 1.0)]
    for k in range(beads):
        profile += [(0.2, 1 - (k + 0.5) / beads)]
        if k + 1 < beads:
            profile += [(0.2 * waist, 1 - (k + 1) / beads)]
    return turned(profile + [(0, 0.0)], rng.choice((4, 8, 16, 32)))


def crater(rng):
    """A block with a conical hole from above that nearly reaches the ground."""
    rest, r = log_between(rng, 1e-4, 0.3), log_between(rng, 0.02, 0.9)
    return turned([(0, rest), (r, 1.0), (1.0, 1.0), (1.0, 0.0), (0, 0.0)], rng.choice((4, 8, 16, 32, 64)))


def eccentric_hole(rng):
    """A disc with a round cavity that nearly reaches its side, closed in a thin skin."""
    sides, r, skin = rng.choice((12, 24, 48)), rng.uniform(0.2, 0.7), log_between(rng, 1e-4, 0.1)
    outer = sphere(1.0, sides)
    inner = moved(sphere(r, sides), (math.cos(math.pi / sides) - r - skin, 0.0, 0.0))
    return together(outer, turned_inside_out(inner))


def notched(rng):
    """A beam with a crack-like notch."""
    deep, wide = rng.uniform(0.2, 0.95), log_between(rng, 1e-4, 0.2)
    return prism([(-1.0, 0.0), (1.0, 0.0), (1.0, 1.0), (wide, 1.0), (0.0, 1 - deep), (-wide, 1.0), (-1.0, 1.0)], rng.uniform(0.2, 1))


def slivers(rng):
    """A plain block whose faces meet in very unequal steps."""
    ring = [(0.0, 0.0)]
    x = 1.0
    steps = []
    while len(steps) < rng.randint(4, 12):
        steps.append(x)
        x *= log_between(rng, 0.05, 0.8)
    ring += [(s, 0.0) for s in steps[::-1]] + [(1.0, 1.0)] + [(s, 1.0) for s in steps[1:]] + [(0.0, 1.0)]
    return prism(ring, rng.uniform(0.2, 1))


def stairs(rng):
    """Steps that shrink."""
    factor, n = rng.uniform(0.4, 0.9), rng.randint(3, 14)
    xs = [1.0]
    for _ in range(n):
        xs.append(xs[-1] * factor)
    ring = [(0.0, 0.0)]
    ring += [(xs[0], 0.0)]
    for k in range(n):
        ring += [(xs[k], 1 - xs[k + 1]), (xs[k + 1], 1 - xs[k + 1])]
    return prism(ring + [(0.0, 1 - xs[n])], rng.uniform(0.05, 1))


def hedgehog(rng):
    """A ball with spikes on its faces."""
    ball = sphere(0.3, rng.choice((6, 8, 12)))
    points, triangles = list(ball.points), []
    for t in ball.triangles:
        a, b, c = (ball.points[v] for v in t)
        if rng.random() < 0.6:
            triangles.append(t)
            continue
        middle = [sum(x) / 3 for x in zip(a, b, c)]
        far = rng.uniform(1.2, 3)
        triangles += [(t[0], t[1], len(points)), (t[1], t[2], len(points)), (t[2], t[0], len(points))]
        points.append(tuple(x * far for x in middle))
    return Solid(points, triangles)


def fan_of_blades(rng):
    """A hub with thin blades: an outline."""
    blades, thin = rng.randint(3, 12), log_between(rng, 0.002, 0.1)
    ring = []
    for k in range(blades):
        a = 2 * math.pi * k / blades
        half = math.pi / blades
        for r, d in ((0.25, -half), (math.hypot(0.25, thin), -thin / 0.25 / 2), (1.0, -thin / 2), (1.0, thin / 2),
                     (math.hypot(0.25, thin), thin / 0.25 / 2)):
            ring.append((r * math.cos(a + d), r * math.sin(a + d)))
    return prism(ring, log_between(rng, 0.01, 1))


def near_blocks(rng):
    """Two blocks face to face, a hair apart."""
    gap = log_between(rng, 1e-4, 0.1)
    return together(box(1.0, 1.0, 0.5, rng.choice((1, 4))), moved(box(0.7, 0.8, 0.5, rng.choice((1, 3))), (0.1, 0.05, 0.5 + gap)))


FAMILIES = {f.__name__: f for f in (
    cone, bicone, frustum, needle, flat_tetrahedron, wedge, plate, comb, sharp_comb, spiral, nested_spheres, gear, star,
    star_pyramid, tube, ring, lens, spindle, crater, eccentric_hole, notched, slivers, stairs, hedgehog, fan_of_blades, near_blocks)}


def drawn(families, number, seed):
    """(family, Solid, what it was drawn with) of this number: seed and number say everything."""
    name = list(families)[number % len(families)]
    rng = random.Random(f"{seed} {number} {name}")
    solid = families[name](rng)
    if rng.random() < 0.5:
        solid = rotated(solid, rng)
    return name, solid, rng


def make(number, seed=0):
    return drawn(FAMILIES, number, seed)[:2]
