#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Results are what their JSON Schemas say, and scenes what the schema of scenes says; see schemas.py.
# Skipped without Python's jsonschema; where CI is set, that is a failure.
#
# Environment: HR2D_PROGRAM, the program; HR2D_SRCDIR, the top of the sources; PYTHON.
# shellcheck disable=SC2154 # what expect.sh sets
: "${HR2D_SRCDIR:?names the source directory}"
. "$HR2D_SRCDIR/tests/program/cli/expect.sh"
for python in ${PYTHON-} python3 /usr/bin/python3 ''; do
  ! "$python" -c 'import jsonschema; jsonschema.Draft202012Validator' 2>/dev/null || break
done
if [ -z "$python" ]; then
  echo "skipped: no python3 has jsonschema"
  [ -n "${CI-}" ] && exit 1
  exit 77
fi
usage "there is no schema 'solv' (did you mean solve?)" schema solv
usage "'x' is one argument too many" schema solve x
usage "'schema' has no option --json" schema --json x
check "results and scenes are what the schemas say" "$python" "$HR2D_SRCDIR/tests/program/schemas.py" "$work"
summary schemas
