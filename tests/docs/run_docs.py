#!/usr/bin/env python3
"""Runs what pages of documentation tell their readers to type: each section in an empty folder, its blocks in order.

    run_docs.py [--all] [--keep FOLDER] [--tool FOLDER] PAGE ...

Blocks of `python` share the names of their section, blocks of `sh` stop at the first failure. In comments of the page:
    <!-- needs: PROGRAM -->       the next block or check is run only with --all, which installs and wants the program
    <!-- not run: REASON -->      the next block is not run
    <!-- before ... -->           sh that makes what readers have
    <!-- check ... -->            Python that looks at what came out
A page without blocks is an error: then this script no longer reads it. --keep leaves what sections made, each in a folder
of its number. --tool: the folder of another octafront, such as one that has HDF5.
"""
import argparse
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import traceback

ROOT = pathlib.Path(__file__).resolve().parents[2]
PART = re.compile(r"^(?P<fence>```)(?P<kind>\w*)\n(?P<code>.*?)^```$|<!-- needs: (?P<needs>\S+) -->"
                  r"|<!-- not run: .*? -->(?P<skip>)|<!-- check\n(?P<check>.*?)-->|<!-- before\n(?P<before>.*?)-->", re.M | re.S)


def sections(text):
    """(title, text) of each part that begins with ##; of one without, the whole."""
    parts = re.split(r"^## (.*)$", text, flags=re.M)
    return list(zip(["", *parts[1::2]], parts[0::2]))


def run_shell(code):
    subprocess.run(["bash", "-euo", "pipefail", "-c", code], check=True)


def run_section(name, text, names, everything):
    """Runs the blocks of a section; how many it ran."""
    ran, needs, skip = 0, None, False
    for part in PART.finditer(text):
        if part["needs"]:
            needs = part["needs"]
            continue
        if part["skip"] is not None:
            skip = True
            continue
        if part["before"]:
            run_shell(part["before"])
            continue
        runnable = part["kind"] in ("python", "sh") or part["check"] is not None
        if runnable and not skip and (needs is None or everything):
            if needs and not shutil.which(needs):
                raise SystemExit(f"{name}: {needs} is not installed")
            code = part["check"] if part["check"] is not None else part["code"]
            print(f"--- {name}: {code.strip().splitlines()[0]} ...", flush=True)
            if part["kind"] == "sh":
                run_shell(code)
            else:
                exec(compile(code, name, "exec"), names)
            ran += 1
        needs, skip = None, False
    return ran


def run_page(page, everything, kept):
    ran = 0
    for number, (title, text) in enumerate(sections(page.read_text())):
        folder = kept / str(number)
        folder.mkdir(parents=True)
        os.chdir(folder)
        os.symlink(ROOT / "samples", "samples")
        ran += run_section(f"{page.name}, {title}" if title else page.name, text, {}, everything)
        os.chdir(ROOT)
    if ran == 0:
        raise SystemExit(f"{page}: nothing to run was found")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--all", action="store_true")
    parser.add_argument("--keep", type=pathlib.Path)
    parser.add_argument("--tool", type=pathlib.Path)
    parser.add_argument("pages", nargs="+", type=pathlib.Path)
    arguments = parser.parse_args()
    # The tool of this Python's package goes before others, but for the one that is asked for.
    tools = [arguments.tool, pathlib.Path(sys.executable).parent]
    os.environ["PATH"] = os.pathsep.join([*(str(t.absolute()) for t in tools if t), os.environ["PATH"]])
    with tempfile.TemporaryDirectory() as scratch:
        for page in arguments.pages:
            kept = arguments.keep.resolve() if arguments.keep else pathlib.Path(scratch) / page.stem
            try:
                run_page(page.resolve(), arguments.all, kept)
            except subprocess.CalledProcessError as error:
                return f"{page}: a block failed: {error.cmd[-1]}"
            except Exception:
                traceback.print_exc()
                return f"{page}: a block failed"
            finally:
                os.chdir(ROOT)
    return 0


if __name__ == "__main__":
    sys.exit(main())
