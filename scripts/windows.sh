#!/usr/bin/env bash
# Builds the command line tool for 64-bit Windows on another machine (Debian's MinGW-w64), runs it under Wine, and compares with this
# machine: the same meshes, bit for bit. build/windows/octafront.exe needs nothing but the system. Installs what it needs.
#   scripts/windows.sh
set -euo pipefail
cd "$(dirname "$0")/.."
source scripts/lib/apt.sh
source scripts/lib/static.sh
work=$PWD/build/windows
need_packages "${build_packages[@]}" python3 dpkg-dev g++-mingw-w64-x86-64-posix libz-mingw-w64-dev wine64 wine
toolchain=-DCMAKE_TOOLCHAIN_FILE=$PWD/cmake/x86_64-w64-mingw32.cmake

build_tbb_and_fmt "$work" "$toolchain"
# Headers alone, which Debian has among all others.
mkdir -p "$work/inside/include" "$work/inside/share/cmake"
for name in nlohmann CLI; do ln -sfn "/usr/include/$name" "$work/inside/include/$name"; done
for name in nlohmann_json CLI11; do ln -sfn "/usr/share/cmake/$name" "$work/inside/share/cmake/$name"; done
launcher=()
[ -z "${CMAKE_CXX_COMPILER_LAUNCHER:-}" ] || launcher=("-DCMAKE_CXX_COMPILER_LAUNCHER=$CMAKE_CXX_COMPILER_LAUNCHER")
cmake -S . -B "$work/all" -G Ninja -DCMAKE_BUILD_TYPE=Release "$toolchain" "-DCMAKE_FIND_ROOT_PATH=$work/inside" \
  -DZLIB_LIBRARY=/usr/x86_64-w64-mingw32/lib/libz.a -DOCTAFRONT_HDF5=OFF -DOCTAFRONT_GDCM=OFF -DOCTAFRONT_TIFF=OFF -DOCTAFRONT_CAD=OFF -DOCTAFRONT_PCH=OFF \
  -DOCTAFRONT_UNITY=ON -DOCTAFRONT_BUILD_PYTHON=OFF -DOCTAFRONT_BUILD_TESTS=OFF -DOCTAFRONT_BUILD_EXAMPLES=OFF -DOCTAFRONT_INSTALL=OFF \
  "${launcher[@]}" >/dev/null
cmake --build "$work/all" --target octafront_cli
x86_64-w64-mingw32-strip -o "$work/octafront.exe" "$work/all/cli/octafront.exe"
ls -l "$work/octafront.exe" | awk '{ printf "%s %.2f MB\n", $9, $5 / 1e6 }'
needed=$(x86_64-w64-mingw32-objdump -p "$work/octafront.exe" | sed -n 's/.*DLL Name: //p' | sort -f | tr '\n' ' ')
echo "needs $needed"
! echo "$needed" | grep -q -i 'lib.*\.dll' || { echo "which Windows has not"; exit 1; }

cmake --preset release >/dev/null
cmake --build --preset release --target octafront_cli >/dev/null
# Names of files are in UTF-8 here, which Wine asks the locale for.
export WINEPREFIX=$work/wine WINEDEBUG=-all LC_ALL=C.UTF-8
here=build/release/cli/octafront there=(wine "$work/octafront.exe")
wineboot --init >/dev/null 2>&1 || true
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
compare samples/head_labels.nii.gz --size 8
compare samples/bracket.stl --layers 3 --first 0.1 --size 3

# Files of every format, byte for byte, over older ones, under a name of two, three and four bytes a letter.
rm -rf "$work/files" && mkdir -p "$work/files/here" "$work/files/there"
"$here" mesh samples/bracket.stl -o "$work/files/Größe.msh" --size 6 --patches -q
for ending in msh vtu inp bdf unv mesh meshb vtk exo cdb k feb su2 vol ele; do
  for try in first again; do
    (cd "$work/files/here" && "../../../../$here" convert "../Größe.msh" -o "Größe 大小 𝛽.$ending" -q)
    (cd "$work/files/there" && "${there[@]}" convert "../Größe.msh" -o "Größe 大小 𝛽.$ending" -q)
  done
done
diff -r -q "$work/files/here" "$work/files/there" || different=1
echo "$(find "$work/files/there" -type f | wc -l) files of 15 formats, byte for byte"
refuses() { # STATUS WORDS ARGUMENT ...: what is wrong has its status, is said, and leaves nothing
  local status=$1 words=$2 found=0
  shift 2
  "${there[@]}" "$@" >/dev/null 2>"$work/refused.txt" || found=$?
  if [ "$found" = "$status" ] && grep -q "$words" "$work/refused.txt"; then echo "refused: $words"; else
    echo "NOT REFUSED as it should be: $*: status $found"
    cat "$work/refused.txt"
    different=1
  fi
}
refuses 3 "there is no such file" mesh "$work/files/none.stl" -o "$work/files/none.vtu"
cp samples/bracket.step "$work/files/Größe.step"
refuses 3 "not read on Windows" mesh "$work/files/Größe.step" -o "$work/files/none.vtu"
refuses 5 "there is no folder" mesh samples/bracket.stl -o "$work/files/none/none.vtu"
[ -z "$(find "$work/files" -name '*none*' -o -name '*tmp')" ] || { echo "something is left"; different=1; }
exit $different
