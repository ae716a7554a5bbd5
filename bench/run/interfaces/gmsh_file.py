import math
import gmsh

gmsh.initialize()
gmsh.option.setNumber("General.Terminal", 0)
gmsh.merge("samples/gear.stl")
gmsh.model.mesh.classifySurfaces(math.radians(40), True, True)
gmsh.model.mesh.createGeometry()
surfaces = [tag for _, tag in gmsh.model.getEntities(2)]
gmsh.model.geo.addVolume([gmsh.model.geo.addSurfaceLoop(surfaces)])
gmsh.model.geo.synchronize()
gmsh.option.setNumber("Mesh.MeshSizeMin", 2)
gmsh.option.setNumber("Mesh.MeshSizeMax", 2)
gmsh.model.mesh.generate(3)
_, coordinates, _ = gmsh.model.mesh.getNodes()
_, _, nodes = gmsh.model.mesh.getElements(3)
gmsh.write("gmsh.vtk")
print(len(coordinates) // 3, len(nodes[0]) // 4)
gmsh.finalize()
