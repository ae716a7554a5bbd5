"""The mesh object of a document: a Fem::FemMeshObjectPython with the properties that Octafront is asked by.

They have the names of FreeCAD's own mesh object for Gmsh, so its mesh regions, groups and boundary layers (ObjectsFem.makeMeshRegion and
the like) take this object, too.
"""
import FreeCAD

ORDERS = ["1st", "2nd"]
PRESETS = ["draft", "standard", "fine"]
PROPERTIES = [
    ("App::PropertyLink", "Part", "FEM Mesh", "The body, compound or other shape with solids that is meshed"),
    ("App::PropertyLength", "CharacteristicLengthMax", "FEM Mesh", "Edge length; 0: automatic, unless Elements says how many there shall be"),
    ("App::PropertyLength", "CharacteristicLengthMin", "FEM Mesh", "No size falls below this; 0: no bound"),
    ("App::PropertyInteger", "Elements", "FEM Mesh", "Number of tetrahedra wanted, met within 15 %; 0: as sizes say"),
    ("App::PropertyEnumeration", "ElementOrder", "FEM Mesh", "2nd: mid-side nodes on the true shape"),
    ("App::PropertyEnumeration", "Preset", "FEM Mesh", "How fine automatic sizes are, and how long the mesh is improved"),
    ("App::PropertyStringList", "Options", "FEM Mesh", "Further options of `octafront mesh`, one a line: --through=2"),
    ("App::PropertyLinkList", "MeshRegionList", "FEM Mesh", "Sizes at faces, edges, points or solids"),
    ("App::PropertyLinkList", "MeshGroupList", "FEM Mesh", "Groups for export"),
    ("App::PropertyLinkList", "MeshBoundaryLayerList", "FEM Mesh", "Thin elements along faces"),
    ("App::PropertyStringList", "Told", "FEM Mesh", "What the program said of the last mesh"),
]


class Unsaved:
    """What FreeCAD writes nothing of into files, but for its properties."""

    # FreeCAD 0.20 asks for the first two, newer ones for the others.
    def __getstate__(self):
        return None

    def __setstate__(self, state):
        return None

    def dumps(self):
        return None

    def loads(self, state):
        return None


class MeshOctafront(Unsaved):
    """What FreeCAD asks of an object that is told by Python."""

    Type = "Fem::FemMeshOctafront"
    BaseType = "Fem::BaseFemPythonObject"

    def __init__(self, obj):
        obj.Proxy = self
        self.add_properties(obj)

    def add_properties(self, obj):
        for kind, name, group, about in PROPERTIES:
            if not hasattr(obj, name):
                obj.addProperty(kind, name, group, about)
                if name == "ElementOrder":
                    obj.ElementOrder, obj.ElementOrder = ORDERS, "2nd"
                elif name == "Preset":
                    obj.Preset, obj.Preset = PRESETS, "standard"
        obj.setEditorMode("Told", 1)  # to be read only

    def onDocumentRestored(self, obj):
        self.add_properties(obj)


def make_mesh(part, name="MeshOctafront", *, size=0.0, elements=0, order="2nd", preset="standard"):
    """A mesh object beside `part`, empty until mesh_shape() fills it. `size`: in mm, 0: automatic."""
    obj = part.Document.addObject("Fem::FemMeshObjectPython", name)
    MeshOctafront(obj)
    obj.Part, obj.CharacteristicLengthMax, obj.Elements, obj.ElementOrder, obj.Preset = part, size, elements, order, preset
    if FreeCAD.GuiUp:
        from .gui import view
        view.ViewOfMesh(obj.ViewObject)
    return obj
