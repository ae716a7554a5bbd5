#!/bin/sh
# Builds and runs a program of a user's by what pkg-config says of an installed octafront, in C++ and in C.
#   pkg_config.sh PREFIX EXAMPLES SCRATCH
set -eu
prefix=$1 examples=$2 scratch=$3
mkdir -p "$scratch"
PKG_CONFIG_PATH=$(dirname "$(find "$prefix" -name octafront.pc)")
export PKG_CONFIG_PATH
# As README says it: the library knows whether it is static, and what it wants then.
pkg_config="pkg-config --cflags --libs octafront"
c++ -std=c++20 "$examples/mesh_a_sphere.cpp" -o "$scratch/sphere" $($pkg_config)
cc -std=c99 -Wall -Wextra -Wpedantic -Werror "$examples/mesh_from_c.c" -o "$scratch/cube" $($pkg_config)
c++ -std=c++20 "$examples/mesh_arrays.cpp" -o "$scratch/arrays" $(pkg-config --cflags --libs octafront_mesher)
LD_LIBRARY_PATH=$(dirname "$PKG_CONFIG_PATH") "$scratch/arrays"
LD_LIBRARY_PATH=$(dirname "$PKG_CONFIG_PATH") "$scratch/sphere" "$scratch/sphere.vtu"
LD_LIBRARY_PATH=$(dirname "$PKG_CONFIG_PATH") "$scratch/cube" "$scratch/cube.vtu"
test -s "$scratch/sphere.vtu" && test -s "$scratch/cube.vtu"

# Of several processes, where they were built: in C and in C++.
if pkg-config --exists octafront_mpi; then
  mpicc -std=c99 -Wall -Wextra -Wpedantic -Werror "$examples/mesh_with_mpi.c" -o "$scratch/from_c" $($pkg_config)
  mpicxx -std=c++20 "$examples/../tests/install/ranks/ranks.cpp" -o "$scratch/ranks" $(pkg-config --cflags --libs octafront_mpi)
  export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
  for program in ranks "from_c $examples/../samples/bracket.stl $scratch/by_ranks.vtu"; do
    LD_LIBRARY_PATH=$(dirname "$PKG_CONFIG_PATH") mpirun --oversubscribe --bind-to none -n 2 "$scratch/"$program
  done
  test -s "$scratch/by_ranks.vtu"
fi

# The example of the README.
code=$(awk '/^```cpp/ { on = 1; next } /^```/ { on = 0 } on' "$examples/../README.md")
[ -n "$code" ] || { echo "no C++ in README.md"; exit 1; }
{
  echo "$code" | grep '^#include'
  echo 'int main() {'
  echo "$code" | grep -v '^#include'
  echo '}'
} >"$scratch/readme.cpp"
c++ -std=c++20 "$scratch/readme.cpp" -o "$scratch/readme" $($pkg_config)
cp "$examples/../samples/bracket.stl" "$scratch/part.stl"
cd "$scratch"
LD_LIBRARY_PATH=$(dirname "$PKG_CONFIG_PATH") ./readme
test -s part.vtu
