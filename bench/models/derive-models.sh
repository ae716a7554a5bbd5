#!/usr/bin/env bash
# Makes test surfaces that nobody has tuned for: every clean model decimated to 50, 20 and 5 % of its triangles and with
# noise of .05 and .2 % of its diagonal, and isosurfaces of a CT skull and of three analytic fields, at several
# resolutions. Those that repair finds clean are kept, in models/derived/ (ignored by git). Always the same ones.
#   bench/models/derive-models.sh [PROGRAM]      PROGRAM: the octafront that judges, by default build/release/cli/octafront
set -euo pipefail
cd "$(dirname "$0")/../.."
source scripts/lib/apt.sh

need_packages python3-vtk9 python3-meshio
program=${1:-build/release/cli/octafront}
[ -x "$program" ] || { echo "no $program: build it first, or name it" >&2; exit 2; }
[ -d models/clean ] || bench/models/get-models.sh
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
(cd "$work" && apt-get -qq download invesalius-examples 2>/dev/null) || echo "without the CT volume: it cannot be fetched"
for package in "$work"/*.deb; do [ ! -e "$package" ] || dpkg -x "$package" "$work"; done
/usr/bin/python3 bench/models/derive_models.py models/clean "$work" models/derived "$program"
