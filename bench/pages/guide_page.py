#!/usr/bin/env python3
"""Writes what a notebook shows of a mesh as a page: guide_page.py PAGE.html"""
import sys

import octafront

mesh = octafront.mesh(octafront.read("samples/bracket.stl"), size=4, patches=True)
with open(sys.argv[1], "w") as page:
    page.write(f"<meta charset='utf-8'><body style='font: 14px sans-serif; margin: 20px'>{mesh._repr_html_()}")
