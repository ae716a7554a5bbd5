#!/usr/bin/env python3
"""No two sources, and no two tests, of a wing give one name to different things in their unnamed namespaces: then many of them can be
compiled as one (OCTAFRONT_UNITY), and no overload of another file is chosen unseen. Aliases of the same type may repeat.
And no file of src has a name that a file of another room has: names tell rooms apart.

    check_names.py ROOT | --self-test
"""
import collections
import pathlib
import re
import sys

UNNAMED = re.compile(r"^namespace \{\n(.*?)^\}  // namespace$", re.S | re.M)
ALIAS = re.compile(r"^using (\w+) = (.*?);", re.S | re.M)
NAMES = [re.compile(r"^(?:template <[^\n]*\n)?(?:class|struct|enum class) (\w+)", re.M),
         re.compile(r"^(?!\s|return|using|class|struct|//|#|\}|TEST|RC_|INSTANTIATE|static_assert)[\w:<>,&*\[\]. ]*?[\w>&*\]] [&*]*(\w+)\(", re.M)]
CONSTANTS = re.compile(r"^(?:static |inline )*(?:constexpr|const) [^\n(]*?(k[A-Z]\w*)\b[^;]*;", re.M)
CONSTANT = re.compile(r"\b(k[A-Z]\w*)(?:\[\w*\])? ?(?:=|\{)")


def names_in(text):
    """{name: what it stands for} of the unnamed namespaces of a source; what stands for itself has an empty text."""
    found = {}
    for body in UNNAMED.findall(text):
        found.update({name: " ".join(meaning.split()) for name, meaning in ALIAS.findall(body)})
        found.update({name: "" for pattern in NAMES for name in pattern.findall(body)})
        found.update({name: "" for line in CONSTANTS.finditer(body) for name in CONSTANT.findall(line.group(0))})
    return found


def clashes(sources):
    """sources: {wing: {file: text}}. Yields a sentence for each name that two files of a wing give to different things."""
    for wing, files in sorted(sources.items()):
        users = collections.defaultdict(list)
        for file, text in sorted(files.items()):
            for name, meaning in names_in(text).items():
                users[name].append((file, meaning))
        for name, uses in sorted(users.items()):
            if len(uses) > 1 and (len({meaning for _, meaning in uses}) > 1 or not uses[0][1]):
                yield f"{wing}: {name} is a name of its own in {', '.join(file for file, _ in uses)}: let each say its subject"


def shared_names(paths):
    """paths: of files in src, as WING/ROOM/NAME. Yields a sentence for each name that stands in several rooms."""
    rooms = collections.defaultdict(set)
    for path in map(pathlib.PurePosixPath, paths):
        rooms[path.stem].add("/".join(path.parts[:2]) if len(path.parts) > 2 else path.parts[0])
    for name, places in sorted(rooms.items()):
        if len(places) > 1:
            yield f"{name} is the name of files in {', '.join(sorted(places))}: let each say what is in it"


def read_sources(root):
    sources = collections.defaultdict(dict)
    for top in ("src", "tests", "cli", "cad"):
        for path in (root / top).rglob("*.cpp"):
            parts = path.relative_to(root).parts
            wing = top if top in ("cli", "cad") else "/".join(parts[:2][: len(parts) - 1])
            if wing not in ("tests/corpus", "tests/fuzz", "tests/install"):
                sources[wing]["/".join(parts)] = path.read_text()
    return sources


def self_test():
    def source(body):
        return f"namespace octafront {{\nnamespace {{\n\n{body}\n}}  // namespace\n}}\n"
    alone = source("constexpr double kHere = 1, kThere = 2;\nusing Kind = A::B;\nstruct Place {\n  int at() { return 0; }\n};\n"
                   "std::vector<int> made_of(int n) {\n  return kept(n);\n}\n")
    for body, name in [("constexpr int kThere = 3;\n", "kThere"), ("using Kind = A::C;\n", "Kind"), ("class Place {\n};\n", "Place"),
                       ("void made_of(double) {}\n", "made_of"), ("constexpr int kHere[] = {1};\n", "kHere")]:
        found = list(clashes({"wing": {"a.cpp": alone, "b.cpp": source(body)}}))
        assert len(found) == 1 and f" {name} " in found[0], (body, found)
        assert not list(clashes({"wing": {"a.cpp": alone}, "other": {"b.cpp": source(body)}}))
    for body in ["using Kind = A::B;\n", "void kept(int) {}\n", "struct Other {\n  int made_of() { return 0; }\n};\n"]:
        assert not list(clashes({"wing": {"a.cpp": alone, "b.cpp": source(body)}})), body
    assert len(list(shared_names(["fill/front/walls.h", "fill/front/walls.cpp", "soup/cells/walls.cpp", "ranks/mpi.cpp"]))) == 1


def main():
    if sys.argv[1] == "--self-test":
        return self_test()
    sources = read_sources(pathlib.Path(sys.argv[1]))
    assert sum(len(files) for files in sources.values()) > 300, "the sources were not found"
    src = pathlib.Path(sys.argv[1]) / "src"
    found = [*clashes(sources), *shared_names(path.relative_to(src).as_posix() for path in src.rglob("*") if path.suffix in (".h", ".cpp"))]
    print("\n".join(found))
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
