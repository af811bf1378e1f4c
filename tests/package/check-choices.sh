#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Each choice in src/base/choices.h is used; none is defined elsewhere; and no constant of src/ has
# a name of one word that says only how many, so that it could mean anything.
set -eu
cd "$HR2D_SRCDIR"
table=src/base/choices.h
status=0

# unused TABLE: choices that no file but the table has.
unused() {
  sed -n 's/^#define \(HR2DI_CHOICE_[A-Z0-9_]*\) .*/\1/p' "$1" | while read -r name; do
    grep -rqw --include='*.c' --include='*.h' --exclude=choices.h "$name" src || echo "$name"
  done
}

# vague FILE...: constants that are named so.
vague() {
  grep -HnE '(#define|[{,]) *(MANY|MOST|SOME|FEW|LEAST|LEFT|HIDDEN)( *=| [-(0-9])' "$@" || true
}

found=$(unused "$table")
[ -z "$found" ] || { echo "nobody uses $found" >&2; status=1; }
if grep -rn --include='*.[ch]' --exclude=choices.h '#define HR2DI_CHOICE_' src; then
  echo "choices are defined in $table alone" >&2
  status=1
fi
# shellcheck disable=SC2046 # the names of sources have no blanks
found=$(vague $(find src -name '*.[ch]'))
[ -z "$found" ] || { echo "constants that do not say of what: $found" >&2; status=1; }

# Negative controls.
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
echo '#define HR2DI_CHOICE_OF_NOBODY 3' >"$work/choices.h"
if [ "$(unused "$work/choices.h")" != HR2DI_CHOICE_OF_NOBODY ]; then
  echo "an unused choice is not found" >&2
  status=1
fi
printf '%s\n' '#define MANY 3' 'enum { FIRST = 1, SOME = 2 };' >"$work/vague.c"
if [ "$(vague "$work/vague.c" | wc -l)" != 2 ]; then
  echo "vague names are not found" >&2
  status=1
fi
echo "$(grep -c '^#define HR2DI_CHOICE_[A-Z0-9_]* ' "$table") choices"
exit $status
