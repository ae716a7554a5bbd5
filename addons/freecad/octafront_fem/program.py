"""The program octafront as a process: where it is, what it tells, how it is stopped. Needs nothing of FreeCAD."""
import json
import os
import pathlib
import queue
import shutil
import subprocess
import threading

WAIT = 0.05  # seconds between looks at whether somebody cancelled
PATIENCE = 10  # seconds that the program has to end by itself


class Refused(ValueError):
    """What is asked for cannot be told to the program; the message says what to change."""


class Cancelled(Exception):
    """Somebody stopped the program; nothing was written."""


class Failed(RuntimeError):
    """The program ended without a mesh. `report`: what it said as JSON, a dict; empty if it said nothing."""

    def __init__(self, message, report):
        super().__init__(message)
        self.report = report


def find(preferred=""):
    """The path of the program: the one that is set, that of the variable OCTAFRONT, or the one in PATH. Raises Refused."""
    for wanted in (preferred, os.environ.get("OCTAFRONT", ""), "octafront"):
        if wanted and (found := shutil.which(wanted)):
            return found
    raise Refused("the program octafront was not found: put it into PATH, or say in the preferences of the workbench, or by the "
                  "variable OCTAFRONT, where it is")


def environment():
    """That of the process, which makes it tell its progress by lines."""
    return {**os.environ, "OCTAFRONT_PROGRESS": "lines"}


class Listener:
    """Takes apart what the program writes to standard error: `tell(stage, fraction)` hears of progress, a fraction below 0
    where it is not known; the rest are messages."""

    def __init__(self, tell=None):
        self.tell, self.messages = tell or (lambda stage, fraction: None), []

    def hear(self, line):
        line = line.rstrip("\r\n")
        if not line.startswith("\x1f"):
            if line:
                self.messages.append(line)
            return
        stage, _, fraction = line[1:].partition("\t")
        self.tell(stage, float(fraction or -1))


def result(status, listener, report_file):
    """The report of a process that ended with `status`, a dict. Raises Cancelled, Failed."""
    if status == 130:
        raise Cancelled
    report = json.loads(pathlib.Path(report_file).read_text(encoding="utf-8")) if pathlib.Path(report_file).exists() else {}
    if status == 0:
        return report
    said = report.get("error", {}).get("message") or "\n".join(listener.messages[-5:])
    raise Failed(said or f"octafront ended with status {status}", report)


def run(command, report_file, progress=None, cancelled=None):
    """Runs it to its end. `progress(stage, fraction)` is told how far it is, and `cancelled()` asked twenty times a second
    whether to stop, both by the calling thread. Raises Cancelled, Failed."""
    listener, lines = Listener(progress), queue.Queue()
    process = subprocess.Popen(command, env=environment(), stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
                               text=True, encoding="utf-8", errors="replace")
    reader = threading.Thread(target=lambda: [lines.put(line) for line in process.stderr], daemon=True)
    reader.start()
    try:
        while process.poll() is None or reader.is_alive() or not lines.empty():
            if cancelled is not None and cancelled():
                raise Cancelled
            try:
                listener.hear(lines.get(timeout=WAIT))
            except queue.Empty:
                pass
    finally:
        stop(process)
        reader.join()
        process.stderr.close()
    return result(process.returncode, listener, report_file)


def stop(process):
    """Asks it to end, which leaves nothing half-written; one that does not is ended."""
    if process.poll() is not None:
        return
    process.terminate()
    try:
        process.wait(PATIENCE)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()
