#!/usr/bin/env bash
# Makes the pictures of the README anew: three meshes, cut open, elements coloured by quality; and those of
# docs/how/second-order.md, docs/use/complex.md, docs/use/picture.md and docs/use/cad.md (which take octafront-cad: scripts/quickstart.sh
# samples/bracket.step builds it); and, by VTK, the worst ten of docs/measured/derived-status.md, each around its worst element.
set -euo pipefail
cd "$(dirname "$0")/../.."
source scripts/lib/apt.sh
need_packages python3-vtk9 xvfb xauth
[ -d models/clean ] || bench/models/get-models.sh
octafront=${1:-build/quickstart/cli/octafront}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

picture() { # name, input, mesh options, options of octafront picture
  "$octafront" mesh "$2" -o "$work/$1.vtu" -q $3
  "$octafront" picture "$work/$1.vtu" -o "docs/images/$1.png" -q $4
}
picture bracket samples/bracket.stl "" "--size 900x700 --cut y --view 0.5,1,0.6"
picture bunny models/clean/bunny00.off "--elements 60000" "--size 900x700 --cut z --up y"
picture fandisk models/clean/fandisk_large.off "--elements 60000" "--size 900x700 --cut y=60% --view 0.45,1,0.5"
picture first-order samples/torus_knot.ply "--size 4 --order 1" "--size 700x560 --edges none --bare --up y --view 0.3,0.4,1"
picture second-order samples/torus_knot.ply "--size 4 --order 2" "--size 700x560 --edges none --bare --up y --view 0.3,0.4,1"
bench/models/make-complexes.sh "$work/complexes"
picture complex "$work/complexes/spheres.ply" "" "--size 700x560 --color region --cut z=55% --up y"
picture cad-assembly samples/assembly.step "--size 4" "--size 900x640 --color region --cut y=66% --view 0.8,1,0.7"
"$octafront" mesh samples/bracket.step -o "$work/cad-sizes.vtu" -q --size 6 --size-of "color #d03030=1"
"$octafront" picture "$work/cad-sizes.vtu" -o docs/images/cad-sizes.png -q --size 900x640 --view 0.35,-1,0.7

# Those of docs/use/picture.md.
"$octafront" picture samples/assembly.step -o docs/images/picture-names.png -q --size 900x675 --names
"$octafront" picture "$work/bunny.vtu" -o docs/images/picture-cut.png -q --size 900x675 --cut x --up y
"$octafront" mesh samples/bracket.step -o "$work/places.msh" -q --size 4
"$octafront" picture "$work/places.msh" -o docs/images/picture-highlight.png -q --size 900x675 --highlight "bolt hole 1" --highlight wall
"$octafront" picture "$work/fandisk.vtu" -o docs/images/picture-worst.png -q --size 900x675 --worst

meshes=()
for model in $(awk '/^## Sizes: 100 k/ { exit } /^\| [^ ]*\.[a-z]+ \|/ { print $2 }' docs/measured/derived-status.md); do
  meshes+=("$work/${model%.*}.vtu")
  "$octafront" mesh models/*/"$model" -o "${meshes[-1]}" -q
done
xvfb-run -a /usr/bin/python3 bench/pages/render_worst.py docs/images/derived-worst.png "${meshes[@]}"
