#!/usr/bin/env bash
# Makes pages of the docstrings: the C++ and C headers by Doxygen, the Python package by Sphinx. A warning is an error.
#   scripts/api-docs.sh [FOLDER [BIN]]    FOLDER: where the pages go, by default out/api
#                                         BIN: the folder of liboctafront.so, by default that of build/release
set -euo pipefail
cd "$(dirname "$0")/.."
source scripts/lib/apt.sh
need_packages doxygen python3-sphinx python3-numpy

out=$(realpath -m "${1:-out/api}") bin=$(realpath "${2:-build/release/python/octafront/_bin}")
mkdir -p "$out"
OUT=$out doxygen docs/api/Doxyfile
PYTHONPATH=python OCTAFRONT_BIN=$bin /usr/bin/python3 -m sphinx -q -W -b html docs/api "$out/python"
echo "open $out/cpp/index.html and $out/python/index.html"
