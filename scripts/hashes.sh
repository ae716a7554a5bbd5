#!/usr/bin/env bash
# Do these sources still make the same meshes, bit for bit? Meshes every clean model with default options and with
# --keep-surface, and the samples by every method, and compares the hashes of the reports with those in bench/hashes.txt.
#   scripts/hashes.sh [--quick] [--write] [PROGRAM]
#     --quick   only models that take a second or so
#     --write   rewrites bench/hashes.txt: for a change that alters meshes on purpose
#     PROGRAM   an octafront to try; by default build/release's, built first
# Prints a line for each mesh that differs; status 1 if there are any. Everything takes one to two minutes on two cores.
set -euo pipefail
cd "$(dirname "$0")/.."
source scripts/lib/apt.sh

list=bench/hashes.txt quick="" write="" program=""
for argument in "$@"; do
  case $argument in
    --quick) quick=1 ;;
    --write) write=1 ;;
    -*) sed -n '2,8s/^# \{0,1\}//p' "$0" >&2; exit 2 ;;
    *) program=$argument ;;
  esac
done
[ -z "$quick" ] || [ -z "$write" ] || { echo "hashes: --write needs every model" >&2; exit 2; }

[ -d models/clean ] || bench/models/get-models.sh
if [ -z "$program" ]; then
  need_packages "${build_packages[@]}"
  cmake --preset release -DOCTAFRONT_BUILD_TESTS=OFF >/dev/null
  cmake --build --preset release --target octafront_cli
  program=build/release/cli/octafront
fi

quick_models="anchor bunny_npm cross double-torus-example hinge joint knot1 part1 spool"

runs() { # one line each: model, options
  local model
  for model in models/clean/*; do
    [ -z "$quick" ] || grep -qw -- "$(basename "${model%.*}")" <<<"$quick_models" || continue
    echo "$model"
    echo "$model --keep-surface"
  done
  for model in samples/*.{stl,obj,off,ply}; do
    [ -z "$quick" ] || [ "$model" = samples/bracket.stl ] || continue
    for method in octree-aft aft octree recover; do echo "$model --method $method"; done
  done
}

one() { # model options...: prints them and the hash
  local work hash=failed
  work=$(mktemp -d)
  if "$program" mesh "$@" -o "$work/mesh.msh" --json "$work/report.json" --threads 1 -q 2>"$work/error"; then
    hash=$(sed -n 's/^ *"hash": "\{0,1\}\([0-9a-fx]*\)"\{0,1\},\{0,1\}$/\1/p' "$work/report.json")
  fi
  rm -rf "$work"
  echo "$* $hash"
}
export -f one
export program

made=$(mktemp)
trap 'rm -f "$made"' EXIT
runs | xargs -d '\n' -P "$(nproc)" -I{} bash -c 'one {}' | LC_ALL=C sort >"$made"

if [ -n "$write" ]; then
  cp "$made" "$list"
  echo "$(wc -l <"$list") hashes written to $list"
  exit 0
fi
# Each line is looked up by what was run; only those that were run are compared.
awk 'function key(   k) { k = $0; sub(/ [^ ]*$/, "", k); return k }
  NR == FNR { before[key()] = $NF; next }
  { n++ }
  before[key()] != $NF { print key() ": " before[key()] " before, " $NF " now"; differ++ }
  END { printf "%d meshes, %d differ\n", n, differ; exit differ > 0 }' "$list" "$made"
