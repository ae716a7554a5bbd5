#!/usr/bin/env python3
"""Draws the surroundings of the worst element of each mesh, side by side: render_worst.py PICTURE.png MESH.vtu ...

Of the elements around it, those behind a plane through it are shown, coloured by quality. Needs what render.py needs.
"""
import math
import pathlib
import sys

import numpy as np
import vtk
from vtk.util.numpy_support import vtk_to_numpy

from render import extracted, read_tets, skin_of

PANEL, COLUMNS = 300, 5
AROUND = 5  # longest edges of the worst element


def around_worst(grid):
    """The elements, the place, how far they reach, and the direction from which to look."""
    points, beta = vtk_to_numpy(grid.GetPoints().GetData()).astype(float), vtk_to_numpy(grid.GetCellData().GetArray("beta"))
    types = vtk_to_numpy(grid.GetCellTypesArray())
    tets = np.flatnonzero(types == vtk.VTK_TETRA)
    offsets = vtk_to_numpy(grid.GetCells().GetOffsetsArray())[:-1]
    corners = vtk_to_numpy(grid.GetCells().GetConnectivityArray())[offsets[tets][:, None] + np.arange(4)]
    middle = points[corners].mean(axis=1)
    worst = int(np.argmin(beta[tets]))
    p = points[corners[worst]]
    reach = AROUND * max(np.linalg.norm(p[i] - p[j]) for i in range(4) for j in range(i))
    near = np.linalg.norm(middle - middle[worst], axis=1) < reach
    # From where there is least material the element is seen best.
    view = middle[worst] - middle[near].mean(axis=0)
    view /= np.linalg.norm(view) or 1
    size = np.linalg.norm(p - middle[worst], axis=1).max()
    keep = tets[near & ((middle - middle[worst]) @ view < 0.3 * size)]
    return extracted(grid, [*keep, tets[worst]]), middle[worst], reach, view, float(beta[tets[worst]])


def panel(path):
    cells, at, reach, view, beta = around_worst(read_tets(path))
    title = vtk.vtkTextActor()
    title.SetInput(f"{pathlib.Path(path).stem}  {beta:.3f}")
    title.SetPosition(8, 8)
    title.GetTextProperty().SetColor(0.1, 0.1, 0.1)
    title.GetTextProperty().SetFontSize(15)
    renderer = vtk.vtkRenderer()
    renderer.SetBackground(1, 1, 1)
    renderer.AddActor(skin_of(cells, True))
    renderer.AddActor2D(title)
    camera = renderer.GetActiveCamera()
    camera.SetFocalPoint(*at)
    camera.SetPosition(*(at + 3.2 * reach * view))
    camera.SetViewUp(*np.cross(view, (0.3, 0.9, 0.1) if abs(view[0]) > 0.7 else (0.9, 0.3, 0.1)))
    renderer.ResetCameraClippingRange()
    return renderer


def main():
    picture, meshes = sys.argv[1], sys.argv[2:]
    rows = math.ceil(len(meshes) / COLUMNS)
    window = vtk.vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(8)
    window.SetSize(COLUMNS * PANEL, rows * PANEL)
    for i, path in enumerate(meshes):
        renderer = panel(path)
        x, y = i % COLUMNS / COLUMNS, 1 - (i // COLUMNS + 1) / rows
        renderer.SetViewport(x, y, x + 1 / COLUMNS, y + 1 / rows)
        window.AddRenderer(renderer)
    window.Render()
    image = vtk.vtkWindowToImageFilter()
    image.SetInput(window)
    image.ReadFrontBufferOff()
    writer = vtk.vtkPNGWriter()
    writer.SetFileName(picture)
    writer.SetInputConnection(image.GetOutputPort())
    writer.Write()


if __name__ == "__main__":
    main()
