#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Every example runs and prints what NAME.expected says.
set -eu
status=0
cd "$HR2D_SRCDIR"
for example in $HR2D_EXAMPLES; do
  if "$HR2D_BUILDDIR/$example" | diff -u "$example.expected" -; then
    echo "ok: $example"
  else
    echo "failed: $example" >&2
    status=1
  fi
done
exit $status
