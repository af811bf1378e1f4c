#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Some seconds of the adversary: two scenes of each kind, or twenty with `make check-long`.
set -eu
exec "$HR2D_BUILDDIR/tests/adversary/adversary" \
  --runs "$(awk "BEGIN { print int(760 * ${HR2D_TEST_MULTIPLIER-0.1} + 4) }")" \
  --seed "${HR2D_TEST_SEED-1}" --limit 10
