#!/usr/bin/env python3
"""Do the rooms keep to their walls? Reads every #include and compares it with the table of rooms in ARCHITECTURE.md.

    check_walls.py ROOT          prints each breach as a line; status 1 if there are any
    check_walls.py --self-test   builds a small house with one breach of each kind, and must find them all

What holds:
- A room includes from itself, from the rooms that its row names, and public headers; its CMake ROOMS are that row.
- A row names rooms of rows above it, and only such as the room needs: it includes from them, or includes a public header
  that they define. So dependencies go down, and the table does not outlive them.
- Each room has a header ROOM/ROOM.h that begins with what the room is for. A house with rooms inside (surface/repair)
  shows them there: its room header may include them all.
- Public headers include public headers. The command line includes public headers and its own.
- Tests of a room include that room, rooms that it could reach, and tests/support. Benchmarks may look into any room.
"""
import pathlib
import re
import sys
import tempfile

INCLUDE = re.compile(r'^\s*#\s*include\s*(?:"([^"]+)"|<octafront/([^>]+)>)', re.M)


def read_tables(text):
    """From ARCHITECTURE.md: {room: rooms it may include from} in the order of rows, {public header: defining room}."""
    rooms, homes = {}, {}
    for line in text.splitlines():
        cells = [cell.strip() for cell in line.strip().strip("|").split("|")]
        if len(cells) == 4 and re.fullmatch(r"`[\w/]+`", cells[0]):
            rooms[cells[0].strip("`")] = re.findall(r"`([\w/]+)`", cells[1])
        if len(cells) == 2 and re.fullmatch(r"`[\w/]+`", cells[0]):
            homes.update((header, cells[0].strip("`")) for header in re.findall(r"`(\w+\.h)`", cells[1]))
    return rooms, homes


def sources(folder):
    return sorted(path for path in folder.rglob("*") if path.suffix in (".h", ".cpp"))


def includes(path):
    """(of our own tree, public) headers that a file includes."""
    found = INCLUDE.findall(path.read_text())
    return [own for own, _ in found if own], [public for _, public in found if public]


class House:
    def __init__(self, root):
        self.root = root
        self.rooms, self.homes = read_tables((root / "ARCHITECTURE.md").read_text())
        self.breaches = []

    def breach(self, where, what):
        where = where.relative_to(self.root) if isinstance(where, pathlib.Path) else where
        self.breaches.append(f"{where}: {what}")

    def room_of(self, header):
        """The room that "surface/repair/steps.h" lies in: the deepest one; None if in no room."""
        parts = header.split("/")[:-1]
        while parts and "/".join(parts) not in self.rooms:
            parts.pop()
        return "/".join(parts) or None

    def reach(self, room):
        """A room and all below it."""
        return {room}.union(*(self.reach(r) for r in self.rooms[room]))

    def check_order(self):
        seen = set()
        for room, below in self.rooms.items():
            for other in below:
                if other not in seen:
                    self.breach("ARCHITECTURE.md", f"{room} names {other}, which is no row above it")
            seen.add(room)

    def check_rooms(self):
        src, needed = self.root / "src", {room: set() for room in self.rooms}
        for path in sources(src):
            room = self.room_of(path.relative_to(src).as_posix())
            if room is None:
                self.breach(path, "lies in no room of ARCHITECTURE.md")
                continue
            own, public = includes(path)
            is_room_header = path.relative_to(src).as_posix() == f"{room}/{room}.h"
            for header in own:
                other = self.room_of(header)
                if other == room or (is_room_header and header.startswith(room + "/")):
                    continue
                needed[room].add(other)
                if other not in self.rooms[room]:
                    self.breach(path, f'includes "{header}", where {room} may not reach')
            needed[room].update(self.homes.get(header) for header in public)
        for room, below in self.rooms.items():
            for other in set(below) - needed[room]:
                self.breach("ARCHITECTURE.md", f"{room} no longer needs {other}")

    def check_room_headers(self):
        for room in self.rooms:
            header = self.root / "src" / room / f"{room.split('/')[-1]}.h"
            if not header.exists():
                self.breach(header, "is missing: each room has a header that says what it is for")
            elif not header.read_text().startswith(f"#pragma once\n\n// {room}: "):
                self.breach(header, f'does not begin with "// {room}: " and what the room is for')

    def check_cmake(self):
        for path in sorted(self.root.glob("src/*/CMakeLists.txt")):
            room = path.parent.name
            row = {r for name, below in self.rooms.items() if name.split("/")[0] == room for r in below}
            row = {r.split("/")[0] for r in row} - {room}
            words = re.search(r"octafront_room\(([^)]*)\)", path.read_text()).group(1).split()
            listed = words[words.index("ROOMS") + 1 :] if "ROOMS" in words else []
            listed = set(listed[: listed.index("LIBS")] if "LIBS" in listed else listed)
            if listed != row:
                self.breach(path, f"ROOMS are {sorted(listed)}, ARCHITECTURE.md names {sorted(row)}")

    def check_outside(self):
        for path in sources(self.root / "include"):
            for header in includes(path)[0]:
                self.breach(path, f'is public and includes "{header}"')
        for path in sources(self.root / "cli"):
            for header in includes(path)[0]:
                if not (path.parent / header).exists():
                    self.breach(path, f'includes "{header}"; the command line sees public headers only')
        for path in sources(self.root / "tests"):
            folder = path.relative_to(self.root / "tests").parts[0]
            tested = [room for room in self.rooms if room.split("/")[0] == folder] or self.rooms
            may = {"support"}.union(*map(self.reach, tested))
            for header in includes(path)[0]:
                room = self.room_of(header) or header.split("/")[0]
                beside = (path.parent / header).exists() or (self.root / folder / header).exists()
                if room not in may and not beside:
                    self.breach(path, f'includes "{header}", which {folder} cannot reach')

    def check(self):
        self.check_order()
        self.check_rooms()
        self.check_room_headers()
        self.check_cmake()
        self.check_outside()
        return self.breaches


def self_test():
    files = {
        "ARCHITECTURE.md": "| `low` | - | a | b |\n| `mid` | `low` | a | b |\n| `house` | `low`, `house/in` | a | b |\n"
        "| `house/in` | - | a | b |\n| `top` | `mid`, `low` | a | b |\n\n| `low` | `p.h` |\n",
        "include/octafront/p.h": '#include "low/low.h"\n',
        "src/low/low.h": "#pragma once\n\n// low: it\n",
        "src/low/up.cpp": '#include "mid/mid.h"\n',
        "src/low/CMakeLists.txt": "octafront_room(low SOURCES up.cpp ROOMS mid LIBS x)",
        "src/mid/mid.h": "#pragma once\n\n#include <octafront/p.h>\n",
        "src/house/house.h": '#pragma once\n\n// house: it\n#include "house/in/in.h"\n#include "low/low.h"\n',
        "src/house/in/in.h": '#pragma once\n\n// house/in: it\n#include "low/low.h"\n',
        "src/stray/x.h": "",
        "src/top/a.cpp": '#include "mid/mid.h"\n',
        "cli/main.cpp": '#include "low/low.h"\n',
        "tests/low/a_test.cpp": '#include "top/top.h"\n#include "support/s.h"\n',
    }
    expected = [
        "ARCHITECTURE.md: house names house/in, which is no row above it",
        'src/house/in/in.h: includes "low/low.h", where house/in may not reach',
        'src/low/up.cpp: includes "mid/mid.h", where low may not reach',
        "src/stray/x.h: lies in no room of ARCHITECTURE.md",
        "ARCHITECTURE.md: house no longer needs house/in",
        "ARCHITECTURE.md: top no longer needs low",
        'src/mid/mid.h: does not begin with "// mid: " and what the room is for',
        "src/top/top.h: is missing: each room has a header that says what it is for",
        "src/low/CMakeLists.txt: ROOMS are ['mid'], ARCHITECTURE.md names []",
        'include/octafront/p.h: is public and includes "low/low.h"',
        'cli/main.cpp: includes "low/low.h"; the command line sees public headers only',
        'tests/low/a_test.cpp: includes "top/top.h", which low cannot reach',
    ]
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)
        for name, text in files.items():
            (root / name).parent.mkdir(parents=True, exist_ok=True)
            (root / name).write_text(text)
        found = House(root).check()
    for line in sorted(set(expected) ^ set(found)):
        print("not found:" if line in expected else "not expected:", line)
    return found == expected


def main():
    if sys.argv[1:] == ["--self-test"]:
        return 0 if self_test() else 1
    breaches = House(pathlib.Path(sys.argv[1]).resolve()).check()
    print(*breaches, sep="\n")
    return 1 if breaches else 0


if __name__ == "__main__":
    sys.exit(main())
