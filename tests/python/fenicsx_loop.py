#!/usr/bin/python3
"""The loop of docs/use/adapt.md: its adapted meshes have six tenths of the error of uniform ones of as many unknowns. Skipped (77)
without DOLFINx."""
import math

from fenicsx_example import found


def slope(rows):
    return math.log(rows[-1]["error"] / rows[0]["error"]) / math.log(rows[-1]["unknowns"] / rows[0]["unknowns"])


def main():
    rows = found("fenicsx_loop.py", "adapt.md", "A loop with FEniCSx")
    uniform, adapted = rows["uniform"], rows["metric"]
    print(uniform, adapted)
    assert slope(adapted) < -0.3, slope(adapted)
    assert slope(rows["sizes"]) < -0.25, slope(rows["sizes"])
    last, first = uniform[-1], adapted[0]
    # By their theory a uniform mesh of as many unknowns as the first adapted one has this error.
    as_many = last["error"] * (last["unknowns"] / first["unknowns"]) ** (2 / 9)
    assert first["error"] < 0.6 * as_many, (first, as_many)


main()
