"""OFF to binary STL, and to OFF of triangles, for programs that read nothing else: to_stl.py IN.off OUT.stl OUT.off"""
import struct
import sys

words = iter(" ".join(line.split("#")[0] for line in open(sys.argv[1])).split())
assert next(words) == "OFF"
vertices, faces, _ = int(next(words)), int(next(words)), next(words)
points = [tuple(float(next(words)) for _ in range(3)) for _ in range(vertices)]
triangles = []
for _ in range(faces):
    corners = [int(next(words)) for _ in range(int(next(words)))]
    triangles += [(corners[0], b, c) for b, c in zip(corners[1:], corners[2:])]
with open(sys.argv[2], "wb") as out:
    out.write(bytes(80) + struct.pack("<I", len(triangles)))
    for t in triangles:
        out.write(struct.pack("<12fH", 0, 0, 0, *(x for v in t for x in points[v]), 0))
with open(sys.argv[3], "w") as out:
    out.write(f"OFF\n{len(points)} {len(triangles)} 0\n")
    out.writelines("%.17g %.17g %.17g\n" % p for p in points)
    out.writelines("3 %d %d %d\n" % t for t in triangles)
