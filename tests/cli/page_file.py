"""Reads a report page back: what is in it, without a browser."""
import base64
import html.parser
import json
import pathlib
import zlib


class _Scripts(html.parser.HTMLParser):
    """The contents of script elements by id, and every attribute that could make a browser fetch something."""

    def __init__(self):
        super().__init__()
        self.by_id, self.links, self.tags, self._open = {}, [], [], None

    def handle_starttag(self, tag, attributes):
        attributes = dict(attributes)
        self.tags.append(tag)
        self.links += [value for name, value in attributes.items() if name in ("src", "href", "action", "data", "srcset")]
        if tag == "script":
            self._open = attributes.get("id", f"code {len(self.by_id)}")
            self.by_id[self._open] = ""

    def handle_endtag(self, tag):
        if tag == "script":
            self._open = None

    def handle_data(self, data):
        if self._open is not None:
            self.by_id[self._open] += data


class Page:
    def __init__(self, file):
        self.text = pathlib.Path(file).read_text(encoding="utf-8")
        parser = _Scripts()
        parser.feed(self.text)
        self.scripts, self.links, self.tags = parser.by_id, parser.links, parser.tags
        self.report = json.loads(self.scripts["report"])
        self.facts = json.loads(self.scripts["facts"])

    def stream(self, name):
        return zlib.decompress(base64.b64decode(self.scripts["mesh-" + name]))

    def numbers(self, name):
        values, value, place = [], 0, 0
        for byte in self.stream(name):
            value |= (byte & 127) << place
            place += 7
            if byte < 128:
                values.append(value)
                value, place = 0, 0
        assert place == 0, "a number that does not end"
        return values

    def tets(self):
        met, corners = 0, []
        for behind in self.numbers("tets"):
            corners.append(met - behind)
            met += behind == 0
        assert met == self.facts["points"]
        return [tuple(corners[i:i + 4]) for i in range(0, len(corners), 4)]

    def points(self):
        n, columns = self.facts["points"], []
        numbers = [-(v + 1) // 2 if v % 2 else v // 2 for v in self.numbers("points")]
        assert len(numbers) == 3 * n
        for axis in range(3):
            at, column = 0, []
            for difference in numbers[axis * n:(axis + 1) * n]:
                at += difference
                column.append(self.facts["origin"][axis] + self.facts["step"] * at)
            columns.append(column)
        return list(zip(*columns))

    def faces(self, name, two_sided):
        """(half-face, number), or (half-face, other half-face, number)."""
        numbers, last, faces = self.numbers(name), 0, []
        width = 3 if two_sided else 2
        for i in range(0, len(numbers), width):
            last += numbers[i]
            faces.append((last, last + numbers[i + 1], numbers[i + 2]) if two_sided else (last, numbers[i + 1]))
        return faces


FACES = [(1, 2, 3), (0, 3, 2), (0, 1, 3), (0, 2, 1)]


def corners_of(tets, half_face):
    return tuple(tets[half_face // 4][i] for i in FACES[half_face % 4])
