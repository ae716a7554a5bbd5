"""Readers of formats that no program in Debian reads, written from the formats' manuals and apart from our writers: Ansys
archives (NBLOCK, EBLOCK, CMBLOCK by their Fortran formats), LS-DYNA keyword files, FEBio, SU2, OpenFOAM's lists; and of
what lies in HDF5 files. Each returns points, tets (VTK's order of nodes), and parts: (kind, name) -> members."""
import re
import xml.etree.ElementTree as xml

import numpy as np


class Nodes:
    def __init__(self):
        self.index, self.points = {}, []

    def add(self, label, xyz):
        self.index[label] = len(self.points)
        self.points.append(xyz)


def fixed(line, width, count=None):
    fields = [line[i:i + width] for i in range(0, len(line.rstrip("\n")), width)]
    return [int(f) for f in fields if f.strip()][:count]


# ---- Ansys: "NBLOCK, 6, SOLID" and "(3i10,6e25.16e3)": widths are read from the format line.

def ansys(file):
    lines = iter(open(file, encoding="utf-8").read().split("\n"))
    nodes, tets, materials, ids, parts = Nodes(), [], [], {}, {}
    components = []
    for line in lines:
        word = line.split(",")[0].strip().upper()
        if word == "NBLOCK":
            count = int(line.split(",")[4])
            ints, width, reals, size = map(int, re.match(r"\((\d+)i(\d+),(\d+)e(\d+)\.", next(lines)).groups())
            for _ in range(count):
                row = next(lines)
                start = ints * width
                xyz = [float(row[start + k * size:start + (k + 1) * size] or 0) for k in range(3)]
                nodes.add(int(row[:width]), xyz)
        elif word == "EBLOCK":
            width = int(re.match(r"\(\d+i(\d+)\)", next(lines)).group(1))
            while True:
                row = fixed(next(lines), width)
                if row[0] == -1:
                    break
                count, label = row[8], row[10]
                corners = row[11:]
                while len(corners) < count:
                    corners += fixed(next(lines), width)
                ids[label] = len(tets)
                tets.append([nodes.index[n] for n in corners])
                materials.append(row[0])
        elif word == "CMBLOCK":
            _, name, kind, count = [f.strip() for f in line.split(",")]
            per, width = map(int, re.match(r"\((\d+)i(\d+)\)", next(lines)).groups())
            items = []
            while len(items) < int(count):
                items += fixed(next(lines), width)
            members = []
            for item in items:
                # A negative number ends a range that the one before it begins.
                members += range(members[-1] + 1, -item + 1) if item < 0 else [item]
            components.append((name, kind, members))
    for name, kind, members in components:
        if kind.startswith("NODE"):
            parts["nodes", name] = [nodes.index[m] for m in members]
        else:
            parts["elements", name] = [ids[m] for m in members]
    return {"points": nodes.points, "tets": tets, "parts": parts, "materials": materials}


# ---- LS-DYNA: columns of 8 and 16 (nodes), 8 (elements), 10 (sets); "$" begins a comment.

def lsdyna(file):
    nodes, tets, of_part, titles, parts, ids = Nodes(), [], [], {}, {}, {}
    keyword, state, pending = "", 0, []
    for line in open(file, encoding="utf-8"):
        line = line.rstrip("\n")
        if line.startswith("$"):
            continue
        if line.startswith("*"):
            keyword, state, pending = line.strip().upper(), 0, []
            continue
        state += 1
        if keyword == "*NODE":
            nodes.add(int(line[:8]), [float(line[8 + 16 * k:24 + 16 * k]) for k in range(3)])
        elif keyword == "*ELEMENT_SOLID":
            if state % 2 == 1:
                pending = fixed(line, 8)
            else:
                corners = fixed(line, 8)
                # Repeated last node: a tetrahedron of four nodes.
                corners = corners[:4] if len(set(corners)) == 4 else corners
                ids[pending[0]] = len(tets)
                tets.append([nodes.index[n] for n in corners])
                of_part.append(pending[1])
        elif keyword == "*PART":
            if state == 1:
                pending = [line]
            else:
                titles[int(line[:10])] = pending[0]
        elif keyword.startswith("*SET_"):
            kind = {"*SET_NODE_LIST_TITLE": "nodes", "*SET_SEGMENT_TITLE": "faces", "*SET_SOLID_TITLE": "elements"}[keyword]
            if state == 1:
                pending = line
                parts[kind, line] = []
            elif state > 2:
                row = fixed(line, 10)
                if kind == "faces":
                    assert row[2] == row[3]
                    parts[kind, pending].append([nodes.index[n] for n in row[:3]])
                else:
                    parts[kind, pending] += [nodes.index[n] if kind == "nodes" else ids[n] for n in row]
    for number, title in titles.items():
        parts["elements", title] = [t for t, p in enumerate(of_part) if p == number]
    return {"points": nodes.points, "tets": tets, "parts": parts}


# ---- FEBio 4.0

def febio(file):
    root = xml.parse(file).getroot()
    assert root.tag == "febio_spec" and root.get("version") == "4.0"
    mesh = root.find("Mesh")
    nodes, tets, parts, ids = Nodes(), [], {}, {}
    for node in mesh.find("Nodes"):
        nodes.add(int(node.get("id")), [float(x) for x in node.text.split(",")])
    numbers = lambda text: [int(n) for n in text.split(",")]
    for part in mesh:
        name = part.get("name")
        if part.tag == "Elements":
            assert part.get("type") in ("tet4", "tet10")
            parts["elements", name] = []
            for e in part:
                ids[int(e.get("id"))] = len(tets)
                parts["elements", name].append(len(tets))
                tets.append([nodes.index[n] for n in numbers(e.text)])
    for part in mesh:
        name = part.get("name")
        if part.tag == "Surface":
            parts["faces", name] = [[nodes.index[n] for n in numbers(f.text)] for f in part]
        elif part.tag == "Edge":
            parts["edges", name] = [[nodes.index[n] for n in numbers(f.text)] for f in part]
        elif part.tag == "NodeSet":
            parts["nodes", name] = [nodes.index[n] for n in numbers(part.text)]
        elif part.tag == "ElementSet":
            parts["elements", name] = [ids[n] for n in numbers(part.text)]
    domains = [d.get("name") for d in root.find("MeshDomains")]
    assert all(("elements", d) in parts for d in domains) and len(domains) == len(mesh.findall("Elements"))
    # What order the tetrahedra have in the mesh is told by their numbers.
    order = np.argsort([k for k in ids])
    place = np.empty(len(order), dtype=int)
    place[order] = np.arange(len(order))
    tets = [tets[i] for i in order]
    parts = {k: [int(place[m]) for m in v] if k[0] == "elements" else v for k, v in parts.items()}
    return {"points": nodes.points, "tets": tets, "parts": parts}


# ---- SU2

def su2(file):
    text = [line.split("%")[0].strip() for line in open(file, encoding="utf-8")]
    lines = iter([line for line in text if line])
    points, tets, parts = [], [], {}
    for line in lines:
        key, value = [w.strip() for w in line.split("=")]
        if key == "NDIME":
            assert value == "3"
        elif key == "NELEM":
            for _ in range(int(value)):
                row = [int(w) for w in next(lines).split()]
                assert row[0] == 10
                tets.append(row[1:5])
        elif key == "NPOIN":
            for _ in range(int(value.split()[0])):
                points.append([float(w) for w in next(lines).split()[:3]])
        elif key == "MARKER_TAG":
            name = value
            count = int(next(lines).split("=")[1])
            parts["faces", name] = []
            for _ in range(count):
                row = [int(w) for w in next(lines).split()]
                assert row[0] == 5
                parts["faces", name].append(row[1:4])
    return {"points": points, "tets": tets, "parts": parts}


# ---- OpenFOAM: lists in brackets behind the header; cells follow from owner and neighbour.

def foam_body(file):
    text = re.sub(r"//[^\n]*", "", file.read_text())
    return text[text.index("}") + 1:]


def foam_labels(body):
    return [int(w) for w in body[body.index("(") + 1:body.rindex(")")].split()]


def openfoam(folder):
    points = [[float(x) for x in m.split()] for m in re.findall(r"\(([^()]+)\)", foam_body(folder / "points"))]
    faces = [[int(x) for x in m.split()] for m in re.findall(r"3\(([^()]+)\)", foam_body(folder / "faces"))]
    owner, neighbour = foam_labels(foam_body(folder / "owner")), foam_labels(foam_body(folder / "neighbour"))
    same = list(zip(owner, neighbour))
    assert same == sorted(same) and all(o < n for o, n in same) and len(owner) == len(faces)
    corners = [set() for _ in range(max(owner) + 1)]
    for f, cell in list(enumerate(owner)) + list(enumerate(neighbour)):
        corners[cell].update(faces[f])
    P = np.array(points)
    tets = []
    for cell in corners:
        a, b, c, d = sorted(cell)
        tets.append([a, b, c, d] if np.linalg.det(P[[b, c, d]] - P[a]) > 0 else [a, c, b, d])
    # A face looks from its owner to its neighbour, or outward.
    for f, cell in enumerate(owner):
        normal = np.cross(P[faces[f][1]] - P[faces[f][0]], P[faces[f][2]] - P[faces[f][0]])
        assert normal @ (P[faces[f]].mean(axis=0) - P[sorted(corners[cell])].mean(axis=0)) > 0
    parts = {}
    end = len(neighbour)
    for name, block in re.findall(r"(\S+)\s*\{([^}]*)\}", foam_body(folder / "boundary")):
        count, start = (int(re.search(rf"{key}\s+(\d+)", block).group(1)) for key in ("nFaces", "startFace"))
        assert start == end
        end += count
        parts["faces", name] = faces[start:start + count]
    assert end == len(faces)
    for kind, file in (("elements", "cellZones"), ("faces", "faceZones")):
        for name, block in re.findall(r"(\S+)\s*\{([^}]*)\}", foam_body(folder / file)):
            labels = [int(w) for w in re.search(r"Labels\s+List<label>\s+\d+\s*\(([^)]*)\)", block).group(1).split()]
            parts[kind, name] = [faces[f] for f in labels] if kind == "faces" else labels
    return {"points": points, "tets": tets, "parts": parts}


# ---- MED by libmed (python3-med): its own order of nodes, positive where ours is

MED_TET10 = [0, 2, 1, 3, 6, 5, 4, 7, 9, 8]


def med(file):
    from med.medenum import (MED_ACC_RDONLY, MED_CELL, MED_CONNECTIVITY, MED_COORDINATE, MED_FULL_INTERLACE, MED_NO_DT,
                             MED_NO_IT, MED_NODAL, MED_NODE, MED_NONE, MED_SEG2, MED_SEG3, MED_TETRA4, MED_TETRA10, MED_TRIA3,
                             MED_TRIA6)
    from med.medfamily import MEDCHAR, MEDfamilyInfo, MEDnFamily, MEDnFamilyGroup
    from med.medfile import MEDfileClose, MEDfileOpen
    from med.medmesh import (MEDFLOAT, MEDINT, MEDmeshElementConnectivityRd, MEDmeshEntityFamilyNumberRd, MEDmeshInfo,
                             MEDmeshNodeCoordinateRd, MEDmeshnEntity)
    f = MEDfileOpen(str(file), MED_ACC_RDONLY)
    info = MEDmeshInfo(f, 1)
    name = info[0] if isinstance(info, (list, tuple)) and isinstance(info[0], str) else "mesh"

    def count(entity, kind, what=MED_CONNECTIVITY):
        r = MEDmeshnEntity(f, name, MED_NO_DT, MED_NO_IT, entity, kind, what, MED_NODAL)
        return r[0] if isinstance(r, (list, tuple)) else r

    n = count(MED_NODE, MED_NONE, MED_COORDINATE)
    xyz = MEDFLOAT(3 * n)
    MEDmeshNodeCoordinateRd(f, name, MED_NO_DT, MED_NO_IT, MED_FULL_INTERLACE, xyz)
    points = np.array(xyz).reshape(-1, 3)
    groups = {}
    for i in range(1, MEDnFamily(f, name) + 1):
        k = MEDnFamilyGroup(f, name, i)
        if k == 0:
            continue
        chars = MEDCHAR(80 * k + 1)
        number = MEDfamilyInfo(f, name, i, chars)[1]
        text = "".join(chars)
        groups[number] = [text[80 * j:80 * (j + 1)].split("\0")[0].rstrip() for j in range(k)]
    parts = {}

    def families(entity, kind, size, rows, label):
        numbers = MEDINT(size)
        try:
            MEDmeshEntityFamilyNumberRd(f, name, MED_NO_DT, MED_NO_IT, entity, kind, numbers)
        except Exception:
            return
        for i, number in enumerate(numbers):
            for group in groups.get(number, []):
                parts.setdefault((label, group), []).append(rows[i])

    tets = []
    for kind, each, label in ((MED_TETRA4, 4, "elements"), (MED_TETRA10, 10, "elements"), (MED_TRIA3, 3, "faces"),
                              (MED_TRIA6, 6, "faces"), (MED_SEG2, 2, "edges"), (MED_SEG3, 3, "edges")):
        size = count(MED_CELL, kind)
        if size <= 0:
            continue
        flat = MEDINT(each * size)
        MEDmeshElementConnectivityRd(f, name, MED_NO_DT, MED_NO_IT, MED_CELL, kind, MED_NODAL, MED_FULL_INTERLACE, flat)
        rows = (np.array(flat) - 1).reshape(size, each)
        if label == "elements":
            # MED draws the tetrahedron with its second and third corner exchanged.
            tets = rows[:, MED_TET10[:each]]
            rows = range(size)
        families(MED_CELL, kind, size, list(rows), label)
    families(MED_NODE, MED_NONE, n, range(n), "nodes")
    MEDfileClose(f)
    return {"points": points, "tets": tets, "parts": parts}


# ---- XDMF: three light files, one of values

def xdmf(file):
    import h5py
    points, tets, parts = None, None, {}
    for further in ("", "_patches", "_curves"):
        root = xml.parse(file.with_name(file.stem + further + ".xdmf")).getroot()
        for grid in root.iter("Grid"):
            def values(item):
                name, path = item.text.strip().split(":")
                found = h5py.File(file.with_name(name))[path][()]
                assert list(found.shape) == [int(n) for n in item.get("Dimensions").split()]
                return found
            topology = grid.find("Topology")
            rows = values(topology.find("DataItem"))
            kind, prefix = {"Tetrahedron": ("elements", "region"), "Tetrahedron_10": ("elements", "region"),
                            "Triangle": ("faces", "patch"), "Triangle_6": ("faces", "patch"),
                            "Polyline": ("edges", "curve"), "Edge_3": ("edges", "curve")}[topology.get("TopologyType")]
            if kind == "elements":
                points, tets = values(grid.find("Geometry").find("DataItem")), rows
            take = lambda at: [rows[i] for i in at] if kind == "faces" else list(at)
            for attribute in grid.findall("Attribute"):
                name, found = attribute.get("Name"), values(attribute.find("DataItem")).ravel()
                if name == prefix:
                    for number in np.unique(found):
                        label = attribute.get(f"name_{number}", f"{prefix} {number}")
                        parts[kind, label] = take(np.flatnonzero(found == number))
                else:
                    of, label = name.split(" ", 1)
                    parts[of, label] = list(np.flatnonzero(found)) if of == "nodes" else take(np.flatnonzero(found))
    return {"points": points, "tets": tets, "parts": parts}


# ---- CGNS: sections by the SIDS; one zone

def cgns_name(name):
    return "".join(c if c.isalnum() or c in " _-.+#()[]{}<>=&%$!?*'\"" else "_" for c in name)[:32]


def cgns(file):
    import h5py
    zone = h5py.File(file)["Base/Zone"]
    value = lambda node: node[" data"][()]
    points = np.column_stack([value(zone["GridCoordinates/Coordinate" + a]) for a in "XYZ"])
    nodes = {10: 4, 11: 10, 5: 3, 6: 6, 3: 2, 4: 3}
    elements, tets, parts = {}, [], {}
    for name, node in zone.items():
        if not isinstance(node, h5py.Group) or node.attrs.get("label", b"").decode().strip("\0") != "Elements_t":
            continue
        kind = int(value(node)[0])
        first, last = value(node["ElementRange"])
        rows = value(node["ElementConnectivity"]).reshape(-1, nodes[kind]) - 1
        assert len(rows) == last - first + 1
        if kind >= 10:
            parts["elements", name] = list(range(first - 1, last))
            elements.update(zip(range(first, last + 1), rows))
        else:
            elements.update(zip(range(first, last + 1), rows))
    tets = [row for number, row in sorted(elements.items()) if len(row) in (4, 10)]
    for name, condition in zone["ZoneBC"].items():
        if isinstance(condition, h5py.Group):
            first, last = value(condition["PointRange"]).ravel()
            parts["faces", name] = [elements[i] for i in range(first, last + 1)]
    return {"points": points, "tets": tets, "parts": parts}


# ---- binary MEDIT, version 2 (places of 4 bytes) or 3 (of 8): keyword, place of the next one, count, values

def medit_binary(file, expected):
    data = file.read_bytes()
    integer = lambda at: int(np.frombuffer(data, "<i4", 1, at)[0])
    assert integer(0) == 1 and integer(4) in (2, 3)
    place = 4 if integer(4) == 2 else 8
    at, sections = 8, {}
    while True:
        code, following = integer(at), int(np.frombuffer(data, f"<i{place}", 1, at + 4)[0])
        if code == 54:
            break
        sections[code] = (at + 8 + place, integer(at + 4 + place))
        at = following
    def rows(code, width):
        start, count = sections[code]
        return np.frombuffer(data, "<i4", count * width, start).reshape(count, width)
    start, count = sections[4]
    vertices = np.frombuffer(data, [("x", "<f8", 3), ("ref", "<i4")], count, start)
    parts = {}
    for code, width, kind, origin in ((30, 11, "elements", "region"), (24, 7, "faces", "patch"), (25, 4, "edges", "curve")):
        found = rows(code, width)
        for part in expected["parts"]:
            if part["origin"] == origin:
                at = np.flatnonzero(found[:, -1] == part["number"] + 1)
                parts[kind, part["name"]] = list(found[at, :-1] - 1) if kind == "faces" else list(at)
    return {"points": vertices["x"], "tets": rows(30, 11)[:, :-1] - 1, "parts": parts}
