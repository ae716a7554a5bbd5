"""CAD solids by OpenCASCADE, as STEP files: 27 families with dimensions by chance. Needs Gmsh's Python module.

make(number, file, seed=0) writes one, and returns its family, and by OpenCASCADE its volume and the diagonal of its box.
"""
import math
import random

import gmsh

occ = gmsh.model.occ
X, Y, Z = (1, 0, 0), (0, 1, 0), (0, 0, 1)


def cut(body, *tools):
    return occ.cut([body], list(tools))[0]


def cylinder(at, axis, radius):
    return 3, occ.addCylinder(*at, *axis, radius)


def box(size, at=(0, 0, 0)):
    return 3, occ.addBox(*at, *size)


def solids_of(entities):
    return [e for e in entities if e[0] == 3]


def loop(points):
    tags = [occ.addPoint(*p) for p in points]
    return occ.addCurveLoop([occ.addLine(a, b) for a, b in zip(tags, tags[1:] + tags[:1])])


def circle(z, radius):
    """Of four arcs, that begin where corners of square() are."""
    center = occ.addPoint(0, 0, z)
    ends = [occ.addPoint(radius * math.cos(a), radius * math.sin(a), z) for a in (math.pi / 4 + k * math.pi / 2 for k in range(4))]
    return occ.addCurveLoop([occ.addCircleArc(a, center, b) for a, b in zip(ends, ends[1:] + ends[:1])])


def square(z, half, turned=0.0):
    return loop([(half * math.sqrt(2) * math.cos(turned + a), half * math.sqrt(2) * math.sin(turned + a), z)
                 for a in (math.pi / 4 + k * math.pi / 2 for k in range(4))])


def profile(points):
    """A face: a closed spline through the points."""
    tags = [occ.addPoint(*p) for p in points]
    return 2, occ.addPlaneSurface([occ.addCurveLoop([occ.addBSpline([*tags, tags[0]])])])


def rounded(body, radius, chamfer=False):
    occ.synchronize()
    edges = [t for _, t in gmsh.model.getBoundary(gmsh.model.getBoundary([body], oriented=False), combined=False, oriented=False)]
    edges = sorted(set(edges))
    if chamfer:
        faces = {e: gmsh.model.getAdjacencies(1, e)[0][0] for e in edges}
        return occ.chamfer([body[1]], edges, [faces[e] for e in edges], [radius])
    return occ.fillet([body[1]], edges, [radius])


def plain_box(r):
    return [box((r(1, 10), r(1, 10), r(.3, 10)))]


def plate_with_holes(r):
    w, n, t = r(20, 60), int(r(2, 6)), r(1, 5)
    pitch = w / n
    holes = [cylinder((pitch * (i + .5), pitch * (j + .5), -1), (0, 0, t + 2), r(.1, .35) * pitch) for i in range(n) for j in range(2)]
    return cut(box((w, 2 * pitch, t)), *holes)


def plain_cylinder(r):
    return [cylinder((0, 0, 0), (0, 0, r(.5, 20)), r(1, 5))]


def cone(r):
    return [(3, occ.addCone(0, 0, 0, 0, 0, r(2, 12), r(2, 4), 0))]


def frustum(r):
    return [(3, occ.addCone(0, 0, 0, 0, 0, r(2, 12), r(2, 4), r(.2, 1.5)))]


def sphere(r):
    return [(3, occ.addSphere(0, 0, 0, r(1, 10)))]


def part_of_a_sphere(r):
    return [(3, occ.addSphere(0, 0, 0, r(1, 10), -1, -r(.2, 1.2), r(.2, 1.2), r(1, 5)))]


def ring(r):
    return [(3, occ.addTorus(0, 0, 0, r(3, 8), r(.5, 2.5)))]


def part_of_a_ring(r):
    return [(3, occ.addTorus(0, 0, 0, r(3, 8), r(.5, 2.5), -1, r(1, 5)))]


def wedge(r):
    return [(3, occ.addWedge(0, 0, 0, r(2, 6), r(1, 4), r(1, 6), -1, r(.2, 1.5)))]


def ellipsoid(r):
    body = 3, occ.addSphere(0, 0, 0, 1)
    occ.dilate([body], 0, 0, 0, r(1, 4), r(1, 4), r(1, 4))
    return [body]


def filleted_box(r):
    return rounded(box((r(4, 10), r(4, 10), r(4, 10))), r(.2, 1.8))


def chamfered_box(r):
    return rounded(box((r(4, 10), r(4, 10), r(4, 10))), r(.2, 1.2), chamfer=True)


def hollow_box(r):
    w, t = r(6, 12), r(.3, 1)
    return cut(box((w, w, w)), box((w - 2 * t,) * 3, (t,) * 3))


def tube(r):
    radius, h = r(2, 5), r(5, 30)
    return cut(cylinder((0, 0, 0), (0, 0, h), radius), cylinder((0, 0, -1), (0, 0, h + 2), radius * r(.6, .93)))


def elbow(r):
    disc = occ.addDisk(0, 0, 0, 1, 1)
    hole = occ.addDisk(0, 0, 0, *(2 * [r(.5, .85)]))
    face = occ.cut([(2, disc)], [(2, hole)])[0]
    return solids_of(occ.revolve(face, r(2, 5), 0, 0, 0, 1, 0, r(.6, 2.6)))


def spring(r):
    turns, radius, pitch = r(1.5, 3), r(2, 4), r(1.5, 2.5)
    steps = int(16 * turns)
    points = [occ.addPoint(radius * math.cos(a), radius * math.sin(a), pitch * a / (2 * math.pi))
              for a in (2 * math.pi * turns * k / steps for k in range(steps + 1))]
    wire = occ.addWire([occ.addBSpline(points)])
    disc = occ.addDisk(radius, 0, 0, *(2 * [r(.3, .6)]))
    occ.rotate([(2, disc)], radius, 0, 0, 1, 0, 0, math.pi / 2)
    return solids_of(occ.addPipe([(2, disc)], wire, "Frenet"))


def square_to_round(r):
    return occ.addThruSections([square(0, r(2, 4)), circle(r(4, 8), r(1, 3))])


def twisted_loft(r):
    turn, h = r(.2, .9), r(2, 4)
    return occ.addThruSections([square(h * k, 2 - .2 * k, turn * k) for k in range(4)])


def extruded_spline(r):
    n = int(r(6, 12))
    points = [((s := r(2, 5)) * math.cos(a), s * math.sin(a), 0) for a in (2 * math.pi * k / n for k in range(n))]
    return solids_of(occ.extrude([profile(points)], 0, 0, r(1, 10)))


def vase(r):
    heights = [1.5 * k for k in range(6)]
    outer = [occ.addPoint(r(2, 4), 0, z) for z in heights]
    axis = [occ.addPoint(0, 0, heights[-1]), occ.addPoint(0, 0, 0)]
    curves = [occ.addBSpline(outer), occ.addLine(outer[-1], axis[0]), occ.addLine(*axis), occ.addLine(axis[1], outer[0])]
    face = occ.addPlaneSurface([occ.addCurveLoop(curves)])
    return solids_of(occ.revolve([(2, face)], 0, 0, 0, 0, 0, 1, 2 * math.pi))


def gear(r):
    n, radius, t = int(r(8, 20)), r(6, 12), r(1, 5)
    tooth = 2 * math.pi * radius / n / 4
    slots = []
    for k in range(n):
        slots.append(box((3 * tooth, 2 * tooth, t + 2), (radius - 1.5 * tooth, -tooth, -1)))
        occ.rotate([slots[-1]], 0, 0, 0, 0, 0, 1, 2 * math.pi * k / n)
    return cut(cylinder((0, 0, 0), (0, 0, t), radius), *slots, cylinder((0, 0, -1), (0, 0, t + 2), r(.2, .5) * radius))


def tee(r):
    big, small, h = r(2, 3), r(.8, 1.9), r(10, 16)
    body = occ.fuse([cylinder((0, 0, 0), (0, 0, h), big)], [cylinder((0, 0, h / 2), (h / 2, 0, 0), small)])[0][0]
    thin = r(.6, .9)
    return cut(body, cylinder((0, 0, -1), (0, 0, h + 2), big * thin), cylinder((0, 0, h / 2), (h, 0, 0), small * thin))


def bracket(r):
    w, t, n = r(10, 30), r(1, 4), int(r(1, 4))
    body = occ.fuse([box((w, w, t))], [box((t, w, w))])[0][0]
    holes = [cylinder((w * .6, w * (k + .5) / n, -1), (0, 0, t + 2), r(.05, .3) * w / n) for k in range(n)]
    return cut(body, *holes, cylinder((-1, w / 2, w * .6), (t + 2, 0, 0), r(.05, .2) * w))


def two_crossing_cylinders(r):
    a, b = r(1, 3), r(1, 3)
    return occ.intersect([cylinder((0, 0, -5), (0, 0, 10), a)], [cylinder((-5, 0, 0), (10, 0, 0), b)])[0]


def bored_sphere(r):
    radius = r(4, 8)
    bores = [cylinder(tuple(-10 * c for c in axis), tuple(20 * c for c in axis), r(.1, .6) * radius) for axis in (X, Y, Z)]
    return cut((3, occ.addSphere(0, 0, 0, radius)), *bores)


def lens(r):
    radius = r(4, 8)
    return occ.intersect([(3, occ.addSphere(0, 0, 0, radius))], [(3, occ.addSphere(0, 0, radius * r(1.1, 1.8), radius))])[0]


FAMILIES = {f.__name__: f for f in (
    plain_box, plate_with_holes, plain_cylinder, cone, frustum, sphere, part_of_a_sphere, ring, part_of_a_ring, wedge, ellipsoid, filleted_box,
    chamfered_box, hollow_box, tube, elbow, spring, square_to_round, twisted_loft, extruded_spline, vase, gear, tee, bracket,
    two_crossing_cylinders, bored_sphere, lens)}


def make(number, file, seed=0):
    family = list(FAMILIES)[number % len(FAMILIES)]
    gmsh.initialize()
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        solids = FAMILIES[family](random.Random(f"{seed} {number}").uniform)
        occ.remove([e for dim in (2, 1, 0) for e in occ.getEntities(dim)], recursive=False)
        occ.synchronize()
        volume = sum(occ.getMass(*s) for s in solids_of(solids))
        lo_and_hi = occ.getBoundingBox(*solids_of(solids)[0])
        gmsh.write(str(file))
    finally:
        gmsh.finalize()
    return family, volume, math.dist(lo_and_hi[:3], lo_and_hi[3:])
