"""Triangle surfaces as OFF files, and what the peers want them as."""
import math
import struct


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


def boundary_of_medit(path):
    """(points, triangles) of the boundary of a mesh that Octafront wrote as MEDIT; only points that are used."""
    words = open(path).read().split()
    vertices, faces = words.index("Vertices"), words.index("Triangles")
    corners = words[faces + 2:faces + 2 + 4 * int(words[faces + 1])]
    triangles = [tuple(int(v) - 1 for v in corners[i:i + 3]) for i in range(0, len(corners), 4)]
    number = {v: i for i, v in enumerate(sorted({v for t in triangles for v in t}))}
    points = [tuple(map(float, words[vertices + 2 + 4 * v:vertices + 5 + 4 * v])) for v in number]
    return points, [tuple(number[v] for v in t) for t in triangles]
