"""Clean models damaged in known ways: what a repair has to give back is known. Needs NumPy.

A Case holds the damaged triangles, the solids whose union they stand for, and what is not to be asked for:
  zones     point sets (k, 3): in the convex hull of each the surface is lost (a hole), nobody can know what was there
  touched   boxes (lo, hi) around defects: sharp edges in them need not survive
  expected  components, shells, genus of the result; None: not known
Everything is drawn from the random generator that is passed: same seed, same case.
"""
import dataclasses
import heapq
import math

import numpy as np

from bench.models import solids
from bench.models.solids import Solid

# Shares of the diagonal. The tolerance that the cases are made for is 1e-3.
FOLD = 3e-4          # height of folds
T_GAP = 2e-4         # how far a new vertex lies off the edge that it divides
CUT = 3e-3          # how far halves stand apart
JITTER = 2e-4       # how far vertices move
REACH = 0.01         # how far around a defect edges are not judged
HOLE_MARGIN = 0.1    # a hole's zone grows by this share of its diameter
HOLE_LOSS = {0.01: 0.15, 0.03: 0.3, 0.1: 2.85}  # percent of the volume that closing the holes flat may cost


class Unsuitable(Exception):
    """This model does not allow this damage."""


@dataclasses.dataclass
class Case:
    soup: Solid
    truth: list
    zones: list = dataclasses.field(default_factory=list)
    touched: list = dataclasses.field(default_factory=list)
    expected: dict = dataclasses.field(default_factory=dict)
    what: str = ""
    as_stl: bool = False


def case(solid, soup, what, **more):
    return Case(soup=soup, truth=[solid], what=what, expected=solids.topology(solid), **more)


def boxes(point_sets, diagonal):
    reach = REACH * diagonal
    return [(np.min(p, axis=0) - reach, np.max(p, axis=0) + reach) for p in point_sets]


def add(soup, points, triangles):
    return Solid(*solids.together([soup, (np.asarray(points, float).reshape(-1, 3), np.asarray(triangles, int))]))


def corners_of(solid):
    """Per triangle its corners in an order of their own, to be compared bit for bit."""
    return [tuple(sorted(map(tuple, t))) for t in solid.points[solid.triangles].tolist()]


def lost_triangles(made):
    """Per solid of the truth, which of its triangles are no longer there as they were; which way they face does not count."""
    left = set(corners_of(made.soup))
    return [np.array([t not in left for t in corners_of(solid)], bool) for solid in made.truth]


def direction(rng):
    v = rng.normal(size=3)
    return v / np.linalg.norm(v)


def inner_points(solid, rng, count, inside=True, gap=0.0):
    """Random points inside (or outside, within the box) at least `gap` from the surface."""
    lo, size = solid.points.min(axis=0), np.ptp(solid.points, axis=0)
    found = []
    for _ in range(200):
        if len(found) >= count:
            return np.array(found[:count])
        tries = lo + size * rng.uniform(-0.15 * (not inside), 1 + 0.15 * (not inside), (8, 3))
        right = (solids.winding(solid, tries) > 0.5) == inside
        found += [q for q in tries[right] if solids.distance(solid, q) > gap]
    raise Unsuitable("no room")


# -------------------------------------------------------------------------------------------------------- holes


def grown_disc(solid, beyond, area, seed, wanted, forbidden):
    """Triangles around `seed`, the nearest first, that form a disc with about the wanted area; None if they cannot."""
    centres = solid.points[solid.triangles].mean(axis=1)
    region, vertices, total = set(), set(), 0.0
    queue = [(0.0, seed)]
    while queue and total < wanted:
        _, t = heapq.heappop(queue)
        corners = solid.triangles[t].tolist()
        if t in region or forbidden & set(corners):
            continue
        shared = [int(beyond[t, k]) in region for k in range(3)]
        apart = sum(shared) == 1 and corners[(shared.index(True) + 2) % 3] in vertices
        if apart or (region and not any(shared)):
            continue
        region.add(t)
        vertices |= set(corners)
        total += area[t]
        for n in beyond[t].tolist():
            if n not in region:
                heapq.heappush(queue, (float(np.linalg.norm(centres[n] - centres[seed])), n))
    return sorted(region) if 0.8 * wanted <= total <= 1.3 * wanted else None


def rim(solid, region):
    """The half-edges (a, b) of the region whose triangle beyond is not in it."""
    half = {(a, b) for x, y, z in solid.triangles[region].tolist() for a, b in ((x, y), (y, z), (z, x))}
    return np.array(sorted((a, b) for a, b in half if (b, a) not in half))


def segments_hit(starts, ends, corners):
    """Whether any segment meets any triangle (Moeller & Trumbore), in floating point."""
    e1, e2 = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    for s, d in zip(starts, ends - starts):
        h = np.cross(d, e2)
        det = np.einsum("ij,ij->i", e1, h)
        with np.errstate(divide="ignore", invalid="ignore"):
            u = ((s - corners[:, 0]) * h).sum(axis=1) / det
            q = np.cross(s - corners[:, 0], e1)
            v, t = q @ d / det, np.einsum("ij,ij->i", e2, q) / det
            if np.any((u >= 0) & (v >= 0) & (u + v <= 1) & (t >= 0) & (t <= 1)):
                return True
    return False


def lid_is_free(solid, region, edges):
    """Whether the fan that closes the hole flat touches nothing: then nothing blurs what the hole stood for."""
    centre = solid.points[edges[:, 0]].mean(axis=0)
    keep = np.ones(len(solid.triangles), bool)
    keep[region] = False
    others = solid.triangles[keep]
    apart = others[~np.isin(others, edges).any(axis=1)]
    if len(apart) == 0:
        return True
    corners = solid.points[apart]
    ends = solid.points[edges[:, 0]]
    if segments_hit(np.repeat(centre[None], len(ends), 0), ends, corners):
        return False
    lid = np.stack([np.repeat(centre[None], len(edges), 0), solid.points[edges[:, 0]], solid.points[edges[:, 1]]], 1)
    lo, hi = lid.min(axis=(0, 1)), lid.max(axis=(0, 1))
    near = corners[((corners.min(axis=1) <= hi) & (corners.max(axis=1) >= lo)).all(axis=1)]
    return not any(segments_hit(near[:, k], near[:, (k + 1) % 3], lid) for k in range(3))


def loss(solid, region, edges):
    """Volume between the region and the fan over its rim."""
    centre = solid.points[edges[:, 0]].mean(axis=0)
    a, b, c = (solid.points[solid.triangles[region][:, k]] - centre for k in range(3))
    return abs(float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6))


def disc_to_remove(solid, beyond, area, wanted, rng, forbidden, allowed_loss):
    """A disc whose flat lid is free, and what the lid costs; tries twelve places."""
    for _ in range(12):
        region = grown_disc(solid, beyond, area, int(rng.integers(len(solid.triangles))), wanted, forbidden)
        if not region:
            continue
        edges = rim(solid, region)
        if len(edges) >= 3 and loss(solid, region, edges) <= allowed_loss and lid_is_free(solid, region, edges):
            return region
    return None


def holes(solid, rng, share, count):
    """`count` holes, discs, of together `share` of the area; their flat lids touch nothing and cost little volume."""
    solid = solids.divided(solid, 600 if count == 1 else 2500)
    beyond, area = solids.twins(solid.triangles), solids.areas(solid)
    allowed = HOLE_LOSS[share] / 100 * solids.volume(solid) / count
    gone, forbidden, zones = [], set(), []
    for _ in range(count):
        region = disc_to_remove(solid, beyond, area, share * area.sum() / count, rng, forbidden, allowed)
        if not region:
            raise Unsuitable("no place for a hole")
        gone += region
        corners = np.unique(solid.triangles[region])
        zones.append(solid.points[corners])
        forbidden |= set(corners.tolist())
    keep = np.ones(len(solid.triangles), bool)
    keep[gone] = False
    soup = Solid(solid.points, solid.triangles[keep])
    return case(solid, soup, f"{count} hole{'s' * (count > 1)}, {100 * area[gone].sum() / area.sum():.2f} % of the area",
                zones=zones, touched=boxes(zones, solids.diagonal(solid)))


# -------------------------------------------------------------------- orientation, doubles, copies, joints, soups


def turned(solid, rng):
    share = rng.choice([0.02, 0.1, 0.3, 0.5])
    turn = rng.random(len(solid.triangles)) < share
    triangles = np.where(turn[:, None], solid.triangles[:, ::-1], solid.triangles)
    return case(solid, Solid(solid.points, triangles), f"{turn.sum()} triangles turned")


def doubled(solid, rng):
    """Some triangles twice or three times: the same way, turned, or with points of their own."""
    pick = solid.triangles[rng.random(len(solid.triangles)) < rng.choice([0.02, 0.2, 1.0])]
    pick = np.concatenate([pick, pick[rng.random(len(pick)) < 0.2]])
    turn = rng.random(len(pick)) < rng.choice([0.0, 0.5, 1.0])
    pick = np.where(turn[:, None], pick[:, ::-1], pick)
    own = rng.random() < 0.5
    soup = (add(solid, solid.points, pick) if own else Solid(solid.points, np.concatenate([solid.triangles, pick])))
    order = rng.permutation(len(soup.triangles))
    return case(solid, Solid(soup.points, soup.triangles[order]), f"{len(pick)} triangles doubled, {turn.sum()} of them turned")


def united(solid, rng):
    """Two or three shifted copies; half of them along an axis, so that faces lie in common planes."""
    if solids.topology(solid)["components"] != 1:
        raise Unsuitable("several components")
    size = np.ptp(solid.points, axis=0)
    copies = [solid]
    for _ in range(int(rng.integers(1, 3))):
        for _ in range(20):
            way = np.eye(3)[rng.integers(3)] * rng.choice([-1, 1]) if rng.random() < 0.5 else direction(rng)
            shift = way * size * rng.uniform(0.05, 0.5)
            copy = Solid(copies[-1].points + shift, solid.triangles)
            some = rng.choice(len(solid.points), min(60, len(solid.points)), replace=False)
            if (np.abs(solids.winding(copies[-1], copy.points[some])) > 0.99).any():
                copies.append(copy)
                break
        else:
            raise Unsuitable("copies do not overlap")
    made = Case(soup=Solid(*solids.together(copies)), truth=copies, what=f"{len(copies)} copies united")
    made.expected = {"components": 1, "shells": None, "genus": None}
    if len(copies) == 2 and solids.is_convex(solid):
        made.expected = {"components": 1, "shells": 1, "genus": 0}
    return made


def t_junctions(solid, rng):
    """Edges divided in one of their two triangles only, at a point on the edge or a little off it."""
    d = solids.diagonal(solid)
    off = T_GAP * d * float(rng.random() < 0.5)
    share, points, triangles, touched = rng.choice([0.05, 0.3, 0.8]), list(solid.points), [], []
    for corners in solid.triangles.tolist():
        if rng.random() >= share:
            triangles.append(corners)
            continue
        k = int(rng.integers(3))
        a, b, c = corners[k:] + corners[:k]
        s = rng.uniform(0.2, 0.8)
        points.append((1 - s) * solid.points[a] + s * solid.points[b] + off * rng.random() * direction(rng))
        triangles += [(a, len(points) - 1, c), (len(points) - 1, b, c)]
        touched.append(solid.points[corners])
    soup = Solid(np.array(points), np.array(triangles))
    return case(solid, soup, f"{len(points) - len(solid.points)} T-junctions, up to {off / d:.0e} of the diagonal off",
                touched=boxes(touched, d) if off else [], as_stl=bool(rng.random() < 0.3) and off > 0)


def torn(solid, rng, gap):
    """Every triangle by itself, its corners moved at random by up to half of `gap`, a share of the diagonal."""
    d = solids.diagonal(solid)
    points = solid.points[solid.triangles].reshape(-1, 3)
    moves = rng.normal(size=points.shape)
    moves *= (0.5 * gap * d * rng.random(len(points)) / np.linalg.norm(moves, axis=1))[:, None]
    soup = Solid(points + moves, np.arange(len(points)).reshape(-1, 3))
    made = case(solid, soup, f"torn into {len(solid.triangles)} triangles, gaps of up to {100 * gap:g} %",
                as_stl=bool(rng.random() < 0.5))
    made.touched = boxes([solid.points], d)
    return made


# ------------------------------------------------------------------------------------------- walls, fins, folds


def section(solid, normal, offset):
    """The closed polygons in which the plane normal . x = offset meets the surface, as lists of points."""
    height = solid.points @ normal - offset
    above = height > 0
    follows = {}
    for corners in solid.triangles.tolist():
        for k in range(3):
            a, b, c = corners[k], corners[(k + 1) % 3], corners[(k + 2) % 3]
            if above[a] != above[b] and above[a] != above[c]:  # a is alone on its side
                first, last = (a, b), (a, c)
                if above[a]:
                    first, last = last, first
                follows[tuple(sorted(first))] = tuple(sorted(last))
    loops = []
    while follows:
        start, at = next(iter(follows.items()))
        loop = [start]
        del follows[start]
        while at != start:
            loop.append(at)
            at = follows.pop(at)
        loops.append(np.array([solid.points[a] + (solid.points[b] - solid.points[a]) * height[a] / (height[a] - height[b])
                               for a, b in loop]))
    return loops


def ears(flat):
    """Triangles of a simple polygon (n, 2), counter-clockwise, by cutting ears."""
    left, out = list(range(len(flat))), []

    def side(a, b, c):
        return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
    while len(left) > 3:
        for k in range(len(left)):
            i, j, l = left[k - 1], left[k], left[(k + 1) % len(left)]
            a, b, c = flat[i], flat[j], flat[l]
            others = flat[[m for m in left if m not in (i, j, l)]].T
            if side(a, b, c) > 0 and not np.any((side(a, b, others) >= 0) & (side(b, c, others) >= 0) & (side(c, a, others) >= 0)):
                out.append((i, j, l))
                del left[k]
                break
        else:
            raise Unsuitable("section with touching edges")
    return out + [tuple(left)]


def wall_through(solid, rng):
    """A plane section as a wall: (points, triangles). Its rim lies on the skin, which has no vertices there."""
    for _ in range(20):
        normal = direction(rng) if rng.random() < 0.5 else np.eye(3)[rng.integers(3)]
        reach = solid.points @ normal
        loops = section(solid, normal, reach.min() + np.ptp(reach) * rng.uniform(0.2, 0.8))
        if len(loops) != 1 or not 3 <= len(loops[0]) <= 300:
            continue
        u = np.cross(normal, np.eye(3)[np.argmin(np.abs(normal))])
        u /= np.linalg.norm(u)
        flat = np.stack([loops[0] @ u, loops[0] @ np.cross(normal, u)], 1)
        x, y = flat.T
        turns = 1 if np.dot(x, np.roll(y, -1)) > np.dot(y, np.roll(x, -1)) else -1
        try:
            return loops[0][::turns], ears(flat[::turns])
        except Unsuitable:
            continue
    raise Unsuitable("no simple section")


def disc(centre, normal, radius, corners):
    u = np.cross(normal, np.eye(3)[np.argmin(np.abs(normal))])
    u /= np.linalg.norm(u)
    v = np.cross(normal, u)
    angle = 2 * math.pi * np.arange(corners) / corners
    ring = centre + radius * (np.cos(angle)[:, None] * u + np.sin(angle)[:, None] * v)
    return np.concatenate([[centre], ring]), [(0, 1 + k, 1 + (k + 1) % corners) for k in range(corners)]


def walls(solid, rng):
    """Walls through the inside (plane sections) or flat discs that hang in it."""
    soup, added, through = solid, [], bool(rng.random() < 0.5)
    for _ in range(int(rng.integers(1, 5))):
        if through:
            points, triangles = wall_through(solid, rng)
        else:
            centre = inner_points(solid, rng, 1, gap=0.01 * solids.diagonal(solid))[0]
            points, triangles = disc(centre, direction(rng), 0.8 * solids.distance(solid, centre), int(rng.integers(3, 24)))
        soup = add(soup, points, triangles)
        added.append(points)
    return case(solid, soup, f"{len(added)} {'plane sections' if through else 'flat discs'} inside",
                touched=boxes(added, solids.diagonal(solid)))


def vertex_normals(solid):
    n = np.zeros_like(solid.points)
    for k in range(3):
        np.add.at(n, solid.triangles[:, k], solids.normals(solid) * solids.areas(solid)[:, None])
    return n / np.maximum(np.linalg.norm(n, axis=1), 1e-300)[:, None]


def fins(solid, rng):
    """Strips that stand on edges of the surface, joined to it or stuck through it."""
    d, up, soup, added = solids.diagonal(solid), vertex_normals(solid), solid, []
    around = {}
    for a, b, c in solid.triangles.tolist():
        for v, w in ((a, b), (b, c), (c, a)):
            around.setdefault(v, []).append(w)
    for _ in range(int(rng.integers(1, 12))):
        path = [int(rng.integers(len(solid.points)))]
        for _ in range(int(rng.integers(1, 8))):
            choices = [n for n in around[path[-1]] if n not in path]
            if not choices:
                break
            path.append(choices[int(rng.integers(len(choices)))])
        if len(path) < 2:
            continue
        foot, joined = solid.points[path], rng.random() < 0.5
        low = foot if joined else foot - up[path] * d * rng.uniform(0.001, 0.02)
        points = np.concatenate([low, foot + up[path] * d * rng.uniform(0.01, 0.1)])
        n = len(path)
        soup = add(soup, points, [t for k in range(n - 1) for t in ((k, k + 1, n + k + 1), (k, n + k + 1, n + k))])
        added.append(points)
    if not added:
        raise Unsuitable("no path")
    return case(solid, soup, f"{len(added)} fins", touched=boxes(added, d))


FOLDED = [(0, 1, 4), (0, 4, 3), (1, 2, 5), (1, 5, 4), (2, 0, 3), (2, 3, 5), (3, 4, 5)]


def crosses(points):
    """Whether triangles of FOLDED cross that share no vertex with the edge that pierces them."""
    edges = {tuple(sorted((t[k], t[(k + 1) % 3]))) for t in FOLDED for k in range(3)}
    return any(segments_hit(points[[e[0]]], points[[e[1]]], points[[t]]) for e in edges for t in FOLDED if not set(e) & set(t))


def twisted(p, normal, height, rng):
    """The corners p (3, 3) of a triangle, and an inner triangle turned about half way round and tilted, so that the strip
    between the two crosses itself."""
    m = p.mean(axis=0)
    for _ in range(100):
        angle = math.pi * rng.uniform(0.7, 1.3)
        arm = 0.4 * (p - m)
        turned_arm = math.cos(angle) * arm + math.sin(angle) * np.cross(normal, arm)
        points = np.concatenate([p, m + turned_arm + rng.uniform(-height, height, 3)[:, None] * normal])
        if crosses(points):
            return points
    raise Unsuitable("no fold crosses")


def folds(solid, rng):
    """Triangles divided inside, the inner triangle turned round: the skin lies there in three layers that cross, not
    higher than FOLD."""
    d = solids.diagonal(solid)
    area, n = solids.areas(solid), solids.normals(solid)
    edges = np.linalg.norm(solid.points[solid.triangles] - solid.points[np.roll(solid.triangles, 1, axis=1)], axis=2)
    large = np.flatnonzero((area > 1e-6 * d * d) & (area > 0.2 * edges.max(axis=1) ** 2))
    if len(large) == 0:
        raise Unsuitable("only tiny triangles and needles")
    chosen = rng.choice(large, min(len(large), int(rng.integers(1, 20))), replace=False)
    points, more = list(solid.points), []
    for t in chosen:
        names = [*solid.triangles[t].tolist(), *range(len(points), len(points) + 3)]
        points += list(twisted(solid.points[solid.triangles[t]], n[t], FOLD * d, rng)[3:])
        more += [[names[k] for k in corners] for corners in FOLDED]
    soup = Solid(np.array(points), np.concatenate([np.delete(solid.triangles, chosen, axis=0), np.array(more)]))
    return case(solid, soup, f"{len(chosen)} folds", touched=boxes(solid.points[solid.triangles[chosen]], d))


# ------------------------------------------------------------------------------------------------------- debris


def debris(solid, rng):
    """Small shells inside, which nobody can see; small shells outside, which are parts; loose triangles anywhere."""
    d, soup, parts, added = solids.diagonal(solid), solid, [], []

    def small_shell():
        shape = [solids.sphere(2), solids.voxels([(0, 0, 0)], 1, 1)][int(rng.integers(2))]
        return Solid(shape.points - shape.points.mean(axis=0), shape.triangles)
    known = solids.topology(solid)
    outside = int(rng.integers(0, 4)) * (known["shells"] == known["components"])  # in a cavity, who would see them?
    for inside, count in ((True, int(rng.integers(0, 8))), (False, outside)):
        for _ in range(count):
            radius = d * rng.uniform(0.005, 0.02)
            centre = inner_points(solid, rng, 1, inside, 2 * radius + 0.01 * d)[0]
            shell = small_shell()
            shell = Solid(centre + radius * shell.points, shell.triangles)
            if any(np.linalg.norm(centre - p.points.mean(axis=0)) < 0.12 * d for p in parts):
                continue
            soup = add(soup, *shell)
            parts += [] if inside else [shell]
            added.append(shell.points)
    loose = int(rng.integers(1, 40))
    lo, size = solid.points.min(axis=0), np.ptp(solid.points, axis=0)
    for _ in range(loose):
        points = lo + size * rng.uniform(-0.05, 1.05, 3) + d * rng.uniform(0.002, 0.03) * rng.normal(size=(3, 3))
        soup = add(soup, points, [(0, 1, 2)])
        added.append(points)
    made = Case(soup=soup, truth=[solid, *parts], touched=boxes(added, d),
                what=f"{len(added) - loose - len(parts)} shells inside, {len(parts)} outside, {loose} loose triangles")
    made.expected = known | {key: known[key] + len(parts) for key in ("components", "shells")}
    return made


# ------------------------------------------------------------------------------------------------- single places


def one_triangle(solid, rng):
    """One triangle is missing."""
    t = int(rng.integers(len(solid.triangles)))
    soup = Solid(solid.points, np.delete(solid.triangles, t, axis=0))
    zone = solid.points[solid.triangles[t]]
    return case(solid, soup, f"triangle {t} missing", zones=[zone], touched=boxes([zone], solids.diagonal(solid)))


def joint_row(solid, rng):
    """Along one path of edges the triangles of one side end in vertices that those of the other side do not have."""
    d, beyond = solids.diagonal(solid), solids.twins(solid.triangles)
    t, rows = int(rng.integers(len(solid.triangles))), {}
    for _ in range(min(24, len(solid.triangles) // 8)):  # a strip of triangles: every other edge of its side
        k = int(rng.integers(3))
        rows.setdefault(t, k)
        t = int(beyond[t, (k + 1) % 3])
    points, triangles = list(solid.points), solid.triangles.tolist()
    for t, k in rows.items():
        a, b, c = (solid.triangles[t].tolist() * 2)[k:k + 3]
        points.append((solid.points[a] + solid.points[b]) / 2 + T_GAP * d * rng.random() * direction(rng))
        triangles[t] = [a, len(points) - 1, c]
        triangles.append([len(points) - 1, b, c])
    return case(solid, Solid(np.array(points), np.array(triangles)), f"a row of {len(rows)} T-junctions",
                touched=boxes([solid.points[solid.triangles[list(rows)]].reshape(-1, 3)], d))


def inside_out(solid, rng):
    return case(solid, Solid(solid.points, solid.triangles[:, ::-1]), "all inside out")


def cut(solid, rng):
    """The triangles on one side of a plane stand off by .3 % of the diagonal."""
    d, normal = solids.diagonal(solid), direction(rng)
    height = solid.points[solid.triangles].mean(axis=1) @ normal
    above = height > height.min() + np.ptp(height) * rng.uniform(0.3, 0.7)
    if not 0 < above.sum() < len(above):
        raise Unsuitable("nothing on one side")
    triangles = np.where(above[:, None], solid.triangles + len(solid.points), solid.triangles)
    soup = Solid(np.concatenate([solid.points, solid.points + CUT * d * normal]), triangles)
    made = case(solid, soup, f"cut in two, {100 * CUT:g} % apart")
    made.touched = boxes([solid.points], d)
    return made


def rotated(solid, rng):
    """The same body a second time, turned by three degrees about its middle."""
    axis, angle = direction(rng), math.radians(3)
    middle = solid.points.mean(axis=0)
    arm = solid.points - middle
    turned_arm = (math.cos(angle) * arm + math.sin(angle) * np.cross(axis, arm)
                  + (1 - math.cos(angle)) * (arm @ axis)[:, None] * axis)
    copy = Solid(middle + turned_arm, solid.triangles)
    made = case(solid, add(solid, *copy), "two copies, turned by 3 degrees")
    made.truth, made.expected, made.touched = [solid, copy], {}, boxes([solid.points], solids.diagonal(solid))
    return made


def jitter(solid, rng):
    """Every vertex moved at random."""
    d = solids.diagonal(solid)
    moves = rng.normal(size=solid.points.shape)
    moves *= (JITTER * d * rng.random(len(moves)) / np.linalg.norm(moves, axis=1))[:, None]
    made = case(solid, Solid(solid.points + moves, solid.triangles), f"vertices moved by up to {100 * JITTER:g} %")
    made.touched = boxes([solid.points], d)
    return made


def spike(solid, rng):
    """One vertex pulled out by a twentieth of the diagonal."""
    v, d = int(rng.integers(len(solid.points))), solids.diagonal(solid)
    points = solid.points.copy()
    points[v] += 0.05 * d * vertex_normals(solid)[v]
    around = solid.points[solid.triangles[(solid.triangles == v).any(axis=1)]].reshape(-1, 3)
    return case(solid, Solid(points, solid.triangles), f"vertex {v} pulled out", zones=[around], touched=boxes([around], d))


def scattered(solid, rng):
    """A twentieth of the triangles is missing, here and there."""
    keep = rng.random(len(solid.triangles)) >= 0.05
    made = case(solid, Solid(solid.points, solid.triangles[keep]), f"{(~keep).sum()} triangles missing")
    made.touched = boxes([solid.points], solids.diagonal(solid))
    return made


KINDS = {
    "hole-1": lambda s, r: holes(s, r, 0.01, 1), "hole-3": lambda s, r: holes(s, r, 0.03, 1),
    "hole-10": lambda s, r: holes(s, r, 0.1, 1),
    "holes-1": lambda s, r: holes(s, r, 0.01, int(r.integers(3, 9))),
    "holes-3": lambda s, r: holes(s, r, 0.03, int(r.integers(3, 9))),
    "holes-10": lambda s, r: holes(s, r, 0.1, int(r.integers(3, 9))),
    "turned": turned, "doubled": doubled, "united": united, "t-junctions": t_junctions,
    "torn-.01": lambda s, r: torn(s, r, 1e-4), "torn-.05": lambda s, r: torn(s, r, 5e-4),
    "walls": walls, "fins": fins, "folds": folds, "debris": debris}

MORE = {"triangle": one_triangle, "t-row": joint_row, "inside-out": inside_out, "cut": cut, "rotated": rotated,
        "jitter": jitter, "spike": spike, "scattered": scattered}
"""Kinds for bench/run/damage.py alone: the answer is not known so well, or repair has little to do. (The numbers of the cases of
KINDS depend on how many there are.)"""
