#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# The storeys of src/LAYERS hold.  A file of src/ includes headers of its own folder, of those
# before it, and public ones; its object calls nothing that a later folder defines.  Planted
# faults show that each rule is checked.
set -eu
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
layers=$HR2D_SRCDIR/src/LAYERS

# includes SRC: the includes that break the rule, a line each.
includes() {
  find "$1" -mindepth 2 -name '*.[ch]' | sort | xargs awk '
    FILENAME == layers { if (!/^#/ && NF) storey[$1] = ++n; next }
    FNR == 1 { k = split(FILENAME, part, "/"); own = part[k - 1]; file = own "/" part[k]
               if (!(own in storey)) print file ": its folder is not in LAYERS" }
    /^ *# *include *"/ {
      split($0, quoted, "\""); header = to = quoted[2]; sub("/.*", "", to)
      if (header == "config.h") next
      if (header !~ "/") print file ": \"" header "\" names no folder"
      else if (!(to in storey) || storey[to] > storey[own]) print file ": may not include " header
    }' layers="$layers" "$layers"
}

# calls SRC: a line "CALLER CALLED SYMBOL" for what an object in SRC takes from another one.
# Objects lie in .libs/ where no static library is built.
calls() {
  objects=$(find "$1" -name '*.o' ! -path '*/.libs/*' | sort)
  [ -n "$objects" ] || objects=$(find "$1" -name '*.o' | sort)
  for object in $objects; do
    echo "FILE $(echo "$object" |
      sed 's|/\.libs/|/|; s|libhr2d_core_la-||; s|\.o$||; s|.*/\([^/]*/[^/]*\)$|\1|')"
    ${NM:-nm} "$object" | sed 's/^[0-9a-f]* *//'
  done | awk '
    $1 == "FILE" { file = $2; next }
    $1 ~ /^[TDBRC]$/ { home[$2] = file }
    $1 == "U" { n++; caller[n] = file; symbol[n] = $2 }
    END { for (k = 1; k <= n; k++) if (symbol[k] in home)
            print caller[k], home[symbol[k]], symbol[k] }'
}

# upward CALLS: the calls that go to a later folder.
upward() {
  awk -v layers="$layers" '
    BEGIN { while ((getline line < layers) > 0) if (line !~ /^#/) storey[line] = ++n }
    { split($1, from, "/"); split($2, to, "/") }
    storey[to[1]] > storey[from[1]] { print $1 " calls " $3 "() of " $2 }' "$1"
}

status=0
# none WHAT FILE: the file is empty.
none() {
  [ ! -s "$2" ] || { sed "s/^/$1: /" "$2" >&2; status=1; }
}
# some WHAT FILE: the file is not empty, as a fault was planted.
some() {
  [ -s "$2" ] || { echo "$1 was planted and not found" >&2; status=1; }
}

includes "$HR2D_SRCDIR/src" >"$work/includes"
none "include" "$work/includes"
calls "$HR2D_BUILDDIR/src" >"$work/calls"
upward "$work/calls" >"$work/upward"
none "call" "$work/upward"
some "a call between files" "$work/calls"

mkdir -p "$work/src/geometry" "$work/src/solve"
echo '#include "solve/equation.h"' >"$work/src/geometry/planted.c"
includes "$work/src" >"$work/planted"
some "an include of a later folder" "$work/planted"
echo '#include "alloc.h"' >"$work/src/geometry/planted.c"
includes "$work/src" >"$work/planted"
some "an include without a folder" "$work/planted"
echo 'void later(void); void sooner(void); void sooner(void) { later(); }' |
  $CC -x c -c -o "$work/src/geometry/sooner.o" -
echo 'void later(void); void sooner(void); void later(void) { sooner(); }' |
  $CC -x c -c -o "$work/src/solve/later.o" -
calls "$work/src" >"$work/calls-planted"
upward "$work/calls-planted" >"$work/planted"
some "a call of a later folder" "$work/planted"

echo "$(wc -l <"$layers") lines of LAYERS, $(wc -l <"$work/calls") calls between files"
exit $status
