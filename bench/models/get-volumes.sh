#!/usr/bin/env bash
# Fetches test volumes (CT, MRI, segmentations) of Debian packages into volumes/ (ignored by git). They are not part of
# this project. Needs a Debian 12 machine with its package sources set up.
#   bench/models/get-volumes.sh [--readers]     --readers: also the files that python3-nibabel and python3-pydicom test with
set -euo pipefail
cd "$(dirname "$0")/../.."

packages=(mricron-data libcgal-demo insighttoolkit5-examples invesalius-examples)
[ "${1:-}" = --readers ] && packages+=(python3-nibabel python3-pydicom)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
echo "fetching packages ..."
(cd "$work" && apt-get -qq download "${packages[@]}" 2>/dev/null)
for package in "$work"/*.deb; do dpkg -x "$package" "$work"; done

mkdir -p volumes
cp "$work"/usr/share/mricron/templates/*.nii.gz "$work"/usr/share/mricron/templates/*.txt volumes/
cp "$work"/usr/share/doc/insighttoolkit5-examples/examples/Data/KmeansTest_*.nii.gz volumes/
cp "$work"/usr/share/doc/insighttoolkit5-examples/examples/Data/BrainProtonDensity3Slices.{mha,raw} volumes/
cp "$work"/usr/share/doc/invesalius-examples/examples/Cranium.inv3 volumes/
tar -C "$work" -xzf "$work"/usr/share/doc/libcgal-dev/data.tar.gz data/images
cp "$work"/data/images/*.inr* "$work"/data/images/420.polylines.txt volumes/
/usr/bin/python3 bench/models/volumes_as_nrrd.py volumes
if [ "${1:-}" = --readers ]; then
  mkdir -p volumes/nibabel volumes/pydicom
  find "$work" -path '*nibabel/tests/data/*' \( -name '*.nii*' -o -name '*.hdr' \) -exec cp {} volumes/nibabel \;
  find "$work" -path '*pydicom/data/test_files/*.dcm' -exec cp {} volumes/pydicom \;
fi
echo "in volumes/: $(find volumes -type f | wc -l) files, $(du -sh volumes | cut -f1)"
