"""What stands in menus and toolbars."""
import FemGui
import FreeCAD
import FreeCADGui

from . import view


def selected_shape():
    """The first selected object that has a solid."""
    return next((o for o in FreeCADGui.Selection.getSelection() if getattr(o, "Shape", None) is not None and o.Shape.Solids), None)


class MeshFromShape:
    """A mesh object for what is selected, and its panel."""

    def GetResources(self):
        return {"Pixmap": view.ICON, "MenuText": "Mesh from shape by Octafront",
                "ToolTip": "Makes a mesh of tetrahedra of the body or compound that is selected, in the active analysis if there is one"}

    def IsActive(self):
        return FreeCAD.ActiveDocument is not None and selected_shape() is not None

    def Activated(self):
        part, analysis = selected_shape(), FemGui.getActiveAnalysis()
        FreeCAD.ActiveDocument.openTransaction("Mesh by Octafront")
        FreeCADGui.doCommand("import octafront_fem")
        FreeCADGui.doCommand(f"mesh = octafront_fem.make_mesh(FreeCAD.ActiveDocument.{part.Name}, {part.Name + '_Mesh'!r})")
        if analysis is not None and analysis.Document is part.Document:
            FreeCADGui.doCommand(f"FreeCAD.ActiveDocument.{analysis.Name}.addObject(mesh)")
        FreeCAD.ActiveDocument.commitTransaction()
        FreeCADGui.doCommand("FreeCADGui.ActiveDocument.setEdit(mesh.Name)")


class Size:
    """A size at selected faces, edges or points: FreeCAD's mesh region, for our mesh object."""

    def GetResources(self):
        return {"Pixmap": "FEM_MeshRegion", "MenuText": "Size at faces, edges, points",
                "ToolTip": "Adds a mesh region to the mesh by Octafront that is selected, or the only one; double-click it to pick faces"}

    def mesh(self):
        def is_ours(o):
            return getattr(getattr(o, "Proxy", None), "Type", "") == "Fem::FemMeshOctafront"
        chosen = [o for o in FreeCADGui.Selection.getSelection() if is_ours(o)] or [o for o in FreeCAD.ActiveDocument.Objects if is_ours(o)]
        return chosen[0] if len(chosen) == 1 else None

    def IsActive(self):
        return FreeCAD.ActiveDocument is not None and self.mesh() is not None

    def Activated(self):
        mesh, picked = self.mesh(), FreeCADGui.Selection.getSelectionEx()
        FreeCADGui.doCommand("import ObjectsFem")
        FreeCADGui.doCommand(f"region = ObjectsFem.makeMeshRegion(FreeCAD.ActiveDocument, FreeCAD.ActiveDocument.{mesh.Name})")
        places = [(p.ObjectName, tuple(p.SubElementNames)) for p in picked if p.Object != mesh and p.SubElementNames]
        if places:
            told = ", ".join(f"(FreeCAD.ActiveDocument.{name}, {names!r})" for name, names in places)
            FreeCADGui.doCommand(f"region.References = [{told}]")
        FreeCAD.ActiveDocument.recompute()
        FreeCADGui.doCommand("FreeCADGui.ActiveDocument.setEdit(region.Name)")


COMMANDS = {"Octafront_MeshFromShape": MeshFromShape, "Octafront_Size": Size}


def register():
    for name, command in COMMANDS.items():
        FreeCADGui.addCommand(name, command())
    return list(COMMANDS)
