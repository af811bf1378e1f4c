#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Builds and runs main.c, main.cpp and examples/room.cpp with what pkg-config says of the installed
# library, and the former two by CMake and by Meson where these are.  `make installcheck` sets
# DESTDIR, docdir, libdir, pkgconfigdir, bindir, VERSION and tools.
set -eu
here=$1
: "${DESTDIR=}" "${docdir:?}" "${libdir:?}" "${pkgconfigdir:?}" "${bindir:?}" "${VERSION:?}"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

export PKG_CONFIG_PATH="$DESTDIR$pkgconfigdir${PKG_CONFIG_PATH:+:$PKG_CONFIG_PATH}"
export PKG_CONFIG_ALLOW_SYSTEM_LIBS=1
export LD_LIBRARY_PATH="$DESTDIR$libdir${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}"

# Without a shared library programs need all that libhr2d.a needs.
shared=$(find "$DESTDIR$libdir" -name 'libhr2d.so*' -o -name 'libhr2d*.dylib' | head -n 1)
libs=$("$PKG_CONFIG" --libs hr2d | sed 's/ *$//')
if [ -n "$shared" ] && [ "$libs" != "-L$libdir -lhr2d" ]; then
  echo "pkg-config --libs hr2d: '$libs', not '-L$libdir -lhr2d'" >&2
  exit 1
fi
[ -z "$DESTDIR" ] || export PKG_CONFIG_SYSROOT_DIR="$DESTDIR"

# Words of flags are meant to be split.
# shellcheck disable=SC2046
{
  $CC -std=c11 -Wall -Wextra -Wpedantic -Werror "$here/main.c" -o "$work/c" \
    $("$PKG_CONFIG" --cflags --libs hr2d) -lm
  "$work/c"
  echo "installcheck: C ok"
  if [ -n "$CXX" ]; then
    $CXX -std=c++11 -Wall -Wextra -Wpedantic -Werror "$here/main.cpp" -o "$work/cpp" \
      $("$PKG_CONFIG" --cflags --libs hr2d)
    "$work/cpp"
    echo "installcheck: C++ ok"
    $CXX -std=c++11 -Wall -Wextra -Wpedantic -Werror "$here/../../../examples/room.cpp" \
      -o "$work/room" $("$PKG_CONFIG" --cflags --libs hr2d)
    "$work/room" | diff -u "$here/../../../examples/room.expected" -
    echo "installcheck: C++ example ok"
  fi
  if [ -f "$DESTDIR$libdir/libhr2d.a" ]; then
    $CC -std=c11 "$here/main.c" -o "$work/static" $("$PKG_CONFIG" --cflags hr2d) \
      "$DESTDIR$libdir/libhr2d.a" $("$PKG_CONFIG" --static --libs hr2d | sed 's/-lhr2d//')
    (unset LD_LIBRARY_PATH && "$work/static")
    echo "installcheck: static ok"
  fi
}
# by_tool NAME COMMAND...: makes the programs, quietly unless that fails, and runs them.
by_tool() {
  tool=$1
  shift
  "$@" >"$work/log" 2>&1 || { cat "$work/log" >&2; exit 1; }
  "$work/$tool/c"
  "$work/$tool/cpp"
  if [ "$tool,$static" = cmake,ON ]; then
    # These start where there is no shared library.
    (unset LD_LIBRARY_PATH && "$work/cmake/c-static" && "$work/cmake/cpp-static")
    if [ -n "$shared" ] && ldd "$work/cmake/c-static" | grep libhr2d; then
      echo "hr2d::hr2d_static links the shared library" >&2
      exit 1
    fi
    tool="cmake, static, too:"
  fi
  echo "installcheck: $tool ok"
}
static=OFF
[ ! -f "$DESTDIR$libdir/libhr2d.a" ] || static=ON
make_cmake() {
  # libdir is PREFIX/lib or PREFIX/lib/ARCHITECTURE.  GSL and jansson, which a static library
  # needs, are not below DESTDIR.
  unset PKG_CONFIG_SYSROOT_DIR
  cmake -S "$here" -B "$work/cmake" -DVERSION="$VERSION" -DSTATIC="$static" \
    -DCMAKE_PREFIX_PATH="$DESTDIR$libdir/..;$DESTDIR$libdir/../.." && cmake --build "$work/cmake"
}
make_meson() {
  meson setup "$work/meson" "$here" && ninja -C "$work/meson"
}
if [ -n "$CXX" ]; then
  ! command -v cmake >/dev/null || (by_tool cmake make_cmake)
  ! command -v meson >/dev/null || by_tool meson make_meson
fi
"$DESTDIR$bindir/hr2d" --version

# The examples are installed, and the program reads their scenes.
examples=$DESTDIR$docdir/examples
# shellcheck disable=SC2046 # its words are several arguments
$CC -std=c11 "$examples/digits.c" -o "$work/digits" $("$PKG_CONFIG" --cflags --libs hr2d)
"$work/digits" | diff -u "$here/../../../examples/digits.expected" -
"$DESTDIR$bindir/hr2d" solve "$examples/scenes/lit-room.geojson" --quiet --json "$work/room.json"
echo "installcheck: examples ok"
