#!/usr/bin/env python3
"""Does octafront/option_table.h know every field of octafront/options.h, and the command line every name of it?

    options_in_table.py ROOT PROGRAM

Fields that take more than one value have no row; NOT_ON_THE_LINE are options that the command line leaves out.
"""
import pathlib
import re
import subprocess
import sys

MORE_THAN_ONE_VALUE = {"regions", "point_sizes", "named", "near", "mesh", "field", "callback", "after_pass"}
NOT_ON_THE_LINE = {"chord_error", "sweeps", "kind"}  # kind: --image


def fields(header):
    """`size.gap` and so on of the structs that Options holds."""
    structs = dict(re.findall(r"^struct (\w+Options|Options) \{\n(.*?)^\};", header, re.M | re.S))
    found = set()
    for name, body in structs.items():
        prefix = "" if name == "Options" else name.removesuffix("Options").lower() + "."
        body = re.sub(r"^  (struct|enum class) .*?\};?$", "", body, flags=re.M | re.S) if "struct Worst" not in body \
            else re.sub(r"^  struct Worst \{.*?^  \};", "", re.sub(r"^  enum class .*?\};", "", body, flags=re.M | re.S),
                        flags=re.M | re.S)
        body = re.sub(r"///?.*", "", body)
        for statement in body.split(";"):
            match = re.match(r"\s*[\w:<>, ()*&]+[\s>](\w+)\s*(=.*)?$", statement.replace("\n", " "))
            if match and not re.fullmatch(r"size|surface|layers|volume|improve|adapt|require", match[1]) or match and prefix:
                found.add(prefix + match[1])
    return found


def main():
    root, program = pathlib.Path(sys.argv[1]), sys.argv[2]
    declared = fields((root / "include/octafront/options.h").read_text())
    table = (root / "src/pipeline/options/option_table.cpp").read_text()
    reached = set(re.findall(r"return o\.([\w.]+);", table))
    intake = (root / "src/pipeline/options/intake_table.cpp").read_text()
    names = set(re.findall(r'(?:of|about)\(\s*"(\w+)"', table + intake))
    breaches = [f"options.h has {f}, and option_table.cpp no row for it"
                for f in sorted(declared - reached) if f.split(".")[-1] not in MORE_THAN_ONE_VALUE]
    if len(declared) < 30:
        breaches.append(f"only {len(declared)} fields found in options.h: this check no longer reads it")
    usage = "".join(subprocess.run([program, command, "--help"], check=True, capture_output=True, text=True).stdout
                    for command in ("mesh", "adapt"))
    typed = set(re.findall(r"--([\w-]+)", usage))
    for name in sorted(names - NOT_ON_THE_LINE):
        if name.replace("_", "-") not in typed:
            breaches.append(f"the table calls an option {name}, the command line has no --{name.replace('_', '-')}")
    print(*breaches, sep="\n")
    return 1 if breaches else 0


if __name__ == "__main__":
    sys.exit(main())
