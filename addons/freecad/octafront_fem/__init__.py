"""Meshes of tetrahedra in FreeCAD's FEM workbench, by the program octafront.

    import octafront_fem
    mesh = octafront_fem.make_mesh(part, size=5)      # a FEM mesh object beside a body, compound, ...
    octafront_fem.mesh_shape(mesh, analysis)          # fills its FemMesh, with groups for what the analysis refers to

Neither needs FreeCAD's window. Errors are octafront_fem.Refused (a body that cannot be told to the program, or a
setting), Failed (the program ended without a mesh; `report` is what it wrote) and Cancelled.
"""
from .meshing import Meshing, mesh_shape
from .program import Cancelled, Failed, Refused
from .properties import make_mesh

__all__ = ["Cancelled", "Failed", "Meshing", "Refused", "make_mesh", "mesh_shape"]
