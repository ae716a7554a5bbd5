"""A unit sphere."""
import numpy as np

rings, sectors = 24, 48
theta, phi = np.meshgrid(np.pi * np.arange(1, rings) / rings, 2 * np.pi * np.arange(sectors) / sectors, indexing="ij")
ring = np.stack([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)], axis=-1).reshape(-1, 3)
points = np.vstack([[0, 0, 1], ring, [0, 0, -1]])
at = 1 + np.arange(rings - 1)[:, None] * sectors + np.arange(sectors)
right, south = np.roll(at, -1, axis=1), len(points) - 1
triangles = np.vstack([
    np.stack([0 * at[0], at[0], right[0]], axis=-1),
    np.stack([at[:-1], at[1:], right[1:]], axis=-1).reshape(-1, 3),
    np.stack([at[:-1], right[1:], right[:-1]], axis=-1).reshape(-1, 3),
    np.stack([at[-1], 0 * at[-1] + south, right[-1]], axis=-1),
])
