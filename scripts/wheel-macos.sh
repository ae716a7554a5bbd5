#!/usr/bin/env bash
# Makes the wheel of a release for macOS 14 and younger, on a Mac that has Xcode's tools, cmake, ninja, cli11 and nlohmann-json, in dist/,
# and tries it: oneTBB and fmt are compiled in, and it stands on nothing but the system. A step of .github/workflows/release.yml.
set -euo pipefail
cd "$(dirname "$0")/.."
export MACOSX_DEPLOYMENT_TARGET=14.0
work=$PWD/build/portable wheels=$PWD/dist

build_release() { # of a repository, a tag, as a static library into $work/inside
  local repository=$1 tag=$2 name
  name=$(basename "$repository")
  shift 2
  [ ! -e "$work/inside/$name.done" ] || return 0
  rm -rf "$work/$name"
  git clone -q --depth 1 --branch "$tag" "https://github.com/$repository" "$work/$name"
  cmake -S "$work/$name" -B "$work/build-$name" -G Ninja -DCMAKE_BUILD_TYPE=Release -DBUILD_SHARED_LIBS=OFF \
    -DCMAKE_POSITION_INDEPENDENT_CODE=ON -DCMAKE_INSTALL_PREFIX="$work/inside" "$@"
  cmake --build "$work/build-$name"
  cmake --install "$work/build-$name"
  touch "$work/inside/$name.done"
}
mkdir -p "$work" "$wheels"
build_release uxlfoundation/oneTBB v2021.13.0 -DTBB_TEST=OFF -DTBB_STRICT=OFF -DTBBMALLOC_BUILD=OFF -Wno-dev
build_release fmtlib/fmt 9.1.0 -DFMT_TEST=OFF -DFMT_DOC=OFF

PYTHONPATH=python/backend python3 - "$work/wheel" "$wheels" "-DCMAKE_PREFIX_PATH=$work/inside -DOCTAFRONT_CAD=OFF" <<'PYTHON'
import sys, octafront_build
print(octafront_build.build_wheel(sys.argv[2], {"build-dir": sys.argv[1], "cmake-args": sys.argv[3]}))
PYTHON
python3 -m venv --clear "$work/venv"
"$work/venv/bin/python" -m pip -q install numpy "$wheels"/octafront-*macosx*.whl
cd "$work"
PYTHONPATH=$OLDPWD/tests/python OCTAFRONT_SAMPLES=$OLDPWD/samples venv/bin/python -W error -m unittest -q test_octafront
# It should be that of other machines.
venv/bin/octafront mesh "$OLDPWD/samples/bracket.stl" -o part.vtu --size 3 -q --json - | grep '"hash"'
