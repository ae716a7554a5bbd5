"""The program beside FreeCAD's window, which stays alive meanwhile."""
from PySide import QtCore

from .. import program
from ..meshing import Meshing


class Runner(QtCore.QObject):
    """One run by QProcess. Signals: progressed(stage, fraction), ended(notes, a list), failed(message), cancelled()."""

    progressed = QtCore.Signal(str, float)
    ended = QtCore.Signal(list)
    failed = QtCore.Signal(str)
    cancelled = QtCore.Signal()

    def __init__(self, mesh, analysis, parent=None):
        super().__init__(parent)
        self.meshing, self.process, self.stopped = Meshing(mesh, analysis), QtCore.QProcess(self), False
        self.listener = program.Listener(self.progressed.emit)
        self.process.readyReadStandardError.connect(self._hear)
        self.process.finished.connect(self._take)
        self.process.errorOccurred.connect(self._not_started)

    def start(self):
        """Raises Refused."""
        try:
            executable, *arguments = self.meshing.prepare()
        except program.Refused:
            self.meshing.close()
            raise
        around = QtCore.QProcessEnvironment.systemEnvironment()
        around.insert("OCTAFRONT_PROGRESS", "lines")
        self.process.setProcessEnvironment(around)
        self.process.setStandardInputFile(QtCore.QProcess.nullDevice())
        self.process.setStandardOutputFile(QtCore.QProcess.nullDevice())
        self.process.start(executable, arguments)

    def is_running(self):
        return self.process.state() != QtCore.QProcess.NotRunning

    def stop(self):
        """Asks the program to end; it is ended if it does not. cancelled() comes then."""
        self.stopped = True
        self.process.terminate()
        patience = QtCore.QTimer(self)  # goes with this object
        patience.setSingleShot(True)
        patience.timeout.connect(self.process.kill)
        patience.start(1000 * program.PATIENCE)

    def _hear(self):
        while self.process.canReadLine():
            self.listener.hear(bytes(self.process.readLine()).decode("utf-8", "replace"))

    def _take(self, status, how):
        self.process.setReadChannel(QtCore.QProcess.StandardError)
        self._hear()
        try:
            if self.stopped:
                raise program.Cancelled
            if how == QtCore.QProcess.CrashExit:
                raise program.Failed("octafront crashed", {})
            report = program.result(status, self.listener, self.meshing.report_file)
            self.progressed.emit("reading the mesh", -1.0)
            self.meshing.take(report)
            self.ended.emit(list(self.meshing.mesh.Told))
        except program.Cancelled:
            self.cancelled.emit()
        except Exception as error:  # whatever FreeCAD raises belongs into the panel, too
            self.failed.emit(str(error))
        finally:
            self.meshing.close()

    def _not_started(self, error):
        if error == QtCore.QProcess.FailedToStart:
            self.meshing.close()
            self.failed.emit(f"{self.process.program()} cannot be started")
