#!/usr/bin/env bash
# Builds the library and the commands as WebAssembly (Debian's emscripten), puts together the npm package and the workbench that
# needs no program, and tries both: in Node and in Chromium, where meshes must be those of this machine, bit for bit. In build/web:
# package/, octafront-VERSION.tgz, octafront.html. Installs what it needs.
#   scripts/web.sh                   builds, packs, tests
#   scripts/web.sh --build           builds and packs only
#   scripts/web.sh --times           prints the tables of docs/use/web.md instead of testing
set -euo pipefail
cd "$(dirname "$0")/.."
source scripts/lib/apt.sh
source scripts/lib/static.sh
work=$PWD/build/web
need_packages "${build_packages[@]}" "${browser_packages[@]}" python3 dpkg-dev make nodejs node-typescript emscripten
# Where Debian's emscripten finds what it needs of Node, whosever Node that is.
export NODE_PATH=/usr/share/nodejs
toolchain=-DCMAKE_TOOLCHAIN_FILE=$(dirname "$(readlink -f "$(command -v emcc)")")/cmake/Modules/Platform/Emscripten.cmake
# Exceptions of WebAssembly itself: those made with JavaScript cost every call that may throw.
exceptions=-fwasm-exceptions

build_static "$work" fmtlib -DFMT_TEST=OFF -DFMT_DOC=OFF "$toolchain" "-DCMAKE_CXX_FLAGS=$exceptions"
CC=emcc AR=emar RANLIB=emranlib build_static_zlib "$work" ""
# Headers alone, which Debian has among all others.
mkdir -p "$work/inside/include"
ln -sfn /usr/include/nlohmann "$work/inside/include/nlohmann"
ln -sfn /usr/include/CLI "$work/inside/include/CLI"
cmake -S . -B "$work/all" -G Ninja -DCMAKE_BUILD_TYPE=Release "$toolchain" "-DCMAKE_CXX_FLAGS=$exceptions" -DCMAKE_FIND_ROOT_PATH="$work/inside" \
  -DCMAKE_CXX_FLAGS_RELEASE="-O3 -DNDEBUG" -DZLIB_INCLUDE_DIR="$work/inside/include" -DZLIB_LIBRARY="$work/inside/lib/libz.a" \
  -DOCTAFRONT_THREADS=OFF -DOCTAFRONT_HDF5=OFF -DOCTAFRONT_GDCM=OFF -DOCTAFRONT_TIFF=OFF -DOCTAFRONT_PCH=OFF -DOCTAFRONT_UNITY=ON \
  -DOCTAFRONT_BUILD_TESTS=OFF -DOCTAFRONT_BUILD_PYTHON=OFF -DOCTAFRONT_BUILD_EXAMPLES=OFF -DOCTAFRONT_INSTALL=OFF >/dev/null
cmake --build "$work/all" --target octafront_web octafront_cli
# What npm has for the page.
scripts/ui.sh
python3 web/ui/assemble.py build/ui/npm/node_modules "$work" "$work/all/web"
python3 web/assemble.py "$work/all/web" "$work"
[ "${1:-}" != --build ] || exit 0

cmake --preset release >/dev/null
cmake --build --preset release --target octafront_cli >/dev/null
export OCTAFRONT_PACKAGE=$work/package OCTAFRONT_PROGRAM=$PWD/build/release/cli/octafront OCTAFRONT_SAMPLES=$PWD/samples
if [ "${1:-}" = --times ]; then
  node tests/web/times.mjs
  exec /usr/bin/python3 tests/web/page_test.py "$work/octafront.html" "$OCTAFRONT_PROGRAM" "$OCTAFRONT_SAMPLES" --times
fi
# The types, as a program in TypeScript sees them, which finds the package beside itself.
mkdir -p "$work/types/node_modules"
ln -sfn "$work/package" "$work/types/node_modules/octafront"
cp tests/web/types.mts "$work/types/"
for resolution in node16 node; do
  (cd "$work/types" && tsc --noEmit --strict --target es2022 --module es2022 --moduleResolution "$resolution" --lib es2022,dom types.mts)
done
echo "types: what they promise and what they refuse"
node --test tests/web/package_test.mjs
/usr/bin/python3 tests/web/page_test.py "$work/octafront.html" "$OCTAFRONT_PROGRAM" "$OCTAFRONT_SAMPLES"
