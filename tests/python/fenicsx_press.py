#!/usr/bin/python3
"""The loop of docs/use/move.md: the force on a mesh that moves and is mended is that of a fine Lagrangian one, and its elements
stay sound. Skipped (77) without DOLFINx."""
from fenicsx_example import found


def main():
    rows = found("fenicsx_press.py", "move.md", "With FEniCSx", "--compare")
    fine = {round(height, 6): force for height, force, _, _ in rows["lagrangian"]}
    moved = rows["moved"]
    assert abs(moved[-1][0] - 0.4) < 1e-12, moved[-1]
    assert len({elements for _, _, elements, _ in moved}) > 1, "it was never mended"
    compared = 0
    for height, force, _, quality in moved:
        assert quality > 0.15, (height, quality)
        if round(height, 6) in fine:
            assert abs(force / fine[round(height, 6)] - 1) < 0.04, (height, force, fine[round(height, 6)])
            compared += 1
    assert compared > 15, compared


main()
