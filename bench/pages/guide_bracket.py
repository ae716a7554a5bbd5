#!/usr/bin/python3
"""Draws the bracket of docs/use/guide.md, bent: guide_bracket.py FOLDER PICTURE.png. Needs python3-vtk9; run under xvfb-run,
with examples/solve in PYTHONPATH."""
import pathlib
import sys

import vtk

import ccx
import picture

folder = pathlib.Path(sys.argv[1])
mesh, fields = ccx.Mesh(folder / "part.inp"), ccx.frd(folder / "pull.frd")
moved = {node: u[:3] for node, u in fields["DISP"].items()}
length = {node: sum(x * x for x in moved.get(node, (0, 0, 0))) ** 0.5 for node in mesh.nodes}
window = vtk.vtkRenderWindow()
window.SetOffScreenRendering(1)
window.SetMultiSamples(8)
window.SetSize(800, 600)
window.AddRenderer(picture.viewport(mesh, length, "displacement, mm (drawn 10 times)", (-0.7, -1, 0.7), moved, 10.0,
                                     zoom=0.95))
picture.save(window, sys.argv[2])
