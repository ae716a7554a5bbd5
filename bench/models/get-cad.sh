#!/usr/bin/env bash
# Fetches CAD files to test with into cad-models/ (ignored by git): STEP, IGES and BREP of the Debian packages occt-misc,
# netgen-doc, gmsh-doc and freecad-common. They are not part of this project. Needs a Debian 12 machine with its package
# sources set up.
#   bench/models/get-cad.sh
set -euo pipefail
cd "$(dirname "$0")/../.."

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
echo "fetching packages ..."
(cd "$work" && apt-get -qq download occt-misc netgen-doc gmsh-doc freecad-common 2>/dev/null)
for package in "$work"/*.deb; do dpkg -x "$package" "$work/files"; done
mkdir -p cad-models
find "$work/files" -type f -regextype posix-extended \
  -iregex '.*\.(stp|step|p21|stpz|igs|iges|brep|brp)(\.gz)?' | sort | while read -r file; do
  case $file in
    *.gz) gunzip -c "$file" > "cad-models/$(basename "$file" .gz)" ;;
    *) cp "$file" cad-models/ ;;
  esac
done
echo "cad-models: $(find cad-models -type f | wc -l) files"
