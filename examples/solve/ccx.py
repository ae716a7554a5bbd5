"""Running CalculiX, and reading what it writes."""
import os
import pathlib
import subprocess


class SolverFailed(Exception):
    pass


def run(deck: pathlib.Path) -> str:
    """Runs ccx on a deck in its folder; returns what it printed."""
    env = dict(os.environ, OMP_NUM_THREADS=os.environ.get("OMP_NUM_THREADS", "2"))
    done = subprocess.run(["ccx", deck.stem], cwd=deck.parent, env=env, text=True, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, timeout=1800)
    if done.returncode != 0 or "*ERROR" in done.stdout or "Job finished" not in done.stdout:
        errors = [line for line in done.stdout.splitlines() if "ERROR" in line][:5]
        raise SolverFailed(f"{deck}: ccx ended with {done.returncode}: {errors or done.stdout[-800:]}")
    return done.stdout


class Mesh:
    """The nodes and sets of a mesh that octafront wrote for CalculiX."""

    def __init__(self, path):
        self.nodes, self.elements, self.element_sets, self.node_sets, self.sides = {}, {}, {}, {}, {}
        keep = None
        for line in open(path):
            if line.startswith("**"):
                continue
            if line.startswith("*"):
                words = [w.strip() for w in line[1:].split(",")]
                options = dict(w.split("=", 1) for w in words[1:] if "=" in w)
                options = {k.strip().upper(): v.strip() for k, v in options.items()}
                keep = self._reader(words[0].upper(), options)
            elif keep:
                keep([w.strip() for w in line.strip().rstrip(",").split(",")])

    def nodes_of(self, element_set):
        return {node for e in self.element_sets[element_set] for node in self.elements[e]}

    def _reader(self, keyword, options):
        def node(words):
            self.nodes[int(words[0])] = tuple(float(w.replace("D", "E")) for w in words[1:])

        def element(words):
            self.elements[int(words[0])] = [int(w) for w in words[1:]]
            members.append(int(words[0]))

        if keyword == "NODE":
            return node
        if keyword == "ELEMENT":
            members = self.element_sets.setdefault(options["ELSET"], [])
            return element
        if keyword == "NSET":
            members = self.node_sets.setdefault(options["NSET"], [])
            return lambda words: members.extend(int(w) for w in words)
        if keyword == "SURFACE":
            sides = self.sides.setdefault(options["NAME"], [])
            return lambda words: sides.append((int(words[0]), words[1]))
        return None


def _numbers(line):
    # Fields of frd files have twelve columns and may touch.
    return [float(line[k:k + 12]) for k in range(13, len(line.rstrip("\n")), 12)]


def frd(path):
    """{name of the field: {node: values}} of the last step of a result file."""
    fields, field = {}, None
    for line in open(path, errors="replace"):
        if line.startswith(" -4"):
            field = fields[line[5:13].strip()] = {}
        elif line.startswith(" -3"):
            field = None
        elif line.startswith(" -1") and field is not None:
            field[int(line[3:13])] = _numbers(line)
    return fields


def dat_rows(path, title):
    """The rows of numbers below each line of a .dat file that begins with `title`; names behind the numbers are dropped."""
    rows, on = [], False
    for line in open(path):
        values = _leading_numbers(line.split())
        if values and on:
            rows.append(values)
        elif line.strip() and not values:
            on = line.strip().lower().startswith(title)
    return rows


def _leading_numbers(words):
    values = []
    for word in words:
        try:
            values.append(float(word))
        except ValueError:
            break
    return values
