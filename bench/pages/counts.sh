#!/usr/bin/env bash
# How large the house is, and what a day's work in it costs.
#   bench/pages/counts.sh [--build] [ROOT]
#     --build   also the seconds to build library and tool as quickstart.sh does, and as those who edit do: afresh and
#               after a header or a source was touched (half an hour, without ccache)
#     ROOT      the tree to look at, by default this one: a checkout of an older commit, to compare with
# Seconds are of the processor (user and system), so load matters little; parsing is the best of three. Which structures
# there are is guessed from their marks in the text: a guide to where the same thing is made twice, not a proof.
# Installs what is missing (Debian 12).
set -euo pipefail
cd "$(dirname "$0")/../.."
source scripts/lib/apt.sh

build="" root=$PWD
for argument in "$@"; do
  case $argument in
    --build) build=1 ;;
    -*) sed -n '2,9s/^# \{0,1\}//p' "$0" >&2; exit 2 ;;
    *) root=$argument ;;
  esac
done
need_packages "${build_packages[@]}" universal-ctags time
cd "$root"

row() { printf '%-52s %s\n' "$1" "$2"; }
seconds() {
  local log
  log=$(mktemp)
  /usr/bin/time -o "$log" -f '%U %S' "$@" >/dev/null 2>&1
  awk '{ printf "%.2f", $1 + $2 }' "$log"
  rm -f "$log"
}
files_with() { { grep -rlE "$1" src include cli --include='*.h' --include='*.cpp' || true; } | wc -l; }

row "lines of src, include, cli" "$(find src include cli -name '*.h' -o -name '*.cpp' | xargs cat | wc -l)"
# Defined functions by the commas of their parameters; those inside <> and () do not count.
row "functions with six or more parameters" "$(ctags -R -x --languages=C++ --kinds-C++=f --_xformat='%S' src include cli |
  awk '{ depth = 0; n = /^\( *\)/ ? 0 : 1
         for (i = 1; i <= length($0); ++i) {
           c = substr($0, i, 1)
           if (c ~ /[(<{]/) ++depth; else if (c ~ /[)>}]/) --depth; else if (c == "," && depth == 1) ++n
         }
         if (n >= 6) ++many } END { print many + 0 }')"

echo "files with the marks of a structure"
row "  editable tetrahedral mesh" "$(files_with '^(class|struct) (TetComplex|WorkMesh|EditMesh|MeshOfPieces|TetEditor)\b')"
row "  sorted face as a key" "$(files_with '(TriangleKey|FaceKey|SortedFace|sorted_face)\b *[({=]|std::sort\((t|key|corners|face|f)\.begin')"
row "  edges grouped by a map or sorted pairs" "$(files_with 'map<Edge|pair<Edge,|vector<Edge> sorted')"
row "  counting sort" "$(files_with '\+\+\w*\[[^;]* \+ 1\];')"
row "  flat hash map" "$(files_with '\(i \+ 1\) & |\(at \+ 1\) & ')"
row "  union-find" "$(files_with 'find_root\(.*\{$|^class DisjointSets')"
row "  Morton spread" "$(files_with '0x1f00000000ffff')"
row "  random numbers" "$(files_with '6364136223846793005|mt19937|0xbf58476d1ce4e5b9')"

echo "CPU seconds"
parse=$(mktemp -d)
trap 'rm -rf "$parse"' EXIT
for header in fmt/format.h $(cd include && ls octafront/*.h); do
  echo "#include <$header>" >"$parse/one.cpp"
  best=$(for _ in 1 2 3; do seconds g++ -std=c++20 -fsyntax-only -Iinclude "$parse/one.cpp"; echo; done | sort -n | head -1)
  row "  to parse $header$([ "$header" = fmt/format.h ] && echo ', to compare machines by')" "$best"
done
[ -n "$build" ] || exit 0
configure() {
  cmake -G Ninja -S . -B "$1" -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_COMPILER_LAUNCHER= -DOCTAFRONT_PCH="$2" \
    -DOCTAFRONT_UNITY="$3" -DOCTAFRONT_BUILD_TESTS=OFF -DOCTAFRONT_BUILD_EXAMPLES=OFF >/dev/null
}
configure "$parse/whole" OFF ON
row "  to build library and tool, many sources at a time" "$(seconds ninja -C "$parse/whole" octafront_cli)"
configure "$parse/build" ON OFF
row "  to build them source by source" "$(seconds ninja -C "$parse/build" octafront_cli)"
for touched in include/octafront/tet_mesh.h include/octafront/surface_mesh.h src/improve/schedule/schedule.cpp; do
  touch "$touched"
  row "  after $touched was touched" "$(seconds ninja -C "$parse/build" octafront_cli)"
done
