#!/usr/bin/env python3
"""Do wings and rooms keep to their walls? Reads every #include and compares it with the table of wings in ARCHITECTURE.md
and the tables of rooms in src/WING/README.md.

    check_walls.py ROOT          prints each breach as a line; status 1 if there are any
    check_walls.py --self-test   builds a small house with one breach of each kind, and must find them all

What holds:
- A wing (src/fill) is one room or holds rooms (src/fill/lattice). A row of the table of wings names the wings that it may
  include from, all of rows above it: wings form no circle. Its CMake WINGS are that row.
- A room includes from itself, from what its row names, rooms or whole wings, and public headers.
- A row names rooms of rows above it or of wings above, and only what the room needs: it includes from them, or includes a
  public header that they define. So dependencies go down, and the tables do not outlive them.
- Each wing has a README.md with a row for each of its rooms, and no other.
- Public headers include public headers. The command line includes public headers and its own.
- Tests of a room include that room, rooms that it could reach, and tests/support; those of a wing what its rooms reach.
  Benchmarks may look into any room.
"""
import pathlib
import re
import sys

from self_test import finds

INCLUDE = re.compile(r'^\s*#\s*include\s*(?:"([^"]+)"|<octafront/([^>]+)>)', re.M)


def rows(text, columns):
    """The cells of each row of so many columns that begins with a name in backticks, which may be a link."""
    cells = ([cell.strip() for cell in line.strip().strip("|").split("|")] for line in text.splitlines())
    named = ((re.fullmatch(r"\[?`([\w/]+)`(?:\]\(\S+\))?", row[0]), row) for row in cells if len(row) == columns)
    return [[name[1], *row[1:]] for name, row in named if name]


def names_in(cell):
    return re.findall(r"`([\w/.]+)`", cell)


def read_wings(text):
    """{wing: wings it may include from}, of ARCHITECTURE.md, in the order of rows."""
    return {row[0]: names_in(row[1]) for row in rows(text, 3)}


def read_rooms(text):
    """{room: (rooms and wings it may include from, public headers that it defines)}, of a wing's README.md."""
    return {row[0]: (names_in(row[1]), names_in(row[4])) for row in rows(text, 5)}


def wing_of(room):
    return room.split("/")[0]


def sources(folder):
    return sorted(path for path in folder.rglob("*") if path.suffix in (".h", ".cpp"))


def includes(path):
    """(of our own tree, public) headers that a file includes."""
    found = INCLUDE.findall(path.read_text())
    return [own for own, _ in found if own], [public for _, public in found if public]


class House:
    def __init__(self, root):
        self.root = root
        self.breaches = []
        self.wings = read_wings((root / "ARCHITECTURE.md").read_text())
        self.rooms, self.homes = {}, {}
        for wing in self.wings:
            self.read_rooms_of(wing)

    def read_rooms_of(self, wing):
        page = self.page(wing)
        for room, (below, headers) in read_rooms(page.read_text() if page.exists() else "").items():
            if wing_of(room) != wing:
                self.breach(page, f"has a row of {room}, which is not in this wing")
                continue
            self.rooms[room] = below
            for header in headers:
                self.homes.setdefault(header, set()).add(room)

    def page(self, room):
        return self.root / "src" / wing_of(room) / "README.md"

    def breach(self, where, what):
        where = where.relative_to(self.root) if isinstance(where, pathlib.Path) else where
        self.breaches.append(f"{where}: {what}")

    def room_of(self, header):
        """The room that "fill/lattice/core.h" lies in; None if in no room."""
        parts = header.split("/")[:-1]
        return next((room for room in ("/".join(parts[:2]), *parts[:1]) if room in self.rooms), None)

    def rooms_in(self, name):
        """A room alone, a wing's rooms."""
        return {name} if name in self.rooms else {room for room in self.rooms if wing_of(room) == name}

    def row(self, room):
        return set().union(*map(self.rooms_in, self.rooms[room]))

    def reach(self, room):
        """A room and all below it."""
        return {room}.union(*(self.reach(r) for r in self.row(room)))

    def check_order(self):
        seen = set()
        for wing, below in self.wings.items():
            for other in below:
                if other not in seen:
                    self.breach("ARCHITECTURE.md", f"{wing} names {other}, which is no wing of a row above it")
            seen.add(wing)
        seen = set()
        for room, below in self.rooms.items():
            for other in below:
                if not (seen & self.rooms_in(other) if other not in self.rooms else other in seen):
                    self.breach(self.page(room), f"{room} names {other}, which is no room of a row or wing above it")
            seen.add(room)

    def check_rooms(self):
        src, needed = self.root / "src", {room: set() for room in self.rooms}
        for path in sources(src):
            room = self.room_of(path.relative_to(src).as_posix())
            if room is None:
                self.breach(path, "lies in no room that the README.md of its wing names")
                continue
            own, public = includes(path)
            for header in own:
                other = self.room_of(header)
                if other != room:
                    needed[room].add(other)
                    if other not in self.row(room):
                        self.breach(path, f'includes "{header}", where {room} may not reach')
            needed[room] = needed[room].union(*(self.homes.get(header, ()) for header in public))
        for room, below in self.rooms.items():
            for name in below:
                if not self.rooms_in(name) & needed[room]:
                    self.breach(self.page(room), f"{room} no longer needs {name}")

    def check_wings(self):
        for wing, below in self.wings.items():
            used = {wing_of(other) for room in self.rooms_in(wing) for other in self.rooms[room]} - {wing}
            for other in sorted(used ^ set(below)):
                self.breach("ARCHITECTURE.md", f"the row of {wing} {'does not name' if other in used else 'needs not name'} {other}")

    def check_pages(self):
        for wing in self.wings:
            if not self.rooms_in(wing):
                self.breach(self.page(wing), "is not there, or has no row for a room")
        for room in self.rooms:
            if not sources(self.root / "src" / room):
                self.breach(self.page(room), f"names {room}, which has no sources")

    def check_cmake(self):
        for wing, below in self.wings.items():
            path = self.root / "src" / wing / "CMakeLists.txt"
            words = re.search(r"octafront_wing\(([^)]*)\)", path.read_text()).group(1).split()
            listed = words[words.index("WINGS") + 1 :] if "WINGS" in words else []
            listed = listed[: listed.index("LIBS")] if "LIBS" in listed else listed
            if set(listed) != set(below):
                self.breach(path, f"WINGS are {sorted(listed)}, ARCHITECTURE.md names {sorted(below)}")

    def check_outside(self):
        for path in sources(self.root / "include"):
            for header in includes(path)[0]:
                self.breach(path, f'is public and includes "{header}"')
        for path in sources(self.root / "cli"):
            for header in includes(path)[0]:
                if not (path.parent / header).exists():
                    self.breach(path, f'includes "{header}"; the command line sees public headers only')
        for path in sources(self.root / "tests"):
            folder = path.relative_to(self.root / "tests").parent.as_posix()
            tested = self.rooms_in(folder) or self.rooms_in(wing_of(folder)) or self.rooms
            may = {"support"}.union(*map(self.reach, tested))
            for header in includes(path)[0]:
                room = self.room_of(header) or header.split("/")[0]
                beside = any((root / header).exists() for root in (path.parent, self.root / "tests", self.root / folder))
                if room not in may and not beside:
                    self.breach(path, f'includes "{header}", which {folder} cannot reach')

    def check(self):
        self.check_order()
        self.check_rooms()
        self.check_wings()
        self.check_pages()
        self.check_cmake()
        self.check_outside()
        return self.breaches


def self_test():
    files = {
        "ARCHITECTURE.md": "| [`low`](src/low/README.md) | - | it |\n| `mid` | `low`, `top` | it |\n| `top` | `mid` | it |\n| `bare` | - | it |\n",
        "src/low/README.md": "| `low` | - | a | b | `p.h` |\n| `mid/two` | - | a | b | - |\n",
        "src/mid/README.md": "| `mid/one` | `mid/two`, `low` | a | b | - |\n| `mid/two` | - | a | b | - |\n| `mid/gone` | - | a | b | - |\n",
        "src/top/README.md": "| `top` | `mid`, `low` | a | b | - |\n",
        "include/octafront/p.h": '#include "low/low.h"\n',
        "src/low/low.h": "",
        "src/low/up.cpp": '#include "mid/two/two.h"\n',
        "src/low/CMakeLists.txt": "octafront_wing(low WINGS mid LIBS x)",
        "src/mid/CMakeLists.txt": "octafront_wing(mid WINGS low top)",
        "src/mid/one/one.h": "#include <octafront/p.h>\n",
        "src/mid/two/two.h": '#include "mid/one/one.h"\n',
        "src/mid/stray.h": "",
        "src/bare/CMakeLists.txt": "octafront_wing(bare)",
        "src/bare/a.cpp": "",
        "src/top/a.cpp": '#include "mid/one/one.h"\n',
        "src/top/CMakeLists.txt": "octafront_wing(top WINGS mid)",
        "cli/main.cpp": '#include "low/low.h"\n',
        "tests/low/a_test.cpp": '#include "top/top.h"\n#include "support/s.h"\n',
        "tests/mid/two/a_test.cpp": '#include "mid/one/one.h"\n',
    }
    expected = [
        "ARCHITECTURE.md: mid names top, which is no wing of a row above it",
        "src/mid/README.md: mid/one names mid/two, which is no room of a row or wing above it",
        "src/low/README.md: has a row of mid/two, which is not in this wing",
        "src/mid/README.md: names mid/gone, which has no sources",
        "src/bare/README.md: is not there, or has no row for a room",
        "src/bare/a.cpp: lies in no room that the README.md of its wing names",
        'src/low/up.cpp: includes "mid/two/two.h", where low may not reach',
        "src/mid/stray.h: lies in no room that the README.md of its wing names",
        'src/mid/two/two.h: includes "mid/one/one.h", where mid/two may not reach',
        "src/mid/README.md: mid/one no longer needs mid/two",
        "src/top/README.md: top no longer needs low",
        "ARCHITECTURE.md: the row of mid needs not name top",
        "ARCHITECTURE.md: the row of top does not name low",
        "src/low/CMakeLists.txt: WINGS are ['mid'], ARCHITECTURE.md names []",
        'include/octafront/p.h: is public and includes "low/low.h"',
        'cli/main.cpp: includes "low/low.h"; the command line sees public headers only',
        'tests/low/a_test.cpp: includes "top/top.h", which low cannot reach',
        'tests/mid/two/a_test.cpp: includes "mid/one/one.h", which mid/two cannot reach',
    ]
    return finds(House, files, expected)


def main():
    if sys.argv[1:] == ["--self-test"]:
        return 0 if self_test() else 1
    breaches = House(pathlib.Path(sys.argv[1]).resolve()).check()
    print(*breaches, sep="\n")
    return 1 if breaches else 0


if __name__ == "__main__":
    sys.exit(main())
