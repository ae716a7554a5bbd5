"""Bodies with known answers: their CAD, supports and loads, and what is right.

Where no formula is exact, the answer is that of a plane or axially symmetric model of second order, meshed far finer at its notch
(answers_planar.py), and the published factor stands beside it.
"""
import dataclasses
import functools
import math
import typing

import numpy as np

from bench.judges.answers_solved import CONDUCTIVITY, consistent, first_principal, ON_FACE, POISSON, Problem, SHEAR, YOUNG
from bench.models import answers_planar as planar

LOAD = 100.0
STRAIN_YOUNG, STRAIN_POISSON = YOUNG / (1 - POISSON**2), POISSON / (1 - POISSON)  # of plane strain
X, Y, Z = 0, 1, 2


def plane(axis, at):
    return lambda p: np.abs(p[:, axis] - at) < ON_FACE


def pillar(radius, x=0.0, y=0.0):
    return lambda p: np.abs(np.hypot(p[:, 0] - x, p[:, 1] - y) - radius) < ON_FACE


def ball(radius):
    return lambda p: np.abs(np.linalg.norm(p, axis=1) - radius) < ON_FACE


def both(*where):
    return lambda p: np.all([w(p) for w in where], axis=0)


def pressure(amount):
    return lambda at, normal: -amount * normal


def steady(*vector):
    return lambda at, normal: np.broadcast_to(np.array(vector, float), (len(at), len(vector)))


@dataclasses.dataclass
class Case:
    """`build(occ)` makes the body. `held`: (where, degree of freedom, value or function of points); `loads`: (where, traction). `place`, `along`:
    whose displacement is compared. `peak(points, stress)`: the stress that counts, at the corners that are `hot`; worst=True: the largest of them,
    else the root mean square of their errors. `right()`: displacement, work of loads, peak stress. `about` says {found} where a `model` tells them."""
    name: str
    about: str
    build: typing.Callable
    held: list
    loads: list
    place: tuple
    along: int
    hot: typing.Callable
    peak: typing.Callable
    right: typing.Callable
    worst: bool = False
    heat: bool = False
    fixed_nodes: tuple = ()

    model: typing.Any = None  # where the right answers are those of a plane model

    @functools.cached_property
    def answer(self):
        return self.right()

    @property
    def says(self):
        return self.about.replace("{found}", self.model.told() if self.model else "")

    def problem(self, mesh):
        held = {(mesh.node_at(place), k): 0.0 for place, k in self.fixed_nodes}
        for where, k, value in self.held:
            nodes = mesh.nodes_where(where)
            values = value(mesh.points[nodes]) if callable(value) else np.full(len(nodes), value)
            held.update(zip(((int(n), k) for n in nodes), values))
        forces = sum(consistent(mesh, mesh.faces_where(where), traction) for where, traction in self.loads)
        return Problem(mesh, forces, held, "DC3D" if self.heat else "C3D")

    def errors(self, problem, primary, stress):
        """In percent."""
        mesh, (displacement, work, peak) = problem.mesh, self.answer
        hot = mesh.corners_where(self.hot)
        found = self.peak(mesh.points[hot], stress[hot])
        off = found.max() / peak - 1 if self.worst else math.sqrt(np.mean((found / peak - 1) ** 2))
        return {"displacement": 100 * (primary[mesh.node_at(self.place), self.along] / displacement - 1),
                "energy": 100 * ((problem.forces * primary[:, :problem.forces.shape[1]]).sum() / 2 / work - 1), "stress": 100 * off}


# Lamé and the heat of a hollow cylinder: a quarter of it.
INNER, OUTER, HIGH = 10.0, 20.0, 10.0


def quarter_ring(inner, outer, high):
    def build(occ):
        occ.cut([(3, occ.addCylinder(0, 0, 0, 0, 0, high, outer, angle=math.pi / 2))], [(3, occ.addCylinder(0, 0, 0, 0, 0, high, inner, angle=math.pi / 2))])
    return build


def hoop(p, s):
    c, d = p[:, 0] / np.hypot(p[:, 0], p[:, 1]), p[:, 1] / np.hypot(p[:, 0], p[:, 1])
    return d * d * s[:, 0] + c * c * s[:, 1] - 2 * c * d * s[:, 3]


def lame():
    ratio = LOAD / (OUTER**2 - INNER**2)
    displacement = ratio * INNER / YOUNG * ((1 - POISSON) * INNER**2 + (1 + POISSON) * OUTER**2)
    return displacement, LOAD * displacement * math.pi / 4 * INNER * HIGH, ratio * (INNER**2 + OUTER**2)


def pipe():
    return Case("thick pipe",
                "Inner radius 10, outer 20, height 10, pressure inside, ends free: Lamé. Displacement of the inner wall; hoop stress on it, root mean "
                "square over its nodes.",
                quarter_ring(INNER, OUTER, HIGH), [(plane(X, 0), X, 0), (plane(Y, 0), Y, 0), (plane(Z, 0), Z, 0)], [(pillar(INNER), pressure(LOAD))],
                (INNER, 0, 0), X, pillar(INNER), hoop, lame)


FLUX, SMALL = 10.0, 5.0


def heat():
    def right():
        warm = FLUX * SMALL / CONDUCTIVITY * math.log(OUTER / SMALL)
        return warm, FLUX * warm * math.pi / 4 * SMALL * HIGH, FLUX
    return Case("heat",
                "A hollow cylinder of radii 5 and 20, height 10, heat flows in through the inner wall, the outer one is held at 0. Temperature and heat "
                "flux of the inner wall (root mean square over its nodes) stand for displacement and stress.",
                quarter_ring(SMALL, OUTER, HIGH), [(pillar(OUTER), 0, 0)],
                [(pillar(SMALL), steady(FLUX))], (SMALL, 0, 0), 0, pillar(SMALL), lambda p, q: np.hypot(q[:, 0], q[:, 1]), right, heat=True)


# Plates with a hole, bracket and shaft: the same outline in the plane and in space.
HOLE, THICK = 5.0, 5.0
STRETCHED = {.1: (50.0, 100.0, 3.03), .3: (HOLE / .3, 40.0, 3.36), .5: (10.0, 30.0, 4.32)}  # half width, half length, Howland's factor


def plate(ratio):
    wide, long, published = STRETCHED[ratio]

    def outline(occ):
        return occ.cut([(2, occ.addRectangle(0, 0, 0, long, wide))], [(2, occ.addDisk(0, 0, 0, HOLE, HOLE))])[0][0][1]
    model = planar.Model(outline, [(plane(X, 0), X), (plane(Y, 0), Y)], [(plane(X, long), (LOAD, 0.0))], (long, 0.0), X, pillar(HOLE), HOLE)
    return Case(f"plate, hole of {ratio:g} of its width",
                f"A hole of radius 5 in a plate {2 * wide:.4g} wide and {2 * long:g} long, pulled; both faces held (plane strain, whose stresses in the "
                f"plane are those of plane stress). Displacement of the end; stress where the hole is widest, root mean square over the nodes of that "
                f"edge. Howland 1930: {published} of the mean stress at the ends; {{found}}.",
                planar.raised(outline, THICK), [(plane(X, 0), X, 0), (plane(Y, 0), Y, 0), (plane(Z, 0), Z, 0), (plane(Z, THICK), Z, 0)],
                [(plane(X, long), steady(LOAD, 0, 0))], (long, 0, 0), X, both(plane(X, 0), plane(Y, HOLE)), lambda p, s: s[:, 0], lambda: model.right(THICK),
                model=model)


LEG, ARM, FILLET, DEEP = 20.0, 80.0, 5.0, 10.0


def bracket_outline(occ):
    corner = LEG + FILLET
    p = [occ.addPoint(x, y, 0) for x, y in ((0, 0), (ARM, 0), (ARM, LEG), (corner, LEG), (LEG, corner), (LEG, ARM), (0, ARM))]
    centre = occ.addPoint(corner, corner, 0)
    lines = [occ.addLine(p[i], p[(i + 1) % 7]) if i != 3 else occ.addCircleArc(p[3], centre, p[4]) for i in range(7)]
    return occ.addPlaneSurface([occ.addCurveLoop(lines)])


def bracket():
    corner = LEG + FILLET
    top = both(plane(Y, LEG), lambda p: p[:, 0] > corner - ON_FACE)
    round_ = both(pillar(FILLET, corner, corner), lambda p: (p[:, 0] < corner + ON_FACE) & (p[:, 1] < corner + ON_FACE))
    model = planar.Model(bracket_outline, [(plane(Y, ARM), Y)], [(top, (0.0, -1.0))], (ARM, 0.0), Y, round_, FILLET, fixed=(((0.0, ARM), X),), nominal=1.0)
    return Case("bracket",
                "Legs 80 long, 20 wide, a fillet of radius 5 in the corner, 10 deep, both faces held (plane strain); one leg's end held along it, "
                "pressure of 1 on the other leg. Displacement of that leg's end; largest principal stress of the fillet's nodes; {found}.",
                planar.raised(bracket_outline, DEEP),
                [(plane(Y, ARM), Y, 0), (plane(Z, 0), Z, 0), (plane(Z, DEEP), Z, 0)], [(top, pressure(1.0))], (ARM, 0, 0), Y, round_,
                lambda p, s: first_principal(s), lambda: model.right(DEEP), worst=True, model=model, fixed_nodes=(((0, ARM, 0), X),))


THIN, WIDE, STEP, REST, ROUND = 10.0, 20.0, 30.0, 70.0, 2.0  # radii of the shaft, heights of its step and of its end, radius of the fillet


def shaft_outline(occ):
    p = [occ.addPoint(x, y, 0) for x, y in ((0, 0), (WIDE, 0), (WIDE, STEP), (THIN + ROUND, STEP), (THIN, STEP + ROUND), (THIN, REST), (0, REST))]
    centre = occ.addPoint(THIN + ROUND, STEP + ROUND, 0)
    lines = [occ.addLine(p[i], p[(i + 1) % 7]) if i != 3 else occ.addCircleArc(p[3], centre, p[4]) for i in range(7)]
    return occ.addPlaneSurface([occ.addCurveLoop(lines)])


def pilkey():
    """Stress concentration of a stepped shaft that is pulled (W. D. Pilkey, Peterson's Stress Concentration Factors, chart 3.4)."""
    t = (WIDE - THIN) / ROUND
    root, part = math.sqrt(t), (WIDE - THIN) / WIDE
    c = (1.200 + 0.860 * root - 0.022 * t, -1.805 - 0.346 * root - 0.038 * t, 2.198 - 0.486 * root + 0.165 * t, -0.593 - 0.028 * root - 0.106 * t)
    return sum(factor * part**k for k, factor in enumerate(c))


def shaft():
    def round_(p):
        r = np.hypot(p[:, 0], p[:, 2])
        near = (r < THIN + ROUND + ON_FACE) & (p[:, 1] < STEP + ROUND + ON_FACE)
        return near & (np.abs(np.hypot(r - THIN - ROUND, p[:, 1] - STEP - ROUND) - ROUND) < ON_FACE)
    model = planar.Model(shaft_outline, [(plane(X, 0), X), (plane(Y, 0), Y)], [(plane(Y, REST), (0.0, LOAD))], (0.0, REST), Y,
                         pillar(ROUND, THIN + ROUND, STEP + ROUND), ROUND, around=True)
    return Case("stepped shaft",
                f"Radii 20 and 10, fillet 2, pulled. Displacement of the end; largest principal stress of the fillet's nodes. Peterson's chart by "
                f"Pilkey's formula: {pilkey():.3f} of the thin part's mean stress, and S. M. Tipton, J. R. Sorem and R. D. Rolovic found in 1996 that "
                f"such charts are low; {{found}}.",
                planar.turned(shaft_outline), [(plane(X, 0), X, 0), (plane(Y, 0), Y, 0), (plane(Z, 0), Z, 0)],
                [(plane(Y, REST), steady(0, LOAD, 0))], (0, REST, 0), Y, round_, lambda p, s: first_principal(s), lambda: model.right(0.25), worst=True,
                model=model)


# S. Timoshenko, J. N. Goodier, Theory of Elasticity, article 21: a cantilever whose end carries a parabola of shear.
LONG, HALF, BEAM_WIDE, SHEAR_FORCE = 100.0, 10.0, 10.0, 1000.0  # force for each unit of width
INERTIA = 2 * HALF**3 / 3


def beam(p):
    """Displacements along x and y in plane strain."""
    x, y = p[:, 0], p[:, 1]
    q = SHEAR_FORCE / (6 * STRAIN_YOUNG * INERTIA)
    u = q * (-3 * x * x * y - STRAIN_POISSON * y**3 + 3 * LONG**2 * y) + SHEAR_FORCE / (6 * INERTIA * SHEAR) * (y**3 - 3 * HALF**2 * y)
    v = q * (3 * STRAIN_POISSON * x * y * y + x**3 - 3 * LONG**2 * x + 2 * LONG**3)
    return u, v


def beam_end(at, normal):
    force = np.zeros_like(at)
    force[:, 1] = SHEAR_FORCE / (2 * INERTIA) * (HALF**2 - at[:, 1] ** 2)
    return force


def cantilever():
    def right():
        tip = float(beam(np.zeros((1, 3)))[1][0])
        return tip, SHEAR_FORCE * BEAM_WIDE * tip / 2, SHEAR_FORCE * LONG * HALF / INERTIA
    wall = plane(X, LONG)
    return Case("cantilever",
                "100 x 20 x 10, both faces held (plane strain), a parabola of shear at its end, at the wall the displacements of theory: Timoshenko and "
                "Goodier, exact. Deflection of the tip; bending stress along the edges of the wall, root mean square.",
                lambda occ: occ.addBox(0, -HALF, 0, LONG, 2 * HALF, BEAM_WIDE),
                [(wall, X, lambda p: beam(p)[0]), (wall, Y, lambda p: beam(p)[1]), (plane(Z, 0), Z, 0), (plane(Z, BEAM_WIDE), Z, 0)], [(plane(X, 0), beam_end)],
                (0, HALF, 0), Y, both(wall, lambda p: np.abs(np.abs(p[:, 1]) - HALF) < ON_FACE), lambda p, s: np.abs(s[:, 0]), right)


# J. N. Goodier 1933: a spherical cavity in a body that is pulled.
CAVITY, BLOCK = 5.0, 15.0


def around_cavity(p):
    """Displacements (points may be complex)."""
    x, y, z = p.T
    r, rho2 = np.sqrt(x * x + y * y + z * z), x * x + y * y
    cosine2, unit = (z * z - rho2) / (r * r), LOAD / (8 * SHEAR * (7 - 5 * POISSON))
    a, b, c = unit * (13 - 10 * POISSON) * CAVITY**3, unit * CAVITY**5, unit * 5 * (1 - 2 * POISSON) * CAVITY**3
    radial = a / r**2 - 3 * b / r**4 + ((5 - 4 * POISSON) / (1 - 2 * POISSON) * c / r**2 - 9 * b / r**4) * cosine2
    turned = -2 * (2 * c / r**2 + 6 * b / r**4) / r**3
    far = LOAD / YOUNG
    across, along = radial / r + turned * z * z, radial / r - turned * rho2
    return np.stack([(across - POISSON * far) * x, (across - POISSON * far) * y, (along + far) * z], axis=1)


def stress_of(displacement, p):
    """By complex steps: exact but for rounding."""
    step, gradient = 1e-30, np.empty((len(p), 3, 3))
    for k in range(3):
        moved = p.astype(complex)
        moved[:, k] += 1j * step
        gradient[:, :, k] = displacement(moved).imag / step
    strain = (gradient + gradient.transpose(0, 2, 1)) / 2
    return 2 * SHEAR * (strain + POISSON / (1 - 2 * POISSON) * np.trace(strain, axis1=1, axis2=2)[:, None, None] * np.eye(3))


def cavity_load(at, normal):
    return np.einsum("nij,nj->ni", stress_of(around_cavity, at), normal)


def work_on_block():
    """Of half the tractions times displacements, on the three outer sides."""
    places, weights = np.polynomial.legendre.leggauss(24)
    u, v = (g.ravel() for g in np.meshgrid(*[(places + 1) * BLOCK / 2] * 2))
    weight = np.outer(weights, weights).ravel() * BLOCK**2 / 4
    total = 0.0
    for axis in range(3):
        p, normal = np.insert(np.stack([u, v], 1), axis, BLOCK, axis=1), np.eye(3)[axis]
        total += (weight * (cavity_load(p, np.broadcast_to(normal, p.shape)) * around_cavity(p)).sum(axis=1)).sum()
    return total / 2


def cavity():
    def right():
        top = around_cavity(np.array([[0, 0, CAVITY]]))[0, 2]
        return top, work_on_block(), LOAD * (27 - 15 * POISSON) / (2 * (7 - 5 * POISSON))

    def build(occ):
        occ.cut([(3, occ.addBox(0, 0, 0, BLOCK, BLOCK, BLOCK))], [(3, occ.addSphere(0, 0, 0, CAVITY))])
    sides = [(plane(k, BLOCK), cavity_load) for k in range(3)]
    return Case("cavity",
                "A spherical cavity of radius 5, an eighth, in a cube of 15 that carries the tractions of Goodier's solution for a body without end that "
                "is pulled. Displacement of the cavity's pole; stress along its equator, root mean square.",
                build, [(plane(k, 0), k, 0) for k in range(3)], sides, (0, 0, CAVITY), Z, both(plane(Z, 0), ball(CAVITY)),
                lambda p, s: s[:, 2], right)


# Saint-Venant's torsion of a square bar, a quarter of it: shear by the series for the stress function.
BAR, BAR_LONG, TWIST = 5.0, 20.0, 1e-4
ODD = np.arange(1, 400, 2)


def torsion_shear(p):
    """Stresses xz and yz."""
    x, y = p[:, :1], p[:, 1:2]
    k = ODD * math.pi / (2 * BAR)
    sign = (-1.0) ** ((ODD - 1) // 2)
    scale = 16 * SHEAR * TWIST * BAR / math.pi**2 * sign / ODD**2
    # cosh(k y) / cosh(k BAR), sinh(k y) / cosh(k BAR), with nothing that overflows
    bottom = 1 + np.exp(-2 * k * BAR)
    high, low = np.exp(k * (y - BAR)) / bottom, np.exp(-k * (y + BAR)) / bottom
    return -(scale * (high - low) * np.cos(k * x)).sum(axis=1), 2 * SHEAR * TWIST * x[:, 0] - (scale * (high + low) * np.sin(k * x)).sum(axis=1)


def torsion():
    def end(at, normal):
        xz, yz = torsion_shear(at)
        return np.stack([xz, yz, np.zeros_like(xz)], axis=1)

    def right():
        k = ODD * math.pi / 2
        constant = (1 - 192 / math.pi**5 * (np.tanh(k) / ODD**5).sum()) / 3  # .1406
        torque = constant * SHEAR * TWIST * (2 * BAR) ** 4 / 4
        return TWIST * BAR_LONG * BAR, torque * TWIST * BAR_LONG / 2, float(torsion_shear(np.array([[BAR, 0.0, 0.0]]))[1][0])
    flat = plane(Z, 0)
    return Case("torsion",
                "A square bar of side 10, 20 long, a quarter of it, twisted by Saint-Venant's shear at its end (torsion constant .1406 of side⁴). "
                "Displacement of a corner; shear along the middle of a side, root mean square.",
                lambda occ: occ.addBox(0, 0, 0, BAR, BAR, BAR_LONG),
                [(flat, X, 0), (flat, Y, 0), (plane(X, 0), Y, 0), (plane(X, 0), Z, 0), (plane(Y, 0), X, 0), (plane(Y, 0), Z, 0)], [(plane(Z, BAR_LONG), end)],
                (BAR, BAR, BAR_LONG), Y, both(plane(X, BAR), plane(Y, 0)), lambda p, s: s[:, 4], right)


def all_cases():
    return [pipe(), *(plate(ratio) for ratio in STRETCHED), shaft(), bracket(), cantilever(), cavity(), torsion(), heat()]
