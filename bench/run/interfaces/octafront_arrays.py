import numpy as np
import octafront
from model import points, triangles

def size(p):
    return 0.05 + 0.2 * np.linalg.norm(p - [1, 0, 0], axis=1)

mesh = octafront.mesh(points, triangles, size=size)
print(mesh.points.shape, mesh.tets.shape)
