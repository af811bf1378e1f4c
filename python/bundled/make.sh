#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# make.sh SRCDIR OUT LIBS: a wheel in OUT that carries libhr2d, GSL and jansson.
#
# It is the package as pip builds it against any libhr2d; only the file for pkg-config is another one,
# which names static libraries.  Run by `make wheel` in the top of the build.  Environment: PYTHON,
# PKG_CONFIG, VERSION.
set -eu
source=$1 out=$2 libs=$3
top=$(pwd)
if [ ! -e .libs/libhr2d.so ]; then
  echo "make wheel: configure made no shared library, so the objects do not fit into an extension" >&2
  exit 1
fi
rm -rf "$out"
mkdir -p "$out/source" "$out/pkg-config"
(cd "$source/python" && cp -r hr2d README.md hr2d-convert.1 ./*.py pyproject.toml "$top/$out/source")
cp "$source/COPYING" "$source/python/bundled/NOTICE" "$out/source"
chmod -R u+w "$out/source"

# The first interpreter that has what the package is built with; another python3 may come first in PATH.
# If there is none, the last one says what it lacks.
for python in ${PYTHON-} python3 /usr/bin/python3; do
  ! (cd "$out/source" && PYTHONDONTWRITEBYTECODE=1 "$python" -c 'import hr2d_backend, pip') 2>/dev/null || break
done

# Only archives and -l:libNAME.a: with -lNAME the linker would take shared libraries.  What is in the
# archives stays hidden, so that another GSL in the process is neither used nor replaced.  See streams.c for
# what is wrapped.
archives=$(printf '%s\n' "$libs" | sed 's/ -lm\>//g; s/ -l\([^ :]*\)/ -l:lib\1.a/g')
cat >"$out/pkg-config/hr2d-uninstalled.pc" <<PC
archives=$top/.libs/libhr2d-core.a$archives $top/python/.libs/libstreams.a
wrapped=-Wl,--wrap=stdin,--wrap=stdout,--wrap=stderr
linker=-Wl,--exclude-libs,ALL,-z,text,-z,now,-s
Name: hr2d
Description: the static library in its build folder, with all that it needs
Version: $VERSION
Libs: \${archives} \${wrapped} \${linker} -lm -pthread
Cflags: -I$top/include -I$source/include
PC
PKG_CONFIG_PATH="$top/$out/pkg-config" "$python" -m pip wheel --quiet --no-build-isolation --no-index \
  --no-deps --no-cache-dir --disable-pip-version-check --wheel-dir "$out" "$out/source"
rm -r "$out/source" "$out/pkg-config"
ls "$out"/*.whl
