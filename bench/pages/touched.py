#!/usr/bin/env python3
"""What a day's edit costs: builds library and tool, touches a header, builds again, and prints the part of docs/measured/house.md.

    bench/pages/touched.py COMMIT ...     each is checked out into a folder of its own; HEAD is what is committed here

The preset dev, one source at a time, with precompiled headers, no ccache, no tests; two jobs. CPU seconds are user and system time
of compilers, archiver and linker. An hour of CPU time a commit.
"""
import os
import pathlib
import resource
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2]))
from bench.pages.origin import written_by  # noqa: E402

HEADERS = ["include/octafront/tet_mesh.h", "include/octafront/surface_mesh.h"]
OPTIONS = ["-DOCTAFRONT_UNITY=OFF", "-DOCTAFRONT_PCH=ON", "-DOCTAFRONT_BUILD_TESTS=OFF", "-DOCTAFRONT_BUILD_EXAMPLES=OFF",
           "-DCMAKE_CXX_COMPILER_LAUNCHER="]
UNIT = "Building CXX object"


def git(*arguments):
    return subprocess.run(["git", "-C", ROOT, *arguments], check=True, capture_output=True, text=True).stdout.strip()


def build(tree):
    """Units compiled, CPU and wall seconds."""
    def used():
        times = resource.getrusage(resource.RUSAGE_CHILDREN)
        return times.ru_utime + times.ru_stime
    cpu, wall = used(), time.monotonic()
    told = subprocess.run(["ninja", "-C", tree / "build/dev", "-j2", "octafront_cli"], check=True, capture_output=True, text=True,
                          env=os.environ | {"CCACHE_DISABLE": "1"}).stdout
    units = sum(UNIT in line and "cmake_pch" not in line for line in told.splitlines())
    return units, used() - cpu, time.monotonic() - wall


def rows(commit):
    name = git("log", "-1", "--format=%h of %cd", "--date=format:%Y-%m-%d", commit)
    with tempfile.TemporaryDirectory() as folder:
        tree = pathlib.Path(folder, "tree")
        git("worktree", "add", "--detach", str(tree), commit)
        try:
            subprocess.run(["cmake", "--preset", "dev", *OPTIONS], cwd=tree, check=True, capture_output=True)
            yield name, "all", *build(tree)
            for header in HEADERS:
                os.utime(tree / header)
                yield name, f"`{header}`", *build(tree)
        finally:
            git("worktree", "remove", "--force", str(tree))


def main():
    commits = sys.argv[1:] or ["HEAD"]
    print(f"""## What an edit costs

{written_by(" ".join(["bench/pages/touched.py", *commits]))}: library and tool in the preset `dev`, one source at a time, no ccache, two jobs,
on two cores that others used, too: compare CPU seconds, not wall.

| commit | touched | sources compiled | CPU s | wall s |
| --- | --- | ---: | ---: | ---: |""")
    for commit in commits:
        for name, touched, units, cpu, wall in rows(commit):
            print(f"| {name} | {touched} | {units} | {cpu:.0f} | {wall:.0f} |", flush=True)


if __name__ == "__main__":
    main()
