#!/usr/bin/env bash
# The benchmarks, by name. Builds what they need.
#   bench/run.sh status      every model of bench/models.csv: valid? how true is the boundary?   -> docs/status.md
#   bench/run.sh pipeline    three models at 100 k and 1 M elements, elements per second and stage -> docs/benchmarks.md
#   bench/run.sh volume      kept surfaces up to 10 M elements, against TetGen, HXT and Netgen -> docs/volume-bench.md
set -euo pipefail
cd "$(dirname "$0")/.."
source scripts/lib/apt.sh

case ${1:-} in
  status | pipeline | volume) ;;
  *) sed -n '2,6s/^# \{0,1\}//p' "$0"; exit 2 ;;
esac
need_packages "${build_packages[@]}" python3
[ "$1" != volume ] || need_packages "${peer_packages[@]}"
[ -d models/clean ] || scripts/get-models.sh --ct
cmake --preset release -DOCTAFRONT_BUILD_TESTS=OFF >/dev/null
cmake --build --preset release --target octafront_cli octafront_evaluate
exec python3 "bench/$1.py" build/release "${@:2}"
