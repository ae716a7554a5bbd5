#!/bin/sh
# What options change, as far as configuring shows it: what a shared library stands on is no business of its users.
#   other_options.sh CMAKE SOURCE SCRATCH
set -eu
cmake=$1 source=$2 scratch=$3
configure() {
  rm -rf "$scratch"
  "$cmake" -G Ninja -S "$source" -B "$scratch" -DOCTAFRONT_BUILD_TESTS=OFF "$@" >/dev/null
}
configure -DBUILD_SHARED_LIBS=ON
grep -q 'version-script=.*exports.map' "$scratch/build.ninja" || { echo "a shared library shows all that it is made with"; exit 1; }
grep -q '^Requires.private: .*fmt' "$scratch/octafront.pc"
! grep -q '^Libs: .*-lstdc++' "$scratch/octafront.pc" || { echo "a shared library names what it stands on"; exit 1; }
! grep -q 'std=c++' "$scratch/octafront.pc" || { echo "flags of C++ for programs in C"; exit 1; }
