"""3D Slicer: a mesh of tetrahedra of a segmentation, a region for each segment.

What runs the program is in octafront_segmentation.py, which is tested without Slicer. This file, what Slicer shows of it, was never run: no Slicer was
at hand.
"""
import os
import tempfile

import ctk
import qt
import slicer
from slicer.ScriptedLoadableModule import ScriptedLoadableModule, ScriptedLoadableModuleLogic, ScriptedLoadableModuleWidget

import octafront_program as program
from octafront_segmentation import Segmentation


class Octafront(ScriptedLoadableModule):
    def __init__(self, parent):
        super().__init__(parent)
        parent.title = "Octafront"
        parent.categories = ["Segmentation", "Surface Models"]
        parent.dependencies = ["Segmentations"]
        parent.contributors = ["The Octafront authors"]
        parent.helpText = "Meshes of tetrahedra of segmentations, a region for each segment, by the program octafront."
        parent.acknowledgementText = ""


class OctafrontWidget(ScriptedLoadableModuleWidget):
    def setup(self):
        super().setup()
        box = ctk.ctkCollapsibleButton()
        box.text = "Mesh"
        self.layout.addWidget(box)
        rows = qt.QFormLayout(box)
        self.segmentation = slicer.qMRMLNodeComboBox()
        self.segmentation.nodeTypes = ["vtkMRMLSegmentationNode"]
        self.segmentation.setMRMLScene(slicer.mrmlScene)
        self.size = ctk.ctkDoubleSpinBox()
        self.size.minimum, self.size.maximum, self.size.value, self.size.suffix = 0, 1000, 3, " mm"
        self.options = qt.QLineEdit()
        self.options.toolTip = "Further options of octafront mesh: order=2 preset=head"
        self.program = ctk.ctkPathLineEdit()
        self.program.toolTip = "The program octafront, where it is not in PATH"
        self.start, self.bar = qt.QPushButton("Mesh"), qt.QProgressBar()
        for label, field in (("Segmentation", self.segmentation), ("Edge length", self.size), ("Options", self.options), ("Program", self.program)):
            rows.addRow(label, field)
        rows.addRow(self.start)
        rows.addRow(self.bar)
        self.bar.visible, self.cancel = False, False
        self.start.connect("clicked()", self.mesh)
        self.layout.addStretch(1)

    def mesh(self):
        if self.bar.visible:
            self.cancel = True
            return
        self.cancel, self.bar.visible, self.start.text = False, True, "Stop"
        try:
            options = {name: value or True for name, _, value in (word.partition("=") for word in self.options.text.split())}
            if self.size.value > 0:
                options["size"] = self.size.value
            OctafrontLogic().mesh(self.segmentation.currentNode(), options, self.program.currentPath, self.tell, self.is_cancelled)
        except program.Cancelled:
            pass
        except (program.Refused, program.Failed) as error:
            slicer.util.errorDisplay(str(error))
        finally:
            self.bar.visible, self.start.text = False, "Mesh"

    def tell(self, stage, fraction):
        self.bar.maximum = 0 if fraction < 0 else 1000
        self.bar.value, self.bar.format = int(1000 * max(fraction, 0)), stage + " %p %"

    def is_cancelled(self):
        slicer.app.processEvents()
        return self.cancel


class OctafrontLogic(ScriptedLoadableModuleLogic):
    def mesh(self, segmentation, options, executable="", progress=None, cancelled=None):
        """A model node with the mesh; what its regions are called is in its description."""
        if segmentation is None:
            raise program.Refused("choose a segmentation")
        with tempfile.TemporaryDirectory(prefix="octafront-") as folder:
            file = os.path.join(folder, "segmentation.seg.nrrd")
            if not slicer.util.saveNode(segmentation, file):
                raise program.Refused(f"{segmentation.GetName()} cannot be written")
            grid, names, report = Segmentation(file, **options).mesh(executable, progress, cancelled)
        node = slicer.mrmlScene.AddNewNodeByClass("vtkMRMLModelNode", segmentation.GetName() + " mesh")
        node.SetAndObserveMesh(grid)
        node.SetDescription(", ".join(f"region {number}: {name}" for number, name in sorted(names.items())))
        node.CreateDefaultDisplayNodes()
        node.GetDisplayNode().SetActiveScalarName("region")
        node.GetDisplayNode().SetScalarVisibility(True)
        return node
