#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# The prototypes of the public headers are the symbols of the shared library, one
# for one, and the library needs no other libraries than it should.
set -eu
library=$HR2D_BUILDDIR/.libs/libhr2d.so
if [ ! -e "$library" ]; then
  echo "no shared library was built"
  exit 77
fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# In preprocessed text only a declaration has a name and a parenthesis side by side.
for header in "$HR2D_SRCDIR"/include/hr2d/*.h "$HR2D_BUILDDIR/include/hr2d/version.h"; do
  echo "#include <hr2d/${header##*/}>"
done |
  $CC -E -P -I"$HR2D_BUILDDIR/include" -I"$HR2D_SRCDIR/include" -x c - |
  grep -o '\bhr2d_[a-z0-9_]*(' | tr -d '(' | sort -u >"$work/declared"

# Absolute symbols are the names of versions.
${NM:-nm} -D --defined-only "$library" |
  awk '$2 != "A" { sub(/@.*/, "", $3); print $3 }' | sort -u >"$work/exported"

status=0
if [ ! -s "$work/declared" ]; then
  echo "no prototypes found in the headers" >&2
  status=1
fi
comm -23 "$work/declared" "$work/exported" >"$work/missing"
comm -13 "$work/declared" "$work/exported" >"$work/extra"
if [ -s "$work/missing" ] || [ -s "$work/extra" ]; then
  sed 's/^/declared in a header, not exported: /' "$work/missing" >&2
  sed 's/^/exported, not declared in a header: /' "$work/extra" >&2
  status=1
fi

if readelf -d "$library" >"$work/dynamic" 2>/dev/null; then
  sed -n 's/.*(NEEDED).*\[\(.*\)\]/\1/p' "$work/dynamic" |
    grep -Ev '^(libgsl|libgslcblas|libjansson|libm|libpthread|libc|ld-linux.*)\.so' \
      >"$work/foreign" || true
  if [ -s "$work/foreign" ]; then
    sed 's/^/the library links /' "$work/foreign" >&2
    status=1
  fi
fi
# A tarball has no debian/.
symbols=$(find "$HR2D_SRCDIR/debian" -name 'libhr2d[0-9]*.symbols' 2>/dev/null || true)
if [ -f "$symbols" ]; then
  sed -n 's/^ \(hr2d_[a-z0-9_]*\)@HR2D_[0-9]* .*/\1/p' "$symbols" | sort -u >"$work/packaged"
  if ! diff "$work/declared" "$work/packaged" >"$work/differences"; then
    sed -n 's/^< /a header has, the symbols file of debian\/ lacks: /p
      s/^> /the symbols file of debian\/ has, no header: /p' "$work/differences" >&2
    status=1
  fi
fi
echo "$(wc -l <"$work/declared") prototypes, $(wc -l <"$work/exported") symbols"
exit $status
