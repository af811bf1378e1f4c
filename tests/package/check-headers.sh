#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Each public header compiles alone, as C11 and as C++11, is reached through hr2d.h,
# and shows nothing of GSL, of jansson or of config.h.  The programs in hr2d.h and README.md
# compile, too.
set -eu
status=0
flags="-I$HR2D_BUILDDIR/include -I$HR2D_SRCDIR/include -Wall -Wextra -Wpedantic -Werror"

# compile LANGUAGE HEADER COMPILER...: the header alone, and twice.
compile() {
  language=$1 header=$2
  shift 2
  if ! printf '#include <%s>\n#include <%s>\ntypedef int not_empty;\n' "$header" "$header" |
    "$@" -fsyntax-only -x "$language" -; then
    echo "$header does not compile alone as $language" >&2
    status=1
  fi
}

for path in "$HR2D_SRCDIR"/include/hr2d/*.h "$HR2D_BUILDDIR/include/hr2d/version.h"; do
  header=hr2d/${path##*/}
  # Words of flags are meant to be split.
  # shellcheck disable=SC2086
  {
    compile c "$header" $CC -std=c11 -Wstrict-prototypes $flags
    [ -z "$CXX" ] || compile c++ "$header" $CXX -std=c++11 $flags
  }
  if grep -nE 'gsl_|<gsl/|jansson\.h|json_t|config\.h|HAVE_' "$path"; then
    echo "$header shows what it must not" >&2
    status=1
  fi
  if [ "$header" != hr2d/hr2d.h ] &&
    ! grep -q "^#include <$header>" "$HR2D_SRCDIR/include/hr2d/hr2d.h"; then
    echo "$header is not included by hr2d.h" >&2
    status=1
  fi
done

# program NAME FROM TO FILE: the text between two lines is a program that compiles.
program() {
  text=$(sed -n "/$2/,/$3/p" "$4" | sed '1d;$d; s/^ \* \{0,1\}//')
  case $text in *main*) ;; *) echo "$1 has no program" >&2; status=1 ;; esac
  # shellcheck disable=SC2086
  if ! printf '%s\n' "$text" | $CC -std=c11 $flags -fsyntax-only -x c -; then
    echo "the program in $1 does not compile" >&2
    status=1
  fi
}
program hr2d.h '@code' '@endcode' "$HR2D_SRCDIR/include/hr2d/hr2d.h"
program README.md '^```c$' '^```$' "$HR2D_SRCDIR/README.md"
exit $status
