"""Triangle surfaces as OFF files, and what the peers want them as."""
import math
import struct


def read_off(path):
    """(points, triangles) of an OFF file with triangles only."""
    words = iter(open(path).read().split())
    if next(words) != "OFF":
        raise ValueError(f"{path} is not an OFF file")
    points, faces, _ = int(next(words)), int(next(words)), next(words)
    xyz = [(float(next(words)), float(next(words)), float(next(words))) for _ in range(points)]
    triangles = []
    for _ in range(faces):
        if next(words) != "3":
            raise ValueError(f"{path} has faces that are not triangles")
        triangles.append((int(next(words)), int(next(words)), int(next(words))))
    return xyz, triangles


def mean_edge(points, triangles):
    total = 0.0
    for a, b, c in triangles:
        total += math.dist(points[a], points[b]) + math.dist(points[b], points[c]) + math.dist(points[c], points[a])
    return total / (3 * len(triangles))


def write_msh(path, points, triangles):
    """MSH 2.2 with all triangles in surface 1, as gmsh merges it."""
    with open(path, "w") as f:
        f.write(f"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{len(points)}\n")
        f.writelines(f"{i} {x!r} {y!r} {z!r}\n" for i, (x, y, z) in enumerate(points, 1))
        f.write(f"$EndNodes\n$Elements\n{len(triangles)}\n")
        f.writelines(f"{i} 2 2 1 1 {a + 1} {b + 1} {c + 1}\n" for i, (a, b, c) in enumerate(triangles, 1))
        f.write("$EndElements\n")


def write_medit(path, points, triangles, tets):
    with open(path, "w") as f:
        f.write(f"MeshVersionFormatted 2\nDimension 3\nVertices\n{len(points)}\n")
        f.writelines(f"{x!r} {y!r} {z!r} 0\n" for x, y, z in points)
        f.write(f"Triangles\n{len(triangles)}\n")
        f.writelines(f"{a + 1} {b + 1} {c + 1} 1\n" for a, b, c in triangles)
        f.write(f"Tetrahedra\n{len(tets)}\n")
        f.writelines(f"{a + 1} {b + 1} {c + 1} {d + 1} 1\n" for a, b, c, d in tets)
        f.write("End\n")


def write_stl(path, points, triangles):
    """Binary STL; normals are left to the reader."""
    with open(path, "wb") as f:
        f.write(bytes(80) + struct.pack("<I", len(triangles)))
        for triangle in triangles:
            f.write(struct.pack("<12fH", 0, 0, 0, *(x for corner in triangle for x in points[corner]), 0))
