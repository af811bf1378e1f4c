#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# choices.sh [NAME=VALUE...]: what another value of a row in src/base/choices.h costs; without a
# NAME half and twice the value of every row.  In a copy of this tree the rows become variables,
# and bench/bench-choices.c changes them.  CONTACTS and GAPS are sizes of arrays and stay.
set -eu
source=$(cd "$(dirname "$0")/.." && pwd)
table=src/base/choices.h
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir "$work/tree" "$work/build"
(cd "$source" && git ls-files -z | xargs -0 tar cf -) | tar xf - -C "$work/tree"

# A row without a point or an exponent is a whole number.
awk -v definitions="$work/definitions" '
  /^#define HR2DI_CHOICE_[A-Z0-9_]+ / && !/CHOICE_(CONTACTS|GAPS) / {
    name = $2; sub(/^HR2DI_CHOICE_/, "", name)
    value = $0; sub(/^#define [A-Z0-9_]+ +/, "", value)
    type = value ~ /^(0x[0-9a-fA-F]+|[0-9]+)$/ ? "int" : "double"
    printf "extern double hr2di_choice_%s;\n#define %s ((%s)hr2di_choice_%s)\n", name, $2, type, name
    printf "double hr2di_choice_%s = %s;\n", name, value > definitions
    rows = rows " row(" name ")"
    next
  }
  /^#endif/ { print "#define HR2DI_CHOICES(row)" rows }
  { print }' "$source/$table" >"$work/table"
cat "$work/table" >"$work/tree/$table"
{ echo '#include "base/choices.h"' && cat "$work/definitions"; } >>"$work/tree/src/base/constants.c"
(cd "$work/tree" && autoreconf -fi && cd ../build && ../tree/configure --quiet --disable-shared &&
  make -s -j"$(nproc)" bench/bench-choices) >"$work/log" 2>&1 || { cat "$work/log" >&2; exit 1; }
"$work/build/bench/bench-choices" "$@"
