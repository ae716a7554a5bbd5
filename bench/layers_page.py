"""Parts of docs/measured/layers.md that commands of their own write, between marks."""
import pathlib

from pages.origin import written_by

PAGE = pathlib.Path(__file__).resolve().parents[1] / "docs/measured/layers.md"


def rewrite(mark, command, lines):
    """Puts these lines where the page has `<!-- MARK -->` up to `<!-- MARK: end -->`; what is around stays."""
    begin, end = f"<!-- {mark} -->", f"<!-- {mark}: end -->"
    before, rest = PAGE.read_text().split(begin)
    behind = rest.split(end)[1]
    PAGE.write_text("\n".join([before + begin, f"{written_by(command)}.", "", *lines, ""]) + end + behind)
