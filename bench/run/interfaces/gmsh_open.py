import math
import gmsh
import numpy as np
from model import points, triangles

triangles = triangles[3:]  # three triangles are missing
gmsh.initialize()
gmsh.option.setNumber("General.Terminal", 0)
gmsh.model.addDiscreteEntity(2, 1)
gmsh.model.mesh.addNodes(2, 1, np.arange(1, len(points) + 1), points.ravel())
gmsh.model.mesh.addElementsByType(1, 2, [], triangles.ravel() + 1)
gmsh.model.mesh.classifySurfaces(math.pi, True, True)
gmsh.model.mesh.createGeometry()
surfaces = [tag for _, tag in gmsh.model.getEntities(2)]
gmsh.model.geo.addVolume([gmsh.model.geo.addSurfaceLoop(surfaces)])
gmsh.model.geo.synchronize()
gmsh.option.setNumber("Mesh.MeshSizeMax", 0.2)
gmsh.model.mesh.generate(3)
