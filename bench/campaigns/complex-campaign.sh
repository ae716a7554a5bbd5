#!/usr/bin/env bash
# Random complexes of known volume (plane cuts, Voronoi foams, rough cells), each meshed with its triangles kept and
# triangulated anew: all must be valid, and volumes exact where walls are planar.
#   bench/campaigns/complex-campaign.sh [FIRST_SEED [COUNT]]      default: seeds 1 to 334, a thousand complexes, two runs each
#   bench/campaigns/complex-campaign.sh FIRST_SEED COUNT small    foams and plane cuts of few cells: minutes for a thousand
# Builds what it needs. A line for each run; ends with status 1 if one failed.
set -euo pipefail
cd "$(dirname "$0")/../.."
source scripts/lib/apt.sh
need_packages "${build_packages[@]}" "${test_packages[@]}"
cmake --preset release -DOCTAFRONT_BUILD_TESTS=ON >/dev/null
cmake --build --preset release --target complex_campaign
exec build/release/tests/pipeline/complex_campaign "${1:-1}" "${2:-334}" "${@:3:1}"
