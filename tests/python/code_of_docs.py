#!/usr/bin/env python3
"""Writes the Python of pages of documentation into files that a type checker can read, one for each section.

    code_of_docs.py FOLDER PAGE ...
"""
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parents[1] / "docs"))
from run_docs import PART, sections  # noqa: E402


def main():
    folder, pages = pathlib.Path(sys.argv[1]), map(pathlib.Path, sys.argv[2:])
    for page in pages:
        codes = ["\n".join(part["code"] for part in PART.finditer(text) if part["kind"] == "python")
                 for _, text in sections(page.read_text())]
        if not any(codes):
            raise SystemExit(f"{page}: no Python was found")
        for number, code in enumerate(codes):
            if code:
                (folder / f"{page.stem.lower()}_{number}.py").write_text(code)


if __name__ == "__main__":
    main()
