#!/usr/bin/env python3
"""Draws a mesh with a cut, elements coloured by quality, or with --regions by the region that they are in:
render.py MESH.vtu PICTURE.png [--cut X,Y,Z] [--view X,Y,Z].

Whole elements on one side of the cutting plane are shown, none is sliced. Needs the Debian packages python3-vtk9 and,
where there is no display, xvfb (run under xvfb-run).
"""
import argparse

import numpy as np
import vtk
from vtk.util.numpy_support import vtk_to_numpy


def vector(text):
    return np.array([float(x) for x in text.split(",")])


def read_tets(path):
    reader = vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(path)
    reader.Update()
    return reader.GetOutput()


def extracted(grid, cells):
    ids = vtk.vtkIdList()
    for cell in cells:
        ids.InsertNextId(int(cell))
    extract = vtk.vtkExtractCells()
    extract.SetInputData(grid)
    extract.SetCellList(ids)
    extract.Update()
    return extract.GetOutput()


def cells_behind(grid, normal, fraction):
    """The tetrahedra whose centroid lies behind the plane that leaves `fraction` of the extent."""
    points = vtk_to_numpy(grid.GetPoints().GetData())
    types = vtk_to_numpy(grid.GetCellTypesArray())
    tets = np.flatnonzero(np.isin(types, (vtk.VTK_TETRA, vtk.VTK_QUADRATIC_TETRA)))
    corners = vtk_to_numpy(grid.GetCells().GetConnectivityArray())
    offsets = vtk_to_numpy(grid.GetCells().GetOffsetsArray())[:-1]
    height = points[corners[offsets[tets][:, None] + np.arange(4)]].mean(axis=1) @ normal
    level = points @ normal
    keep = tets[height <= level.min() + fraction * (level.max() - level.min())]
    return extracted(grid, keep)


def colours():
    # Red for poor, through yellow, to the blue of good elements; the eye should catch the poor ones.
    table = vtk.vtkColorTransferFunction()
    for value, rgb in ((0, (0.7, 0, 0.1)), (0.4, (0.95, 0.5, 0.1)), (0.7, (0.98, 0.9, 0.5)), (1, (0.25, 0.5, 0.75))):
        table.AddRGBPoint(value, *rgb)
    return table


def colours_of_regions(count):
    # Okabe and Ito's palette, which colour-blind eyes tell apart; the first region, often a matrix, is pale.
    palette = [(0.85, 0.85, 0.82), (0.34, 0.71, 0.91), (0.9, 0.62, 0), (0, 0.62, 0.45), (0.8, 0.47, 0.65), (0, 0.45, 0.7), (0.84, 0.37, 0)]
    table = vtk.vtkLookupTable()
    table.SetNumberOfTableValues(count)
    table.SetTableRange(0, max(1, count - 1))
    for region in range(count):
        table.SetTableValue(region, *palette[region and 1 + (region - 1) % (len(palette) - 1)], 1)
    return table


def skin_of(cells, edges, regions=False):
    """The skin of the elements, coloured by quality or region."""
    skin = vtk.vtkGeometryFilter()
    skin.SetInputData(cells)
    skin.SetNonlinearSubdivisionLevel(3)  # curved elements are drawn curved
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputConnection(skin.GetOutputPort())
    mapper.SetScalarModeToUseCellFieldData()
    mapper.SelectColorArray("region" if regions else "beta")
    count = 1 + int(cells.GetCellData().GetArray("region").GetRange()[1]) if regions else 0
    mapper.SetLookupTable(colours_of_regions(count) if regions else colours())
    mapper.UseLookupTableScalarRangeOn()
    actor = vtk.vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().SetEdgeVisibility(edges)
    actor.GetProperty().SetEdgeColor(0.15, 0.15, 0.15)
    actor.GetProperty().SetLineWidth(0.6)
    actor.GetProperty().SetAmbient(0.25)
    return actor


def scene(cells, edges, regions):
    actor = skin_of(cells, edges, regions)
    renderer = vtk.vtkRenderer()
    renderer.SetBackground(1, 1, 1)
    renderer.AddActor(actor)
    if not regions:
        renderer.AddActor2D(scale_of(actor))
    return renderer


def scale_of(actor):
    bar = vtk.vtkScalarBarActor()
    bar.SetLookupTable(actor.GetMapper().GetLookupTable())
    bar.SetTitle("beta")
    bar.SetNumberOfLabels(6)
    bar.SetVerticalTitleSeparation(10)
    bar.UnconstrainedFontSizeOn()
    bar.SetMaximumWidthInPixels(70)
    bar.SetPosition(0.9, 0.2)
    bar.SetHeight(0.6)
    for text in (bar.GetTitleTextProperty(), bar.GetLabelTextProperty()):
        text.SetColor(0.1, 0.1, 0.1)
        text.ShadowOff()
    return bar


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("mesh")
    parser.add_argument("picture")
    parser.add_argument("--cut", type=vector, default=vector("0,0,1"), help="normal of the cutting plane")
    parser.add_argument("--keep", type=float, default=0.5, help="part of the extent along the normal that is shown")
    parser.add_argument("--view", type=vector, default=None, help="from where to look; default: along the cut, aslant")
    parser.add_argument("--up", type=vector, default=vector("0,1,0"))
    parser.add_argument("--size", type=int, nargs=2, default=(1000, 800))
    parser.add_argument("--no-edges", action="store_true")
    parser.add_argument("--regions", action="store_true", help="colour by region")
    args = parser.parse_args()
    normal = args.cut / np.linalg.norm(args.cut)
    view = args.view if args.view is not None else normal + 0.35 * np.cross(args.up, normal) + 0.3 * args.up

    renderer = scene(cells_behind(read_tets(args.mesh), normal, args.keep), not args.no_edges, args.regions)
    window = vtk.vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(8)
    window.SetSize(*args.size)
    window.AddRenderer(renderer)
    camera = renderer.GetActiveCamera()
    camera.SetFocalPoint(0, 0, 0)
    camera.SetPosition(*view)
    camera.SetViewUp(*args.up)
    renderer.ResetCamera()
    camera.Zoom(1.25)
    window.Render()
    grab = vtk.vtkWindowToImageFilter()
    grab.SetInput(window)
    grab.ReadFrontBufferOff()
    writer = vtk.vtkPNGWriter()
    writer.SetFileName(args.picture)
    writer.SetInputConnection(grab.GetOutputPort())
    writer.Write()


if __name__ == "__main__":
    main()
