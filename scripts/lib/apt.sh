# Sourced by the scripts: installs Debian packages that are missing.

# need_packages NAME...: asks for root rights only if something is missing.
need_packages() {
  local missing=()
  for package in "$@"; do
    dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q 'install ok installed' || missing+=("$package")
  done
  [ ${#missing[@]} -eq 0 ] && return 0
  local sudo=""
  if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null || {
      echo "missing Debian packages: ${missing[*]}; install them as root: apt-get install ${missing[*]}" >&2
      return 1
    }
    sudo=sudo
  fi
  echo "installing ${missing[*]} ..."
  $sudo apt-get -qq update
  DEBIAN_FRONTEND=noninteractive $sudo apt-get -qq install -y --no-install-recommends "${missing[@]}" >/dev/null
}

# What building needs, and what the tests need beyond it.
build_packages=(g++ cmake ninja-build libtbb-dev zlib1g-dev libfmt-dev libcli11-dev nlohmann-json3-dev libhdf5-dev)
# All of these but HDF5, the last: what is asked of a first build.
first_packages=("${build_packages[@]:0:${#build_packages[@]}-1}")
test_packages=(pkg-config libgtest-dev librapidcheck-dev libmetis-dev python3 python3-numpy python3-venv dpkg-dev file)
# What octafront-cad stands on, which reads STEP, IGES and BREP; without it the rest is built.
cad_packages=(libocct-data-exchange-dev libocct-ocaf-dev libocct-modeling-algorithms-dev libocct-modeling-data-dev libocct-foundation-dev)
# What unpacks the JPEG families of DICOM (OCTAFRONT_GDCM); without it the rest is built.
gdcm_packages=(libgdcm-dev)
tiff_packages=(libtiff-dev)
# What `octafront ui` speaks HTTP with (OCTAFRONT_UI); without it the rest is built.
ui_packages=(libcpp-httplib-dev pkg-config)
# What shares the work among processes (OCTAFRONT_MPI); without it the rest is built.
mpi_packages=(libopenmpi-dev openmpi-bin)
# And what Python programs speak with: of --all.
mpi_test_packages=(python3-mpi4py)
# What judges our files (tests/formats) and packages (tests/install) and solves with them (tests/solved): those of --all.
format_packages=(gmsh python3-gmsh calculix-ccx python3-meshio python3-scipy python3-netcdf4 python3-vtk9 python3-h5py python3-med netcdf-bin cgns-convert openfoam openmpi-bin tetgen lintian)
# Pages of docstrings, and what checks types: those of --all.
doc_packages=(doxygen python3-sphinx mypy)
# What opens the report page (tests/report/page): also of --all.
browser_packages=(chromium chromium-driver python3-selenium fonts-dejavu-core)
# What reads manual, completions and schema (tests/cli): also of --all; without them these are read by fewer programs.
shell_packages=(groff zsh fish python3-jsonschema)
# What solves in loops with us (examples/solve): of --all.
fem_packages=(python3-dolfinx)
# What reads images beside us (tests/images): also of --all.
image_packages=(python3-nibabel python3-pydicom libgdcm-dev libgdcm-tools libtiff-dev)
# FreeCAD, and a display that nobody sees, for the workbench of addons/freecad: also of --all.
addon_packages=(freecad xvfb xauth)
# Other meshers, which some benchmarks run beside ours.
peer_packages=(tetgen gmsh netgen)
