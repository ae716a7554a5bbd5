"""The workbench in FreeCAD's window: a mesh object by the command, its panel, a run that ends and one that is stopped. Started by freecad_test.py."""
import gc
import json
import os
import pathlib
import traceback

import FreeCAD
import FreeCADGui
import Part
from PySide import QtCore

SCRATCH = pathlib.Path(os.environ["OCTAFRONT_SCRATCH"])
WAIT = 200  # milliseconds between looks
told = {}


def leave(name="", error=""):
    if name:
        told[name] = error
    (SCRATCH / "told.json").write_text(json.dumps(told))
    os._exit(0)


class Story:
    """Steps, each begun when what the one before started has ended."""

    def __init__(self):
        self.steps = [self.open_panel, self.mesh, self.stop, self.close, self.add_size, self.keep]
        self.timer = QtCore.QTimer()
        self.timer.timeout.connect(self.go_on)
        self.looks = 0

    def go_on(self):
        self.looks += 1
        if self.looks > 600:
            leave("time", "it never ended")
        if getattr(self, "panel", None) is not None and self.panel.is_running():
            return
        step = self.steps[0]
        try:
            step()
            told[step.__name__] = ""
        except Exception:
            leave(step.__name__, traceback.format_exc())
        self.steps.pop(0)
        if not self.steps:
            leave()

    def open_panel(self):
        FreeCADGui.activateWorkbench("OctafrontWorkbench")
        assert FreeCADGui.activeWorkbench().name() == "OctafrontWorkbench"
        import FemGui
        import ObjectsFem
        self.doc = FreeCAD.newDocument("window")
        part = self.doc.addObject("Part::Feature", "Body")
        part.Shape = Part.makeBox(10, 10, 10).cut(Part.makeCylinder(2, 12, FreeCAD.Vector(5, 5, -1)))
        analysis = ObjectsFem.makeAnalysis(self.doc, "Analysis")
        FemGui.setActiveAnalysis(analysis)
        FreeCADGui.Selection.addSelection(part)
        FreeCADGui.runCommand("Octafront_MeshFromShape")
        self.object = self.doc.getObject("Body_Mesh")
        assert self.object in analysis.Group
        from octafront_fem.gui import panel
        self.panel = next(found for found in gc.get_objects() if isinstance(found, panel.Panel))
        assert self.panel.start.isEnabled() and not self.panel.halt.isEnabled()
        self.panel.size.setProperty("rawValue", 1.5)
        self.panel.start.click()
        assert self.panel.is_running() and self.panel.halt.isEnabled()

    def mesh(self):
        assert self.object.FemMesh.VolumeCount > 1000, self.panel.text.toPlainText()
        assert "tetrahedra" in self.panel.text.toPlainText() and self.object.CharacteristicLengthMax.Value == 1.5
        self.count = self.object.FemMesh.VolumeCount
        self.panel.size.setProperty("rawValue", .1)
        self.panel.start.click()
        QtCore.QTimer.singleShot(700, self.panel.halt.click)

    def stop(self):
        assert "stopped" in self.panel.text.toPlainText(), self.panel.text.toPlainText()
        assert self.object.FemMesh.VolumeCount == self.count
        self.panel.options.setText("--no-such")
        self.panel.start.click()

    def close(self):
        assert "no-such" in self.panel.text.toPlainText()
        self.panel.options.setText("")
        self.panel.size.setProperty("rawValue", 2.0)
        self.panel.accept()

    def add_size(self):
        assert self.object.CharacteristicLengthMax.Value == 2 and not FreeCADGui.Control.activeDialog()
        body = self.doc.getObject("Body")
        FreeCADGui.Selection.clearSelection()
        FreeCADGui.Selection.addSelection(body, "Face3")
        FreeCADGui.runCommand("Octafront_Size")
        region, = self.object.MeshRegionList
        assert FreeCADGui.Control.activeDialog() and region.References == [(body, ("Face3",))], region.References
        FreeCADGui.ActiveDocument.resetEdit()
        assert region in self.object.ViewObject.Proxy.claimChildren()

    def keep(self):
        self.doc.saveAs(str(SCRATCH / "window.FCStd"))
        FreeCAD.closeDocument("window")
        again = FreeCAD.openDocument(str(SCRATCH / "window.FCStd")).getObject("Body_Mesh")
        assert again.FemMesh.VolumeCount == self.count and again.ViewObject.Proxy is not None


story = Story()
story.timer.start(WAIT)
