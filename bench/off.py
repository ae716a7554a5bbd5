"""Surfaces as OFF files."""


def read_off(path):
    """(points, triangles); polygons as fans. No colours."""
    words = [word for line in open(path, errors="replace") for word in line.partition("#")[0].split()]
    if not words or words[0] != "OFF":
        raise ValueError(f"{path}: no OFF file of points and faces")
    n, m = int(words[1]), int(words[2])
    numbers = list(map(float, words[4:4 + 3 * n]))
    triangles, at = [], 4 + 3 * n
    for _ in range(m):
        corners = [int(word) for word in words[at + 1:at + 1 + int(words[at])]]
        at += 1 + int(words[at])
        triangles += [(corners[0], b, c) for b, c in zip(corners[1:], corners[2:])]
    return list(zip(numbers[::3], numbers[1::3], numbers[2::3])), triangles


def write_off(path, points, faces):
    """All digits: reading gives the same bits. Faces of three corners or more."""
    with open(path, "w", encoding="ascii") as out:
        out.write(f"OFF\n{len(points)} {len(faces)} 0\n")
        out.writelines("{!r} {!r} {!r}\n".format(*map(float, point)) for point in points)
        out.writelines(f"{len(face)} {' '.join(map(str, face))}\n" for face in faces)
