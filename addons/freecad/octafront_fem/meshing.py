"""From a mesh object to a command line of octafront, and from the file that it writes to a FemMesh."""
import json
import math
import pathlib
import shutil
import tempfile

import FreeCAD
import Fem
import Part

from . import groups, named_step, program
from .program import Refused
from .references import elements_of, kind_of, number_of

PREFERENCES = "User parameter:BaseApp/Preferences/Mod/Octafront"
POINTS_PER_SIZE = 2  # on an edge that has a size: so near each other that it holds between them
MOST_POINTS = 100_000
NO_SIZE = 10  # times the diagonal: no element is as large
OWN = ("--output", "-o", "--json", "--order", "--layers-as-tets", "--unit", "--format")  # options that are given here


def preferred_program():
    return FreeCAD.ParamGet(PREFERENCES).GetString("Program", "")


def number(value):
    return format(float(value), ".17g")


class Meshing:
    """One run. `command` is made by prepare(); who has run it calls take() with its report; close() removes the files.

    mesh: an object of make_mesh(), or FreeCAD's own for Gmsh, whose sizes, order, regions, groups and boundary layers are heeded.
    analysis: whose references become groups; may be None.
    """

    def __init__(self, mesh, analysis=None):
        self.mesh, self.analysis, self.part = mesh, analysis, mesh.Part
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="octafront-"))
        self.step, self.unv, self.report_file = (self.folder / name for name in ("shape.step", "mesh.unv", "report.json"))
        self.command = []

    def prepare(self):
        """Writes the shape and gives the command line. Raises Refused."""
        if self.part is None:
            raise Refused(f"{self.mesh.Label} has no shape: set its property Part")
        executable = program.find(preferred_program())
        named_step.write(self.part.Shape, self.step)
        self.command = [executable, "mesh", str(self.step), f"--output={self.unv}", f"--json={self.report_file}",
                        *self._sizes(), *self._regions(), *self._kept(), *self._layers(), *self._further()]
        return self.command

    def _sizes(self):
        mesh = self.mesh
        made = ["--order=2"] if mesh.ElementOrder == "2nd" else ["--order=1"]
        made += [f"--{option}={number(value.Value)}" for option, value in (("size", mesh.CharacteristicLengthMax), ("min-size", mesh.CharacteristicLengthMin))
                 if value.Value > 0]
        if getattr(mesh, "Elements", 0) > 0:
            made.append(f"--elements={mesh.Elements}")
        if getattr(mesh, "Preset", "standard") != "standard":
            made.append(f"--preset={mesh.Preset}")
        return made

    def _regions(self):
        """Faces and solids are places by name; edges and points are told as points that have a size."""
        made, points = [], []
        for region in self.mesh.MeshRegionList:
            size = region.CharacteristicLength.Value
            names = elements_of(region, self.part)
            if size <= 0 or not names:
                raise Refused(f"{region.Label} has no {'size' if names else 'reference'}: give it one, or remove it")
            for name in names:
                if kind_of(name) in ("Face", "Solid"):
                    made.append(f"--size-of={name}={number(size)}")
                else:
                    points += [(point, size) for point in points_along(self.part.Shape.getElement(name), size)]
        if points:
            file = self.folder / "sizes.txt"
            file.write_text("".join(" ".join(number(x) for x in (*point, size)) + "\n" for point, size in points), encoding="utf-8")
            made.append(f"--regions={file}")
        return made

    def _kept(self):
        """Faces that something refers to keep their borders: narrow smooth ones would be meshed as one, but not those that have a size of their own,
        and one that is larger than all asks for nothing."""
        shape = self.part.Shape
        named = {name for obj in groups.refer(self.mesh, self.analysis) for name in elements_of(obj, self.part)}
        faces = {name for name in named if kind_of(name) == "Face"}
        number_of_face = named_step.number_of(shape, shape.Faces)
        for edge in (name for name in named if kind_of(name) == "Edge"):
            faces |= {f"Face{number_of_face(face) + 1}" for face in shape.ancestorsOfType(shape.getElement(edge), Part.Face)}
        return [f"--size-of={name}={number(NO_SIZE * shape.BoundBox.DiagonalLength)}" for name in sorted(faces, key=number_of)]

    def _layers(self):
        """Boundary layers: their settings hold for all faces of a mesh."""
        all_settings, faces = set(), []
        for layers in self.mesh.MeshBoundaryLayerList:
            if layers.MinimumThickness.Value <= 0 or not layers.References:
                raise Refused(f"{layers.Label} has no thickness or no faces: give it both, or remove it")
            all_settings.add((layers.NumberOfLayers, layers.MinimumThickness.Value, layers.GrowthRate))
            faces += elements_of(layers, self.part)
        if not all_settings:
            return []
        if len(all_settings) > 1 or any(kind_of(face) != "Face" for face in faces):
            raise Refused("boundary layers lie on faces, and all of a mesh have the same number, height and growth")
        (count, first, growth), = all_settings
        return ["--layers-as-tets", f"--layers={count}", f"--first={number(first)}", f"--growth={number(growth)}", f"--on={','.join(faces)}"]

    def _further(self):
        options = [option.strip() for option in getattr(self.mesh, "Options", []) if option.strip()]
        for option in options:
            if not option.startswith("--"):
                raise Refused(f"Options: {option} is none: they are written as --through=2")
            if option.split("=")[0] in OWN:
                raise Refused(f"Options: {option.split('=')[0]} is given by the workbench")
        return options

    def take(self, report):
        """Reads the mesh that was written, gives it groups, and puts it into the object. Returns notes, a list of sentences."""
        made = Fem.read(str(self.unv))
        notes = groups.add(made, self.mesh, self.analysis)
        self.mesh.FemMesh = made
        if hasattr(self.mesh, "Told"):
            self.mesh.Told = told(report) + notes
        return notes

    def close(self):
        shutil.rmtree(self.folder, ignore_errors=True)

    def __enter__(self):
        return self

    def __exit__(self, *error):
        self.close()


def points_along(shape, size):
    """Of an edge, or the one point of a vertex."""
    if shape.ShapeType == "Vertex":
        return [shape.Point]
    return shape.discretize(Number=max(2, min(MOST_POINTS, 1 + math.ceil(POINTS_PER_SIZE * shape.Length / size))))


def told(report):
    quality = report.get("quality", {})
    return [f"{report.get('tets', 0)} tetrahedra, beta {quality.get('beta_min', 0):.3f} at least, {quality.get('beta_mean', 0):.3f} in the mean",
            *(note if isinstance(note, str) else note.get("text", "") for note in report.get("notes", []))]


def mesh_shape(mesh, analysis=None, *, progress=None, cancelled=None):
    """Meshes the shape of a mesh object and puts the FemMesh into it. `progress(stage, fraction)` is told how far it is, a fraction below 0 where
    it is not known; `cancelled()` is asked whether to stop. Returns the report of the program, a dict, with "freecad_notes" besides. The object keeps its old
    mesh if that fails. Raises Refused, Failed, Cancelled."""
    with Meshing(mesh, analysis) as meshing:
        report = program.run(meshing.prepare(), meshing.report_file, progress, cancelled)
        report["freecad_notes"] = meshing.take(report)
        return report
