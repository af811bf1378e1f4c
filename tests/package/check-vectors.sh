#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Batches of exchange areas are computed with vectors of four doubles at -O2, too: the options of
# configure keep them, and without these they are gone.
set -eu
case $HR2D_CFLAGS in
  *-fsanitize* | *--coverage*) echo "sanitizers and counters make other code" && exit 77 ;;
  *-DHR2D_AVX2*) ;;
  *) echo "configured without vectors of four doubles" && exit 77 ;;
esac
if ! command -v objdump >/dev/null; then
  echo "there is no objdump"
  exit 77
fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# products OPTION...: how many multiplications of four doubles there are in the object.
products() {
  # Words of flags are meant to be split.
  # shellcheck disable=SC2086
  $CC -DHAVE_CONFIG_H -I"$HR2D_BUILDDIR" -I"$HR2D_BUILDDIR/include" -I"$HR2D_SRCDIR/include" \
    -I"$HR2D_SRCDIR/src" $HR2D_CFLAGS "$@" -c "$HR2D_SRCDIR/src/geometry/exchange-area.c" -o "$work/o"
  objdump -d "$work/o" | grep -c 'vmulpd.*%ymm' || true
}

best=$(products -O3) plain=$(products -O2) without=$(products -O2 -fno-tree-vectorize)
echo "products of four doubles: $best at -O3, $plain at -O2, $without without the options"
if [ "$((4 * plain))" -lt "$((3 * best))" ]; then
  echo "-O2 loses the vectors of -O3" >&2
  exit 1
fi
if [ "$((2 * without))" -gt "$best" ]; then
  echo "this test cannot tell whether there are vectors" >&2
  exit 1
fi
