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
            labels = [int(w) for w in re.search(r"Labels List<label> \d+\s*\(([^)]*)\)", block).group(1).split()]
            parts[kind, name] = [faces[f] for f in labels] if kind == "faces" else labels
    return {"points": points, "tets": tets, "parts": parts}
