#!/usr/bin/env bash
# Repairs and meshes soups of triangles that nobody would make on purpose: a hundred thousand crossing pairs, random
# triangles, a million triangles with holes, doubled skins, common and nearly common planes, what is no surface at all.
#   bench/campaigns/nasty-soups.sh [--small] [--only SUBSTRING] [--timeout SECONDS] [--no-mesh] [--keep FOLDER]
# A table: status, processor time, memory of each. Every run must end, with a clean result or a reason and no file;
# status 1 if one does not. PROGRAM=FILE: another octafront than build/release/cli/octafront, which is built.
set -euo pipefail
cd "$(dirname "$0")/../.."
source scripts/lib/apt.sh
need_packages "${build_packages[@]}" python3 python3-numpy
if [ -z "${PROGRAM:-}" ]; then
  cmake --preset release >/dev/null
  cmake --build --preset release --target octafront_cli
fi
exec /usr/bin/python3 bench/campaigns/nasty_soups.py "${PROGRAM:-build/release/cli/octafront}" "$@"
