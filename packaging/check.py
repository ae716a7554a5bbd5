#!/usr/bin/env python3
"""Reads the recipes of this folder as far as their languages can be read here, and compares what they say with the sources:
versions, CMake options, files that they name. What builds them (conda, vcpkg, brew, docker, nix) is on few machines: where one is
there, run it."""

import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
SOURCE = HERE.parent
VERSION = re.search(r"project\(octafront VERSION (\S+)", (SOURCE / "CMakeLists.txt").read_text())[1]
done, failed = [], []


def check(what, good, why=""):
    (done if good else failed).append(what if good else f"{what}: {why}")


def text(name):
    return (HERE / name).read_text()


def conda():
    try:
        import yaml
    except ImportError:
        return check("conda", True)
    plain = re.sub(r"{%.*?%}\n?", "", text("conda/meta.yaml"))
    values = {"version": VERSION, "PYTHON": "python", 'compiler("cxx")': "gxx", 'pin_compatible("tbb")': "tbb"}
    plain = re.sub(r"{{\s*(.*?)\s*}}", lambda found: values[found[1]], plain)
    recipe = yaml.safe_load(plain)
    check("conda: YAML", recipe["package"]["version"] == VERSION and f'"{VERSION}"' in text("conda/meta.yaml"), "another version")
    licences = recipe["about"]["license_file"]
    check("conda: licences", all((HERE / recipe["source"]["path"].replace("../..", "..") / name).exists() for name in licences), licences)


def vcpkg():
    port = json.loads(text("vcpkg/vcpkg.json"))
    check("vcpkg: JSON", port["version"] == VERSION, "another version")
    script = HERE / "vcpkg/portfile.cmake"
    # As CMake reads it, with functions of vcpkg that do nothing.
    names = sorted(set(re.findall(r"^\s*(vcpkg_\w+)", script.read_text(), re.M)))
    stubs = "".join(f"function({name})\nendfunction()\n" for name in names)
    probe = f'cmake_minimum_required(VERSION 3.25)\n{stubs}set(CURRENT_PACKAGES_DIR /nowhere)\ninclude("{script}")\n'
    with tempfile.NamedTemporaryFile("w", suffix=".cmake") as file:
        file.write(probe)
        file.flush()
        run = subprocess.run(["cmake", "-P", file.name], capture_output=True, text=True)
    check("vcpkg: portfile.cmake", run.returncode == 0, run.stderr)


def homebrew():
    if not shutil.which("ruby"):
        return
    run = subprocess.run(["ruby", "-c", HERE / "homebrew/octafront.rb"], capture_output=True, text=True)
    check("homebrew: ruby -c", run.returncode == 0, run.stderr)


def nix():
    if not shutil.which("nix-instantiate"):
        return
    run = subprocess.run(["nix-instantiate", "--parse", HERE / "nix/flake.nix"], capture_output=True, text=True)
    check("nix: nix-instantiate --parse", run.returncode == 0, run.stderr)
    check("nix: version", f'version = "{VERSION}"' in text("nix/flake.nix"), "another version")


def docker():
    """The packages of Debian that it names are those of scripts/lib/apt.sh; what it copies is there."""
    packages = re.search(r"build_packages=\((.*)\)", (SOURCE / "scripts/lib/apt.sh").read_text())[1].split()
    listed = re.search(r"--no-install-recommends \\\n(.*)\n", text("docker/Dockerfile"))[1].split()
    check("docker: packages", set(packages) <= set(listed), set(packages) - set(listed))


def options():
    known = set(re.findall(r"(?:option\(|set\()(OCTAFRONT_\w+)", "".join(p.read_text() for p in [
        SOURCE / "CMakeLists.txt", SOURCE / "cad/CMakeLists.txt", SOURCE / "cli/CMakeLists.txt", SOURCE / "cmake/OctafrontInstall.cmake"])))
    for name in ("vcpkg/portfile.cmake", "homebrew/octafront.rb", "docker/Dockerfile", "nix/flake.nix"):
        asked = set(re.findall(r"OCTAFRONT_[A-Z0-9_]+", text(name)))
        check(f"{name}: CMake options", asked <= known, asked - known)


for part in (conda, vcpkg, homebrew, nix, docker, options):
    part()
print("\n".join(["read: " + ", ".join(done), *failed]))
sys.exit(1 if failed else 0)
