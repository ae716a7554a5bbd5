#!/usr/bin/env bash
# Meshes random nasty surfaces, by recovery alone and by the whole run with the surface kept, and checks each mesh.
#   bench/campaigns/nasty.sh [COUNT] [FIRST_SEED] [SECONDS]      by default 100 from 0, 60 s for each mesh
# One line for each failure, with its seed; status 1 if there are any. Installs what is missing (Debian 12). About 0.15 s
# of processor time per seed. A seed's surface as a file, for bench/campaigns/minimise.py:
#   build/release/tests/fill/nasty_campaign write SEED FILE.off
set -euo pipefail
cd "$(dirname "$0")/../.."
source scripts/lib/apt.sh

for argument in "$@"; do
  [[ $argument =~ ^[0-9]+$ ]] || { sed -n '2,6s/^# \{0,1\}//p' "$0"; exit 2; }
done

need_packages "${build_packages[@]}" "${test_packages[@]}"
cmake --preset release -DOCTAFRONT_BUILD_BENCH=OFF >/dev/null
cmake --build --preset release --target nasty_campaign
build/release/tests/fill/nasty_campaign "$@"
