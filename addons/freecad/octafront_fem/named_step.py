"""A shape as a STEP file whose faces and solids are called as FreeCAD calls them: Face1, Solid1, ...

FreeCAD writes no names of faces. Each ADVANCED_FACE of the file gets one: the file is read back, which gives faces in the
order in which its shells list them, and each of them is found among the faces of the shape by where it is.
"""
import re

import Part

from .program import Refused

NEAR = 1e-6  # of the diagonal: how well centres and areas agree after a file of 15 digits

FACE = re.compile(r"(#(\d+)\s*=\s*ADVANCED_FACE\s*\(\s*)'(?:[^']|'')*'")
SOLID = re.compile(r"(#(\d+)\s*=\s*(?:MANIFOLD_SOLID_BREP|BREP_WITH_VOIDS)\s*\(\s*)'(?:[^']|'')*'\s*,\s*([^;]*)\)\s*;")
SHELL = re.compile(r"#(\d+)\s*=\s*(?:CLOSED|OPEN)_SHELL\s*\(\s*'(?:[^']|'')*'\s*,\s*\(([^)]*)\)")
TURNED = re.compile(r"#(\d+)\s*=\s*ORIENTED_CLOSED_SHELL\s*\(\s*'(?:[^']|'')*'\s*,\s*\*\s*,\s*(#\d+)")
NUMBER = re.compile(r"#(\d+)")


def numbers(text):
    return NUMBER.findall(text)


def faces_of_solids(text):
    """[(the number of a solid in the file, those of its faces)], in the order of the file."""
    shells = {m[1]: numbers(m[2]) for m in SHELL.finditer(text)}
    turned = {m[1]: m[2][1:] for m in TURNED.finditer(text)}
    return [(m[2], [face for shell in numbers(m[3]) for face in shells[turned.get(shell, shell)]]) for m in SOLID.finditer(text)]


class Finder:
    """Finds faces of one solid in the shape that the file was made of, each once."""

    def __init__(self, faces, size):
        self.left, self.size = list(faces), size

    def is_same(self, one, other):
        return (one.CenterOfMass - other.CenterOfMass).Length <= NEAR * self.size and abs(one.Area - other.Area) <= NEAR * max(one.Area, self.size**2 * NEAR) \
            and one.Surface.TypeId == other.Surface.TypeId

    def take(self, face):
        """The number of the face, or None. Those that come next are looked at first: most often it is the next."""
        for at, (number, candidate) in enumerate(self.left):
            if self.is_same(face, candidate):
                del self.left[at]
                return number
        return None


def number_of(shape, list_of_shapes):
    """From 0, by the hash that both have where they are the same."""
    by_hash = {}
    for number, other in enumerate(list_of_shapes):
        by_hash.setdefault(other.hashCode(), []).append((number, other))
    return lambda wanted: next(number for number, other in by_hash[wanted.hashCode()] if other.isSame(wanted))


def names(shape, path, text):
    """{number in the file: name} of all faces, and of all solids. Raises Refused."""
    listed, back = faces_of_solids(text), Part.read(str(path))
    if len(listed) != len(shape.Solids) or len(back.Solids) != len(shape.Solids):
        raise Refused(f"the shape has {len(shape.Solids)} solids, and {len(listed)} in the STEP file that FreeCAD makes of it; try "
                      "Part > Create a copy > Create simple copy of the body, and mesh that")
    face_number = number_of(shape, shape.Faces)
    faces, solids = {}, {}
    for s, (solid, (number, in_file)) in enumerate(zip(shape.Solids, listed)):
        read = back.Solids[s].Faces
        finder = Finder([(face_number(face), face) for face in solid.Faces], max(shape.BoundBox.DiagonalLength, 1e-12))
        found = [finder.take(face) for face in read]
        if len(read) != len(in_file) or None in found:
            raise Refused(f"Solid{s + 1} has other faces in the STEP file that FreeCAD makes of it: check the geometry of the body (Part > "
                          "Check geometry)")
        solids[number] = f"Solid{s + 1}"
        faces.update((at, f"Face{f + 1}") for at, f in zip(in_file, found))
    return faces, solids


def write(shape, path):
    """Writes the file, in millimetres. Faces that several solids share are there for each of them, with one name. Raises Refused for a shape
    without a solid, or that FreeCAD does not write as it is."""
    if not shape.Solids:
        raise Refused("there is no solid in the shape: a mesh of tetrahedra needs one")
    shape.exportStep(str(path))
    text = path.read_text(encoding="utf-8", errors="surrogateescape")
    faces, solids = names(shape, path, text)
    text = FACE.sub(lambda m: f"{m[1]}'{faces[m[2]]}'" if m[2] in faces else m[0], text)
    text = SOLID.sub(lambda m: f"{m[1]}'{solids[m[2]]}',{m[3]});", text)
    path.write_text(text, encoding="utf-8", errors="surrogateescape")
