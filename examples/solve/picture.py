#!/usr/bin/python3
"""Draws what solve.py left in its work folder: picture.py WORK PICTURE.png. Needs python3-vtk9; run under xvfb-run."""
import math
import pathlib
import sys

import vtk
from vtk.util.numpy_support import vtk_to_numpy

import ccx


def grid(mesh, values, moved=None, scale=0.0):
    """The curved elements, with one value a node, displaced by scale * moved."""
    place = {node: k for k, node in enumerate(mesh.nodes)}
    points, field = vtk.vtkPoints(), vtk.vtkDoubleArray()
    field.SetName("value")
    for node, p in mesh.nodes.items():
        by = moved.get(node, (0, 0, 0)) if moved else (0, 0, 0)
        points.InsertNextPoint(*(x + scale * u for x, u in zip(p, by)))
        field.InsertNextValue(values[node])
    out = vtk.vtkUnstructuredGrid()
    out.SetPoints(points)
    out.GetPointData().SetScalars(field)
    for nodes in mesh.elements.values():  # the order of CalculiX is VTK's
        out.InsertNextCell(vtk.VTK_QUADRATIC_TETRA, 10, [place[n] for n in nodes])
    return out


def viewport(mesh, values, title, view, moved=None, scale=0.0, up=(0, 0, 1), zoom=1.2):
    skin = vtk.vtkGeometryFilter()
    skin.SetInputData(grid(mesh, values, moved, scale))
    skin.SetNonlinearSubdivisionLevel(3)
    skin.Update()
    numbers = vtk_to_numpy(skin.GetOutput().GetPointData().GetScalars())
    colours = vtk.vtkColorTransferFunction()
    low, high = float(numbers.min()), float(numbers.max())
    for part, rgb in ((0, (0.16, 0.24, 0.5)), (0.33, (0.25, 0.6, 0.75)), (0.66, (0.98, 0.9, 0.5)), (1, (0.75, 0.1, 0.12))):
        colours.AddRGBPoint(low + part * (high - low), *rgb)
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputConnection(skin.GetOutputPort())
    mapper.SetLookupTable(colours)
    actor = vtk.vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().SetAmbient(0.3)
    # The edges of the elements, curved: the skin's own triangles would show the subdivision.
    edges = vtk.vtkPolyData()
    edges.ShallowCopy(edge_lines(mesh, moved, scale))
    lines = vtk.vtkPolyDataMapper()
    lines.SetInputData(edges)
    lines.ScalarVisibilityOff()
    drawn = vtk.vtkActor()
    drawn.SetMapper(lines)
    drawn.GetProperty().SetColor(0.12, 0.12, 0.12)
    drawn.GetProperty().SetLineWidth(0.7)
    bar = vtk.vtkScalarBarActor()
    bar.SetLookupTable(colours)
    bar.SetNumberOfLabels(4)
    bar.SetOrientationToHorizontal()
    bar.UnconstrainedFontSizeOn()
    bar.SetMaximumHeightInPixels(60)
    bar.SetPosition(0.2, 0.02)
    bar.SetWidth(0.6)
    heading = vtk.vtkTextActor()
    heading.SetInput(title)
    heading.GetPositionCoordinate().SetCoordinateSystemToNormalizedViewport()
    heading.GetPositionCoordinate().SetValue(0.05, 0.93)
    for text in (heading.GetTextProperty(), bar.GetLabelTextProperty()):
        text.SetColor(0.1, 0.1, 0.1)
        text.SetFontSize(16)
        text.ShadowOff()
        text.ItalicOff()
        text.BoldOff()
    # Lines lie on the skin: they win.
    vtk.vtkMapper.SetResolveCoincidentTopologyToPolygonOffset()
    renderer = vtk.vtkRenderer()
    renderer.SetBackground(1, 1, 1)
    for actor in (actor, drawn):
        renderer.AddActor(actor)
    renderer.AddActor2D(bar)
    renderer.AddActor2D(heading)
    camera = renderer.GetActiveCamera()
    camera.SetFocalPoint(0, 0, 0)
    camera.SetPosition(*view)
    camera.SetViewUp(*up)
    renderer.ResetCamera()
    camera.Zoom(zoom)
    return renderer


SIDES = {"S1": ((0, 1, 4), (1, 2, 5), (2, 0, 6)), "S2": ((0, 3, 7), (3, 1, 8), (1, 0, 4)),
         "S3": ((1, 3, 8), (3, 2, 9), (2, 1, 5)), "S4": ((2, 3, 9), (3, 0, 7), (0, 2, 6))}


def edge_lines(mesh, moved, scale):
    """The edges of the sides in surfaces, as parabolas."""
    def at(node):
        by = moved.get(node, (0, 0, 0)) if moved else (0, 0, 0)
        return [x + scale * u for x, u in zip(mesh.nodes[node], by)]

    points, cells = vtk.vtkPoints(), vtk.vtkCellArray()
    seen = set()
    for sides in mesh.sides.values():
        for element, side in sides:
            nodes = mesh.elements[element]
            for a, b, m in SIDES[side]:
                if nodes[m] in seen:
                    continue
                seen.add(nodes[m])
                p, q, r = at(nodes[a]), at(nodes[m]), at(nodes[b])
                line = []
                for k in range(9):
                    t = k / 8
                    w = ((1 - t) * (1 - 2 * t), 4 * t * (1 - t), t * (2 * t - 1))
                    line.append(points.InsertNextPoint(*(w[0] * x + w[1] * y + w[2] * z for x, y, z in zip(p, q, r))))
                cells.InsertNextCell(len(line), line)
    out = vtk.vtkPolyData()
    out.SetPoints(points)
    out.SetLines(cells)
    return out


def load(work, name):
    return ccx.Mesh(work / f"{name}-mesh.inp"), ccx.frd(work / f"{name}.frd")


def pictures(work):
    mesh, fields = load(work, "cantilever")
    moved = {n: u[:3] for n, u in fields["DISP"].items()}
    yield viewport(mesh, {n: -moved[n][2] if n in moved else 0 for n in mesh.nodes}, "cantilever: deflection, mm",
                   (-0.3, -1, 0.5), moved, 2.0, zoom=1.15)
    mesh, fields = load(work, "pipe")
    hoop = {}
    for node, (x, y, _) in mesh.nodes.items():
        sx, sy, _, sxy = fields["STRESS"][node][:4]
        hoop[node] = (y * y * sx + x * x * sy - 2 * x * y * sxy) / (x * x + y * y)
    yield viewport(mesh, hoop, "pipe: hoop stress, MPa", (-0.6, -0.7, 1.0))
    mesh, fields = load(work, "heat")
    yield viewport(mesh, {n: fields["NDTEMP"][n][0] for n in mesh.nodes}, "heat: temperature, degrees", (-0.4, -1, 0.6))
    mesh, fields = load(work, "plate")
    moved = {n: u[:3] for n, u in fields["DISP"].items()}
    largest = max(abs(u[2]) for u in moved.values())
    yield viewport(mesh, {n: abs(moved.get(n, (0, 0, 0))[2]) / largest for n in mesh.nodes}, "plate: first mode",
                   (-0.5, -1, 0.8), moved, 15 / largest)


def main():
    work, picture = pathlib.Path(sys.argv[1]), sys.argv[2]
    window = vtk.vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(8)
    window.SetSize(1300, 1000)
    for k, renderer in enumerate(pictures(work)):
        x, y = (k % 2) / 2, 0.5 - math.floor(k / 2) / 2
        renderer.SetViewport(x, y, x + 0.5, y + 0.5)
        window.AddRenderer(renderer)
    save(window, picture)


def save(window, picture):
    window.Render()
    grab = vtk.vtkWindowToImageFilter()
    grab.SetInput(window)
    grab.ReadFrontBufferOff()
    writer = vtk.vtkPNGWriter()
    writer.SetFileName(picture)
    writer.SetInputConnection(grab.GetOutputPort())
    writer.Write()


if __name__ == "__main__":
    main()
