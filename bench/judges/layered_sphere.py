"""Electric potentials in concentric spheres, with current in through a cap of the outer one and out through the opposite cap: the series of
Legendre's polynomials, and finite elements of first order.

In layer i, between r[i-1] and r[i], order n of the series is A (r / r[i])^n + B (r[i-1] / r)^(n+1); B is 0 in the innermost. Potential and
current density pass from layer to layer, so A and B of the next one follow from those of the one before, up to a factor, which the current through
the outer sphere gives. All powers are of ratios below 1, so nothing overflows.
"""
import numpy as np
from scipy.sparse import coo_matrix, diags
from scipy.sparse.linalg import cg
from scipy.special import eval_legendre

ORDERS = 300  # (81 / 88)^300 = 1e-11


class LayeredSphere:
    """Radii and conductivities from the inside; caps of this half angle around `axis` and -`axis`, current 1 through each, evenly."""

    def __init__(self, radii, conductivities, half_angle, axis):
        self.radii, self.axis = np.array(radii, float), np.array(axis, float) / np.linalg.norm(axis)
        self.half_angle = half_angle
        n = np.arange(1, ORDERS + 1)
        a, b = [np.ones(len(n))], [np.zeros(len(n))]
        for i, radius in enumerate(radii):
            inner = radii[i - 1] / radius if i else 0.0
            value = a[i] + b[i] * inner ** (n + 1)
            current = conductivities[i] * (n * a[i] - (n + 1) * b[i] * inner ** (n + 1)) / radius
            if i + 1 < len(radii):
                slope = current * radius / conductivities[i + 1]
                a.append(((n + 1) * value + slope) / (2 * n + 1) / (radius / radii[i + 1]) ** n)
                b.append((n * value - slope) / (2 * n + 1))
        c = np.cos(half_angle)
        density = (eval_legendre(n - 1, c) - eval_legendre(n + 1, c)) / (4 * np.pi * radii[-1] ** 2 * (1 - c))
        density[1::2] = 0  # both caps: even orders cancel
        self.orders, self.a, self.b = n, np.array(a) * 2 * density / current, np.array(b) * 2 * density / current

    def potential(self, points, radius=None):
        """At points, or where their directions meet the sphere of this radius."""
        away = np.linalg.norm(points, axis=1)
        x, r = points @ self.axis / away, away if radius is None else np.full(len(points), float(radius))
        layer = np.minimum(np.searchsorted(self.radii, r), len(self.radii) - 1)
        outer, inner = self.radii[layer], np.where(layer > 0, self.radii[layer - 1], 0)
        sum_of, before, now = np.zeros(len(x)), np.ones(len(x)), x.copy()
        for n in range(1, ORDERS + 1):  # Bonnet's recursion
            if n % 2:
                sum_of += now * (self.a[layer, n - 1] * (r / outer) ** n + self.b[layer, n - 1] * (inner / r) ** (n + 1))
            before, now = now, ((2 * n + 1) * x * now - n * before) / (n + 1)
        return sum_of


def areas_of(points, faces):
    p = points[faces]
    return 0.5 * np.linalg.norm(np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]), axis=1)


def shared_areas(points, faces):
    """Each point's third of the faces around it."""
    return np.bincount(faces.ravel(), np.repeat(areas_of(points, faces) / 3, 3), len(points))


def faces_of(tets, labels):
    """Faces between tetrahedra of different labels, and of one tetrahedron: (faces, lesser label, greater label), 0 being outside."""
    faces = np.sort(tets[:, [[1, 2, 3], [0, 2, 3], [0, 1, 3], [0, 1, 2]]].reshape(-1, 3), axis=1)
    of = np.repeat(labels, 4)
    order = np.lexsort(faces.T)
    faces, of = faces[order], of[order]
    same = np.append((faces[1:] == faces[:-1]).all(axis=1), False)
    first, second = np.flatnonzero(same), np.flatnonzero(same) + 1
    lone = np.flatnonzero(~(same | np.insert(same[:-1], 0, False)))
    between = np.concatenate([first[of[first] != of[second]], lone])
    other = np.concatenate([of[second[of[first] != of[second]]], np.zeros(len(lone), of.dtype)])
    return faces[between], np.minimum(of[between], other), np.maximum(of[between], other)


def through_cap(points, faces, sphere, side, parts=8):
    """Current into each point of what comes evenly through the cap around side * axis: faces on its rim count by the parts that lie in it."""
    step = np.arange(parts)
    i, j = (k.ravel() for k in np.meshgrid(step, step))
    up, down = i + j < parts, i + j < parts - 1
    at = np.concatenate([np.stack([i + 1 / 3, j + 1 / 3], 1)[up], np.stack([i + 2 / 3, j + 2 / 3], 1)[down]]) / parts
    weights = np.column_stack([1 - at.sum(axis=1), at])
    places = np.einsum("qk,fkd->fqd", weights, points[faces])
    within = places @ (side * sphere.axis) > np.cos(sphere.half_angle) * np.linalg.norm(places, axis=2)
    share = areas_of(points, faces)[:, None] / len(weights) * within @ weights
    load = np.bincount(faces.ravel(), share.ravel(), len(points))
    return load / load.sum()


def gradients_of(points, tets):
    """Of the four linear functions of each element, and the volumes."""
    edges = points[tets[:, 1:]] - points[tets[:, :1]]
    inner = np.linalg.inv(edges).transpose(0, 2, 1)
    return np.concatenate([-inner.sum(axis=1, keepdims=True), inner], axis=1), np.abs(np.linalg.det(edges)) / 6


def stiffness(size, tets, gradients, weights):
    """Of linear elements; a weight is volume times conductivity."""
    elements = gradients @ gradients.transpose(0, 2, 1) * weights[:, None, None]
    rows, columns = np.repeat(tets, 4, axis=1), np.tile(tets, (1, 4))
    return coo_matrix((elements.ravel(), (rows.ravel(), columns.ravel())), (size, size)).tocsr()


def solved(matrix, load, tolerance=1e-9):
    """Conjugate gradients with Jacobi's preconditioner: (potential up to a constant, iterations)."""
    count = [0]

    def counted(_):
        count[0] += 1
    potential, status = cg(matrix, load, tol=tolerance, maxiter=20000, M=diags(1 / matrix.diagonal()), callback=counted)
    if status != 0:
        raise SystemExit("conjugate gradients did not converge")
    return potential, count[0]
