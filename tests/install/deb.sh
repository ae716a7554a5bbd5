#!/bin/sh
# Makes the Debian packages, looks into them, and builds programs of users with what they would install.
#   deb.sh CPACK BUILD CONFIG CONSUMER EXAMPLES SCRATCH
set -eu
cpack=$1 build=$2 config=$3 consumer=$4 examples=$5 scratch=$6
rm -rf "$scratch"
mkdir -p "$scratch"
cd "$scratch"
"$cpack" --config "$build/CPackConfig.cmake" -G DEB -C "$config" -B "$scratch" >/dev/null
set -- octafront_*.deb liboctafront-dev_*.deb
[ $# -eq 2 ] && [ -s "$1" ] && [ -s "$2" ] || { echo "expected two packages, found: $*"; exit 1; }
# A third one where CAD is read: nobody else needs OpenCASCADE.
[ ! -x "$build/cad/octafront-cad" ] || set -- "$@" octafront-cad_*.deb
for package in "$@"; do
  dpkg-deb -x "$package" unpacked
  dpkg-deb -f "$package" Version Depends
  # Every path is one that Debian allows, owned by root, and the licence is inside.
  dpkg-deb -c "$package" | awk '{print $2, $6}' | grep -v '^root/root \./' && { echo "$package: not owned by root"; exit 1; }
  dpkg-deb -c "$package" | grep -q '/LICENSE$' || { echo "$package: no licence"; exit 1; }
  dpkg-deb -c "$package" | awk '{print $6}' | grep -v -E '^\./(usr(/(bin|include|lib|libexec|share)(/.*)?)?/?)?$' &&
    { echo "$package: files where none belong"; exit 1; }
done
dpkg-deb -f "$1" Depends | grep -q 'libc6' || { echo "$1: does not say what it needs"; exit 1; }
# What they need can be had.
if apt-get --version >/dev/null 2>&1 && [ "$(id -u)" -eq 0 ]; then
  apt-get -s --no-install-recommends install $(printf './%s ' "$@") >/dev/null
fi
unpacked/usr/bin/octafront --version
gunzip -c unpacked/usr/share/man/man1/octafront.1.gz | grep -q '^.TH OCTAFRONT'
# What Debian's own judge says; without it these files are looked for. There is no address to write to, and who meshes on
# one architecture with libraries of another is not served yet.
dpkg-deb -f "$1" Depends | grep -q occt && { echo "$1: needs OpenCASCADE"; exit 1; }
for package in "$@"; do
  package=${package%%_*}
  test -s "unpacked/usr/share/doc/$package/copyright"
  gunzip -c "unpacked/usr/share/doc/$package/changelog.gz" | grep -q '^ -- '
done
if command -v lintian >/dev/null; then
  lintian --allow-root --fail-on error,warning \
    --suppress-tags bogus-mail-host,bogus-mail-host-in-debian-changelog,pkg-config-unavailable-for-cross-compilation "$@"
fi
bash -n unpacked/usr/share/bash-completion/completions/octafront
for file in zsh/vendor-completions/_octafront fish/vendor_completions.d/octafront.fish; do test -s "unpacked/usr/share/$file"; done
cmake -S "$consumer" -B consumer -DCMAKE_BUILD_TYPE="$config" -DCMAKE_PREFIX_PATH="$scratch/unpacked/usr" >/dev/null
cmake --build consumer >/dev/null
consumer/consumer "$scratch/sphere.vtu"
"$(dirname "$0")/pkg_config.sh" "$scratch/unpacked/usr" "$examples" "$scratch/pkg_config"
