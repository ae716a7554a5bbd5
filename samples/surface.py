"""Triangle surfaces: building, checking and writing them."""
import math
import struct


def sub(a, b):
    return tuple(x - y for x, y in zip(a, b))


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def unit(a):
    length = math.sqrt(dot(a, a))
    return tuple(x / length for x in a)


class Surface:
    """Points, triangles (counter-clockwise from outside) and a patch name for each triangle."""

    def __init__(self):
        self.points, self.triangles, self.patches = [], [], []

    def add_point(self, p):
        self.points.append(tuple(p))
        return len(self.points) - 1

    def add_triangle(self, a, b, c, patch="surface"):
        self.triangles.append((a, b, c))
        self.patches.append(patch)

    def add_quad(self, a, b, c, d, patch="surface"):
        """Divided along the shorter diagonal."""
        p = self.points
        if math.dist(p[a], p[c]) <= math.dist(p[b], p[d]):
            self.add_triangle(a, b, c, patch)
            self.add_triangle(a, c, d, patch)
        else:
            self.add_triangle(a, b, d, patch)
            self.add_triangle(b, c, d, patch)

    def append(self, other, inside_out=False):
        shift = len(self.points)
        self.points += other.points
        for (a, b, c), patch in zip(other.triangles, other.patches):
            if inside_out:
                b, c = c, b
            self.add_triangle(a + shift, b + shift, c + shift, patch)


def volume(s):
    total = 0
    for a, b, c in s.triangles:
        (ax, ay, az), (bx, by, bz), (cx, cy, cz) = s.points[a], s.points[b], s.points[c]
        total += ax * (by * cz - bz * cy) + ay * (bz * cx - bx * cz) + az * (bx * cy - by * cx)
    return total / 6


def check(s):
    """Closed, 2-manifold at edges and vertices, outward, every point used."""
    edges = set()
    around = {}
    for t in s.triangles:
        for k in range(3):
            a, b, c = t[k], t[(k + 1) % 3], t[(k + 2) % 3]
            assert a != b and (a, b) not in edges, "an edge is used twice in one direction"
            edges.add((a, b))
            around.setdefault(a, {})[b] = c
    assert all((b, a) in edges for a, b in edges), "the surface is open"
    for fan in around.values():
        start = at = next(iter(fan))
        length = 0
        while True:
            at = fan[at]
            length += 1
            if at == start:
                break
        assert length == len(fan), "the triangles at a vertex form more than one fan"
    assert len(around) == len(s.points), "a point is unused"
    assert len(set(s.points)) == len(s.points), "two points are equal"
    assert volume(s) > 0, "the surface is inside out"


def number(x):
    """Five decimals are a hundredth of a micrometre."""
    text = f"{x:.5f}".rstrip("0").rstrip(".")
    return "0" if text == "-0" else text


def write_stl(s, name):
    with open(name, "wb") as f:
        f.write(b"bracket, millimetres".ljust(80) + struct.pack("<I", len(s.triangles)))
        for t in s.triangles:
            a, b, c = (s.points[v] for v in t)
            n = cross(sub(b, a), sub(c, a))
            f.write(struct.pack("<12fH", *unit(n), *a, *b, *c, 0))


def write_obj(s, name):
    with open(name, "w") as f:
        f.write("# millimetres\n")
        for p in s.points:
            f.write("v " + " ".join(map(number, p)) + "\n")
        for patch in dict.fromkeys(s.patches):
            f.write(f"g {patch}\n")
            for t, its in zip(s.triangles, s.patches):
                if its == patch:
                    f.write("f " + " ".join(str(v + 1) for v in t) + "\n")


def write_off(s, name):
    with open(name, "w") as f:
        f.write(f"OFF\n# millimetres\n{len(s.points)} {len(s.triangles)} 0\n")
        for p in s.points:
            f.write(" ".join(map(number, p)) + "\n")
        for t in s.triangles:
            f.write("3 " + " ".join(map(str, t)) + "\n")


def write_ply(s, name, byte_order="little"):
    order = "<" if byte_order == "little" else ">"
    names = list(dict.fromkeys(s.patches))
    with open(name, "wb") as f:
        header = ["ply", f"format binary_{byte_order}_endian 1.0", "comment millimetres"]
        header += [f"comment patch {k} {patch}" for k, patch in enumerate(names)] if len(names) > 1 else []
        header += [f"element vertex {len(s.points)}", "property float x", "property float y", "property float z",
                   f"element face {len(s.triangles)}", "property list uchar ushort vertex_indices"]
        header += ["property uchar patch"] if len(names) > 1 else []
        f.write(("\n".join(header + ["end_header"]) + "\n").encode())
        for p in s.points:
            f.write(struct.pack(order + "3f", *p))
        for t, patch in zip(s.triangles, s.patches):
            f.write(struct.pack(order + "B3H", 3, *t))
            if len(names) > 1:
                f.write(bytes([names.index(patch)]))
