"""Runs a program within a limit of processor time: other programs may be at work."""
import math
import os
import signal
import subprocess
import tempfile
import threading


def run(command, seconds):
    """(exit status, None: no end; standard error; CPU seconds; MB at most). Past twenty times `seconds` of wall time the
    program is stopped, too."""
    with tempfile.TemporaryFile() as errors:
        limited = ["prlimit", f"--cpu={math.ceil(seconds)}", *map(str, command)]
        process = subprocess.Popen(limited, stdout=subprocess.DEVNULL, stderr=errors)
        timer = threading.Timer(20 * seconds, process.kill)
        timer.start()
        _, status, used = os.wait4(process.pid, 0)
        timer.cancel()
        process.returncode = os.waitstatus_to_exitcode(status)
        ended = process.returncode not in (-signal.SIGXCPU, -signal.SIGKILL)
        errors.seek(0)
        return (process.returncode if ended else None, errors.read().decode(errors="replace").strip(),
                used.ru_utime + used.ru_stime, used.ru_maxrss / 1e3)
