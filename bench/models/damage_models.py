#!/usr/bin/python3
"""Damages clean models in known ways, for bench/run/known_answers.py to judge what repair makes of them.

  bench/models/damage_models.py FOLDER [--cases FIRST:END] [--seed N] [--kinds A,B] [--generated] [--list]

Writes FOLDER/NNNN.off or .stl (the damaged model), NNNN-truth-K.off (the solids whose union it stands for) and NNNN.json
(what is known of it); cases 0 to 1999 by default. Case and seed say everything: the kind of damage is the case modulo the
number of kinds, the model is drawn. Models: generated shapes, and with bench/models/get-models.sh those of models/clean that
have at most MOST_FACES triangles. Needs python3-numpy.
"""
import argparse
import functools
import json
import pathlib
import sys
import zlib

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2]))
from bench.off import write_off
from bench.models import damages
from bench.models import solids

FACES = (20, 8000)
CASES = 2000
ROOT = pathlib.Path(__file__).resolve().parents[2]
DIRECTIONS = [(x, y, z) for x in (-2, -1, 0, 1, 2) for y in (-2, -1, 0, 1, 2) for z in (-2, -1, 0, 1, 2)
              if np.gcd.reduce((x, y, z)) == 1]
"""Zones are convex hulls as seen from these directions: for each the greatest product with a point of the zone."""


@functools.lru_cache(maxsize=None)
def load(name):
    """The solid, or None if it is not clean, or too large or too small."""
    if name in solids.GENERATED:
        return solids.GENERATED[name]()
    try:
        solid = solids.read_off(ROOT / "models/clean" / name)
    except (ValueError, IndexError):  # with colours or normals: there are enough others
        return None
    right = FACES[0] <= len(solid.triangles) <= FACES[1] and solids.is_strictly_clean(solid)
    return solid if right else None


@functools.lru_cache(maxsize=None)
def model_names(generated_only):
    names = sorted(solids.GENERATED)
    if not generated_only:
        names += sorted(p.name for p in (ROOT / "models/clean").glob("*.off"))
    return names


def make(number, seed=0, kinds=None, generated_only=False):
    """(kind, model, Case) of this number."""
    kinds = kinds or list(damages.KINDS)
    kind = kinds[number % len(kinds)]
    rng = np.random.default_rng([seed, number, zlib.crc32(kind.encode())])
    for name in rng.permutation(model_names(generated_only)).tolist():
        solid = load(name)
        if solid is None:
            continue
        try:
            return kind, name, damages.KINDS[kind](solid, rng)
        except damages.Unsuitable:
            continue
    raise SystemExit(f"no model can be damaged as case {number}, {kind}")


def zone(points):
    """The zone's greatest product with each direction, grown by a margin."""
    margin = damages.HOLE_MARGIN * float(np.linalg.norm(np.ptp(points, axis=0)))
    return [float((points @ np.array(d)).max() + margin * np.linalg.norm(d)) for d in DIRECTIONS]


def write(folder, number, kind, name, made, seed):
    """The files of a case; returns what the JSON says, with paths."""
    stem = pathlib.Path(folder, f"{number:04}")
    damaged = stem.with_suffix(".stl" if made.as_stl else ".off")
    if made.as_stl:
        solids.write_stl(damaged, made.soup)
    else:
        write_off(damaged, *made.soup)
    truth = []
    for k, solid in enumerate(made.truth):
        truth.append(stem.with_name(f"{stem.name}-truth-{k}.off"))
        write_off(truth[-1], *solid)
    known = {"case": number, "seed": seed, "kind": kind, "model": name, "what": made.what, "file": str(damaged),
             "solids": [str(t) for t in truth], "expected": made.expected, "directions": DIRECTIONS,
             "zones": [zone(z) for z in made.zones],
             "touched": [[list(lo), list(hi)] for lo, hi in made.touched],
             "lost": [np.flatnonzero(lost).tolist() for lost in damages.lost_triangles(made)],
             "damaged_triangles": len(made.soup.triangles)}
    stem.with_suffix(".json").write_text(json.dumps(known, default=float))
    return known


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--cases", default=f"0:{CASES}", help="FIRST:END, or one number")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--kinds", default=",".join(damages.KINDS), help="by default all: " + ", ".join(damages.KINDS))
    parser.add_argument("--generated", action="store_true", help="generated shapes only, whatever was fetched")
    parser.add_argument("--list", action="store_true", help="say what would be made, write nothing")
    a = parser.parse_args()
    first, _, end = a.cases.partition(":")
    if not a.list:
        a.folder.mkdir(parents=True, exist_ok=True)
    for number in range(int(first), int(end or int(first) + 1)):
        kind, name, made = make(number, a.seed, a.kinds.split(","), a.generated)
        if not a.list:
            write(a.folder, number, kind, name, made, a.seed)
        print(f"{number:4} {kind:12} {name:24} {made.what}", flush=True)


if __name__ == "__main__":
    main()
