#!/usr/bin/env python3
"""Do pages lead where they say, and tell where their figures come from?

    check_docs.py ROOT          prints each fault as a line; status 1 if there are any
    check_docs.py --self-test   writes pages with one fault of each kind, and must find them all

What holds:
- docs/README.md links to every page of docs/.
- Each page of docs/measured, and each part of others that a command wrote, says "Written by `COMMAND` (commit ..., date,
  machine" as bench/pages/origin.py does, or "Measured by" where the figures were put on the page by hand; the script that the
  command begins with exists.
- A page of docs/measured is one screen: at most 900 words. Rows are in CSV files of docs/measured/rows, and pages link to them.
- Links, pictures and anchors of pages lead somewhere; so do paths in backticks that begin with a folder of the project.
- Workflows and .ci/run call scripts that are there.
"""
import pathlib
import re
import sys

from self_test import finds

ORIGIN = re.compile(r"(?:Written|Measured) by `(?P<script>[^` ]+)[^`]*` \(commit [0-9a-f]{7}(?: with changes)?, \d{4}-\d\d-\d\d, \w[^)]*\)")
WRITTEN = re.compile(r"(?:Written|Measured) by `(?:bench|scripts)/")
MOST_WORDS = 900  # of a page of docs/measured; lines and bars of tables are none
LINK = re.compile(r"\]\(([^)\s]+)\)")
QUOTED = re.compile(r"`((?:bench|cli|cmake|docs|examples|include|licenses|python|samples|scripts|src|tests)/[\w./-]*)[^`]*`")
SCRIPT = re.compile(r"\bscripts/[\w-]+\.\w+")
FENCE = re.compile(r"^```.*?^```$", re.M | re.S)


def anchors(text):
    """As hosts of Markdown name headings."""
    heads = re.findall(r"^#+ (.*)$", FENCE.sub("", text), re.M)
    return {re.sub(r"[^\w\- ]", "", head.lower()).replace(" ", "-") for head in heads}


class Docs:
    def __init__(self, root):
        self.root = root
        self.pages = sorted((root / "docs").rglob("*.md"))
        self.faults = []

    def fault(self, page, what):
        self.faults.append(f"{page.relative_to(self.root)}: {what}")

    def check_index(self):
        index = self.root / "docs/README.md"
        linked = {(index.parent / link).resolve() for link in LINK.findall(index.read_text())}
        for page in self.pages:
            if page != index and page.resolve() not in linked:
                self.fault(index, f"does not link to {page.relative_to(index.parent)}")

    def check_origins(self):
        for page in self.pages:
            text = page.read_text()
            found = list(ORIGIN.finditer(text))
            if len(found) < len(WRITTEN.findall(text)) or (page.parent.name == "measured" and not found):
                self.fault(page, "does not say which command wrote it, at which commit, when, on which machine")
            for origin in found:
                if not (self.root / origin["script"]).exists():
                    self.fault(page, f"there is no {origin['script']}")

    def check_measured(self):
        linked = set()
        for page in self.pages:
            text = page.read_text()
            linked |= {(page.parent / link).resolve() for link in LINK.findall(text) if not re.match(r"\w+:", link)}
            if page.parent.name != "measured":
                continue
            words = len(re.findall(r"\S*\w\S*", text))
            if words > MOST_WORDS:
                self.fault(page, f"has {words} words, {MOST_WORDS} are a screen: its rows belong to a CSV file (bench/pages/tables.py)")
        for rows in sorted((self.root / "docs/measured").rglob("*.csv")):
            if rows.resolve() not in linked:
                self.fault(rows, "no page links to it")

    def check_link(self, page, link):
        file, _, anchor = link.partition("#")
        target = page.parent / file if file else page
        if not target.exists():
            self.fault(page, f"leads to {link}, which is not there")
        elif anchor and anchor not in anchors(target.read_text()):
            self.fault(page, f"leads to {link}, and there is no such heading")

    def check_links(self):
        beside = [self.root / name for name in ("README.md", "CONTRIBUTING.md", "ARCHITECTURE.md")]
        for page in [*self.pages, *beside, *sorted(self.root.glob("src/*/README.md"))]:
            text = FENCE.sub("", page.read_text())
            for link in LINK.findall(text):
                if not re.match(r"\w+:", link):
                    self.check_link(page, link)
            for path in QUOTED.findall(text):
                if not (self.root / path).exists():
                    self.fault(page, f"names {path}, which is not there")

    def check_workflows(self):
        for path in [*sorted(self.root.glob(".github/workflows/*.yml")), *self.root.glob(".ci/run")]:
            for script in SCRIPT.findall(path.read_text()):
                if not (self.root / script).exists():
                    self.fault(path, f"calls {script}, which is not there")

    def check(self):
        self.check_index()
        self.check_origins()
        self.check_measured()
        self.check_links()
        self.check_workflows()
        return self.faults


def self_test():
    files = {
        "README.md": "![a](docs/a.png) [b](docs/b.png) [there](https://there)\n```\n[c](c.png)\n```\n",
        "CONTRIBUTING.md": "`docs/README.md`, `scripts/gone.sh --all`, `build/a`\n",
        "ARCHITECTURE.md": "[here](#a-head-here) [gone](#gone)\n\n## A head, here\n",
        "src/low/README.md": "[there](../../bench/run.sh) [gone](gone.h)\n",
        "docs/README.md": "[use](use/use.md) [good](measured/good.md) [bare](measured/bare.md) [stray](measured/stray.md)\n",
        "docs/a.png": "",
        "docs/use/use.md": "[good](../measured/good.md#figures)\n",
        "docs/use/lonely.md": "Written by `bench/run.sh it`.\n",
        "docs/measured/good.md": "# Figures\n\nWritten by `bench/run.sh it --all` (commit 0123abc with changes, 2026-01-31, AMD EPYC), one thread: "
                                 "[rows](rows/good.csv).\n" + "| - |" * 1000,
        "docs/measured/rows/good.csv": "",
        "docs/measured/rows/lost.csv": "",
        "docs/measured/bare.md": "Written by `bench/run.sh it`, commit 0123abc.\n",
        "docs/measured/stray.md": "Measured by `bench/gone.sh` (commit 0123abc, 2026-01-31, AMD EPYC).\n" + "word " * 900,
        "bench/run.sh": "",
        ".github/workflows/tests.yml": "steps:\n  - run: scripts/gone.sh --all\n",
    }
    expected = [
        "docs/use/lonely.md: does not say which command wrote it, at which commit, when, on which machine",
        ".github/workflows/tests.yml: calls scripts/gone.sh, which is not there",
        "README.md: leads to docs/b.png, which is not there",
        "CONTRIBUTING.md: names scripts/gone.sh, which is not there",
        "ARCHITECTURE.md: leads to #gone, and there is no such heading",
        "src/low/README.md: leads to gone.h, which is not there",
        "docs/README.md: does not link to use/lonely.md",
        "docs/measured/bare.md: does not say which command wrote it, at which commit, when, on which machine",
        "docs/measured/stray.md: there is no bench/gone.sh",
        "docs/measured/stray.md: has 908 words, 900 are a screen: its rows belong to a CSV file (bench/pages/tables.py)",
        "docs/measured/rows/lost.csv: no page links to it",
        "docs/measured/stray.md: names bench/gone.sh, which is not there",
    ]
    return finds(Docs, files, expected)


def main():
    if sys.argv[1:] == ["--self-test"]:
        return 0 if self_test() else 1
    faults = Docs(pathlib.Path(sys.argv[1]).resolve()).check()
    print(*faults, sep="\n")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
