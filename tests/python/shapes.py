"""Small surfaces, as NumPy arrays."""

import numpy as np


def cube(side=1.0):
    points = side * np.array([[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)], dtype=float)
    triangles = np.array([[0, 2, 3], [0, 3, 1], [4, 5, 7], [4, 7, 6], [0, 1, 5], [0, 5, 4],
                          [2, 6, 7], [2, 7, 3], [0, 4, 6], [0, 6, 2], [1, 3, 7], [1, 7, 5]])
    return points, triangles


def sphere(rings=16, sectors=32, radius=1.0):
    theta = np.pi * np.arange(1, rings) / rings
    phi = 2 * np.pi * np.arange(sectors) / sectors
    t, p = np.meshgrid(theta, phi, indexing="ij")
    ring_points = np.stack([np.sin(t) * np.cos(p), np.sin(t) * np.sin(p), np.cos(t)], axis=-1).reshape(-1, 3)
    points = radius * np.vstack([[0, 0, 1], ring_points, [0, 0, -1]])
    triangles, south = [], len(points) - 1

    def at(ring, j):
        return 1 + (ring - 1) * sectors + j % sectors

    for j in range(sectors):
        triangles.append([0, at(1, j), at(1, j + 1)])
        for i in range(1, rings - 1):
            triangles.append([at(i, j), at(i + 1, j), at(i + 1, j + 1)])
            triangles.append([at(i, j), at(i + 1, j + 1), at(i, j + 1)])
        triangles.append([at(rings - 1, j), south, at(rings - 1, j + 1)])
    return points, np.array(triangles)
