"""Runs programs within a limit of time, and says what they took: CPU seconds, wall seconds, memory at most."""
import ctypes
import dataclasses
import math
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
    status: int | None = None     # how it ended; None: stopped
    report: dict | None = None    # what a run of ours says of itself (ours.py)


def waited(command, seconds, folder=None, output=subprocess.STDOUT):
    """Ends past `seconds` of wall time, with all that it started: (exit status, whether it was stopped, what it used, wall seconds, what
    it said). `output`: STDOUT, or DEVNULL where only errors are read."""
    late = threading.Event()
    with tempfile.TemporaryFile() as log:
        start = time.monotonic()
        process = subprocess.Popen(list(map(str, command)), cwd=folder, stdin=subprocess.DEVNULL, stdout=log if output == subprocess.STDOUT else output,
                                   stderr=log, start_new_session=True)

        def stop():
            late.set()
            os.killpg(process.pid, signal.SIGKILL)

        timer = threading.Timer(seconds, stop)
        timer.start()
        _, status, usage = os.wait4(process.pid, 0)
        timer.cancel()
        process.returncode = os.waitstatus_to_exitcode(status)
        log.seek(0)
        return process.returncode, late.is_set(), usage, time.monotonic() - start, log.read().decode(errors="replace")


def run_bounded(command, seconds):
    """(exit status, None: no end; standard error; CPU seconds; MB at most), for other programs may be at work: the limit is of processor time,
    and past twenty times that of wall time the program is stopped, too."""
    status, late, usage, _, said = waited(["prlimit", f"--cpu={math.ceil(seconds)}", *command], 20 * seconds, output=subprocess.DEVNULL)
    ended = not late and status not in (-signal.SIGXCPU, -signal.SIGKILL)
    return status if ended else None, said.strip(), usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1e3


def run_measured(command, folder, timeout):
    """Runs `command` in `folder`. The Outcome has no mesh yet; `error` is set on failure or past `timeout` seconds."""
    outcome = Outcome(command=" ".join(map(str, command)))
    status, late, usage, outcome.wall_seconds, outcome.log = waited(command, timeout, folder)
    outcome.status = None if late else status
    outcome.cpu_seconds = usage.ru_utime + usage.ru_stime
    outcome.peak_bytes = usage.ru_maxrss * 1024
    if late:
        outcome.error = f"no end within {timeout:g} s"
    elif status != 0:
        lines = [line.strip() for line in outcome.log.splitlines() if line.strip()]
        said = [line for line in lines if "error" in line.lower()] or lines[-1:] or ["no message"]
        how = f"exit {status}" if status > 0 else f"signal {-status}"
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
