#!/usr/bin/env bash
# The paper's experiments and the peers, from nothing to docs/measured/experiments.md: about 20 minutes on two cores.
#   scripts/experiments.sh [STEP...]   steps: dragon compare growth skull peers pictures page; none: all of them
# Installs what is missing (Debian 12), builds, measures one thread at a time. Do not use the machine meanwhile.
set -euo pipefail
cd "$(dirname "$0")/.."
source scripts/lib/apt.sh

need_packages "${build_packages[@]}" "${peer_packages[@]}" libcgal-dev libgmp-dev libmpfr-dev libboost-dev python3 \
  python3-matplotlib python3-vtk9 xvfb xauth
[ -d models/ct ] && [ -d models/clean ] || scripts/get-models.sh --ct
cmake --preset release -DOCTAFRONT_BUILD_BENCH=ON -DOCTAFRONT_BUILD_TESTS=OFF >/dev/null
cmake --build --preset release --target octafront_cli octafront_evaluate
cmake --build --preset release --target peer_cgal_mesh || echo "CGAL's mesher could not be built: it is left out" >&2
exec python3 bench/experiments.py build/release "$@"
