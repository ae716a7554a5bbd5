"""Meshes as OpenFOAM's polyMesh folders: what checkMesh says of them, and which layers of cells stand on their walls, however they
were made. Needs NumPy, and Debian's openfoam for checkMesh.
"""
import os
import pathlib
import re
import subprocess

import numpy as np

SINE_OF_60 = 0.75**0.5
HEAD = "FoamFile {{ version 2.0; format ascii; class dictionary; object {}; }}\n"
CONTROL = ("application none; startFrom startTime; startTime 0; stopAt endTime; endTime 1; deltaT 1; writeControl timeStep; "
           "writeInterval 1; writePrecision 16; writeFormat ascii;\n")


def environment():
    """Debian's package leaves it to the user."""
    return os.environ | {"WM_PROJECT_DIR": "/usr/share/openfoam"}


def write_dictionary(case, name, text):
    path = pathlib.Path(case, name)
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(HEAD.format(path.name) + text)


def new_case(case):
    write_dictionary(case, "system/controlDict", CONTROL)
    write_dictionary(case, "system/fvSchemes", "ddtSchemes{} gradSchemes{} divSchemes{} laplacianSchemes{} interpolationSchemes{} snGradSchemes{}\n")
    write_dictionary(case, "system/fvSolution", "")


def number_after(text, words):
    found = re.search(re.escape(words) + r"\s*([-+\d.e]+)", text)
    return float(found[1].rstrip(".")) if found else None


def check_mesh(case, timeout=1200):
    """Verdict and figures of checkMesh -allTopology; None where it says nothing of them."""
    if not pathlib.Path(case, "system/fvSchemes").exists():
        new_case(case)
    done = subprocess.run(["checkMesh", "-allTopology", "-case", case], capture_output=True, text=True, timeout=timeout, env=environment())
    said = done.stdout + done.stderr
    return {"ok": "Mesh OK" in said, "cells": int(number_after(said, "cells:") or 0),
            "non_orthogonality": number_after(said, "non-orthogonality Max:"), "mean_non_orthogonality": number_after(said, "average:"),
            "severe": int(number_after(said, "severely non-orthogonal (> 70 degrees) faces:") or 0),
            "skewness": number_after(said, "Max skewness ="), "skew": int((re.search(r"(\d+) highly skew", said) or [0, 0])[1]),
            "faults": [fault.strip() for fault in re.findall(r"^ *\*\*\*(.*)$", said, re.M)]}


def verdict(foam):
    """OK, or what it finds wrong, in few words."""
    words = [f"{foam['skew']} skew" if "highly skew" in fault else re.split(r" *[(.,:]| detected| are ", fault)[0].lower() for fault in foam["faults"]]
    return "OK" if foam["ok"] else "; ".join(words) or "no"


def body_of(path):
    """What stands between the outermost parentheses of a list."""
    text = pathlib.Path(path).read_text()
    return text[text.index("(", text.index("}")) + 1:text.rindex(")")]


def numbers(text, kind):
    return np.array(text.translate({ord("("): " ", ord(")"): " "}).split(), kind)


class FoamMesh:
    """points (n, 3); faces as arrays of points; owner, neighbour; patches: name -> range of faces."""

    def __init__(self, case):
        folder = pathlib.Path(case, "constant/polyMesh")
        self.points = numbers(body_of(folder / "points"), float).reshape(-1, 3)
        flat, at, self.faces = numbers(body_of(folder / "faces"), int), 0, []
        while at < len(flat):
            self.faces.append(flat[at + 1:at + 1 + flat[at]])
            at += 1 + flat[at]
        self.owner, self.neighbour = numbers(body_of(folder / "owner"), int), numbers(body_of(folder / "neighbour"), int)
        self.patches = {}
        for name, block in re.findall(r"(\S+)\s*\{([^}]*)\}", body_of(folder / "boundary")):
            count, start = (int(re.search(rf"{key}\s+(\d+)", block)[1]) for key in ("nFaces", "startFace"))
            self.patches[name] = range(start, start + count)
        sides = np.concatenate([self.owner, self.neighbour])
        order = np.argsort(sides, kind="stable")
        self.of_cell = np.split(np.concatenate([np.arange(len(self.owner)), np.arange(len(self.neighbour))])[order],
                                np.cumsum(np.bincount(sides))[:-1])

    def cells(self):
        return len(self.of_cell)

    def vector_area(self, face):
        p = self.points[self.faces[face]]
        return 0.5 * np.cross(p[1:-1] - p[0], p[2:] - p[0]).sum(axis=0)

    def across(self, cell, face):
        """The face of a cell that shares no vertex with `face`, if the cell is a prism on it: faces around are quads."""
        base, opposite = set(self.faces[face]), None
        for other in self.of_cell[cell]:
            if other == face:
                continue
            if base.isdisjoint(self.faces[other]):
                if opposite is not None or len(self.faces[other]) != len(base):
                    return None
                opposite = other
            elif len(self.faces[other]) != 4:
                return None
        return opposite

    def height(self, face, other):
        """From the middle of one to the middle of the other, across the first."""
        way = self.points[self.faces[other]].mean(axis=0) - self.points[self.faces[face]].mean(axis=0)
        across = self.vector_area(face)
        return abs(float(np.dot(way, across))) / float(np.linalg.norm(across))

    def beyond(self, face, cell):
        if face >= len(self.neighbour):
            return None
        return int(self.neighbour[face] if self.owner[face] == cell else self.owner[face])

    def stack(self, face, most):
        """[(cell, height)] of the prisms over a face of the boundary, at most so many."""
        found, cell = [], int(self.owner[face])
        while cell is not None and len(found) < most:
            other = self.across(cell, face)
            if other is None:
                break
            found.append((cell, self.height(face, other)))
            face, cell = other, self.beyond(other, cell)
        return found

    def scaled_jacobian(self, cell, corners):
        """Least over the vertices of a prism; 1: right angles on a regular base of so many corners (3: a wedge); -1 if it is not closed."""
        ends = {}
        for face in self.of_cell[cell]:
            loop = self.faces[face] if self.owner[face] == cell else self.faces[face][::-1]
            for before, v, after in zip(np.roll(loop, 1), loop, np.roll(loop, -1)):
                ends.setdefault(v, {})[after] = before
        least, regular = 2.0, SINE_OF_60 if corners == 3 else 1.0
        for v, turn in ends.items():
            if set(turn) != set(turn.values()):
                return -1.0
            a = next(iter(turn))
            b = turn[a]
            c = turn[b]
            u, w, x = (self.points[k] - self.points[v] for k in (a, b, c))
            lengths = np.linalg.norm(u) * np.linalg.norm(w) * np.linalg.norm(x)
            # Around a vertex of a cell whose faces look outward, before and after run clockwise from inside.
            least = min(least, -float(np.dot(np.cross(u, w), x)) / (lengths * regular) if lengths > 0 else 0.0)
        return least


def layers_on(mesh, patches, heights):
    """What stands on the faces of these patches. A layer counts if its height is at least half of what was asked of it and no
    more than twice; it is whole from .99 on."""
    area = all_area = whole_area = 0.0
    faces = full = whole = 0
    least, thickness = 2.0, 0.0
    for name in patches:
        for face in mesh.patches[name]:
            a = float(np.linalg.norm(mesh.vector_area(face)))
            stack, good = mesh.stack(face, len(heights)), 0
            for (cell, height), asked in zip(stack, heights):
                if not 0.5 * asked <= height <= 2 * asked:
                    break
                good += 1
                if len(mesh.faces[face]) <= 4:
                    least = min(least, mesh.scaled_jacobian(cell, len(mesh.faces[face])))
            is_full = good == len(heights)
            made = sum(h for _, h in stack[:good])
            is_whole = is_full and made >= 0.99 * sum(heights)
            faces, all_area, thickness = faces + 1, all_area + a, thickness + a * min(1.0, made / sum(heights))
            full, area = full + is_full, area + a * is_full
            whole, whole_area = whole + is_whole, whole_area + a * is_whole
    return {"faces": faces, "full": full / faces, "full_area": area / all_area, "whole": whole / faces,
            "whole_area": whole_area / all_area, "thickness": thickness / all_area, "least_scaled_jacobian": least if least < 2 else None}
