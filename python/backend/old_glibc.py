#!/usr/bin/env python3
"""Makes libraries to link with that stand for an older glibc: what is linked with them runs wherever that one or a newer
one is.

    old_glibc.py 2.17 FOLDER [COMPILER]

glibc keeps old versions of its functions for old programs, and programs get the newest ones of the machine where they are
linked. The stand-ins have the functions of this machine's glibc, each in the newest version that the older glibc had, and
no code. What came later is missing: the linker names it, and python/old_glibc.cpp has it. Linked with -L FOLDER.
"""
import pathlib
import re
import subprocess
import sys

# With the functions of libpthread, libdl and librt, which became parts of libc in 2.34, and are asked for by name, too.
LIBRARIES = {"libc": "libc.so.6", "libm": "libm.so.6"}
LOADERS = {"x86_64": "ld-linux-x86-64.so.2", "aarch64": "ld-linux-aarch64.so.1"}
EMPTY = {"libpthread": "libpthread.so.0", "libdl": "libdl.so.2", "librt": "librt.so.1"}


def main():
    global compiler
    floor, folder = tuple(map(int, sys.argv[1].split("."))), pathlib.Path(sys.argv[2])
    compiler = sys.argv[3] if len(sys.argv) > 3 else "gcc"
    folder.mkdir(parents=True, exist_ok=True)
    for name, file in LIBRARIES.items():
        make(folder, name, file, chosen(symbols_of(place_of(file)), floor))
    for name, file in EMPTY.items():
        make(folder, name, file, {})
    # As Debian's own libc.so: a few functions are linked in, and one is in the loader.
    loader = place_of(LOADERS[run(compiler, "-dumpmachine").split("-")[0]])
    nonshared = place_of("libc_nonshared.a")
    (folder / "libc.so").unlink()
    (folder / "libc.so").write_text(f"GROUP ( {folder / 'libc.so.6'} {nonshared} AS_NEEDED ( {loader} ) )\n")


def run(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def place_of(file):
    return run(compiler, f"-print-file-name={file}").strip()


def symbols_of(file):
    """(name, version, kind, size) of what a library defines."""
    for line in run("readelf", "--wide", "--dyn-syms", file).splitlines():
        words = line.split()
        if len(words) < 8 or words[6] == "UND" or "@" not in words[7]:
            continue
        name, version = re.split("@+", words[7])
        number = re.fullmatch(r"GLIBC_(\d+(?:\.\d+)+)", version)
        if number:
            yield name, tuple(map(int, number[1].split("."))), words[3], int(words[2], 0)


def chosen(symbols, floor):
    """{name: (version, kind, size)}: of each the newest one up to the floor."""
    best = {}
    for name, version, kind, size in symbols:
        if version <= floor and (name not in best or version > best[name][0]):
            best[name] = (version, kind, size)
    return best


def make(folder, name, file, symbols):
    source, versions = [".text"], {version for version, _, _ in symbols.values()}
    for i, (symbol, (version, kind, size)) in enumerate(sorted(symbols.items())):
        label = f"stand_in_{i}"
        is_data = kind in ("OBJECT", "TLS")
        source += [".data" if is_data else ".text", f".globl {label}", f".type {label}, @{'object' if is_data else 'function'}",
                   f"{label}: .zero {max(size, 1) if is_data else 1}", f".size {label}, {max(size, 1) if is_data else 1}",
                   f".symver {label}, {symbol}@@{tag(version)}, remove"]
    (folder / f"{name}.s").write_text("\n".join(source) + "\n")
    (folder / f"{name}.map").write_text("".join(f"{tag(v)} {{ }};\n" for v in sorted(versions)) or "{ local: *; };\n")
    run(compiler, "-shared", "-nostdlib", f"-Wl,-soname,{file}", f"-Wl,--version-script={folder / (name + '.map')}",
        str(folder / f"{name}.s"), "-o", str(folder / file))
    for link in (folder / f"{name}.so",):
        link.unlink(missing_ok=True)
        link.symlink_to(file)


def tag(version):
    return "GLIBC_" + ".".join(map(str, version))


if __name__ == "__main__":
    main()
