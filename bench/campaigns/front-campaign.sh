#!/usr/bin/env bash
# The volume front on every organic model of models/clean, remeshed at ten sizes each: no cavity may stay open.
#   bench/campaigns/front-campaign.sh [--threads N] [--from N --to N]
# Builds what it needs; about an hour on two cores. Prints a line for each model and ends with status 1 if a run failed.
set -euo pipefail
cd "$(dirname "$0")/../.."
source scripts/lib/apt.sh
need_packages "${build_packages[@]}" python3
[ -d models/clean ] || bench/models/get-models.sh
cmake --preset release -DOCTAFRONT_BUILD_TESTS=OFF >/dev/null
cmake --build --preset release --target octafront_cli
exec python3 bench/campaigns/front_campaign.py build/release/cli/octafront "$@"
