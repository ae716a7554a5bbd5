#!/usr/bin/env bash
# Builds for 64-bit ARM on another machine, runs what was built under qemu, and compares with this machine: the same meshes, bit
# for bit. Installs what it needs.
#   scripts/aarch64.sh               the tool and the wheel; the samples meshed on both machines
#   scripts/aarch64.sh --tests       also the tests of some wings, under qemu
set -euo pipefail
cd "$(dirname "$0")/.."
source scripts/lib/apt.sh
source scripts/lib/static.sh
work=$PWD/build/aarch64 wheels=$PWD/dist glibc=2.17
need_packages "${build_packages[@]}" python3 dpkg-dev binutils make g++-aarch64-linux-gnu qemu-user-static
toolchain=-DCMAKE_TOOLCHAIN_FILE=$PWD/cmake/aarch64-linux-gnu.cmake

build_tbb_and_fmt "$work" "$toolchain"
build_static_zlib "$work" aarch64-linux-gnu
arguments="$toolchain -DCMAKE_PREFIX_PATH=$work/inside -DZLIB_USE_STATIC_LIBS=ON -DZLIB_INCLUDE_DIR=$work/inside/include
  -DZLIB_LIBRARY=$work/inside/lib/libz.a -DOCTAFRONT_CAD=OFF -DOCTAFRONT_OLDEST_GLIBC=$glibc"
[ -z "${CMAKE_CXX_COMPILER_LAUNCHER:-}" ] || arguments+=" -DCMAKE_CXX_COMPILER_LAUNCHER=$CMAKE_CXX_COMPILER_LAUNCHER"
arguments=${arguments//$'\n'/ }

mkdir -p "$wheels"
rm -f "$wheels"/octafront-*aarch64.whl
PYTHONPATH=python/backend python3 - "$work/wheel" "$wheels" "$arguments" 2>"$work/wheel.log" <<'PYTHON' || { tail -30 "$work/wheel.log"; exit 1; }
import sys, octafront_build
print(octafront_build.build_wheel(sys.argv[2], {"build-dir": sys.argv[1], "cmake-args": sys.argv[3], "machine": "aarch64"}))
PYTHON
python3 tests/python/look_into_wheel.py "$wheels"/octafront-*aarch64.whl . --glibc "$glibc" --megabytes 8

cmake --preset release >/dev/null
cmake --build --preset release --target octafront_cli >/dev/null
here=build/release/cli/octafront there=(qemu-aarch64-static -L /usr/aarch64-linux-gnu "$work/wheel/python/octafront/_bin/octafront")
different=0
hash_of() { "$@" --json - -q -o /dev/null --format vtu | python3 -c 'import json, sys; r = json.load(sys.stdin); print(r["hash"], r["tets"])'; }
compare() {
  local a b
  a=$(hash_of "$here" mesh "$@") b=$(hash_of "${there[@]}" mesh "$@")
  if [ "$a" = "$b" ]; then echo "the same: $* (${a#* } elements, hash ${a% *})"; else
    echo "DIFFERENT: $*: $a here, $b there"
    different=1
  fi
}
compare samples/bracket.stl
compare samples/gear.obj --order 2 --size 2
compare samples/torus_knot.ply --elements 20000
compare samples/gyroid.ply --elements 20000
compare samples/bracket.stl samples/gear.obj --size 4
compare samples/torus_knot.ply samples/gyroid.ply samples/bracket.stl --size 4
compare samples/head_labels.nii.gz --size 12

if [ "${1:-}" = --tests ]; then
  # The tests of base and pipeline link rapidcheck, and are not built.
  need_packages librapidcheck-dev
  build_static "$work" googletest "$toolchain"
  # shellcheck disable=SC2086
  cmake -S . -B "$work/tests" -G Ninja -DCMAKE_BUILD_TYPE=Release -DOCTAFRONT_UNITY=ON -DOCTAFRONT_HDF5=OFF -DOCTAFRONT_GDCM=OFF -DOCTAFRONT_TIFF=OFF -DOCTAFRONT_BUILD_PYTHON=OFF \
    -Drapidcheck_DIR="$(dirname "$(find /usr/lib -name rapidcheckConfig.cmake)")" $arguments >/dev/null
  for wing in sizing formats images soup; do
    cmake --build "$work/tests" --target "test_$wing" >/dev/null
    # Tests leave files where they run.
    (cd "$work/tests/tests/$wing" && qemu-aarch64-static -L /usr/aarch64-linux-gnu "./test_$wing" --gtest_brief=1 | tail -2)
  done
fi
exit $different
