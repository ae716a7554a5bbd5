#!/usr/bin/env bash
# Fuzzes the readers, and the repair of surfaces, under address and undefined behaviour sanitizers, from the seeds in tests/corpus.
#   scripts/fuzz.sh [MINUTES] [TARGET ...]      minutes per target, by default 10; targets surface, mesh, tetgen, sizes, repair, poly, complex, mend and image
# Found inputs are left in build/fuzz/found; shrink one (fuzz_TARGET -minimize_crash=1 -runs=100000 FILE), fix, and add it
# to tests/corpus. Installs what is missing (Debian 12).
set -euo pipefail
cd "$(dirname "$0")/.."
source scripts/lib/apt.sh

minutes=${1:-10}
[[ $minutes =~ ^[0-9]+$ ]] || { sed -n '2,5s/^# //p' "$0"; exit 2; }
[ $# -gt 0 ] && shift
targets=("$@")
[ ${#targets[@]} -gt 0 ] || targets=(surface mesh tetgen sizes repair poly complex mend image)

need_packages "${build_packages[@]}" clang libclang-rt-14-dev
cmake --preset fuzz -DOCTAFRONT_BUILD_CLI=OFF -DOCTAFRONT_BUILD_BENCH=OFF >/dev/null
mkdir -p build/fuzz/found
for target in "${targets[@]}"; do
  cmake --build build/fuzz --target "fuzz_$target"
  mkdir -p "build/fuzz/corpus/$target"
  seeds=tests/corpus/$target
  [ -d "$seeds" ] || seeds=tests/corpus/surface
  # What grows during the run stays in the build folder; the seeds are only read.
  build/fuzz/tests/fuzz/fuzz_"$target" -max_total_time=$((60 * minutes)) -timeout=10 -rss_limit_mb=2048 -max_len=4096 \
    -artifact_prefix="build/fuzz/found/$target-" -print_final_stats=1 -verbosity=0 \
    "build/fuzz/corpus/$target" "$seeds"
done
