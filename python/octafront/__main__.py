"""python -m octafront: the command line tool that came with the package."""

import os
import sys

from ._library import FOLDER

os.execv(FOLDER / "octafront", ["octafront", *sys.argv[1:]])
