#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Builds and runs main.c and main.cpp with what pkg-config says of the installed
# library.  `make installcheck` sets DESTDIR, libdir, pkgconfigdir, bindir and tools.
set -eu
here=$1
: "${DESTDIR=}" "${libdir:?}" "${pkgconfigdir:?}" "${bindir:?}"
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
  fi
  if [ -f "$DESTDIR$libdir/libhr2d.a" ]; then
    $CC -std=c11 "$here/main.c" -o "$work/static" $("$PKG_CONFIG" --cflags hr2d) \
      "$DESTDIR$libdir/libhr2d.a" $("$PKG_CONFIG" --static --libs hr2d | sed 's/-lhr2d//')
    (unset LD_LIBRARY_PATH && "$work/static")
    echo "installcheck: static ok"
  fi
}
"$DESTDIR$bindir/hr2d" --version
