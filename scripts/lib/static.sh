# Sourced by the scripts, after lib/apt.sh: static libraries from Debian's sources, whose sums Debian signs, for this machine or
# another one. Debian has static ones of few.

# unpack FOLDER NAME: the source of a package, in FOLDER/sources/NAME/unpacked.
unpack() {
  local work=$1 name=$2
  mkdir -p "$work/lists/partial"
  echo "deb-src [signed-by=/usr/share/keyrings/debian-archive-keyring.gpg] http://deb.debian.org/debian bookworm main" >"$work/sources.list"
  local apt=(apt-get -qq -o "Dir::Etc::sourcelist=$work/sources.list" -o Dir::Etc::sourceparts=- -o "Dir::State::lists=$work/lists" -o APT::Sandbox::User=root)
  "${apt[@]}" update
  rm -rf "$work/sources/$name"
  mkdir -p "$work/sources/$name"
  (cd "$work/sources/$name" && "${apt[@]}" source --download-only "$name" && dpkg-source -x ./*.dsc unpacked)
}

# build_static FOLDER NAME [CMAKE_ARGUMENT ...]: into FOLDER/inside. What is there already stays.
build_static() {
  local work=$1 name=$2
  shift 2
  [ -e "$work/inside/$name.done" ] && return
  mkdir -p "$work"
  {
    unpack "$work" "$name" &&
      cmake -S "$work/sources/$name/unpacked" -B "$work/build-$name" -G Ninja -DCMAKE_BUILD_TYPE=Release -DBUILD_SHARED_LIBS=OFF \
        -DCMAKE_POSITION_INDEPENDENT_CODE=ON -DCMAKE_INSTALL_PREFIX="$work/inside" "$@" &&
      cmake --build "$work/build-$name" && cmake --install "$work/build-$name"
  } >"$work.$name.log" 2>&1 || { tail -20 "$work.$name.log" >&2; return 1; }
  touch "$work/inside/$name.done"
}

# The two that the library stands on and Debian has shared alone.
build_tbb_and_fmt() {
  local work=$1
  shift
  build_static "$work" onetbb -DTBB_TEST=OFF -DTBB_STRICT=OFF -DTBBMALLOC_BUILD=OFF -DTBB_DISABLE_HWLOC_AUTOMATIC_SEARCH=ON -Wno-dev "$@"
  build_static "$work" fmtlib -DFMT_TEST=OFF -DFMT_DOC=OFF "$@"
}

# build_static_zlib FOLDER MACHINE: Debian's source lacks what its CMake project wants.
build_static_zlib() {
  local work=$1
  [ -e "$work/inside/zlib.done" ] && return
  mkdir -p "$work"
  {
    unpack "$work" zlib &&
      (cd "$work/sources/zlib/unpacked" && CHOST=$2 CFLAGS="-O3 -fPIC" ./configure --static --prefix="$work/inside" && make install)
  } >"$work.zlib.log" 2>&1 || { tail -20 "$work.zlib.log" >&2; return 1; }
  touch "$work/inside/zlib.done"
}
