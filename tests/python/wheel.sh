#!/bin/sh
# Makes the wheel, installs it with pip, without a network, into a clean environment that has NumPy and nothing else, and
# runs the tests of the package there.
#   wheel.sh PYTHON SOURCE BUILD SCRATCH
set -eu
python=$1 source=$2 build=$3 scratch=$4
rm -rf "$scratch"
mkdir -p "$scratch"

"$python" -m venv "$scratch/venv"
site=$("$scratch/venv/bin/python" -c 'import sysconfig; print(sysconfig.get_path("purelib"))')
numpy=$("$python" -c 'import numpy, pathlib; print(pathlib.Path(numpy.__file__).parents[1])')
for part in "$numpy"/numpy "$numpy"/numpy-*-info "$numpy"/numpy.libs; do
  [ -e "$part" ] && ln -s "$part" "$site/"
done

pip="$scratch/venv/bin/python -m pip --disable-pip-version-check --no-cache-dir"
$pip wheel -q --no-index --no-deps -w "$scratch" --config-settings "build-dir=$build" "$source"
$pip install -q --no-index "$scratch"/octafront-*.whl
$pip check
"$python" "$source/tests/python/look_into_wheel.py" "$scratch"/octafront-*.whl "$source"

# From an empty folder, by nothing but what the environment has.
mkdir "$scratch/empty"
cd "$scratch/empty"
unset PYTHONPATH LD_LIBRARY_PATH OCTAFRONT_BIN
PYTHONPATH="$source/tests/python" OCTAFRONT_SAMPLES="$source/samples" \
  "$scratch/venv/bin/python" -W error -m unittest -q test_octafront
"$scratch/venv/bin/python" "$source/python/backend/make_stubs.py" --check "$source/python/octafront/__init__.pyi"
