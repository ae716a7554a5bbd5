#!/usr/bin/python3
"""Draws surfaces with defects above what repair made of them: before_after.py PROGRAM PICTURE.png MODEL.off ...

Red above: edges of one triangle, or of more than two; below, orange: what closes holes ("closed by repair"). Five models in a row.
Needs the Debian packages python3-vtk9, python3-numpy and, where there is no display, xvfb (run under xvfb-run).
"""
import pathlib
import subprocess
import sys
import tempfile

import vtk

SIDE, COLUMNS = 260, 5
CLOSED = "closed by repair"


def read_off(path):
    rows = [line.split("#")[0].split() for line in open(path, errors="replace")]
    rows = [row for row in rows if row]
    counts, first = (rows[0][1:], 1) if len(rows[0]) > 1 else (rows[1], 2)
    points, faces = int(counts[0]), int(counts[1])
    corners = [[int(x) for x in row[1:1 + int(row[0])]] for row in rows[first + points:first + points + faces]]
    return [[float(x) for x in row[:3]] for row in rows[first:first + points]], corners, [False] * faces


def read_obj(path):
    points, faces, is_closed, closed = [], [], [], False
    for line in open(path):
        words = line.split()
        if line.startswith("v "):
            points.append([float(x) for x in words[1:4]])
        elif line.startswith(("g ", "usemtl ")):
            closed = CLOSED in line.replace("_", " ")
        elif line.startswith("f "):
            faces.append([int(w.split("/")[0]) - 1 for w in words[1:]])
            is_closed.append(closed)
    return points, faces, is_closed


def actors(points, faces, is_closed):
    place = vtk.vtkPoints()
    for p in points:
        place.InsertNextPoint(p)
    for wanted, colour in ((False, (0.72, 0.78, 0.88)), (True, (0.95, 0.6, 0.2))):
        cells = vtk.vtkCellArray()
        for face, closed in zip(faces, is_closed):
            if closed == wanted:
                cells.InsertNextCell(len(face), face)
        data = vtk.vtkPolyData()
        data.SetPoints(place)
        data.SetPolys(cells)
        yield actor(data, colour)
        if not wanted and not any(is_closed):
            yield edges_of(data)


def actor(data, colour):
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputData(data)
    mapper.ScalarVisibilityOff()
    made = vtk.vtkActor()
    made.SetMapper(mapper)
    made.GetProperty().SetColor(colour)
    made.GetProperty().SetInterpolationToFlat()
    return made


def edges_of(data):
    clean = vtk.vtkCleanPolyData()
    clean.SetInputData(data)
    edges = vtk.vtkFeatureEdges()
    edges.SetInputConnection(clean.GetOutputPort())
    edges.FeatureEdgesOff()
    edges.Update()
    made = actor(edges.GetOutput(), (0.9, 0, 0))
    made.GetProperty().SetLineWidth(2)
    return made


def main(program, picture, models):
    rows = 2 * -(-len(models) // COLUMNS)
    window = vtk.vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetSize(COLUMNS * SIDE, rows * SIDE)
    for k, model in enumerate(models):
        with tempfile.TemporaryDirectory() as folder:
            made = pathlib.Path(folder, "made.obj")
            subprocess.run([program, "repair", model, "-o", made, "-q"], check=True)
            pair = read_off(model), read_obj(made)
        for i, surface in enumerate(pair):
            renderer = vtk.vtkRenderer()
            renderer.SetBackground(1, 1, 1)
            for each in actors(*surface):
                renderer.AddActor(each)
            x, y = k % COLUMNS, rows - 1 - 2 * (k // COLUMNS) - i
            renderer.SetViewport(x / COLUMNS, y / rows, (x + 1) / COLUMNS, (y + 1) / rows)
            camera = renderer.GetActiveCamera()
            camera.SetPosition(0.6, 0.4, 1)
            renderer.ResetCamera()
            camera.Zoom(1.4)
            window.AddRenderer(renderer)
    window.Render()
    image = vtk.vtkWindowToImageFilter()
    image.SetInput(window)
    writer = vtk.vtkPNGWriter()
    writer.SetFileName(picture)
    writer.SetInputConnection(image.GetOutputPort())
    writer.Write()


if __name__ == "__main__":
    if len(sys.argv) < 4:
        sys.exit(__doc__)
    main(sys.argv[1], sys.argv[2], sys.argv[3:])
