# The Python package as pages: scripts/api-docs.sh.
import re

import octafront

project = "octafront"
version = release = octafront.__version__
extensions = ["sphinx.ext.autodoc"]
html_theme = "alabaster"
html_theme_options = {"page_width": "1100px", "nosidebar": True}
autodoc_member_order = "bysource"
autodoc_typehints = "none"


def as_written(app, what, name, obj, options, lines):
    """Docstrings are plain text, laid out by hand: their line ends stay."""
    for i, line in enumerate(lines):
        lines[i] = "| " + re.sub(r"([\\*|_`])", r"\\\1", line) if line.strip() else ""


def setup(app):
    app.connect("autodoc-process-docstring", as_written)
