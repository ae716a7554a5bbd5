#!/usr/bin/env python3
"""Damaged CAD files through the command line: no crash, no hang, a clear message for each.

  bench/campaigns/mutated-cad.py [COUNT [FIRST]]      files of cad-models/ (bench/models/get-cad.sh), damaged by number

Prints a line for each that went wrong, and counts at the end. Exits with 1 if any did.
"""
import collections
import pathlib
import random
import re
import subprocess
import sys
import tempfile

OCTAFRONT = pathlib.Path("build/release/cli/octafront").resolve()
LARGEST = 400_000  # bytes of a file
CPU_SECONDS, WALL_SECONDS = 5, 60


def cut(bytes_, rng):
    return bytes_[:rng.randrange(len(bytes_))]


def flipped(bytes_, rng):
    out = bytearray(bytes_)
    for _ in range(rng.choice((1, 3, 30))):
        out[rng.randrange(len(out))] ^= 1 << rng.randrange(8)
    return bytes(out)


def other_numbers(bytes_, rng):
    numbers = list(re.finditer(rb"-?\d+(\.\d*)?(E[+-]?\d+)?", bytes_))
    out = bytearray(bytes_)
    values = (b"0", b"-1", b"1", b"1e300", b"-1E-300", b"nan", b"99999999", b"2147483648", b"0.", b"-7.5")
    for number in sorted(rng.sample(numbers, min(len(numbers), rng.choice((1, 4)))), key=lambda m: -m.start()):
        out[number.start():number.end()] = rng.choice(values)
    return bytes(out)


def without_lines(bytes_, rng):
    lines = bytes_.split(b"\n")
    for _ in range(rng.choice((1, 5))):
        del lines[rng.randrange(len(lines))]
        if len(lines) < 2:
            break
    return b"\n".join(lines)


def swapped_lines(bytes_, rng):
    lines = bytes_.split(b"\n")
    a, b = rng.randrange(len(lines)), rng.randrange(len(lines))
    lines[a], lines[b] = lines[b], lines[a]
    return b"\n".join(lines)


def repeated(bytes_, rng):
    begin, length = rng.randrange(len(bytes_)), rng.randrange(1, 2000)
    return bytes_[:begin + length] + bytes_[begin:begin + length] + bytes_[begin + length:]


DAMAGES = (cut, flipped, other_numbers, other_numbers, without_lines, swapped_lines, repeated)


def sources():
    kinds = collections.defaultdict(list)
    for file in sorted(pathlib.Path("cad-models").iterdir()):
        if file.stat().st_size <= LARGEST:
            kinds[{".step": "stp", ".iges": "igs"}.get(file.suffix, file.suffix.strip("."))].append(file)
    return [files for _, files in sorted(kinds.items())]


def what_is_wrong(done):
    if done.returncode not in (0, 3, 4):
        return f"status {done.returncode}"
    if done.returncode != 0 and not done.stderr.startswith("octafront: "):
        return "no message"
    if "\ufffd" in done.stderr:
        return "message is not UTF-8"
    return ""


def try_one(number, kinds, folder):
    rng = random.Random(number)
    source = rng.choice(kinds[number % len(kinds)])
    damage = rng.choice(DAMAGES)
    file = folder / f"damaged{source.suffix}"
    file.write_bytes(damage(source.read_bytes(), rng))
    command = [OCTAFRONT, "mesh", file, "--dry-run", "--cad-seconds", str(CPU_SECONDS), "--cad-memory", "3",
               "--threads", "1"] + ["--keep-going"] * (number % 2)
    try:
        done = subprocess.run(command, capture_output=True, text=True, errors="replace", timeout=WALL_SECONDS)
        return source, damage, done, what_is_wrong(done)
    except subprocess.TimeoutExpired:
        return source, damage, None, f"no end within {WALL_SECONDS} s"


def main():
    count, first = [int(word) for word in sys.argv[1:3]] + [2000, 0][len(sys.argv) - 1:]
    kinds, outcomes, messages, bad = sources(), collections.Counter(), collections.Counter(), 0
    with tempfile.TemporaryDirectory() as folder:
        for number in range(first, first + count):
            source, damage, done, wrong = try_one(number, kinds, pathlib.Path(folder))
            outcomes[done.returncode if done else "no end"] += 1
            if done and done.returncode:
                messages[re.sub(r"[\d.e+-]*\d[\d.e+-]*", "N", done.stderr.strip().replace(folder, ""))[:160]] += 1
            if (number + 1 - first) % 200 == 0:
                print(f"{number + 1 - first} of {count}: {dict(outcomes)}", file=sys.stderr, flush=True)
            if wrong:
                bad += 1
                print(f"{number}: {source.name} {damage.__name__}: {wrong}: {done.stderr.strip()[:300] if done else ''}", flush=True)
    print("by status:", dict(outcomes), "wrong:", bad)
    for message, times in messages.most_common(40):
        print(f"{times:6} {message}")
    sys.exit(1 if bad else 0)


main()
