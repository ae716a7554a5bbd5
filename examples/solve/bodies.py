"""The bodies of the solved examples, as OBJ files whose groups become the sets that loads and supports are put on."""
import math
import struct


class Body:
    """Points that are shared by place, and polygons in named groups, counter-clockwise from outside."""

    def __init__(self):
        self.points, self.index, self.groups = [], {}, {}

    def point(self, *p):
        key = tuple(round(x, 9) for x in p)
        if key not in self.index:
            self.index[key] = len(self.points) + 1
            self.points.append(p)
        return self.index[key]

    def polygon(self, group, *corners):
        ids = [self.point(*p) for p in corners]
        ids = [v for k, v in enumerate(ids) if v != ids[k - 1]]
        if len(ids) > 2:
            self.groups.setdefault(group, []).append(ids)

    def grid(self, group, place, us, vs):
        """Quadrangles of place(u, v), counter-clockwise in the plane of u and v."""
        for u, u2 in zip(us, us[1:]):
            for v, v2 in zip(vs, vs[1:]):
                self.polygon(group, place(u, v), place(u2, v), place(u2, v2), place(u, v2))

    def write(self, path):
        with open(path, "w") as out:
            for p in self.points:
                out.write("v {!r} {!r} {!r}\n".format(*map(float, p)))
            for group, polygons in self.groups.items():
                out.write(f"g {group}\n")
                for ids in polygons:
                    out.write("f " + " ".join(map(str, ids)) + "\n")


def steps(lo, hi, n):
    return [lo + (hi - lo) * k / n for k in range(n + 1)]


def box(lo, hi, names, divisions=(1, 1, 1)):
    """names: of the sides x0, x1, y0, y1, z0, z1."""
    (x, y, z), (a, b, c) = lo, hi
    xs, ys, zs = steps(x, a, divisions[0]), steps(y, b, divisions[1]), steps(z, c, divisions[2])
    body = Body()
    body.grid(names[0], lambda u, v: (x, v, u), zs, ys)
    body.grid(names[1], lambda u, v: (a, u, v), ys, zs)
    body.grid(names[2], lambda u, v: (u, y, v), xs, zs)
    body.grid(names[3], lambda u, v: (v, b, u), zs, xs)
    body.grid(names[4], lambda u, v: (v, u, z), ys, xs)
    body.grid(names[5], lambda u, v: (u, v, c), xs, ys)
    return body


def voxels(path, size, value):
    """An image of NIfTI-1, millimetre voxels, with the whole number value(i, j, k)."""
    header = bytearray(352)
    struct.pack_into("<i", header, 0, 348)
    struct.pack_into("<8h", header, 40, 3, *size, 1, 1, 1, 1)
    struct.pack_into("<hh", header, 70, 4, 16)
    struct.pack_into("<8f", header, 76, 1, 1, 1, 1, 1, 1, 1, 1)
    struct.pack_into("<f", header, 108, 352)
    struct.pack_into("<h", header, 254, 1)
    for row in range(3):
        struct.pack_into("<f", header, 280 + 20 * row, 1)
    header[344:348] = b"n+1\0"
    places = [(i, j, k) for k in range(size[2]) for j in range(size[1]) for i in range(size[0])]
    path.write_bytes(bytes(header) + struct.pack(f"<{len(places)}h", *(value(*p) for p in places)))


def quarter_pipe(inner, outer, height, n):
    """A quarter of a thick-walled cylinder about the z axis; n facets along the quarter circles."""
    angles = steps(0, math.pi / 2, n)
    # Exactly on the planes of symmetry at both ends.
    circle = {t: (math.cos(t), math.sin(t)) for t in angles}
    circle[angles[0]], circle[angles[-1]] = (1.0, 0.0), (0.0, 1.0)

    def at(r, t, z):
        return (r * circle[t][0], r * circle[t][1], z)

    body = Body()
    radii, heights = [inner, outer], [0.0, height]
    body.grid("inner", lambda z, t: at(inner, t, z), heights, angles)
    body.grid("outer", lambda t, z: at(outer, t, z), angles, heights)
    body.grid("bottom", lambda t, r: at(r, t, 0.0), angles, radii)
    body.grid("top", lambda r, t: at(r, t, height), radii, angles)
    body.grid("plane_y", lambda r, z: at(r, angles[0], z), radii, heights)
    body.grid("plane_x", lambda z, r: at(r, angles[-1], z), heights, radii)
    return body


def octant_shells(radii, names, n):
    """An eighth of concentric spheres with the layers between them, walls included: names[k] is the sphere of radii[k], the planes of
    symmetry are plane_x, plane_y and plane_z. n facets along the quarter circles."""

    def at(r, i, j):
        direction = (float(i), float(j), float(n - i - j))
        length = math.hypot(*direction)
        return tuple(r * x / length for x in direction)

    body = Body()
    for r, name in zip(radii, names):
        for i in range(n):
            for j in range(n - i):
                body.polygon(name, at(r, i, j), at(r, i + 1, j), at(r, i, j + 1))
                if i + j + 2 <= n:
                    body.polygon(name, at(r, i + 1, j), at(r, i + 1, j + 1), at(r, i, j + 1))
    quarters = {"plane_x": lambda r, k: at(r, 0, k), "plane_y": lambda r, k: at(r, n - k, 0),
                "plane_z": lambda r, k: at(r, k, n - k)}
    for name, place in quarters.items():
        body.grid(name, place, radii, range(n + 1))
    return body
