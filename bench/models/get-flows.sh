#!/usr/bin/env bash
# Fetches bodies that flows go around into models/flows/ (ignored by git): the motorbike, the car, the propeller and the fan of OpenFOAM's
# examples, which come from Debian's package openfoam-examples and are no part of this project, mended by `octafront repair`.
#   bench/models/get-flows.sh [OCTAFRONT]      the program, else that of build/release
set -euo pipefail
cd "$(dirname "$0")/../.."
octafront=${1:-build/release/cli/octafront}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
(cd "$work" && apt-get -qq download openfoam-examples 2>/dev/null && dpkg -x openfoam-examples_*.deb .)
examples=$work/usr/share/doc/openfoam-examples/examples
mkdir -p models/flows
for file in resources/geometry/{motorBike,propellerTip}.obj heatTransfer/buoyantSimpleFoam/simpleCarSolarPanel/constant/triSurface/simpleCar.stl \
  incompressible/pimpleFoam/RAS/rotatingFanInRoom/constant/triSurface/fan.stl; do
  name=$(basename "$file")
  zcat "$examples/$file.gz" >"$work/$name"
  "$octafront" repair "$work/$name" -q -o "models/flows/${name%.*}.off"
done
ls models/flows
