"""Runs one mesher as a whole process with a time limit; measures CPU time, wall time and peak memory."""
import ctypes
import dataclasses
import os
import pathlib
import signal
import subprocess
import tempfile
import threading
import time


def load_library(names, package):
    """The first of the shared libraries that is there; OSError names the Debian package if none is."""
    for name in names:
        try:
            return ctypes.CDLL(name)
        except OSError:
            continue
    raise OSError(f"{names[-1]} not found (Debian: {package})")


@dataclasses.dataclass
class Outcome:
    """What a run made. `mesh` is None where it made none; `error` says why in one line."""
    command: str
    mesh: pathlib.Path | None = None
    error: str = ""
    cpu_seconds: float = 0.0      # user and system, of the process and its children
    wall_seconds: float = 0.0
    stage_seconds: float | None = None  # CPU seconds of filling alone, as far as the mesher tells
    stage_wall_seconds: float | None = None
    peak_bytes: int = 0
    log: str = ""


def run_measured(command, folder, timeout):
    """Runs `command` in `folder`. The Outcome has no mesh yet; `error` is set on failure or past `timeout` seconds."""
    command = [str(part) for part in command]
    outcome = Outcome(command=" ".join(command))
    with tempfile.TemporaryFile() as log:
        start = time.monotonic()
        process = subprocess.Popen(command, cwd=folder, stdin=subprocess.DEVNULL, stdout=log, stderr=subprocess.STDOUT,
                                   start_new_session=True)
        late = threading.Event()

        def stop():
            late.set()
            os.killpg(process.pid, signal.SIGKILL)

        timer = threading.Timer(timeout, stop)
        timer.start()
        _, status, usage = os.wait4(process.pid, 0)
        timer.cancel()
        process.returncode = os.waitstatus_to_exitcode(status)
        outcome.wall_seconds = time.monotonic() - start
        log.seek(0)
        outcome.log = log.read().decode(errors="replace")
    outcome.cpu_seconds = usage.ru_utime + usage.ru_stime
    outcome.peak_bytes = usage.ru_maxrss * 1024
    if late.is_set():
        outcome.error = f"no end within {timeout:g} s"
    elif process.returncode != 0:
        lines = [line.strip() for line in outcome.log.splitlines() if line.strip()]
        said = [line for line in lines if "error" in line.lower()] or lines[-1:] or ["no message"]
        how = f"exit {process.returncode}" if process.returncode > 0 else f"signal {-process.returncode}"
        outcome.error = f"{how}: {said[-1][:120]}"
    return outcome


def finish(outcome, mesh):
    """Sets the mesh if the run left one."""
    if not outcome.error:
        if pathlib.Path(mesh).is_file():
            outcome.mesh = pathlib.Path(mesh)
        else:
            outcome.error = "it ended without a mesh"
    return outcome
