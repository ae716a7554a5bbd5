"""Complexes of several regions: PLY files with the properties front and back, as bench/models/make-complexes.sh makes them and
octafront surface writes them; and what TetGen reads.
"""
import pathlib
import struct

from bench import off

# Types of PLY properties as struct has them.
TYPES = {"double": "d", "float": "f", "uint": "I", "int": "i", "uchar": "B"}


def read_ply(path):
    """(points, triangles, sides): two region numbers per triangle, in front and behind; -1 is outside."""
    data = pathlib.Path(path).read_bytes()
    head, _, body = data.partition(b"end_header\n")
    counts, kinds, element = {}, {}, None
    for words in (line.split() for line in head.decode().splitlines()):
        if words[0] == "element":
            element = words[1]
            counts[element], kinds[element] = int(words[2]), []
        elif words[0] == "property":
            kinds[element].append((words[-1], words[-2]))
    if b"binary_little_endian" not in head or kinds["face"][0] != ("vertex_indices", "uint"):
        raise ValueError(f"{path}: not a binary PLY file of triangles")
    point = struct.Struct("<" + "".join(TYPES[kind] for _, kind in kinds["vertex"]))
    face = struct.Struct("<B3I" + "".join(TYPES[kind] for _, kind in kinds["face"][1:]))
    names = [name for name, _ in kinds["face"][1:]]
    front, back = 4 + names.index("front"), 4 + names.index("back")
    split = counts["vertex"] * point.size
    points = [p[:3] for p in point.iter_unpack(body[:split])]
    faces = list(face.iter_unpack(body[split:split + counts["face"] * face.size]))
    return points, [f[1:4] for f in faces], [(f[front], f[back]) for f in faces]


def write_poly(path, points, triangles):
    """TetGen's .poly, a facet for each triangle."""
    with open(path, "w") as out:
        out.write(f"{len(points)} 3 0 0\n")
        out.writelines(f"{k} {x!r} {y!r} {z!r}\n" for k, (x, y, z) in enumerate(points, 1))
        out.write(f"{len(triangles)} 0\n")
        out.writelines(f"1 0\n3 {a + 1} {b + 1} {c + 1}\n" for a, b, c in triangles)
        out.write("0\n0\n")


def boundary_of(triangles, sides, region):
    """The triangles around a region, facing away from it; sheets left out."""
    out = [t for t, (front, back) in zip(triangles, sides) if back == region != front]
    return out + [(a, c, b) for (a, b, c), (front, back) in zip(triangles, sides) if front == region != back]


def write_off(path, points, triangles):
    """Of the points only those that are used."""
    used = {v: k for k, v in enumerate(sorted({v for t in triangles for v in t}))}
    off.write_off(path, [points[v] for v in used], [[used[v] for v in t] for t in triangles])


def volumes_of_sides(points, triangles, sides):
    """{region: volume} by the divergence theorem, each seen from a vertex of its own: far from it tiny regions would cancel."""
    origins, volumes = {}, {}
    for t, (front, back) in zip(triangles, sides):
        for region, sign in ((back, 1), (front, -1)):
            if region >= 0 and front != back:
                origin = origins.setdefault(region, points[t[0]])
                part = triple(*(minus(points[v], origin) for v in t)) / 6
                volumes[region] = volumes.get(region, 0.0) + sign * part
    return volumes


def volumes_of_medit(path):
    """{reference: volume} of the tetrahedra of a MEDIT file."""
    words = iter(pathlib.Path(path).read_text().split())
    points, volumes = [], {}
    for word in words:
        if word == "Vertices":
            for _ in range(int(next(words))):
                points.append((float(next(words)), float(next(words)), float(next(words))))
                next(words)
        elif word == "Tetrahedra":
            for _ in range(int(next(words))):
                a, b, c, d = (points[int(next(words)) - 1] for _ in range(4))
                reference = next(words)
                volumes[reference] = volumes.get(reference, 0.0) + abs(triple(*(minus(p, a) for p in (b, c, d)))) / 6
    return volumes


def minus(p, q):
    return tuple(x - y for x, y in zip(p, q))


def triple(a, b, c):
    return (a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0]))
