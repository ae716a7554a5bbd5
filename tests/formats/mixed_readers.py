"""Readers of wedges, pyramids and quadrilaterals by the manuals of their formats, apart from our writers. Each returns a Read:
cells and faces in the order of nodes that this file names, and parts: (kind, name) -> indices of cells or faces."""
import re
import xml.etree.ElementTree as xml

import numpy as np

from second_readers import Nodes, fixed

# Corners, the bases of wedges and pyramids seen counter-clockwise from inside, then the middles of these edges.
EDGES = {"tetra": [(0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3)],
         "pyramid": [(0, 1), (1, 2), (2, 3), (3, 0), (0, 4), (1, 4), (2, 4), (3, 4)],
         "wedge": [(0, 1), (1, 2), (2, 0), (3, 4), (4, 5), (5, 3), (0, 3), (1, 4), (2, 5)]}
CORNERS = {"tetra": 4, "pyramid": 5, "wedge": 6}
SECOND = {"tetra": 10, "pyramid": 13, "wedge": 15}
KIND = {n: k for table in (CORNERS, SECOND) for k, n in table.items()}


class Read:
    def __init__(self, points):
        self.points = np.asarray(points, dtype=float)
        self.cells, self.faces, self.parts = [], [], {}

    def add_face(self, nodes, *parts):
        self.faces.append(list(nodes))
        for name in parts:
            self.parts.setdefault(("faces", name), []).append(len(self.faces) - 1)

    def add_cell(self, nodes, *parts):
        self.cells.append(list(nodes))
        for name in parts:
            self.parts.setdefault(("elements", name), []).append(len(self.cells) - 1)


def middles(nodes):
    """Of the edges of a cell, by their ends."""
    kind = KIND[len(nodes)]
    return {frozenset((nodes[i], nodes[j])): m for (i, j), m in zip(EDGES[kind], nodes[CORNERS[kind]:])}


def side(nodes, corners):
    """The face of a cell with these corners, and its mid-side nodes."""
    face = [nodes[c] for c in corners]
    mids = middles(nodes)
    return face + [mids[frozenset((face[i], face[(i + 1) % len(face)]))] for i in range(len(face)) if mids]


def whole(wedge):
    """A wedge whose nodes 1 and 4 are one is a pyramid on the quadrilateral 2 3 6 5."""
    if wedge[0] != wedge[3]:
        return wedge
    corners = [wedge[2], wedge[1], wedge[4], wedge[5], wedge[0]]
    mids = middles(wedge)
    return corners + [mids[frozenset((corners[i], corners[j]))] for i, j in EDGES["pyramid"] if mids]


BASE_RISE_TOP = [0, 1, 2, 3, 4, 5, 6, 7, 8, 12, 13, 14, 9, 10, 11]  # CGNS, Exodus: 7-9 base, 10-12 between, 13-15 top


# ---- Abaqus: C3D4, C3D10 sides 123 124 234 134; C3D6 123 456 1254 2365 3146; C3D5 1234 125 235 345 415

ABAQUS_SIDES = {4: [(0, 1, 2), (0, 3, 1), (1, 3, 2), (2, 3, 0)],
                6: [(0, 1, 2), (3, 5, 4), (0, 3, 4, 1), (1, 4, 5, 2), (2, 5, 3, 0)],
                5: [(0, 1, 2, 3), (0, 4, 1), (1, 4, 2), (2, 4, 3), (3, 4, 0)]}


def abaqus(text):
    points, elements, sets, surfaces, mode, name = [], {}, {}, {}, "", ""
    pending = []
    for line in text.split("\n"):
        if line.startswith("**") or not line.strip():
            continue
        if line.startswith("*"):
            words = [w.strip() for w in line.split(",")]
            mode = words[0]
            keys = dict(w.split("=") for w in words[1:] if "=" in w)
            name = keys.get("ELSET") or keys.get("NAME")
            continue
        fields = [f.strip() for f in line.rstrip().rstrip(",").split(",")]
        if mode == "*NODE":
            points.append([float(f) for f in fields[1:]])
        elif mode == "*ELEMENT":
            pending += [int(f) for f in fields]
            if not line.rstrip().endswith(","):
                elements[pending[0]] = [n - 1 for n in pending[1:]]
                sets.setdefault(name, []).append(pending[0])
                pending = []
        elif mode == "*ELSET":
            sets.setdefault(name, []).extend(int(f) for f in fields)
        elif mode == "*SURFACE":
            surfaces.setdefault(name, []).append((int(fields[0]), int(fields[1][1])))
    read = Read(points)
    place = {}
    for number, nodes in elements.items():
        place[number] = len(read.cells)
        read.add_cell(whole(nodes) if len(nodes) in (6, 15) else nodes)
    for name, members in sets.items():
        read.parts["elements", name] = [place[m] for m in members]
    for name, sides in surfaces.items():
        for number, s in sides:
            nodes = elements[number]
            corners = CORNERS[KIND[len(nodes)]]
            face = side(nodes, ABAQUS_SIDES[corners][s - 1])
            if nodes[0] == nodes[3 % len(nodes)] and corners == 6 and len(set(face)) < len(face):
                # A side with the edge of no length is a triangle.
                corners_of = list(dict.fromkeys(nodes[c] for c in ABAQUS_SIDES[6][s - 1]))
                mids = middles(nodes)
                face = corners_of + [mids[frozenset((corners_of[i], corners_of[(i + 1) % 3]))] for i in range(3) if mids]
            read.add_face(face, name)
    return read


# ---- Exodus: WEDGE sides 1254 2365 1463 132 456; PYRAMID 125 235 345 154 1432; TETRA 124 234 143 132

EXODUS_SIDES = {4: [(0, 1, 3), (1, 2, 3), (0, 3, 2), (0, 2, 1)],
                6: [(0, 1, 4, 3), (1, 2, 5, 4), (0, 3, 5, 2), (0, 2, 1), (3, 4, 5)],
                5: [(0, 1, 4), (1, 2, 4), (2, 3, 4), (0, 4, 3), (0, 3, 2, 1)]}


def exodus(file):
    import netCDF4
    data = netCDF4.Dataset(str(file))
    data.set_auto_mask(False)
    names = lambda key: ["".join(c.decode() for c in row if c not in (b"", b"\0")) for row in data[key][:]]
    read = Read(np.column_stack([data["coord" + a][:] for a in "xyz"]))
    for b, name in enumerate(names("eb_names")):
        rows = data[f"connect{b + 1}"]
        kind = {"TETRA": "tetra", "PYRAM": "pyramid", "WEDGE": "wedge"}[rows.elem_type[:5]]
        region = re.sub("_(pyramids|wedges)$", "", name)
        for row in rows[:] - 1:
            assert KIND[len(row)] == kind
            read.add_cell([row[k] for k in BASE_RISE_TOP] if len(row) == 15 else row, region)
    for s, name in enumerate(names("ss_names")):
        for cell, number in zip(data[f"elem_ss{s + 1}"][:], data[f"side_ss{s + 1}"][:]):
            nodes = read.cells[cell - 1]
            read.add_face(side(nodes, EXODUS_SIDES[CORNERS[KIND[len(nodes)]]][number - 1]), name)
    for s, name in enumerate(names("els_names")):
        read.parts["elements", name] = [int(c) - 1 for c in data[f"elem_els{s + 1}"][:]]
    return read


# ---- CGNS: numbers of the SIDS

CGNS_NODES = {5: 3, 6: 6, 7: 4, 8: 8, 10: 4, 11: 10, 12: 5, 21: 13, 14: 6, 15: 15}


def cgns(file):
    import h5py
    zone = h5py.File(file)["Base/Zone"]
    value = lambda node: node[" data"][()]
    read = Read(np.column_stack([value(zone["GridCoordinates/Coordinate" + a]) for a in "XYZ"]))
    elements, sections = {}, []
    for name, node in zone.items():
        if not isinstance(node, h5py.Group) or node.attrs.get("label", b"").decode().strip("\0") != "Elements_t":
            continue
        kind = int(value(node)[0])
        first, last = value(node["ElementRange"])
        rows = value(node["ElementConnectivity"]).reshape(-1, CGNS_NODES[kind]) - 1
        assert len(rows) == last - first + 1
        elements.update(zip(range(first, last + 1), rows))
        sections.append((first, last, kind, name))
    assert sorted(elements) == list(range(1, len(elements) + 1))
    for first, last, kind, name in sorted(sections):
        if kind < 10:
            continue
        for i in range(first, last + 1):
            row = elements[i]
            read.add_cell([row[k] for k in BASE_RISE_TOP] if len(row) == 15 else row, name.split()[0])
    assert value(zone).ravel()[1] == len(read.cells)
    for name, condition in zone["ZoneBC"].items():
        if isinstance(condition, h5py.Group):
            first, last = value(condition["PointRange"]).ravel()
            for i in range(first, last + 1):
                read.add_face(elements[i], name)
    return read


# ---- I-deas: 111, 118 tetrahedra, 112, 113 wedges; 91, 92 triangles, 94, 95 quadrilaterals; of second order edge by edge

UNV_NODES = {111: range(4), 118: [0, 2, 4, 9, 1, 3, 5, 6, 7, 8], 112: range(6),
             113: [0, 2, 4, 9, 11, 13, 1, 3, 5, 10, 12, 14, 6, 7, 8],
             91: range(3), 92: [0, 2, 4, 1, 3, 5], 94: range(4), 95: [0, 2, 4, 6, 1, 3, 5, 7]}


def unv(file):
    sets = re.findall(r"^    -1\n *(\d+)\n(.*?)^    -1\n", file.read_text(), re.S | re.M)
    body = {number: text.split("\n") for number, text in sets}
    lines = body["2411"]
    read = Read([[float(w.replace("D", "E")) for w in row.split()] for row in lines[1::2] if row])
    where, lines = {}, iter(body["2412"])
    for line in lines:
        if not line:
            continue
        number, kind, _, _, _, count = map(int, line.split())
        if kind in (11, 24):
            next(lines)
        nodes = []
        while len(nodes) < count:
            nodes += [int(w) - 1 for w in next(lines).split()]
        if kind in (11, 24):
            continue
        nodes = [nodes[k] for k in UNV_NODES[kind]]
        if kind > 100:
            where[number] = ("elements", len(read.cells))
            read.add_cell(whole(nodes) if kind in (112, 113) else nodes)
        else:
            where[number] = ("faces", len(read.faces))
            read.add_face(nodes)
    lines = iter(body["2477"])
    for line in lines:
        if not line:
            continue
        count = int(line.split()[7])
        name, numbers = next(lines).strip(), []
        while len(numbers) < 4 * count:
            numbers += [int(w) for w in next(lines).split()]
        for kind, label in zip(numbers[::4], numbers[1::4]):
            if kind == 8:
                of, at = where[label]
                read.parts.setdefault((of, name), []).append(at)
    return read


# ---- Ansys: bricks I J K L M N O P, mid-side nodes Q to B on IJ JK KL LI MN NO OP PM IM JN KO LP; K = L and O = P: a wedge,
# M = N = O = P: a pyramid

BRICK_EDGES = [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7)]


def from_brick(nodes):
    mids = {frozenset((nodes[i], nodes[j])): m for (i, j), m in zip(BRICK_EDGES, nodes[8:]) if nodes[i] != nodes[j]}
    if len(set(nodes[4:8])) == 1:
        kind, corners = "pyramid", nodes[:5]
    else:
        assert nodes[2] == nodes[3] and nodes[6] == nodes[7]
        kind, corners = "wedge", [nodes[0], nodes[1], nodes[2], nodes[4], nodes[5], nodes[6]]
    return corners + [mids[frozenset((corners[i], corners[j]))] for i, j in EDGES[kind] if mids]


def ansys(file):
    import second_readers
    found = second_readers.ansys(file)
    read = Read(found["points"])
    for nodes in found["tets"]:
        read.add_cell(from_brick(nodes) if len(nodes) in (8, 20) else nodes)
    read.parts = found["parts"]
    return read


# ---- LS-DYNA: N1 N2 N3 N4 N5 N5 N6 N6 is a wedge on a quadrilateral, N1 N2 N3 N4 N5 N5 N5 N5 a pyramid

def lsdyna(file):
    nodes, titles, of_part, labels, sets = Nodes(), {}, [], {}, {}
    cells, keyword, state, head = [], "", 0, None
    for line in file.read_text().split("\n"):
        if line.startswith("$") or not line:
            continue
        if line.startswith("*"):
            keyword, state = line.strip(), 0
            continue
        state += 1
        if keyword == "*NODE":
            nodes.add(int(line[:8]), [float(line[8 + 16 * k:24 + 16 * k]) for k in range(3)])
        elif keyword == "*ELEMENT_SOLID" and state % 2 == 1:
            head = fixed(line, 8)
        elif keyword == "*ELEMENT_SOLID":
            n = [nodes.index[v] for v in fixed(line, 8)][:8]
            labels[head[0]] = len(cells)
            of_part.append(head[1])
            if len(set(n)) == 4:
                cells.append(n[:4])
            elif len(set(n)) == 5:
                cells.append(n[:5])
            else:
                assert n[4] == n[5] and n[6] == n[7]
                cells.append([n[1], n[0], n[4], n[2], n[3], n[6]])  # triangles 2 1 5 and 3 4 6
        elif keyword == "*PART":
            head = line if state == 1 else head
            if state == 2:
                titles[int(line[:10])] = head
        elif keyword.startswith("*SET_") and state == 1:
            head = (keyword, line)
            sets[head] = []
        elif keyword.startswith("*SET_") and state > 2:
            sets[head].append(fixed(line, 10))
    read = Read(nodes.points)
    for cell, part in zip(cells, of_part):
        read.add_cell(cell, titles[part])
    for (keyword, name), rows in sets.items():
        if "SEGMENT" in keyword:
            for row in rows:
                read.add_face([nodes.index[n] for n in (row[:3] if row[2] == row[3] else row)], name)
        elif "SOLID" in keyword:
            read.parts["elements", name] = [labels[n] for row in rows for n in row]
    return read


# ---- FEBio 4.0

def febio(file):
    root = xml.parse(file).getroot()
    nodes, labels = Nodes(), {}
    mesh = root.find("Mesh")
    for node in mesh.find("Nodes"):
        nodes.add(int(node.get("id")), [float(x) for x in node.text.split(",")])
    read = Read(nodes.points)
    numbers = lambda text: [int(n) for n in text.split(",")]
    for part in mesh.findall("Elements"):
        kind = re.fullmatch("(tet|pyra|penta)([0-9]+)", part.get("type"))
        for e in part:
            row = [nodes.index[n] for n in numbers(e.text)]
            assert len(row) == int(kind.group(2))
            labels[int(e.get("id"))] = len(read.cells)
            read.add_cell(row, part.get("name").split()[0])
    for part in mesh.findall("Surface"):
        for f in part:
            row = [nodes.index[n] for n in numbers(f.text)]
            assert f.tag == ("tri" if len(row) in (3, 6) else "quad") + str(len(row))
            read.add_face(row, part.get("name"))
    for part in mesh.findall("ElementSet"):
        read.parts["elements", part.get("name")] = [labels[n] for n in numbers(part.text)]
    materials = {d.get("mat") for d in root.find("MeshDomains")}
    assert materials == {name for kind, name in read.parts if kind == "elements"} - {s.get("name") for s in mesh.findall("ElementSet")}
    return read


# ---- SU2: types and orders of VTK; 13: a wedge whose first triangle faces outward

def su2(file):
    lines = iter([line for line in (row.split("%")[0].strip() for row in file.read_text().split("\n")) if line])
    cells, faces, points = [], [], []
    for line in lines:
        key, value = [w.strip() for w in line.split("=")]
        rows = lambda n: [[float(w) for w in next(lines).split()] for _ in range(n)]
        if key == "NELEM":
            cells = [[int(w) for w in row] for row in rows(int(value))]
        elif key == "NPOIN":
            points = [row[:3] for row in rows(int(value.split()[0]))]
        elif key == "MARKER_TAG":
            faces += [(value, [int(w) for w in row]) for row in rows(int(next(lines).split("=")[1]))]
    read = Read(points)
    for row in cells:
        nodes = row[1:1 + {10: 4, 14: 5, 13: 6}[row[0]]]
        read.add_cell([nodes[k] for k in (0, 2, 1, 3, 5, 4)] if row[0] == 13 else nodes)
    for name, row in faces:
        assert len(row) == {5: 4, 9: 5}[row[0]]
        read.add_face(row[1:], name)
    return read


# ---- XDMF: mixed lists, each element behind its number; nodes as Read has them

XDMF_NODES = {4: 3, 5: 4, 6: 4, 7: 5, 8: 6, 36: 6, 37: 8, 38: 10, 39: 13, 40: 15}


def xdmf(file):
    import h5py
    read = None
    for further in ("", "_patches"):
        grid = xml.parse(file.with_name(file.stem + further + ".xdmf")).getroot().find("Domain/Grid")

        def values(item):
            name, path = item.text.strip().split(":")
            return h5py.File(file.with_name(name))[path][()]
        if read is None:
            read = Read(values(grid.find("Geometry/DataItem")))
        topology = grid.find("Topology")
        assert topology.get("TopologyType") == "Mixed"
        flat, at, rows = values(topology.find("DataItem")).ravel(), 0, []
        while at < len(flat):
            count = XDMF_NODES[int(flat[at])]
            rows.append([int(n) for n in flat[at + 1:at + 1 + count]])
            at += 1 + count
        assert len(rows) == int(topology.get("NumberOfElements"))
        kind, number = ("faces", "patch") if further else ("elements", "region")
        for row in rows:
            read.add_face(row) if further else read.add_cell(row)
        for attribute in grid.findall("Attribute"):
            name, found = attribute.get("Name"), values(attribute.find("DataItem")).ravel()
            if name == number:
                for n in np.unique(found):
                    read.parts[kind, attribute.get(f"name_{n}")] = list(np.flatnonzero(found == n))
            elif name.startswith(kind + " "):
                read.parts[kind, name.split(" ", 1)[1]] = list(np.flatnonzero(found))
    return read


# ---- MED by libmed: its places of the nodes of cells, which turn the other way

MED_NODES = {304: [0, 2, 1, 3], 310: [0, 2, 1, 3, 6, 5, 4, 7, 9, 8], 305: [0, 3, 2, 1, 4],
             313: [0, 3, 2, 1, 4, 8, 7, 6, 5, 9, 12, 11, 10], 306: [0, 2, 1, 3, 5, 4],
             315: [0, 2, 1, 3, 5, 4, 8, 7, 6, 11, 10, 9, 12, 14, 13],
             203: range(3), 206: range(6), 204: range(4), 208: range(8)}


def med(file):
    from med import medenum as e
    from med.medfamily import MEDCHAR, MEDfamilyInfo, MEDnFamily, MEDnFamilyGroup
    from med.medfile import MEDfileClose, MEDfileOpen
    from med.medmesh import (MEDFLOAT, MEDINT, MEDmeshElementConnectivityRd, MEDmeshEntityFamilyNumberRd,
                             MEDmeshNodeCoordinateRd, MEDmeshnEntity)
    f, name = MEDfileOpen(str(file), e.MED_ACC_RDONLY), "mesh"

    def count(entity, kind, what):
        found = MEDmeshnEntity(f, name, e.MED_NO_DT, e.MED_NO_IT, entity, kind, what, e.MED_NODAL)
        return found[0] if isinstance(found, (list, tuple)) else found

    xyz = MEDFLOAT(3 * count(e.MED_NODE, e.MED_NONE, e.MED_COORDINATE))
    MEDmeshNodeCoordinateRd(f, name, e.MED_NO_DT, e.MED_NO_IT, e.MED_FULL_INTERLACE, xyz)
    read = Read(np.array(xyz).reshape(-1, 3))
    groups = {}
    for i in range(1, MEDnFamily(f, name) + 1):
        size = MEDnFamilyGroup(f, name, i)
        chars = MEDCHAR(80 * size + 1)
        number = MEDfamilyInfo(f, name, i, chars)[1]
        text = "".join(chars)
        groups[number] = [text[80 * j:80 * (j + 1)].split("\0")[0].rstrip() for j in range(size)]
    for kind, order in MED_NODES.items():
        size = count(e.MED_CELL, kind, e.MED_CONNECTIVITY)
        if size <= 0:
            continue
        flat, family = MEDINT(len(order) * size), MEDINT(size)
        MEDmeshElementConnectivityRd(f, name, e.MED_NO_DT, e.MED_NO_IT, e.MED_CELL, kind, e.MED_NODAL,
                                     e.MED_FULL_INTERLACE, flat)
        MEDmeshEntityFamilyNumberRd(f, name, e.MED_NO_DT, e.MED_NO_IT, e.MED_CELL, kind, family)
        for row, number in zip((np.array(flat) - 1).reshape(size, -1), family):
            nodes = [int(row[k]) for k in order]
            (read.add_cell if kind > 300 else read.add_face)(nodes, *groups.get(number, []))
    MEDfileClose(f)
    return read
