#!/usr/bin/env bash
# Meshes and solves the examples of examples/solve, and compares them with theory (docs/measured/solved.md). Installs what it needs.
#   bench/campaigns/solve.sh [CASE ...]      with CalculiX: cantilever, pipe, patch, heat, plate, bar, sphere; by default all
#   bench/campaigns/solve.sh --fenicsx       the pipe with FEniCSx (a gigabyte of packages)
#   bench/campaigns/solve.sh --loop          mesh, solve, adapt, solve again with FEniCSx (docs/use/adapt.md)
#   bench/campaigns/solve.sh --others        the bar with FreeFEM, GetFEM, sfepy, deal.II, FEniCSx and OpenFOAM (three gigabytes of packages)
#   bench/campaigns/solve.sh --picture       all, and docs/images/solved.png anew
set -euo pipefail
cd "$(dirname "$0")/../.."
source scripts/lib/apt.sh

need_packages "${build_packages[@]}" python3 calculix-ccx
cmake --preset release >/dev/null
cmake --build --preset release --target octafront_cli
octafront=build/release/cli/octafront work=out/solve
case ${1:-} in
  --fenicsx)
    need_packages python3-dolfinx
    exec /usr/bin/python3 examples/solve/fenicsx.py "$octafront" "$work"
    ;;
  --loop)
    need_packages python3-numpy python3-dolfinx
    cmake --build --preset release --target octafront_python
    PYTHONPATH=python OCTAFRONT_BIN=build/release/python/octafront/_bin exec /usr/bin/python3 examples/solve/fenicsx_loop.py
    ;;
  --others)
    need_packages freefem++ python3-getfem python3-sfepy libdeal.ii-dev python3-dolfinx openfoam
    exec /usr/bin/python3 examples/solve/others.py "$octafront" "$work"
    ;;
  --picture)
    need_packages python3-vtk9 xvfb xauth
    python3 examples/solve/solve.py "$octafront" "$work"
    exec xvfb-run -a /usr/bin/python3 examples/solve/picture.py "$work" docs/images/solved.png
    ;;
  *)
    python3 examples/solve/solve.py "$octafront" "$work" "$@"
    python3 -c 'from bench.pages import origin; print(f"For docs/measured/solved.md: Measured by `bench/campaigns/solve.sh` ({origin.ORIGIN})")'
    ;;
esac
