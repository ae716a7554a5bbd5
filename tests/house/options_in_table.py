#!/usr/bin/env python3
"""Does the table of options (src/base/options) have a row for every field of octafront/options.h?

    options_in_table.py ROOT

Fields that take more than one value have none, nor has what generate() sets of images.
"""
import pathlib
import re
import sys

WITHOUT_A_ROW = {"regions", "point_sizes", "named", "near", "mesh", "field", "callback", "after_pass", "finest", "groups"}


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
            if match and not re.fullmatch(r"size|surface|layers|volume|improve|adapt|carry|move|require", match[1]) or match and prefix:
                found.add(prefix + match[1])
    return found


def main():
    root = pathlib.Path(sys.argv[1])
    declared = fields((root / "include/octafront/options.h").read_text())
    reached = set(re.findall(r"return o\.([\w.]+);", (root / "src/base/options/option_table.cpp").read_text()))
    breaches = [f"options.h has {f}, and option_table.cpp no row for it"
                for f in sorted(declared - reached) if f.split(".")[-1] not in WITHOUT_A_ROW]
    if len(declared) < 30:
        breaches.append(f"only {len(declared)} fields found in options.h: this check no longer reads it")
    print(*breaches, sep="\n")
    return 1 if breaches else 0


if __name__ == "__main__":
    sys.exit(main())
