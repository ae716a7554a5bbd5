#!/usr/bin/env bash
# Builds all with Clang and libc++, as on macOS, runs the tests of the wings, and compares meshes with those of GCC and libstdc++:
# the same, bit for bit. Installs what it needs; libraries in C++ are built from Debian's sources, with libc++.
#   scripts/libcxx.sh [WING ...]     by default all but base and pipeline, whose tests link Debian's rapidcheck, which is libstdc++'s
set -euo pipefail
cd "$(dirname "$0")/.."
source scripts/lib/apt.sh
source scripts/lib/static.sh
work=$PWD/build/libcxx wings=("$@")
[ $# -gt 0 ] || wings=(sizing fill soup periodic surface improve formats images report doors)
need_packages "${build_packages[@]}" librapidcheck-dev python3 dpkg-dev clang-16 libc++-16-dev libc++abi-16-dev
compiler=(-DCMAKE_C_COMPILER=clang-16 -DCMAKE_CXX_COMPILER=clang++-16 -DCMAKE_CXX_FLAGS=-stdlib=libc++ -DCMAKE_EXE_LINKER_FLAGS=-stdlib=libc++)
build_tbb_and_fmt "$work" "${compiler[@]}"
build_static "$work" googletest "${compiler[@]}"
[ -z "${CMAKE_CXX_COMPILER_LAUNCHER:-}" ] || compiler+=("-DCMAKE_CXX_COMPILER_LAUNCHER=$CMAKE_CXX_COMPILER_LAUNCHER")
cmake -S . -B "$work/all" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_PREFIX_PATH="$work/inside" -DOCTAFRONT_UNITY=ON -DOCTAFRONT_PCH=OFF \
  -DOCTAFRONT_HDF5=OFF -DOCTAFRONT_GDCM=OFF -DOCTAFRONT_TIFF=OFF -DOCTAFRONT_CAD=OFF -DOCTAFRONT_BUILD_PYTHON=OFF "${compiler[@]}" >/dev/null
cmake --build "$work/all" --target octafront_cli
failed=0
for wing in "${wings[@]}"; do
  cmake --build "$work/all" --target "test_$wing" >/dev/null
  # Tests leave files where they run.
  (cd "$work/all/tests/$wing" && "./test_$wing" --gtest_brief=1) || failed=1
done

cmake --preset release >/dev/null
cmake --build --preset release --target octafront_cli >/dev/null
hash_of() { "$@" --json - -q -o /dev/null --format vtu | python3 -c 'import json, sys; r = json.load(sys.stdin); print(r["hash"], r["tets"])'; }
compare() {
  local a b
  a=$(hash_of build/release/cli/octafront mesh "$@") b=$(hash_of "$work/all/cli/octafront" mesh "$@")
  if [ "$a" = "$b" ]; then echo "the same: $* (${a#* } elements)"; else
    echo "DIFFERENT: $*: $a by GCC and libstdc++, $b by Clang and libc++"
    failed=1
  fi
}
compare samples/bracket.stl
compare samples/gear.obj --order 2
compare samples/torus_knot.ply --elements 100000
compare samples/bracket.stl samples/gear.obj --size 4
compare samples/head_labels.nii.gz --size 8
exit $failed
