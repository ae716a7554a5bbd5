#!/usr/bin/env python3
"""Prints docs/use/options.md, the options of all commands as tables, from `octafront schema`.

    option_tables.py OCTAFRONT PAGE            writes it
    option_tables.py OCTAFRONT PAGE --check    status 1 if it is not current
"""
import json
import pathlib
import subprocess
import sys

HEAD = """# Options

All options of the command line, group by group, as `octafront help COMMAND GROUP` shows them; in brackets what holds without them. Python's keywords
and the names of the other doors are the same with underscores. This page is printed by `scripts/option_tables.py` from `octafront schema`, which
describes the options, with their types and ranges, and the reports of `--json` for programs ([JSON Schema](https://json-schema.org), draft 2020-12).
Places: [one language](places.md).
"""
# Commands that have options of their own.
HELPERS = {"help", "completion", "schema"}


def cell(text):
    return text.replace("|", "\\|")


def rows_of(schema):
    """{group: {(option, what it takes, what it says): commands}}, in the order of the program."""
    groups = {}
    for name, options in schema["$defs"].items():
        command = name.removeprefix("options_of_")
        if command == name or command in HELPERS:
            continue
        for option, rule in options["properties"].items():
            takes = "" if "const" in rule else "|".join(rule["anyOf"][0]["enum"]) if "anyOf" in rule else rule["$comment"]
            groups.setdefault(rule["title"], {}).setdefault((option, takes, rule["description"]), []).append(command)
    return groups


def page(octafront):
    schema = json.loads(subprocess.run([octafront, "schema"], check=True, capture_output=True).stdout)
    text = HEAD
    for group, rows in rows_of(schema).items():
        text += f"\n## {group}\n\n| option | what | of |\n| --- | --- | --- |\n"
        for (option, takes, says), commands in rows.items():
            text += f"| `--{option}{' ' + cell(takes) if takes else ''}` | {cell(says)} | {', '.join(commands)} |\n"
    return text


def main():
    octafront, file = sys.argv[1], pathlib.Path(sys.argv[2])
    if "--check" in sys.argv:
        return 0 if file.read_text() == page(octafront) else f"{file} is old: scripts/option_tables.py {octafront} {file}"
    file.write_text(page(octafront))
    return 0


if __name__ == "__main__":
    sys.exit(main())
