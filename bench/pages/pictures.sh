#!/usr/bin/env bash
# Makes the pictures of the README anew: three meshes, cut open, elements coloured by quality; and those of
# docs/how/second-order.md, docs/use/complex.md and docs/use/cad.md (which take octafront-cad: scripts/quickstart.sh samples/bracket.step
# builds it); and the worst ten of docs/measured/derived-status.md, each around its worst element.
set -euo pipefail
cd "$(dirname "$0")/../.."
source scripts/lib/apt.sh
need_packages python3-vtk9 xvfb xauth
[ -d models/clean ] || bench/models/get-models.sh
octafront=${1:-build/quickstart/cli/octafront}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

picture() { # name, input, mesh options, render options
  "$octafront" mesh "$2" -o "$work/$1.vtu" -q $3
  xvfb-run -a /usr/bin/python3 bench/pages/render.py "$work/$1.vtu" "docs/images/$1.png" --size 900 700 $4
}
picture bracket samples/bracket.stl "" "--cut 0,1,0 --up 0,0,1 --keep 0.5 --view 0.5,1,0.6"
picture bunny models/clean/bunny00.off "--elements 60000" "--cut 0,0,1 --keep 0.5"
picture fandisk models/clean/fandisk_large.off "--elements 60000" "--cut 0,1,0 --up 0,0,1 --keep 0.6 --view 0.45,1,0.5"
picture first-order samples/torus_knot.ply "--size 4 --order 1" "--keep 1.1 --no-edges --size 700 560 --view 0.3,0.4,1"
picture second-order samples/torus_knot.ply "--size 4 --order 2" "--keep 1.1 --no-edges --size 700 560 --view 0.3,0.4,1"
bench/models/make-complexes.sh "$work/complexes"
picture complex "$work/complexes/spheres.ply" "" "--regions --size 700 560 --keep 0.55"
picture cad-assembly samples/assembly.step "--size 4" "--regions --size 900 640 --cut 0,1,0 --up 0,0,1 --keep 0.66 --view=0.8,1,0.7"
"$octafront" mesh samples/bracket.step -o "$work/cad-sizes.vtu" -q --size 6 --size-of "color #d03030=1"
xvfb-run -a /usr/bin/python3 bench/pages/render.py "$work/cad-sizes.vtu" docs/images/cad-sizes.png --size 900 640 --cut 0,1,0 --up 0,0,1 \
  --keep 1.1 --view=0.35,-1,0.7

meshes=()
for model in $(awk '/^## Sizes: 100 k/ { exit } /^\| [^ ]*\.[a-z]+ \|/ { print $2 }' docs/measured/derived-status.md); do
  meshes+=("$work/${model%.*}.vtu")
  "$octafront" mesh models/*/"$model" -o "${meshes[-1]}" -q
done
xvfb-run -a /usr/bin/python3 bench/pages/render_worst.py docs/images/derived-worst.png "${meshes[@]}"
