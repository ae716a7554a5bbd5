"""Groups of a FemMesh: what the program wrote by faces and solids, and from these one for each object of an analysis that refers to them.

FreeCAD's writers look for groups by the name of the object and an underscore (femmesh.meshtools.get_femmesh_groupdata_sets_by_name): nodes of supports and loads,
elements of materials. Where there is none they search the mesh by distances, which takes longer.
"""
import re

from .references import elements_of, kind_of

# Face6, Face6_(Solid1|Solid2): of a face whose pieces lie at several solids there are several.
NAMED = re.compile(r"(Face\d+|Solid\d+)(?:$|_\()")
TYPES = {"Solid": "Volume", "Face": "Face"}
MOST_COMPARED = 2000  # triangles of a face that FreeCAD looks for: it takes seconds for many, and narrow faces have few
FILLS_THE_REST = "App::MaterialObjectPython"  # without references it is what all solids are made of that nothing else is


class Written:
    """What the program wrote, by the names of the shape."""

    def __init__(self, femmesh, part):
        self.femmesh, self.part, self.members = femmesh, part, {}
        self.pieces = []  # names of faces that two solids share
        for group in femmesh.Groups:
            name = femmesh.getGroupName(group)
            if (match := NAMED.match(name)) and femmesh.getGroupElementType(group) in TYPES.values():
                self.members.setdefault(match[1], []).extend(femmesh.getGroupElements(group))
                if "|" in name:
                    self.pieces.append(match[1])

    def elements(self, name):
        """Ids of triangles of a face, of tetrahedra of a solid. Of two faces of different solids that lie on each other, which the program makes one,
        the mesh has the name of the first: the other is found by where it is."""
        found = set(self.members.get(name, ()))
        if kind_of(name) == "Face" and (not found or self.pieces):
            found.update(self.femmesh.getFacesByFace(self.part.Shape.getElement(name)))
        return sorted(found)

    def nodes(self, name):
        """Of a face, an edge or a point."""
        shape = self.part.Shape.getElement(name) if kind_of(name) != "Solid" else None
        if kind_of(name) == "Edge":
            return self.femmesh.getNodesByEdge(shape)
        if kind_of(name) == "Vertex":
            return self.femmesh.getNodesByVertex(shape)
        return [node for element in self.elements(name) for node in self.femmesh.getElementNodes(element)]


def add_group(femmesh, name, kind, members):
    femmesh.addGroupElements(femmesh.addGroup(name, kind), sorted(set(members)))


def add_for(obj, name, written):
    """Groups of what one object refers to. Returns notes."""
    names = elements_of(obj, written.part)
    of_kind = {kind: [n for n in names if kind_of(n) == kind] for kind in ("Solid", "Face", "Edge", "Vertex")}
    for kind, type_of_group in TYPES.items():
        if members := [e for n in of_kind[kind] for e in written.elements(n)]:
            add_group(written.femmesh, f"{name}_{type_of_group}s", type_of_group, members)
    if nodes := [n for part in ("Face", "Edge", "Vertex") for one in of_kind[part] for n in written.nodes(one)]:
        add_group(written.femmesh, f"{name}_Nodes", "Node", nodes)
    return [note for n in names if (note := note_on(obj, n, written))]


def note_on(obj, name, written):
    """What is wrong with the elements of a reference: none, or some that FreeCAD will not find by distances. None: nothing."""
    if not (written.elements(name) if kind_of(name) in TYPES else written.nodes(name)):
        return f"{obj.Label}: {name} has no elements: it is too small for the size that is asked for"
    there = len(written.elements(name)) if kind_of(name) == "Face" else 0
    if 0 < there <= MOST_COMPARED:
        by_place = len(written.femmesh.getFacesByFace(written.part.Shape.getElement(name)))
        if there != by_place:
            return f"{obj.Label}: {name} has {there} triangles, of which FreeCAD finds {by_place} by distances: smaller elements there make them the same"
    return None


def add_rest(material, all_materials, written):
    """Of the one material without references: all solids that no other one has."""
    taken = {n for other in all_materials if other is not material for n in elements_of(other, written.part)}
    rest = [f"Solid{s + 1}" for s in range(len(written.part.Shape.Solids)) if f"Solid{s + 1}" not in taken]
    add_group(written.femmesh, f"{material.Name}_Volumes", "Volume", [e for n in rest for e in written.elements(n)])


def refer(mesh, analysis):
    """Objects whose references get groups: mesh groups, and of the analysis all that have some."""
    of_analysis = [obj for obj in (analysis.Group if analysis is not None else []) if obj is not mesh and getattr(obj, "References", None)]
    return list(mesh.MeshGroupList) + of_analysis


def name_of(obj):
    return obj.Label if getattr(obj, "UseLabel", False) else obj.Name


def add(femmesh, mesh, analysis):
    """Adds groups for mesh groups and the analysis. Returns notes, a list of sentences."""
    written = Written(femmesh, mesh.Part)
    notes = [note for obj in refer(mesh, analysis) for note in add_for(obj, name_of(obj), written)]
    materials = [obj for obj in (analysis.Group if analysis is not None else []) if obj.isDerivedFrom(FILLS_THE_REST)]
    for material in materials:
        if not material.References and len(materials) > 1:
            add_rest(material, materials, written)
    return notes
