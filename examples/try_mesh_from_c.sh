#!/bin/sh
# The example in C writes a new file, and leaves those alone that are there.
#   try_mesh_from_c.sh PROGRAM SCRATCH
set -eu
program=$1 scratch=$2
rm -rf "$scratch"
mkdir -p "$scratch"
cd "$scratch"
"$program" cube.vtu
test -s cube.vtu
echo "solid mine" >mine.stl
for arguments in mine.stl "" "new.vtu more"; do
  # shellcheck disable=SC2086 # words
  if "$program" $arguments 2>said; then echo "took: $arguments"; exit 1; fi
  grep -q '^usage: ' said
done
[ "$(cat mine.stl)" = "solid mine" ]
[ "$(ls)" = "$(printf 'cube.vtu\nmine.stl\nsaid')" ]
