#!/usr/bin/env bash
# Makes complexes of several regions with known volumes, as PLY files whose faces carry the regions on their two sides,
# and bodies to be joined, a file each (tests/support/complexes.h says which). Always the same ones.
#   bench/models/make-complexes.sh FOLDER                      the named ones
#   bench/models/make-complexes.sh FOLDER FIRST_SEED COUNT     foams and plane cuts by seed
set -euo pipefail
source "$(dirname "$0")/../../scripts/lib/apt.sh"

[ $# -eq 1 ] || [ $# -eq 3 ] || { sed -n '4,5s/^# //p' "$0"; exit 2; }
folder=$(realpath -m "$1")
shift
cd "$(dirname "$0")/../.."
if [ ! -x build/release/tests/support/make_complexes ]; then
  need_packages "${build_packages[@]}" "${test_packages[@]}"
  cmake --preset release -DOCTAFRONT_BUILD_TESTS=ON >/dev/null
fi
cmake --build build/release --target make_complexes >/dev/null
build/release/tests/support/make_complexes "$folder" "$@"
