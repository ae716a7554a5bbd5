#!/usr/bin/env python3
"""Is a wheel what it says? Needs readelf and nm.

    look_into_wheel.py WHEEL SOURCE [--glibc 2.17] [--megabytes 8]

- Everything that its binaries need is inside, or a part of glibc or of GCC's run time; but for OpenCASCADE, which octafront-cad needs.
- No binary asks for a newer glibc than the name of the wheel says, nor for a newer libstdc++ than that system has.
- The licence and version of each library inside is told, ours too, and py.typed and stubs are there.
- The library shows its C interface and nothing of C++, its own or that of libraries inside.
- It runs with a glibc as old as asked for, without a libstdc++ of the system then, and is no larger than asked for.
- RECORD is right, and the version that of CMakeLists.txt.
"""
import argparse
import base64
import hashlib
import pathlib
import re
import subprocess
import sys
import tempfile
import zipfile

EVERYWHERE = {"libc.so.6", "libm.so.6", "libstdc++.so.6", "libgcc_s.so.1", "ld-linux-x86-64.so.2",
              "ld-linux-aarch64.so.1", "libpthread.so.0", "libdl.so.2", "librt.so.1"}


def readelf(option, file):
    return subprocess.run(["readelf", "--wide", option, file], check=True, capture_output=True, text=True).stdout


def exported(file):
    lines = subprocess.run(["nm", "--dynamic", "--defined-only", file], check=True, capture_output=True, text=True).stdout
    return {line.split()[-1] for line in lines.splitlines()}


def look(wheel, source, oldest, most_bytes):
    names, wrong = wheel.namelist(), []

    def require(holds, what):
        if not holds:
            wrong.append(what)

    tag = re.search(r"-py3-none-manylinux_(\d+)_(\d+)_", wheel.filename)
    require(tag, "the tag is not py3-none-manylinux")
    require(pathlib.Path(wheel.filename).stat().st_size <= most_bytes, f"the wheel is larger than {most_bytes / 1e6:g} MB")
    require(not oldest or (int(tag[1]), int(tag[2])) <= oldest, f"the wheel wants a newer glibc than {oldest}")
    binaries = {pathlib.Path(n).name: wheel.read(n) for n in names if "/_bin/" in n}
    require({"liboctafront.so", "octafront"} <= set(binaries), "the library or the tool is missing")
    with tempfile.TemporaryDirectory() as folder:
        for name, data in binaries.items():
            file = pathlib.Path(folder, name)
            file.write_bytes(data)
            dynamic = readelf("-d", file)
            for needed in re.findall(r"\(NEEDED\).*\[(.+)\]", dynamic):
                require(not oldest or needed != "libstdc++.so.6", f"{name} needs the libstdc++ of the system")
                of_cad = name == "octafront-cad" and needed.startswith("libTK")
                require(of_cad or needed in EVERYWHERE or needed in binaries, f"{name} needs {needed}, which is not inside")
            path = re.findall(r"\((?:RPATH|RUNPATH)\).*\[(.+)\]", dynamic)
            require(path in ([], ["$ORIGIN"]), f"{name} looks for libraries in {path}")
            if name in ("liboctafront.so", "octafront", "octafront-cad"):
                require(path == ["$ORIGIN"], f"{name} does not look beside itself")
            newest = max((int(a), int(b)) for a, b in re.findall(r"GLIBC_(\d+)\.(\d+)", readelf("-V", file)))
            print(f"{name} needs glibc {newest[0]}.{newest[1]}")
            require(newest <= (int(tag[1]), int(tag[2])), f"{name} needs a newer glibc than the name of the wheel says")
            if name == "liboctafront.so":
                shown = exported(file)
                require("octafront_generate" in shown, "the C interface is not shown")
                require(all(s.startswith("octafront_") for s in shown), f"{name} shows {sorted(shown)[:3]} and more")
    contents = wheel.read(next(n for n in names if n.endswith("/licenses/contents.txt"))).decode()
    for library in binaries:
        stem = library.removeprefix("lib").removesuffix("-cad").split(".")[0]
        require(re.search(rf"^{stem} \d+\.\d+[\d.]*, ", contents, re.M), f"the version of {library} is not told")
        require(stem == "octafront" or any(n.endswith(f"licenses/{stem}.txt") for n in names),
                f"the licence of {library} is missing")
    for name in ("LICENSE", "NOTICE", "py.typed", "__init__.pyi"):
        require(any(n.endswith("/" + name) for n in names), f"{name} is missing")
    require(not any("hdf5" in n for n in names), "HDF5 came along")

    version = re.search(r"project\(octafront VERSION ([\d.]+)", (source / "CMakeLists.txt").read_text())[1]
    metadata = wheel.read(f"octafront-{version}.dist-info/METADATA").decode()
    require(f"Version: {version}\n" in metadata, "the version is not that of CMakeLists.txt")
    recorded = dict(line.split(",")[:2] for line in wheel.read(f"octafront-{version}.dist-info/RECORD").decode().split())
    require(set(recorded) == set(names), "RECORD lists other files")
    for name, digest in recorded.items():
        found = base64.urlsafe_b64encode(hashlib.sha256(wheel.read(name)).digest()).rstrip(b"=").decode()
        require(not digest or digest == "sha256=" + found, f"the sum of {name} is wrong")
    return wrong


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("wheel")
    parser.add_argument("source", type=pathlib.Path)
    parser.add_argument("--glibc", type=lambda text: tuple(map(int, text.split("."))))
    parser.add_argument("--megabytes", type=float, default=100)
    asked = parser.parse_args()
    with zipfile.ZipFile(asked.wheel) as wheel:
        wrong = look(wheel, asked.source, asked.glibc, asked.megabytes * 1e6)
    print(*wrong, sep="\n")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
