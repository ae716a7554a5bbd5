"""Jobs as documents of FreeCAD: a body, what holds and loads it, and what is read from the result. Runs inside FreeCAD, started by bench/run/freecad.py.

Each is meshed by Gmsh, as FreeCAD does it, or by the workbench of addons/freecad, and solved by CalculiX through FreeCAD.
"""
import dataclasses
import math
import pathlib
import sys
import tempfile
import time

import FreeCAD
import ObjectsFem
import Part
from femmesh.gmshtools import GmshTools
from femtools import ccxtools

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "addons/freecad"))
import octafront_fem  # noqa: E402

STEEL = {"Name": "Steel", "YoungsModulus": "210000 MPa", "PoissonRatio": "0.30", "Density": "7900 kg/m^3"}
ALUMINIUM = {"Name": "Aluminium", "YoungsModulus": "70000 MPa", "PoissonRatio": "0.33", "Density": "2700 kg/m^3"}
Vector = FreeCAD.Vector


@dataclasses.dataclass
class Job:
    """`hot`: names of the faces whose stress is read, with elements of size `fine` if that is given. `exact`: displacement there and stress, where there is
    a formula."""
    part: object
    analysis: object
    hot: list
    size: float
    fine: float = None
    exact: tuple = (None, None)

    def refine(self, mesh):
        if self.fine:
            region = ObjectsFem.makeMeshRegion(self.part.Document, mesh, self.fine)
            region.References = [(self.part, name) for name in self.hot]


class Maker:
    """Puts a job together in a document of its own."""

    def __init__(self, shape, label):
        self.doc = FreeCAD.newDocument(label)
        self.part = self.doc.addObject("Part::Feature", "Body")
        self.part.Shape = shape
        self.analysis = ObjectsFem.makeAnalysis(self.doc, "Analysis")
        solver = ObjectsFem.makeSolverCalculixCcxTools(self.doc, "Solver")
        solver.GeometricalNonlinearity, solver.ThermoMechSteadyState, solver.MatrixSolverType = "linear", False, "default"
        solver.IterationsControlParameterTimeUse = False
        self.analysis.addObject(solver)

    def add(self, obj):
        self.analysis.addObject(obj)
        return obj

    def faces(self, is_wanted):
        found = [f"Face{i + 1}" for i, face in enumerate(self.part.Shape.Faces) if is_wanted(face)]
        assert found, "no such face"
        return found

    def on(self, names):
        return [(self.part, name) for name in names]

    def material(self, properties, solids=()):
        material = self.add(ObjectsFem.makeMaterialSolid(self.doc, "Material"))
        material.Material = {**material.Material, **properties}
        material.References = self.on(solids)

    def fix(self, names):
        self.add(ObjectsFem.makeConstraintFixed(self.doc, "Fixed")).References = self.on(names)

    def hold(self, names, axis):
        held = self.add(ObjectsFem.makeConstraintDisplacement(self.doc, "Symmetry" + axis))
        held.References = self.on(names)
        setattr(held, axis + "Free", False)
        setattr(held, axis + "Fix", True)

    def press(self, names, pressure):
        pressed = self.add(ObjectsFem.makeConstraintPressure(self.doc, "Pressure"))
        pressed.References, pressed.Pressure, pressed.Reversed = self.on(names), pressure, False

    def pull(self, names, force, along):
        """`along`: a unit vector; it is given by an edge of that direction."""
        load = self.add(ObjectsFem.makeConstraintForce(self.doc, "Force"))
        load.References, load.Force = self.on(names), force
        edge = next(f"Edge{i + 1}" for i, e in enumerate(self.part.Shape.Edges)
                    if e.Curve.TypeId == "Part::GeomLine" and abs(abs(e.tangentAt(e.FirstParameter).dot(along)) - 1) < 1e-9)
        load.Direction, load.Reversed = (self.part, [edge]), False
        self.doc.recompute()
        if load.DirectionVector.dot(along) < 0:
            load.Reversed = True
            self.doc.recompute()
        assert (load.DirectionVector - along).Length < 1e-9, load.DirectionVector

    def job(self, hot, size, fine=None, exact=(None, None)):
        self.doc.recompute()
        return Job(self.part, self.analysis, hot, size, fine, exact)


def is_plane_at(axis, at):
    return lambda face: face.Surface.TypeId == "Part::GeomPlane" and abs(getattr(face.BoundBox, axis + "Min") - at) < 1e-6 \
        and abs(getattr(face.BoundBox, axis + "Max") - at) < 1e-6


def is_cylinder(radius, along=None):
    return lambda face: face.Surface.TypeId == "Part::GeomCylinder" and abs(face.Surface.Radius - radius) < 1e-6 \
        and (along is None or abs(abs(face.Surface.Axis.dot(along)) - 1) < 1e-9)


def bracket():
    """A bracket of the samples, held in two bolt holes, pulled at its wall; stress of its fillet."""
    made = Maker(Part.read(str(ROOT / "samples/bracket.step")), "bracket")
    made.material(STEEL)
    made.fix(made.faces(is_cylinder(4, Vector(0, 0, 1))))
    made.pull(made.faces(is_plane_at("X", 0)), 500, Vector(-1, 0, 0))
    return made.job(made.faces(is_cylinder(8)), 2.4, 0.9)


def plate():
    """A plate 100 x 40 x 5 with a hole of 10, pulled; stress at the hole."""
    hole = Part.makeCylinder(5, 7, Vector(50, 20, -1))
    made = Maker(Part.makeBox(100, 40, 5).cut(hole), "plate")
    made.material(STEEL)
    made.fix(made.faces(is_plane_at("X", 0)))
    made.pull(made.faces(is_plane_at("X", 100)), 20000, Vector(1, 0, 0))
    return made.job(made.faces(is_cylinder(5)), 2.5, 0.5)


def pipe():
    """A quarter of a thick pipe, pressed from inside: Lamé's formulas."""
    inner, outer, high, pressure = 10.0, 20.0, 10.0, 100.0
    ring = Part.makeCylinder(outer, high, Vector(), Vector(0, 0, 1), 90).cut(Part.makeCylinder(inner, high, Vector(), Vector(0, 0, 1), 90))
    made = Maker(ring, "pipe")
    made.material(STEEL)
    for axis in "xyz":
        made.hold(made.faces(is_plane_at(axis.upper(), 0)), axis)
    made.press(made.faces(is_cylinder(inner)), pressure)
    ratio = pressure / (outer**2 - inner**2)
    hoop, radial = ratio * (inner**2 + outer**2), -pressure
    mises = math.sqrt((hoop**2 + radial**2 + (hoop - radial)**2) / 2)  # ends are free
    moved = ratio * inner / 210000 * (0.7 * inner**2 + 1.3 * outer**2)
    return made.job(made.faces(is_cylinder(inner)), 2.0, exact=(moved, mises))


def two_metals():
    """A bar of two metals that share a face, bent by a pressure on top; stress on its lower side."""
    low, high = Part.makeBox(80, 10, 5), Part.makeBox(80, 10, 5, Vector(0, 0, 5))
    fused = low.generalFuse([high])[0]
    made = Maker(Part.CompSolid(fused.Solids), "two_metals")
    made.material(STEEL, ["Solid1"])
    made.material(ALUMINIUM, ["Solid2"])
    made.fix(made.faces(is_plane_at("X", 0)))
    made.press(made.faces(is_plane_at("Z", 10)), 0.5)
    return made.job(made.faces(is_plane_at("Z", 0)), 2.0)


JOBS = {"bracket": bracket, "plate": plate, "pipe": pipe, "two_metals": two_metals}


def by_gmsh(job, size):
    """Meshes it as FreeCAD does by itself: (mesh object, seconds)."""
    mesh = ObjectsFem.makeMeshGmsh(job.part.Document, "Mesh")
    mesh.Part, mesh.CharacteristicLengthMax, mesh.ElementOrder = job.part, size, "2nd"
    mesh.SecondOrderLinear, mesh.HighOrderOptimize = False, "Optimization"  # mid-side nodes on the shape, and no element inside out
    job.analysis.addObject(mesh)
    job.refine(mesh)
    start = time.perf_counter()
    GmshTools(mesh, job.analysis).create_mesh()
    return mesh, time.perf_counter() - start


def by_octafront(job, size):
    mesh = octafront_fem.make_mesh(job.part, "Mesh", size=size)
    job.analysis.addObject(mesh)
    job.refine(mesh)
    start = time.perf_counter()
    octafront_fem.mesh_shape(mesh, job.analysis)
    return mesh, time.perf_counter() - start


MESHERS = {"gmsh": by_gmsh, "octafront": by_octafront}
TRIES, NEAR = 10, .03


def of_about(job, mesher, count, size):
    """A mesh with about `count` tetrahedra, the nearest of TRIES sizes: (mesh object, seconds). How many there are does not grow evenly as
    sizes fall, so sizes are halved between those that made too few and too many."""
    too_few, too_many, tried = None, None, {}
    for _ in range(TRIES):
        mesh, _ = MESHERS[mesher](job, size)
        made = mesh.FemMesh.VolumeCount
        job.part.Document.removeObject(mesh.Name)
        tried[abs(made / count - 1)] = size
        if abs(made / count - 1) <= NEAR:
            break
        too_few, too_many = (size, too_many) if made < count else (too_few, size)
        size = math.sqrt(too_few * too_many) if too_few and too_many else size * (made / count) ** (1 / 3) * (.97 if made < count else 1.03)
    return MESHERS[mesher](job, tried[min(tried)])


def mean_on(femmesh, faces, shape, values):
    """Of values at nodes, by the areas of the triangles on these faces."""
    total = area = 0.0
    nodes = femmesh.Nodes
    for name in faces:
        for element in femmesh.getFacesByFace(shape.getElement(name)):
            corners = femmesh.getElementNodes(element)[:3]
            a, b, c = (nodes[n] for n in corners)
            weight = (b - a).cross(c - a).Length / 2
            total, area = total + weight * sum(values[n] for n in corners) / 3, area + weight
    return total / area


def solve(job, mesh):
    """As CalculiX finds them: the largest displacement, von Mises stress of the hot faces in the mean and at most, and the mean displacement there."""
    tools = ccxtools.FemToolsCcx(job.analysis)
    tools.update_objects()
    with tempfile.TemporaryDirectory() as folder:
        tools.setup_working_dir(folder)
        wrong = tools.check_prerequisites()
        assert not wrong, wrong
        tools.purge_results()
        tools.write_inp_file()
        status = tools.ccx_run()
        assert status == 0, f"CalculiX ended with {status}"
        tools.load_results()
    result = next(o for o in job.analysis.Group if o.isDerivedFrom("Fem::FemResultObject"))
    stress, moved = dict(zip(result.NodeNumbers, result.vonMises)), dict(zip(result.NodeNumbers, result.DisplacementLengths))
    shape = job.part.Shape
    hot = {node for name in job.hot for node in mesh.FemMesh.getNodesByFace(shape.getElement(name))}
    return {"displacement": max(moved.values()), "hot_displacement": mean_on(mesh.FemMesh, job.hot, shape, moved),
            "stress": mean_on(mesh.FemMesh, job.hot, shape, stress), "peak": max(stress[n] for n in hot)}


def run(name, mesher, count=None, factor=1.0):
    """A row: what was made, and what CalculiX says of it. `count`: of about so many elements; `factor`: all sizes times it."""
    job = JOBS[name]()
    job.size, job.fine = job.size * factor, job.fine and job.fine * factor
    mesh, seconds = of_about(job, mesher, count, job.size) if count else MESHERS[mesher](job, job.size)
    femmesh = mesh.FemMesh
    start = time.perf_counter()
    row = {"job": name, "mesher": mesher, "tets": femmesh.VolumeCount, "nodes": femmesh.NodeCount, "mesh_seconds": seconds, **solve(job, mesh)}
    row["solve_seconds"] = time.perf_counter() - start
    row["exact_displacement"], row["exact_stress"] = job.exact
    FreeCAD.closeDocument(job.part.Document.Name)
    return row
