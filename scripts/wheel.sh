#!/usr/bin/env bash
# Makes the wheel and the sdist of a release in dist/, and looks at them: the wheel runs with every glibc from 2.17 on
# (manylinux2014), has libstdc++, oneTBB, fmt and zlib inside, and shows octafront_* alone. The steps of
# .github/workflows/release.yml, on Debian 12.
#   scripts/wheel.sh                 makes both, and tries the wheel
#   scripts/wheel.sh --sdist         also builds a wheel from the sdist, in an empty folder
#   scripts/wheel.sh --old           also tries the wheel in a Debian 11 (glibc 2.31; by debootstrap, as root)
set -euo pipefail
cd "$(dirname "$0")/.."
source scripts/lib/apt.sh
source scripts/lib/static.sh
glibc=2.17 megabytes=8 work=$PWD/build/portable
wheels=$PWD/dist
need_packages "${build_packages[@]}" python3 python3-numpy python3-venv dpkg-dev binutils

build_tbb_and_fmt "$work"

rm -f "$wheels"/octafront-*"$(uname -m)".whl "$wheels"/octafront-*.tar.gz
mkdir -p "$wheels"
arguments="-DCMAKE_PREFIX_PATH=$work/inside -DZLIB_USE_STATIC_LIBS=ON -DOCTAFRONT_CAD=OFF -DOCTAFRONT_OLDEST_GLIBC=$glibc"
[ -z "${CMAKE_CXX_COMPILER_LAUNCHER:-}" ] || arguments+=" -DCMAKE_CXX_COMPILER_LAUNCHER=$CMAKE_CXX_COMPILER_LAUNCHER"
make_wheel() { # of a source, in a build folder, into a folder
  PYTHONPATH=$1/python/backend python3 - "$2" "$3" "$arguments" <<'PYTHON'
import sys, octafront_build
print(octafront_build.build_wheel(sys.argv[2], {"build-dir": sys.argv[1], "cmake-args": sys.argv[3]}))
PYTHON
}
make_wheel "$PWD" "$work/wheel" "$wheels" 2>"$work/wheel.log" || { tail -30 "$work/wheel.log"; exit 1; }
PYTHONPATH=python/backend python3 -c "import octafront_build; octafront_build.build_sdist('$wheels')"

wheel=$(echo "$wheels"/octafront-*"$(uname -m)".whl)
python3 tests/python/look_into_wheel.py "$wheel" . --glibc "$glibc" --megabytes "$megabytes"
ls -l "$wheels" | awk 'NR > 1 { printf "%s %.2f MB\n", $9, $5 / 1e6 }'

# In a clean environment, with this machine's NumPy and nothing else.
python3 -m venv --clear "$work/venv"
site=$("$work/venv/bin/python" -c 'import sysconfig; print(sysconfig.get_path("purelib"))')
for part in /usr/lib/python3/dist-packages/numpy /usr/lib/python3/dist-packages/numpy-*-info; do ln -s "$part" "$site/"; done
"$work/venv/bin/python" -m pip install -q --no-index --no-deps "$wheel"
(cd "$work" && PYTHONPATH="$OLDPWD/tests/python" OCTAFRONT_SAMPLES="$OLDPWD/samples" venv/bin/python -W error -m unittest -q test_octafront)
"$work/venv/bin/python" -c 'import time; t = time.perf_counter(); import octafront; t = time.perf_counter() - t; print(f"import octafront: {1e3 * t:.0f} ms"); assert t < 0.1'

try_there() { # in the folder of another system; without /proc programs do not find out where they lie
  rm -rf "$1/wheel"
  mkdir "$1/wheel"
  cp samples/bracket.stl "$1/wheel/"
  (cd "$1/wheel" && python3 -m zipfile -e "$wheel" . && chmod +x octafront/_bin/*)
  chroot "$1" /bin/sh -c 'cd /wheel && ldd --version | head -1 && python3 --version && LD_LIBRARY_PATH=octafront/_bin octafront/_bin/octafront mesh bracket.stl -o part.vtu --size 3 -q --json - | grep -o "\"hash\": *\"[0-9a-f]*\"" &&
    python3 -W error -c "import octafront; m = octafront.mesh(\"bracket.stl\", size=3); print(m, m.points.mean(axis=0)); print(m.report[\"hash\"])"'
}
for option in "$@"; do
  case $option in
    --sdist)
      rm -rf "$work/sdist" && mkdir -p "$work/sdist/wheel"
      tar -C "$work/sdist" -xzf "$wheels"/octafront-*.tar.gz
      make_wheel "$(echo "$work"/sdist/octafront-*)" "$work/sdist/build" "$work/sdist/wheel" 2>"$work/sdist.log" || { tail -30 "$work/sdist.log"; exit 1; }
      cmp "$work"/sdist/wheel/*.whl "$wheel" && echo "the sdist makes the same wheel"
      ;;
    --old)
      need_packages debootstrap
      [ -e "$work/bullseye/usr/bin/python3" ] ||
        debootstrap --variant=minbase --include=python3-numpy bullseye "$work/bullseye" http://deb.debian.org/debian >"$work/bullseye.log"
      try_there "$work/bullseye"
      octafront=$(cd "$site" && echo "$PWD/octafront/_bin/octafront")
      (cd "$work" && "$octafront" mesh ../../samples/bracket.stl -o part.vtu --size 3 -q --json - | grep -o '"hash": *"[0-9a-f]*"' && echo "on this machine")
      ;;
    *)
      echo "usage: scripts/wheel.sh [--sdist] [--old]" >&2
      exit 2
      ;;
  esac
done
