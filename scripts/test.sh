#!/usr/bin/env bash
# Builds everything and runs the tests, the lowest wings first. Installs what is missing (Debian 12).
#   scripts/test.sh [--all | --low | --ranks] [PRESET] [CTEST OPTION ...]
#     --all     with the long tests: large models, a campaign of nasty surfaces, solved examples
#     --low     only what all others stand on: base, soup, surface
#     --ranks   only what several processes do together, on small models, as virtual ranks of one: for tsan
#     PRESET    a configure preset, by default release; also: dev (validators), asan-ubsan, tsan
#     CTEST OPTION   e.g. -L fill (the tests of one wing), --stop-on-failure
# What failed is listed at the end, the lowest wing first, with the command that repeats it.
set -euo pipefail
cd "$(dirname "$0")/.."
source scripts/lib/apt.sh

which=(-LE long) targets=()
case ${1:-} in
  --all) which=() && shift ;;
  --low) which=(-L '^(base|soup|surface)$') targets=(--target test_base test_soup test_surface) && shift ;;
  --ranks) which=(-R '(Comm|Shares)\.|Ranks\.(MakeASmallMesh|MakeTheSameMeshByAllOptions|MeetTheSame)') targets=(--target test_base test_pipeline) && shift ;;
esac
preset=release
if [ $# -gt 0 ] && [[ $1 != -* ]]; then preset=$1 && shift; fi

need_packages "${build_packages[@]}" "${test_packages[@]}"
[ ${#which[@]} -gt 0 ] ||
  need_packages "${format_packages[@]}" "${doc_packages[@]}" "${browser_packages[@]}" "${shell_packages[@]}" "${image_packages[@]}" \
    "${cad_packages[@]}" "${ui_packages[@]}" "${mpi_packages[@]}" "${mpi_test_packages[@]}" "${fem_packages[@]}" "${addon_packages[@]}"
[ ${#which[@]} -gt 0 ] || [ -d volumes/nibabel ] || bench/models/get-volumes.sh --readers ||
  echo "the test volumes cannot be fetched here: tests that need them are skipped"
[ ${#which[@]} -gt 0 ] || scripts/ui.sh || echo "the page of octafront ui cannot be made here: its tests are skipped"
# A new folder is built whole: by many sources at a time. One that is there stays as it is.
fresh=()
[ -f "build/$preset/CMakeCache.txt" ] || fresh=(-DOCTAFRONT_UNITY=ON)
[ ${#which[@]} -gt 0 ] || fresh+=(-DOCTAFRONT_MPI=ON)
cmake --preset "$preset" "${fresh[@]}" -DOCTAFRONT_BUILD_BENCH=OFF -DOCTAFRONT_WERROR=ON >/dev/null
cmake --build --preset "$preset" "${targets[@]}"
failed=build/$preset/Testing/Temporary/LastTestsFailed.log
rm -f "$failed"
ctest --preset "$preset" -j "$(nproc)" "${which[@]}" "$@" && exit

echo
echo "failed, the lowest wing first:"
sort -n "$failed" | sed 's/^[0-9]*:/  /'
echo "once more, only these: ctest --preset $preset --rerun-failed"
exit 1
