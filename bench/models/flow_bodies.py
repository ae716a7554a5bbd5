"""Bodies that flows are measured around, in metres, the flow along x, z up. Needs NumPy."""
import math

import numpy as np

from bench.models import layers_bodies


def loft(rings):
    """A closed surface through rings of four corners, each counter-clockwise as seen from behind, along x."""
    points = np.array([p for ring in rings for p in ring])
    triangles = [(0, 2, 1), (0, 3, 2)]
    for first in range(0, 4 * (len(rings) - 1), 4):
        for k in range(4):
            a, b = first + k, first + (k + 1) % 4
            triangles += [(a, b, b + 4), (a, b + 4, a + 4)]
    last = len(points) - 4
    return points, np.array(triangles + [(last, last + 1, last + 2), (last, last + 2, last + 3)])


def ahmed(slant=25, slices=24):
    """Ahmed's car (S. R. Ahmed, G. Ramm, G. Faltin, SAE 840300), its nose at x = 0: 1.044 long, .389 wide, .288 high, edges of the nose rounded
    by .1, a slant of .222 behind, 50 mm above the ground z = 0. The four stilts are left out."""
    length, half, high, radius, clearance = 1.044, 0.389 / 2, 0.288, 0.1, 0.05
    edge = length - 0.222 * math.cos(math.radians(slant))

    def ring(x):
        inset = radius - math.sqrt(max(0.0, radius**2 - max(0.0, radius - x) ** 2))
        y, low = half - inset, clearance + inset
        top = clearance + high - inset - max(0.0, x - edge) * math.tan(math.radians(slant))
        return [(x, -y, low), (x, y, low), (x, y, top), (x, -y, top)]
    nose = [radius * (1 - math.cos(math.pi / 2 * i / slices)) for i in range(slices + 1)]
    return {"car": loft([ring(x) for x in [*nose, edge, length]])}


def wing(span=4.0, attack=0.0):
    """NACA 0012 of chord 1, from y = -span/2 to span/2, its tips flat, its nose raised by so many degrees."""
    c, s = math.cos(math.radians(attack)), math.sin(math.radians(attack))
    return {"wing": layers_bodies.mapped(layers_bodies.wing(span), lambda p: (c * p[0] + s * p[1], span / 2 - p[2], c * p[1] - s * p[0]))["body"]}
