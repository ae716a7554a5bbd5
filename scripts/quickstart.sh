#!/usr/bin/env bash
# Builds Octafront and meshes a surface. Installs what is missing (Debian 12).
#   scripts/quickstart.sh [--mpi] [INPUT] [octafront mesh options ...]
# Writes out/NAME.vtu and out/NAME.json, and prints the quality table. INPUT is a model of samples/ by default.
# --mpi: also installs Open MPI and builds with it; two processes make the mesh then (docs/use/ranks.md).
set -euo pipefail
caller=$PWD
cd "$(dirname "$0")/.."
source scripts/lib/apt.sh

mpi=OFF launch=()
if [ "${1:-}" = --mpi ]; then
  shift
  mpi=ON launch=(mpirun --oversubscribe -n 2)
  # As in most containers.
  [ "$(id -u)" -ne 0 ] || launch+=(--allow-run-as-root)
  need_packages "${mpi_packages[@]}"
fi
input=${1:-samples/bracket.stl}
[ $# -gt 0 ] && shift
if [ ! -e "$input" ] && [ -e "$caller/$input" ]; then input=$caller/$input; fi
[ -e "$input" ] || { echo "quickstart: no such file: $input" >&2; exit 3; }

# What the input and the options ask for is built, and what earlier calls have asked for stays.
built() { grep -q "OCTAFRONT_$1:BOOL=ON" build/quickstart/CMakeCache.txt 2>/dev/null && echo ON || echo OFF; }
images=$(built IMAGES) hdf5=$(built HDF5) gdcm=$(built GDCM) tiff=$(built TIFF) targets=(octafront_cli)
case ${input,,} in
  *.step | *.stp | *.stpz | *.step.gz | *.stp.gz | *.p21 | *.iges | *.igs | *.brep | *.brp)
    need_packages "${cad_packages[@]}"
    targets+=(octafront_cad_program) ;;
  *.stl | *.obj | *.off | *.ply | *.msh | *.vtu | *.vtk | *.inp | *.poly | *.smesh | *.mesh) ;;
  *) images=ON ;;
esac
case "${input,,} ${*,,}" in *.med* | *.xdmf* | *.cgns* | *.vtkhdf*) hdf5=ON ;; esac
# By the names of the JPEG families, which stand in the files' heads.
if [ $images = ON ] && grep -rqam1 '1\.2\.840\.10008\.1\.2\.4\.' "$input"; then gdcm=ON; fi
if [ $images = ON ] && [ -n "$(find "$input" -iname '*.tif' -o -iname '*.tiff' | head -1)" ]; then tiff=ON; fi
need_packages "${first_packages[@]}"
[ $tiff = OFF ] || need_packages "${tiff_packages[@]}"
[ $gdcm = OFF ] || need_packages "${gdcm_packages[@]}"
[ $hdf5 = OFF ] || need_packages "${build_packages[@]}"
[ $images = ON ] || echo "built without images and formulas: they come with an input that is one"
[ $hdf5 = ON ] || echo "built without HDF5: it comes with a file in MED, XDMF, CGNS or VTKHDF"
cmake --preset release -DOCTAFRONT_UNITY=ON -DOCTAFRONT_BUILD_TESTS=OFF -DOCTAFRONT_BUILD_BENCH=OFF -DOCTAFRONT_BUILD_EXAMPLES=OFF \
  -DOCTAFRONT_MPI=$mpi -DOCTAFRONT_IMAGES=$images -DOCTAFRONT_HDF5=$hdf5 -DOCTAFRONT_GDCM=$gdcm -DOCTAFRONT_TIFF=$tiff -B build/quickstart >/dev/null
cmake --build build/quickstart --target "${targets[@]}"

name=$(basename "${input%.*}")
mkdir -p out
"${launch[@]}" build/quickstart/cli/octafront mesh "$input" -o "out/$name.vtu" --json "out/$name.json" "$@"
echo "open out/$name.vtu in ParaView; the report is out/$name.json"
