#!/usr/bin/env python3
"""Shrinks a surface on which a command fails to a small one on which it fails in the same way.

  bench/campaigns/minimise.py BAD.off SMALL.off [--seconds N] -- COMMAND...

COMMAND is run with {} replaced by a file; it fails in the same way if its exit status is that of the first run, on
BAD.off itself. Example, for a cavity that could not be filled (exit status 4):

  bench/campaigns/minimise.py bad.off small.off -- build/release/cli/octafront mesh {} -o mesh.vtu -q --keep-surface

What is tried: leaving out connected parts, collapsing many edges, then fewer, then each, and rounding coordinates.
Collapses keep the surface closed and manifold; where they make it meet itself, the command refuses it with another
status. SMALL.off is written at every success, so an interrupted run loses nothing. Surfaces are triangles in OFF.
"""
import argparse
import pathlib
import random
import subprocess
import sys
import tempfile
import time


def read_off(path):
    words = " ".join(line.split("#")[0] for line in pathlib.Path(path).read_text().splitlines()).split()
    if not words or words[0] != "OFF":
        sys.exit(f"{path} is no OFF file")
    vertices, faces = int(words[1]), int(words[2])
    numbers = words[4:]
    points = [tuple(map(float, numbers[3 * v : 3 * v + 3])) for v in range(vertices)]
    numbers = numbers[3 * vertices :]
    if any(numbers[4 * f] != "3" for f in range(faces)):
        sys.exit(f"{path} has faces that are no triangles")
    return points, [tuple(map(int, numbers[4 * f + 1 : 4 * f + 4])) for f in range(faces)]


def write_off(path, points, triangles):
    used = sorted({v for t in triangles for v in t})
    number = {v: i for i, v in enumerate(used)}
    lines = ["OFF", f"{len(used)} {len(triangles)} 0"]
    lines += [" ".join(repr(x) for x in points[v]) for v in used]
    lines += ["3 " + " ".join(str(number[v]) for v in t) for t in triangles]
    pathlib.Path(path).write_text("\n".join(lines) + "\n")


class Command:
    """The command, and the status that it has to keep."""

    def __init__(self, words, seconds):
        self.words, self.end, self.runs, self.status = words, time.monotonic() + seconds, 0, None
        self.folder = tempfile.TemporaryDirectory()

    def status_on(self, points, triangles):
        file = pathlib.Path(self.folder.name, "surface.off")
        write_off(file, points, triangles)
        self.runs += 1
        words = [w.replace("{}", str(file)) for w in self.words]
        return subprocess.run(words, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL).returncode

    def fails(self, points, triangles):
        return bool(triangles) and self.in_time() and self.status_on(points, triangles) == self.status

    def in_time(self):
        return time.monotonic() < self.end


def parts(triangles):
    """Lists of triangles that share vertices."""
    root = {}

    def find(v):
        while root.setdefault(v, v) != v:
            root[v] = v = root[root[v]]
        return v

    for a, b, c in triangles:
        root[find(a)] = find(b)
        root[find(b)] = find(c)
    groups = {}
    for t in triangles:
        groups.setdefault(find(t[0]), []).append(t)
    return list(groups.values())


def collapse(triangles, edges):
    """Moves the first end of each edge onto the second, where the surface stays a closed manifold and no collapse has
    touched the place before. Returns the new triangles and how many edges were collapsed."""
    around = {}
    for t in triangles:
        for v in t:
            around.setdefault(v, []).append(t)
    neighbours = {v: {u for t in fan for u in t} - {v} for v, fan in around.items()}
    target, touched = {}, set()
    for a, b in edges:
        common = neighbours[a] & neighbours[b]
        region = neighbours[a] | neighbours[b]
        # The link condition; a tetrahedron cannot lose a vertex.
        if len(common) != 2 or region & touched or any(len(neighbours[c]) <= 3 for c in common):
            continue
        target[a] = b
        touched |= region
    moved = [tuple(target.get(v, v) for v in t) for t in triangles]
    return [t for t in moved if len(set(t)) == 3], len(target)


def shrink_parts(command, points, triangles, keep):
    for part in sorted(parts(triangles), key=len, reverse=True):
        rest = [t for t in triangles if t not in set(part)]
        if command.fails(points, rest):
            triangles = keep(points, rest)
    return triangles


def six_volumes(a, b, c, d):
    u, v, w = ([q - p for p, q in zip(a, x)] for x in (b, c, d))
    return (u[0] * (v[1] * w[2] - v[2] * w[1]) + u[1] * (v[2] * w[0] - v[0] * w[2]) + u[2] * (v[0] * w[1] - v[1] * w[0]))


def edges_by_change(points, triangles, rng):
    """All edges in both directions; first those whose collapse sweeps the least volume, ties at random."""
    around = {}
    for t in triangles:
        for v in t:
            around.setdefault(v, []).append(t)
    edges = []
    for t in triangles:
        for a, b in zip(t, t[1:] + t[:1]):
            swept = sum(abs(six_volumes(points[b], *(points[v] for v in f))) for f in around[a])
            edges.append((swept, rng.random(), a, b))
    return [(a, b) for _, _, a, b in sorted(edges)]


def shrink_by_collapses(command, points, triangles, keep, rng):
    share = 0.5
    while command.in_time():
        edges = edges_by_change(points, triangles, rng)
        wanted = int(share * len(edges))
        if wanted > 3:
            fewer, count = collapse(triangles, edges[:wanted])
            if count > 1 and command.fails(points, fewer):
                triangles = keep(points, fewer)
            else:
                share /= 2
            continue
        before = len(triangles)
        for edge in edges:
            if not {*edge} <= {v for t in triangles for v in t}:
                continue
            fewer, count = collapse(triangles, [edge])
            if count and command.fails(points, fewer):
                triangles = keep(points, fewer)
        if len(triangles) == before:
            return triangles
        share = 0.25
    return triangles


def round_coordinates(command, points, triangles, keep):
    for digits in range(1, 16):
        rounded = [tuple(float(f"{x:.{digits}g}") for x in p) for p in points]
        if command.fails(rounded, triangles):
            keep(rounded, triangles)
            return


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bad")
    parser.add_argument("small")
    parser.add_argument("--seconds", type=float, default=600, help="stop after this long")
    parser.add_argument("--seed", type=int, default=0, help="another seed shrinks in another order")
    parser.add_argument("command", nargs="+", help="the command, {} for the file")
    args = parser.parse_args()
    points, triangles = read_off(args.bad)
    command = Command(args.command, args.seconds)
    command.status = command.status_on(points, triangles)
    print(f"{len(triangles)} triangles, exit status {command.status}", flush=True)

    def keep(new_points, new_triangles):
        write_off(args.small, new_points, new_triangles)
        print(f"{len(new_triangles)} triangles after {command.runs} runs", flush=True)
        return new_triangles

    keep(points, triangles)
    triangles = shrink_parts(command, points, triangles, keep)
    triangles = shrink_by_collapses(command, points, triangles, keep, random.Random(args.seed))
    round_coordinates(command, points, triangles, keep)


main()
