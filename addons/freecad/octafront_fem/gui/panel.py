"""The task panel: sizes, order, one button that meshes and one that stops."""
import FreeCADGui
import FemGui
from PySide import QtCore, QtGui

from .. import program
from ..properties import ORDERS, PRESETS
from .runner import Runner


def active_analysis(mesh):
    """The one that holds the mesh."""
    analysis = FemGui.getActiveAnalysis()
    return analysis if analysis is not None and mesh in analysis.Group else next((o for o in mesh.InList if o.isDerivedFrom("Fem::FemAnalysis")), None)


def quantity(value):
    field = FreeCADGui.UiLoader().createWidget("Gui::QuantitySpinBox")
    field.setProperty("unit", "mm")
    field.setProperty("minimum", 0.0)
    field.setProperty("rawValue", value.Value)
    return field


def choice(all_of_them, chosen):
    field = QtGui.QComboBox()
    field.addItems(all_of_them)
    field.setCurrentText(chosen)
    return field


def count(value):
    field = QtGui.QSpinBox()
    field.setRange(0, 2_000_000_000)
    field.setGroupSeparatorShown(True)
    field.setSpecialValueText("as sizes say")
    field.setValue(value)
    return field


class Panel:
    """What FreeCAD's task view shows."""

    def __init__(self, mesh):
        self.mesh, self.runner = mesh, None
        self.form = QtGui.QWidget()
        self.form.setWindowTitle("Mesh by Octafront")
        self.size, self.least = quantity(mesh.CharacteristicLengthMax), quantity(mesh.CharacteristicLengthMin)
        self.elements, self.order = count(mesh.Elements), choice(ORDERS, mesh.ElementOrder)
        self.preset, self.options = choice(PRESETS, mesh.Preset), QtGui.QLineEdit(" ".join(mesh.Options))
        self.start, self.halt = QtGui.QPushButton("Mesh"), QtGui.QPushButton("Stop")
        self.bar, self.text = QtGui.QProgressBar(), QtGui.QPlainTextEdit()
        self.lay_out()
        self.start.clicked.connect(self.run)
        self.halt.clicked.connect(lambda: self.runner.stop())
        self.show_running(False)
        self.text.setPlainText("\n".join(mesh.Told))

    def lay_out(self):
        rows = QtGui.QFormLayout(self.form)
        for label, field, tip in (("Edge length", self.size, "0: automatic, by curvature and thickness"), ("At least", self.least, "0: no bound"),
                                  ("Elements", self.elements, "met within 15 %"), ("Order", self.order, ""),
                                  ("Automatic sizes", self.preset, "draft: about a quarter of the elements; fine: eight times as many"),
                                  ("Options", self.options, "further ones of octafront mesh, such as --through=2")):
            field.setToolTip(tip)
            rows.addRow(label, field)
        buttons = QtGui.QHBoxLayout()
        buttons.addWidget(self.start)
        buttons.addWidget(self.halt)
        rows.addRow(buttons)
        rows.addRow(self.bar)
        self.text.setReadOnly(True)
        rows.addRow(self.text)

    def getStandardButtons(self):
        return int(QtGui.QDialogButtonBox.Ok | QtGui.QDialogButtonBox.Cancel)

    def set_properties(self):
        mesh = self.mesh
        mesh.CharacteristicLengthMax, mesh.CharacteristicLengthMin = self.size.property("rawValue"), self.least.property("rawValue")
        mesh.Elements, mesh.ElementOrder, mesh.Preset = self.elements.value(), self.order.currentText(), self.preset.currentText()
        mesh.Options = self.options.text().split()

    def show_running(self, running):
        self.start.setEnabled(not running)
        self.halt.setEnabled(running)
        self.bar.setVisible(running)

    def run(self):
        self.set_properties()
        self.text.setPlainText("")
        runner = Runner(self.mesh, active_analysis(self.mesh), self.form)
        runner.progressed.connect(self.tell)
        runner.ended.connect(lambda notes: self.end("\n".join(notes)))
        runner.failed.connect(self.end)
        runner.cancelled.connect(lambda: self.end("stopped; the mesh is as it was"))
        try:
            runner.start()
        except program.Refused as error:
            self.end(str(error))
            return
        self.runner = runner
        self.show_running(True)

    def tell(self, stage, fraction):
        self.bar.setRange(0, 0 if fraction < 0 else 1000)
        self.bar.setValue(int(1000 * max(fraction, 0)))
        self.bar.setFormat(f"{stage} %p %")

    def end(self, text):
        self.runner = None
        self.show_running(False)
        self.text.setPlainText(text)

    def is_running(self):
        return self.runner is not None and self.runner.is_running()

    def leave(self):
        if self.is_running():
            process = self.runner.process
            self.runner.stop()
            process.waitForFinished(1000 * program.PATIENCE)
        # Later, for this panel is what FreeCAD still works on.
        QtCore.QTimer.singleShot(0, self.mesh.ViewObject.Document.resetEdit)
        self.mesh.Document.recompute()
        return True

    def accept(self):
        self.set_properties()
        return self.leave()

    def reject(self):
        return self.leave()
