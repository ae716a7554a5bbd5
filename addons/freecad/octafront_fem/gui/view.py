"""How the mesh object looks in the tree, and what a double click does."""
import pathlib

import FreeCADGui

from ..properties import Unsaved

ICON = str(pathlib.Path(__file__).resolve().parents[2] / "resources" / "octafront.svg")


class ViewOfMesh(Unsaved):
    def __init__(self, view):
        view.Proxy = self

    def getIcon(self):
        return ICON

    def attach(self, view):
        self.ViewObject, self.Object = view, view.Object

    def setEdit(self, view, mode=0):
        from . import panel
        FreeCADGui.Control.showDialog(panel.Panel(view.Object))
        return True

    def unsetEdit(self, view, mode=0):
        FreeCADGui.Control.closeDialog()
        return True

    def doubleClicked(self, view):
        view.Document.setEdit(view)
        return True

    def claimChildren(self):
        mesh = self.Object
        return mesh.MeshRegionList + mesh.MeshGroupList + mesh.MeshBoundaryLayerList
