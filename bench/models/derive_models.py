"""Derives surfaces from the clean models: derive_models.py CLEAN_DIR CT_PACKAGE_DIR TARGET PROGRAM."""
import concurrent.futures
import json
import os
import pathlib
import subprocess
import sys

import numpy as np
import vtk
from vtk.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray

from extract_models import arrays_of_polydata, ct_volume, isosurface, skull_surface, write_off

DECIMATED = (50, 20, 5)  # per cent of the triangles left
NOISE = (0.05, 0.2)  # per cent of the diagonal: standard deviation along each axis
LEAST_TRIANGLES = 40  # fewer than that are other tests' business
SKULLS = ((2, 225.53), (3, 225.53), (4, 225.53), (5, 225.53), (6, 225.53), (4, 400.53), (6, 400.53), (5, -300.53))  # shrink, level
RESOLUTIONS = (20, 40, 80)  # grid points a side


def read_off(path):
    """Points and triangles; polygons become fans, colours and comments are passed over."""
    rows = [row for line in open(path) if (row := line.split("#")[0].split())]
    if len(rows[0]) == 1:
        rows.pop(0)  # "OFF" alone, before the counts
    vertices, faces = (int(n) for n in rows[0][-3:-1])
    points = np.array([row[:3] for row in rows[1:1 + vertices]], dtype=float)
    polygons = [[int(v) for v in row[1:1 + int(row[0])]] for row in rows[1 + vertices:1 + vertices + faces]]
    return points, np.array([(p[0], p[i], p[i + 1]) for p in polygons for i in range(1, len(p) - 1)])


def read_surface(path):
    if path.suffix == ".off":
        points, faces = read_off(path)
    else:
        read = {".stl": vtk.vtkSTLReader, ".ply": vtk.vtkPLYReader}[path.suffix]()
        read.SetFileName(str(path))
        triangles = vtk.vtkTriangleFilter()
        triangles.SetInputConnection(read.GetOutputPort())
        triangles.Update()
        points, faces = arrays_of_polydata(triangles.GetOutput())
    points, index = np.unique(points, axis=0, return_inverse=True)
    return points, index.reshape(-1)[faces]


def polydata(points, faces):
    poly = vtk.vtkPolyData()
    vertices = vtk.vtkPoints()
    vertices.SetData(numpy_to_vtk(np.ascontiguousarray(points), deep=True))
    cells = vtk.vtkCellArray()
    rows = np.column_stack([np.full(len(faces), 3), faces]).astype(np.int64).ravel()
    cells.SetCells(len(faces), numpy_to_vtkIdTypeArray(rows, deep=True))
    poly.SetPoints(vertices)
    poly.SetPolys(cells)
    return poly


def decimated(points, faces, percent):
    reduce = vtk.vtkQuadricDecimation()
    reduce.SetInputData(polydata(points, faces))
    reduce.SetTargetReduction(1 - percent / 100)
    reduce.Update()
    points, faces = arrays_of_polydata(reduce.GetOutput())
    used, index = np.unique(faces, return_inverse=True)
    return points[used], index.reshape(-1, 3)


def noisy(points, percent, seed):
    diagonal = np.linalg.norm(np.ptp(points, axis=0))
    return points + np.random.default_rng(seed).normal(0, percent / 100 * diagonal, points.shape)


# Distinct periods and an odd level: no value falls on a grid point.
def gyroid(x, y, z):
    a, b, c = 5.1 * x, 5.3 * y, 4.9 * z
    shell = np.maximum.reduce([np.abs(x), np.abs(y), np.abs(z)]) - 1.7
    return np.maximum(np.sin(a) * np.cos(b) + np.sin(b) * np.cos(c) + np.sin(c) * np.cos(a) - 0.31, 3 * shell)


def balls(x, y, z):
    centers = np.random.default_rng(7).uniform(-1.1, 1.1, (12, 3))
    return 9.01 - sum(1 / ((x - a) ** 2 + (y - b) ** 2 + (z - c) ** 2 + 1e-3) for a, b, c in centers)


def cut_tori(x, y, z):
    rings = [np.hypot(np.hypot(x, y) - 1.1, z) - 0.31, np.hypot(np.hypot(y - 1.1, z) - 1.1, x) - 0.29]
    return np.maximum(np.minimum(*rings), x + 0.7 * y - 1.03)


def field_surface(field, n):
    axis = np.linspace(-2.03, 2.01, n)
    z, y, x = np.meshgrid(axis, axis, axis, indexing="ij")
    return isosurface(field(x, y, z).astype(np.float32), (axis[1] - axis[0],) * 3, 0.0, outside=3.0)


def derived(clean, ct):
    """Yields (name, maker): one per surface to derive."""
    for number, path in enumerate(sorted(clean.iterdir())):
        def load(path=path):
            return read_surface(path)
        for percent in DECIMATED:
            yield f"{path.stem}_d{percent}", lambda load=load, percent=percent: decimated(*load(), percent)
        for percent in NOISE:
            def make(load=load, percent=percent, seed=number):
                points, faces = load()
                return noisy(points, percent, seed), faces
            yield f"{path.stem}_n{percent}", make
    for field in (gyroid, balls, cut_tori):
        for n in RESOLUTIONS:
            yield f"{field.__name__}_{n}", lambda field=field, n=n: field_surface(field, n)
    if any(ct.glob("usr/share/doc/invesalius-examples/**/Cranium.inv3")):
        for shrink, level in SKULLS:
            yield f"skull_{shrink}_{level:.0f}", lambda shrink=shrink, level=level: skull_surface(
                *ct_volume(ct), level, shrink)


def is_clean(program, path):
    """One closed surface: decimation makes complexes too, with sheets, of which the boundary of a mesh knows nothing."""
    done = subprocess.run([program, "check", path, "--json", "-", "-q"], capture_output=True, text=True)
    return done.returncode == 0 and "input_regions" not in json.loads(done.stdout)


def make_one(job):
    clean, ct, target, program, name = job
    points, faces = dict(derived(clean, ct))[name]()
    path = target / (name + ".off")
    if len(faces) >= LEAST_TRIANGLES:
        write_off(path, points, faces)
        if is_clean(program, path):
            return True
        path.unlink()
    return False


def main(clean, ct, target, program):
    clean, ct, target = pathlib.Path(clean), pathlib.Path(ct), pathlib.Path(target)
    target.mkdir(parents=True, exist_ok=True)
    jobs = [(clean, ct, target, program, name) for name, _ in derived(clean, ct)]
    with concurrent.futures.ProcessPoolExecutor(os.cpu_count()) as pool:
        kept = sum(pool.map(make_one, jobs))
    print(f"{kept} of {len(jobs)} derived surfaces are clean: {target}/")


main(*sys.argv[1:])
