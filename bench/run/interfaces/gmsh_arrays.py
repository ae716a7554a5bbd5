import math
import gmsh
import numpy as np
from model import points, triangles

def size(dim, tag, x, y, z, *_):
    return 0.05 + 0.2 * math.dist((x, y, z), (1, 0, 0))

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
gmsh.option.setNumber("Mesh.MeshSizeExtendFromBoundary", 0)
gmsh.model.mesh.setSizeCallback(size)
gmsh.model.mesh.generate(3)
tags, coordinates, _ = gmsh.model.mesh.getNodes()
_, _, nodes = gmsh.model.mesh.getElements(3)
index = np.zeros(int(max(tags)) + 1, int)
index[np.array(tags, int)] = np.arange(len(tags))
print(np.reshape(coordinates, (-1, 3)).shape, index[np.array(nodes[0], int)].reshape(-1, 4).shape)
gmsh.finalize()
