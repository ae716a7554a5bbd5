import octafront

mesh = octafront.mesh_file("samples/gear.obj", size=2)
mesh.save("octafront.vtu")
print(len(mesh.points), len(mesh.tets))
