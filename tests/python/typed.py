"""What a type checker must accept and refuse: `mypy --strict` finds exactly the lines that say so."""

import numpy as np

import octafront

surface = octafront.Surface(np.zeros((3, 3)), [[0, 1, 2]])
mesh: octafront.Mesh = octafront.mesh(surface, size=0.5, method="octree", progress=lambda phase, fraction: True)
mesh = octafront.mesh(np.zeros((3, 3)), [[0, 1, 2]], size=lambda points: points[:, 0])
volume: float = mesh.quality["beta_min"]
field = octafront.size_field(surface, regions=[{"point": [0, 0, 0], "size": 1}])
sizes: float = field(mesh.points).max()
octafront.mesh("part.stl", size="2mm", unit="mm", max_deviation="0.1mm")
octafront.mesh(mesh, size=1), octafront.Surface.of(mesh)
octafront.improve("a.msh", surface=surface, improve="best").save("b.vtu")

octafront.mesh(surface, sise=0.5)  # error: call-arg
octafront.mesh(surface, elements="many")  # error: arg-type
octafront.mesh(surface, method="best")  # error: arg-type
octafront.surface(surface, core="none")  # error: call-arg
octafront.improve(surface)  # error: arg-type
mesh.points = np.zeros((3, 3))  # error: misc

shown: bytes = octafront.picture(mesh, "a.png", cut=(1, 0, 0), color="size", size=(300, 200))
octafront.picture("a.vtu", color="blue")  # error: arg-type
shown = mesh.picture(view="top")
