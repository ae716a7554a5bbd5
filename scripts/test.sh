#!/usr/bin/env bash
# Builds everything and runs the tests. Installs what is missing (Debian 12).
#   scripts/test.sh [PRESET]      a configure preset, by default release; also: dev, asan-ubsan, tsan
set -euo pipefail
cd "$(dirname "$0")/.."
source scripts/lib/apt.sh

preset=${1:-release}
need_packages "${build_packages[@]}" "${test_packages[@]}"
cmake --preset "$preset" -DOCTAFRONT_BUILD_BENCH=OFF -DOCTAFRONT_WERROR=ON >/dev/null
cmake --build --preset "$preset"
ctest --preset "$preset" -j "$(nproc)"
