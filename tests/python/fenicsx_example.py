"""An example of examples/solve that runs with DOLFINx, some lines of which a page of docs prints."""
import importlib.util
import json
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]


def found(example, page, heading, *options):
    """What the example says of itself; ends with 77 where there is no DOLFINx. The section's lines must be the example's."""
    file = ROOT / "examples/solve" / example
    section = (ROOT / "docs/use" / page).read_text(encoding="utf-8").split(f"## {heading}\n")[1].split("\n## ")[0]
    printed = re.search(r"```python\n(.*?)```", section, re.S).group(1)
    assert printed in file.read_text(encoding="utf-8"), "the page prints other lines than the example has"
    if importlib.util.find_spec("dolfinx") is None:
        sys.exit(77)
    with tempfile.TemporaryDirectory() as folder:
        done = subprocess.run([sys.executable, file, "--json", "--short", *options], cwd=folder, check=True, stdout=subprocess.PIPE, text=True)
    return json.loads(done.stdout.strip().splitlines()[-1])
