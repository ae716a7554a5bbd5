"""Where the figures of a page come from: every page that a benchmark writes says so, and tests/house/check_docs.py asks for it."""
import datetime
import pathlib
import platform
import subprocess

ROOT = pathlib.Path(__file__).resolve().parents[2]
MEASURED = ("src", "include", "cli", "bench")  # what figures depend on: a page written before this one does not count


def git(*arguments):
    told = subprocess.run(["git", "-C", ROOT, *arguments], capture_output=True, text=True, check=False)
    return told.stdout.strip()


def commit():
    name = git("rev-parse", "--short=7", "HEAD") or "unknown"
    return name + (" with changes" if git("status", "--porcelain", "--", *MEASURED) else "")


def processor():
    """Its name as Linux knows it, else the kind."""
    try:
        with open("/proc/cpuinfo", encoding="utf-8") as lines:
            return next(line.split(":")[1].strip() for line in lines if line.startswith("model name"))
    except (OSError, StopIteration):
        return platform.machine()


def origin():
    """Commit, date and machine, as a clause of a sentence."""
    return f"commit {commit()}, {datetime.date.today()}, {processor()}"


ORIGIN = origin()  # as the benchmark began: who commits while it runs does not change what it measures


def written_by(command, origins=()):
    """How the sentence begins that each page has, or each part of a page that a command of its own writes. `origins`: those
    of rows that were kept from earlier runs."""
    return f"Written by `{command}` ({'; '.join(sorted({*origins} or {ORIGIN}))})"
