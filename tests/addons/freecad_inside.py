"""What the workbench of addons/freecad does, looked at from inside FreeCAD (freecadcmd): freecad_test.py starts it, and reads what it says."""
import json
import math
import os
import pathlib
import sys
import traceback

ROOT = pathlib.Path(__file__).resolve().parents[2] if "__file__" in globals() else pathlib.Path(os.environ["OCTAFRONT_ROOT"])
sys.path.insert(0, str(ROOT / "addons/freecad"))

import FreeCAD  # noqa: E402
import Fem  # noqa: E402, F401
import ObjectsFem  # noqa: E402
import Part  # noqa: E402
import octafront_fem  # noqa: E402
from femmesh import meshtools  # noqa: E402
from octafront_fem import groups, named_step, program  # noqa: E402

Vector = FreeCAD.Vector
SCRATCH = pathlib.Path(os.environ["OCTAFRONT_SCRATCH"])


def drilled():
    return Part.makeBox(10, 10, 10).cut(Part.makeCylinder(2, 12, Vector(5, 5, -1)))


def beside():
    return Part.makeBox(10, 10, 5, Vector(10, 0, 0))


def turned():
    box = Part.makeBox(3, 4, 5)
    other = box.copy()
    other.Placement = FreeCAD.Placement(Vector(20, 3, 1), FreeCAD.Rotation(Vector(1, 2, 3), 40))
    return Part.makeCompound([box, other, box.translated(Vector(0, 30, 0))])  # the third has the faces of the first


def rounded():
    box = Part.makeBox(20, 15, 10)
    return box.makeFillet(2, box.Edges)


SHAPES = {
    "drilled": drilled,
    "touching": lambda: Part.makeCompound([drilled(), beside()]),
    "fused": lambda: Part.CompSolid(drilled().generalFuse([beside()])[0].Solids),
    "hollow": lambda: Part.makeBox(10, 10, 10).cut(Part.makeBox(2, 3, 4, Vector(4, 4, 4))),
    "turned": turned,
    "rounded": rounded,
    "ball": lambda: Part.makeSphere(5),
    "ring": lambda: Part.makeTorus(8, 2),
    "inside": lambda: Part.makeCompound(Part.makeBox(10, 10, 10).generalFuse([Part.makeSphere(3, Vector(5, 5, 5))])[0].Solids),
}


SHARING = ("touching", "inside")  # whose faces lie on each other, and are there once in the mesh


class Scene:
    """A document with a shape, an analysis and a mesh object."""

    def __init__(self, shape, **settings):
        self.doc = FreeCAD.newDocument()
        self.part = self.doc.addObject("Part::Feature", "Body")
        self.part.Shape = shape
        self.analysis = ObjectsFem.makeAnalysis(self.doc, "Analysis")
        self.mesh = octafront_fem.make_mesh(self.part, **settings)
        self.analysis.addObject(self.mesh)

    def run(self, **more):
        report = octafront_fem.mesh_shape(self.mesh, self.analysis, **more)
        self.fem = self.mesh.FemMesh
        return report

    def group(self, name):
        """{kind: ids} of all groups of that name."""
        return {self.fem.getGroupElementType(g): set(self.fem.getGroupElements(g)) for g in self.fem.Groups if self.fem.getGroupName(g) == name}

    def face(self, number):
        return self.part.Shape.Faces[number - 1]

    def mean_edge(self, number):
        """Of the triangles on a face."""
        lengths, nodes = [], self.fem.Nodes
        for element in self.fem.getFacesByFace(self.face(number)):
            a, b, c = (nodes[n] for n in self.fem.getElementNodes(element)[:3])
            lengths += [(a - b).Length, (b - c).Length, (c - a).Length]
        return sum(lengths) / len(lengths)

    def region(self, names, size):
        ObjectsFem.makeMeshRegion(self.doc, self.mesh, size).References = [(self.part, name) for name in names]


def area(scene, triangles):
    nodes, total = scene.fem.Nodes, 0.0
    for triangle in triangles:
        a, b, c = (nodes[n] for n in scene.fem.getElementNodes(triangle)[:3])
        total += (b - a).cross(c - a).Length / 2
    return total


def check_names(name):
    """Each face's group has those triangles that lie on it, and each solid's those tetrahedra that fill it."""
    scene = Scene(SHAPES[name](), size=1.5)
    scene.run()
    shape, written = scene.part.Shape, groups.Written(scene.fem, scene.part)
    total = 0
    for f, face in enumerate(shape.Faces):
        by_name, by_place = set(written.elements(f"Face{f + 1}")), set(scene.fem.getFacesByFace(face))
        assert by_name and (by_name == by_place or name == "rounded"), (name, f + 1, len(by_name), len(by_place))
        total += len(by_name)
    assert total >= scene.fem.FaceCount, (total, scene.fem.FaceCount)
    assert abs(area(scene, scene.fem.FacesOnly or scene.fem.Faces) / sum(f.Area for f in shape.Faces) - 1) < .05 or name in SHARING, name
    nodes = scene.fem.Nodes
    for s, solid in enumerate(shape.Solids):
        volume = 0.0
        for tet in written.elements(f"Solid{s + 1}"):
            a, b, c, d = (nodes[n] for n in scene.fem.getElementNodes(tet)[:4])
            volume += abs((b - a).cross(c - a).dot(d - a)) / 6
        assert abs(volume / solid.Volume - 1) < .12, (name, s + 1, volume, solid.Volume)


def test_names():
    for name in SHAPES:
        check_names(name)


def test_faces_that_are_referred_to_keep_their_borders():
    """Smooth narrow faces are meshed as one, and then FreeCAD finds fewer of their triangles than there are."""
    scene = Scene(rounded(), size=1.5)
    scene.run()
    merged = groups.Written(scene.fem, scene.part)
    assert any(set(merged.elements(f"Face{n}")) != set(scene.fem.getFacesByFace(scene.face(n))) for n in range(1, 27)), "nothing was meshed as one"
    fixed = scene.doc.addObject("Fem::ConstraintFixed", "Held")
    fixed.References = [(scene.part, f"Face{n}") for n in range(1, 27)]
    scene.analysis.addObject(fixed)
    assert not scene.run()["freecad_notes"]
    for n in range(1, 27):
        assert set(groups.Written(scene.fem, scene.part).elements(f"Face{n}")) == set(scene.fem.getFacesByFace(scene.face(n))), n


def test_names_follow_faces_and_not_their_order():
    """A file whose shells list their faces in another order."""
    shape, path = rounded(), SCRATCH / "order.step"
    shape.exportStep(str(path))
    text = path.read_text()
    shell = named_step.SHELL.search(text)
    faces = named_step.numbers(shell[2])
    text = text.replace(shell[2], ",".join("#" + n for n in faces[::-1]))
    path.write_text(text)
    straight, _ = named_step.names(shape, path, text)
    assert [straight[n] for n in faces] == [f"Face{i + 1}" for i in range(len(faces))], straight


def test_another_shape_is_refused():
    path = SCRATCH / "other.step"
    Part.makeBox(1, 2, 3).exportStep(str(path))
    for other in (Part.makeBox(1, 2, 4), drilled(), turned()):
        try:
            named_step.names(other, path, path.read_text())
        except octafront_fem.Refused:
            continue
        raise AssertionError(f"{len(other.Faces)} faces were found in another shape")


def test_sizes_by_face_edge_point_and_solid():
    plain = Scene(drilled(), size=2)
    plain.run()
    for names, number in ((["Face3"], 3), (["Edge1", "Edge2", "Edge3"], 1), (["Vertex1"], 1)):
        scene = Scene(drilled(), size=2)
        scene.region(names, .5)
        assert scene.run()["tets"] > plain.fem.VolumeCount, names
        assert scene.mean_edge(number) < .9 * plain.mean_edge(number), names
    assert scene.mean_edge(7) > .8 * plain.mean_edge(7)  # far from the point
    scene = Scene(SHAPES["touching"](), size=2)
    scene.region(["Solid2"], .7)
    scene.run()
    volumes = [len(scene.group(f"Solid{s}")["Volume"]) / scene.part.Shape.Solids[s - 1].Volume for s in (1, 2)]
    assert volumes[1] > 2 * volumes[0], volumes


def test_orders():
    for order, nodes in (("1st", 4), ("2nd", 10)):
        scene = Scene(drilled(), size=3, order=order)
        scene.run()
        assert {len(scene.fem.getElementNodes(v)) for v in scene.fem.Volumes} == {nodes}
        radius = [math.hypot(p.x - 5, p.y - 5) for p in (scene.fem.getNodeById(n) for n in scene.fem.getNodesByFace(scene.face(7)))]
        assert len(radius) > 20 and max(abs(r - 2) for r in radius) < 1e-9, "nodes of the bore lie on the true cylinder"


def test_layers():
    scene = Scene(drilled(), size=2)
    layers = ObjectsFem.makeMeshBoundaryLayer(scene.doc, scene.mesh)
    layers.References, layers.NumberOfLayers, layers.MinimumThickness, layers.GrowthRate = [(scene.part, "Face1")], 2, .1, 1.5
    scene.run()
    x = sorted({round(p.x, 6) for p in scene.fem.Nodes.values()})
    assert 0 in x and any(abs(v - .1) < 1e-6 for v in x) and any(abs(v - .25) < 1e-6 for v in x), x[:8]
    assert scene.fem.VolumeCount == scene.fem.TetraCount


def test_groups_of_an_analysis():
    """Nodes of supports, elements of materials, a mesh group: by the names that FreeCAD's writers look for."""
    scene = Scene(SHAPES["fused"](), size=2)
    fixed = scene.doc.addObject("Fem::ConstraintFixed", "Held")
    fixed.References = [(scene.part, "Face1"), (scene.part, "Face5")]
    first, rest = (ObjectsFem.makeMaterialSolid(scene.doc, name) for name in ("First", "Rest"))
    first.References = [(scene.part, "Solid1")]
    for obj in (fixed, first, rest):
        scene.analysis.addObject(obj)
    edges = ObjectsFem.makeMeshGroup(scene.doc, scene.mesh, True, "Rim")
    edges.References, edges.Label = [(scene.part, "Edge1")], "rim"
    scene.doc.recompute()
    scene.run()
    nodes = {n for number in (1, 5) for n in scene.fem.getNodesByFace(scene.face(number))}
    assert scene.group("Held_Nodes")["Node"] == nodes
    assert set(meshtools.get_femmesh_groupdata_sets_by_name(scene.fem, {"Object": fixed}, "Node")) == nodes
    volumes = [scene.group(f"{name}_Volumes")["Volume"] for name in ("First", "Rest")]
    assert volumes[0] == scene.group("Solid1")["Volume"] and volumes[1] == scene.group("Solid2")["Volume"]
    assert len(volumes[0] | volumes[1]) == scene.fem.VolumeCount
    assert scene.group("rim_Nodes")["Node"] == set(scene.fem.getNodesByEdge(scene.part.Shape.Edges[0]))


def test_references_to_the_bodies_of_a_compound():
    """Faces of the body that a compound was made of are found in the compound."""
    scene = Scene(SHAPES["touching"](), size=3)
    box = scene.doc.addObject("Part::Feature", "Box")
    box.Shape = beside()
    fixed = scene.doc.addObject("Fem::ConstraintFixed", "Held")
    top = next(i for i, f in enumerate(box.Shape.Faces) if abs(f.CenterOfMass.x - 20) < 1e-9)
    fixed.References = [(box, f"Face{top + 1}")]
    scene.analysis.addObject(fixed)
    scene.run()
    assert scene.group("Held_Nodes")["Node"] == set(scene.fem.getNodesByFace(box.Shape.Faces[top]))
    fixed.References = [(box, "Face1")]
    box.Shape = Part.makeBox(1, 1, 1)
    refused(scene, "which is not in")


def refused(scene, words, error=octafront_fem.Refused):
    before = scene.mesh.FemMesh.VolumeCount
    try:
        octafront_fem.mesh_shape(scene.mesh, scene.analysis)
    except error as why:
        assert words in str(why), why
        assert scene.mesh.FemMesh.VolumeCount == before
        return why
    raise AssertionError(f"nothing was refused: {words}")


def test_refusals():
    scene = Scene(drilled(), size=3)
    scene.run()
    scene.mesh.Options = ["through=2"]
    refused(scene, "they are written as")
    scene.mesh.Options = ["--order=1"]
    refused(scene, "given by the workbench")
    scene.mesh.Options = ["--max-elements=10"]
    assert refused(scene, "10", octafront_fem.Failed).report["error"]["code"] == "max_elements"
    scene.mesh.Options = ["--no-such"]
    refused(scene, "no-such", octafront_fem.Failed)
    scene.mesh.Options = []
    scene.region([], 1)
    refused(scene, "no reference")
    refused(Scene(Part.makePlane(1, 1)), "no solid")
    empty = Scene(drilled())
    empty.mesh.Part = None
    refused(empty, "has no shape")
    path, os.environ["OCTAFRONT"] = os.environ["OCTAFRONT"], "/nowhere/octafront"
    old, os.environ["PATH"] = os.environ["PATH"], "/nowhere"
    refused(Scene(drilled()), "was not found")
    os.environ["OCTAFRONT"], os.environ["PATH"] = path, old


def test_progress_and_cancel():
    scene, heard = Scene(drilled(), size=3), []
    scene.run(progress=lambda stage, fraction: heard.append((stage, fraction)))
    stages = {stage for stage, _ in heard}
    assert {"surface front", "volume front"} <= stages and all(f <= 1 for _, f in heard), stages
    scene.mesh.CharacteristicLengthMax = .1  # 10 million elements: it is stopped long before
    before, asked, told = scene.mesh.FemMesh.VolumeCount, [], []
    try:
        octafront_fem.mesh_shape(scene.mesh, progress=lambda *now: told.append(now), cancelled=lambda: asked.append(1) or len(asked) > 20)
    except octafront_fem.Cancelled:
        assert scene.mesh.FemMesh.VolumeCount == before and 20 < len(asked) < 25
        return
    raise AssertionError("it was not stopped")


def test_a_document_keeps_it():
    scene = Scene(drilled(), size=3)
    scene.run()
    count, names = scene.fem.VolumeCount, sorted(scene.fem.getGroupName(g) for g in scene.fem.Groups)
    file = str(SCRATCH / "kept.FCStd")
    scene.doc.saveAs(file)
    FreeCAD.closeDocument(scene.doc.Name)
    again = FreeCAD.openDocument(file).getObject("MeshOctafront")
    assert again.FemMesh.VolumeCount == count and sorted(again.FemMesh.getGroupName(g) for g in again.FemMesh.Groups) == names
    assert again.Proxy.Type == "Fem::FemMeshOctafront" and again.ElementOrder == "2nd" and again.Told
    octafront_fem.mesh_shape(again)
    assert again.FemMesh.VolumeCount == count


def test_a_mesh_object_of_gmsh():
    """FreeCAD's own mesh object is meshed, too."""
    scene = Scene(drilled())
    gmsh = ObjectsFem.makeMeshGmsh(scene.doc, "MeshGmsh")
    gmsh.Part, gmsh.CharacteristicLengthMax = scene.part, 3
    report = octafront_fem.mesh_shape(gmsh)
    assert gmsh.FemMesh.VolumeCount == report["tets"] > 100


def test_lines_of_progress():
    heard = []
    listener = program.Listener(lambda *now: heard.append(now))
    for line in ("\x1fvolume front\t0.5000\n", "octafront: no such file\n", "\x1fnames\t-1.0000", "\n"):
        listener.hear(line)
    assert heard == [("volume front", .5), ("names", -1.0)] and listener.messages == ["octafront: no such file"]


def main():
    told = {}
    for name, test in sorted(globals().items()):
        if name.startswith("test_"):
            try:
                test()
                told[name] = ""
            except BaseException:
                told[name] = traceback.format_exc()
            for document in list(FreeCAD.listDocuments()):
                FreeCAD.closeDocument(document)
    (SCRATCH / "told.json").write_text(json.dumps(told))


main()
