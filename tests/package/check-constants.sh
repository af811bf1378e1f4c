#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# hr2d_constant() knows each macro with a number and each member of an enumeration of the public
# headers, and no other name.
set -eu
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
headers="$HR2D_SRCDIR/include/hr2d/*.h $HR2D_BUILDDIR/include/hr2d/version.h"

# names FILES: macros whose text is a number or a cast of one; members of enumerations, which are
# the names that begin a line or follow a brace or a comma.
names() {
  sed -n 's/^#define \(HR2D_[A-Z0-9_]*\) (\{0,1\}\(([a-z0-9_]*)\)\{0,1\}-\{0,1\}[0-9].*/\1/p' "$@"
  sed -n '/^\(typedef \)\{0,1\}enum/,/^}/p' "$@" | grep -o '^ *HR2D_[A-Z0-9_]*' | tr -d ' '
}
# shellcheck disable=SC2086 # the names of headers have no blanks
names $headers | sort -u >"$work/declared"
sed -n 's/^ *CONSTANT(\(.*\)),$/\1/p' "$HR2D_SRCDIR/src/base/constants.c" | sort >"$work/known"

status=0
if ! diff "$work/declared" "$work/known" >"$work/differences"; then
  sed -n 's/^< /a header has, hr2d_constant() lacks: /p; s/^> /no header has: /p' \
    "$work/differences" >&2
  status=1
fi
# Negative control: a new macro and a new member are found.
printf '%s\n' '#define HR2D_NEW ((unsigned)-3)' 'enum {' '  HR2D_MEMBER = 1, /**< text */' '};' \
  >"$work/new.h"
if [ "$(names "$work/new.h" | sort | tr '\n' ' ')" != "HR2D_MEMBER HR2D_NEW " ]; then
  echo "a new constant is not found" >&2
  status=1
fi
echo "$(wc -l <"$work/known") constants"
exit $status
