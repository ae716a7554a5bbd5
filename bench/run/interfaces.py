#!/usr/bin/python3
"""Three tasks with the Python interfaces of Octafront and Gmsh, and with TetGen's program (bench/run/interfaces): what they
take, and what an error looks like. Prints the table of docs/use/python.md.

    bench/run/interfaces.py BIN      the folder of liboctafront.so: build/release/python/octafront/_bin

Needs python3-gmsh, tetgen, python3-numpy. The tasks: a file to a file at a size; arrays to arrays with a size function;
a surface with a hole.
"""
import os
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
TASKS = ("file", "arrays", "open")


def lines_of(path):
    text = re.sub(r'"""(.|\n)*?"""', "", path.read_text())
    return sum(1 for line in text.splitlines() if line.strip() and not line.strip().startswith("#"))


def run(tool, task, folder, env):
    script = ROOT / "bench/run/interfaces" / f"{tool}_{task}.py"
    done = subprocess.run(["/usr/bin/python3", script], cwd=folder, env=env, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, text=True, timeout=300, errors="replace")
    return lines_of(script), done.returncode, done.stdout.strip()


def main():
    env = dict(os.environ, PYTHONPATH=f"{ROOT}/python:{ROOT}/bench/run/interfaces", OCTAFRONT_BIN=str(pathlib.Path(sys.argv[1]).resolve()))
    sys.path.insert(0, str(ROOT / "python"))
    os.environ["OCTAFRONT_BIN"] = env["OCTAFRONT_BIN"]
    import octafront
    said = {}
    print("| | lines: " + " | lines: ".join(TASKS) + " |\n| --- |" + " ---: |" * len(TASKS))
    with tempfile.TemporaryDirectory() as folder:
        os.mkdir(f"{folder}/samples")
        os.symlink(ROOT / "samples" / "gear.obj", f"{folder}/samples/gear.obj")
        gear = octafront.read(f"{folder}/samples/gear.obj")
        gear.save(f"{folder}/samples/gear.stl")  # Gmsh reads no OBJ
        gear.save(f"{folder}/gear.off")
        for tool in ("octafront", "gmsh", "tetgen"):
            row = []
            for task in TASKS:
                lines, status, said[tool, task] = run(tool, task, folder, env)
                row.append(f"{lines}, {'status ' + str(status) if status else 'done'}")
            print(f"| {tool} | " + " | ".join(row) + " |")
    for (tool, task), text in said.items():
        print(f"\n--- {tool}, {task}:\n{text[-1500:]}")


if __name__ == "__main__":
    main()
