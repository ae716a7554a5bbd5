#!/usr/bin/env bash
# Makes the Debian packages octafront, liboctafront0, liboctafront-dev, python3-octafront and octafront-doc in build/packages,
# has lintian judge them, and checks the recipes of packaging/ as far as their languages can be read here.
#   scripts/packages.sh              makes and looks
#   scripts/packages.sh --install    also installs them in a fresh Debian 12 (by debootstrap, as root), uses them, removes them
set -euo pipefail
cd "$(dirname "$0")/.."
source scripts/lib/apt.sh
work=$PWD/build/packages
need_packages "${build_packages[@]}" python3 python3-numpy python3-yaml dpkg-dev lintian file ruby nix-bin
launcher=()
[ -z "${CMAKE_CXX_COMPILER_LAUNCHER:-}" ] || launcher=("-DCMAKE_CXX_COMPILER_LAUNCHER=$CMAKE_CXX_COMPILER_LAUNCHER")
cmake -S . -B "$work" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_INSTALL_PREFIX=/usr -DCMAKE_INSTALL_LIBDIR="lib/$(dpkg-architecture -qDEB_HOST_MULTIARCH)" \
  -DBUILD_SHARED_LIBS=ON -DOCTAFRONT_DEBIAN_PYTHON=ON -DOCTAFRONT_CAD=OFF -DOCTAFRONT_BUILD_PYTHON=OFF -DOCTAFRONT_BUILD_TESTS=OFF \
  -DOCTAFRONT_BUILD_EXAMPLES=OFF -DOCTAFRONT_UNITY=ON "${launcher[@]}" >/dev/null
cmake --build "$work"
rm -f "$work"/*.deb
cpack --config "$work/CPackConfig.cmake" -G DEB -B "$work" >/dev/null
packages=("$work"/*.deb)
for name in octafront liboctafront0 liboctafront-dev python3-octafront octafront-doc; do
  ls "$work/${name}"_*.deb >/dev/null || { echo "there is no $name"; exit 1; }
done
ls -l "${packages[@]}" | awk '{ printf "%s %.2f MB\n", $9, $5 / 1e6 }'
# There is no address to write to, and who meshes on one architecture with libraries of another is not served yet.
lintian --allow-root --fail-on error,warning \
  --suppress-tags bogus-mail-host,bogus-mail-host-in-debian-changelog,pkg-config-unavailable-for-cross-compilation "${packages[@]}"
echo "lintian has nothing to say"
python3 packaging/check.py

[ "${1:-}" = --install ] || exit 0
need_packages debootstrap
root=$work/bookworm
[ -e "$root/usr/bin/apt-get" ] || debootstrap --variant=minbase bookworm "$root" http://deb.debian.org/debian >"$work/bookworm.log"
rm -rf "$root/packages" && mkdir "$root/packages"
cp "${packages[@]}" samples/bracket.stl examples/mesh_from_c.c "$root/packages/"
in_there() { chroot "$root" /bin/sh -ec "$1"; }
in_there 'dpkg-query -W -f="\${Package}\n" | sort >/before; find /usr /etc -xdev | sort >/files'
in_there 'cd /packages && apt-get -qq -y --no-install-recommends install ./*.deb gcc libc6-dev pkg-config >/packages/log 2>&1 || { cat /packages/log; exit 1; }'
in_there 'cd /packages && octafront mesh bracket.stl -o part.vtu --size 3 -q --json - | grep -o "\"hash\": *\"[0-9a-fx]*\""
  python3 -W error -c "import octafront; m = octafront.mesh(\"/packages/bracket.stl\", size=3); print(m, m.report[\"hash\"])"
  python3 -m octafront --version
  gcc mesh_from_c.c -o mesh_from_c $(pkg-config --cflags --libs octafront) && ./mesh_from_c c.vtu && test -s c.vtu && echo "a program in C works"'
in_there 'apt-get -qq -y purge octafront liboctafront0 liboctafront-dev python3-octafront octafront-doc >/packages/log 2>&1 || { cat /packages/log; exit 1; }
  ! find / -xdev -name "*octafront*" -not -path "/packages/*" -not -path "/proc/*" | grep . && echo "installed, used, removed: nothing is left"'
