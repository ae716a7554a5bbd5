"""Where the figures of a page come from: every page that a benchmark writes says so."""
import datetime
import platform
import subprocess


def processor():
    """Its name as Linux knows it, else the kind."""
    try:
        with open("/proc/cpuinfo", encoding="utf-8") as lines:
            return next(line.split(":")[1].strip() for line in lines if line.startswith("model name"))
    except (OSError, StopIteration):
        return platform.machine()


def origin():
    """Commit, date and machine, as a clause of a sentence."""
    told = subprocess.run(["git", "describe", "--always", "--dirty", "--abbrev=7"], capture_output=True, text=True, check=False)
    return f"commit {told.stdout.strip() or 'unknown'}, {datetime.date.today()}, {processor()}"
