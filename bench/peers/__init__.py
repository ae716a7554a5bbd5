"""Other meshers, run on the same surfaces as ours: each module has functions that take an OFF surface and leave a mesh.

    outcome = tetgen.fill(surface, folder, timeout)      # the surface's triangles are kept
    outcome = gmsh.fill_hxt(surface, folder, timeout, optimize=True)
    outcome = netgen.fill(surface, folder, timeout)

All return an Outcome (process.py): times, memory, the mesh in a format that octafront_evaluate reads, or why there is none.
"""
