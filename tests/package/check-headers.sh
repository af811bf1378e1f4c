#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Each public header compiles alone, as C11 and as C++11, is reached through hr2d.h,
# and shows nothing of GSL, of jansson or of config.h.  The programs in hr2d.h and README.md
# compile, too.  Headers of unstable interface say so, and are those of doc/compatibility.md.
# Where CC is clang it compares their comments with what they declare.
set -eu
status=0
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
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

# ---- comments: a parameter that no function has
# shellcheck disable=SC2086
documented() { printf '%s\n' "$@" | $CC -std=c11 -fsyntax-only -Wdocumentation $flags -x c -; }
if documented 'int f(int x);' 2>/dev/null; then
  flags="$flags -Wdocumentation"
  if documented '/** @param y  none */' 'int f(int x);' 2>/dev/null; then
    echo "a parameter that a function does not have would not be found" >&2
    status=1
  fi
fi

for path in "$HR2D_SRCDIR"/include/hr2d/*.h "$HR2D_BUILDDIR/include/hr2d/version.h"; do
  header=hr2d/${path##*/}
  # Words of flags are meant to be split.
  # shellcheck disable=SC2086
  {
    compile c "$header" $CC -std=c11 -Wstrict-prototypes $flags
    [ -z "$CXX" ] || compile c++ "$header" $CXX -std=c++11 ${flags%-Wdocumentation}
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

# ---- unstable interface
# unstable FOLDER PAGE: the headers that say so and those of the table of the page, where these
# differ; and the ones that hr2d.h does not list, or does not include, behind all others.
# shellcheck disable=SC2016
unstable() {
  (cd "$1" && grep -l '^ \* @warning Unstable interface' ./*.h | sed 's|.*/||' | sort) >"$work/said"
  awk '/^\| unstable header/ { on = 1; next } !/^\|/ { on = 0 } on' "$2" |
    sed -n 's/^| `\([a-z]*\.h\)`.*/\1/p' | sort >"$work/listed"
  diff "$work/said" "$work/listed" | sed -n 's/^[<>]/one of header and page alone:/p'
  sed '1,/^ \* Unstable interface/d; /^ \*$/,$d' "$1/hr2d.h" |
    sed -n 's/^ \* - \([a-z]*\.h\):.*/\1/p' | sort >"$work/listed"
  diff "$work/said" "$work/listed" | sed -n 's/^[<>]/not in the list of hr2d.h:/p'
  sed '1,/^\/\* Unstable interface/d' "$1/hr2d.h" |
    sed -n 's/^#include <hr2d\/\(.*\)>/\1/p' | sort >"$work/listed"
  diff "$work/said" "$work/listed" | sed -n 's/^[<>]/not in the includes of hr2d.h:/p'
}
page=$HR2D_SRCDIR/doc/compatibility.md
unstable "$HR2D_SRCDIR/include/hr2d" "$page" >"$work/found"
[ ! -s "$work/found" ] || { cat "$work/found" >&2; status=1; }
[ -s "$work/said" ] || { echo "no header says that it is unstable" >&2; status=1; }

# finds WHAT TEXT PAGE: a fault in the copies of the headers is found.
finds() {
  unstable "$work/headers" "$3" >"$work/found"
  grep -q "$2" "$work/found" || { echo "not found: $1" >&2; status=1; }
}
fresh() {
  rm -rf "$work/headers"
  cp -R "$HR2D_SRCDIR/include/hr2d" "$work/headers"
  chmod -R u+w "$work/headers"
}
fresh
# shellcheck disable=SC2016
sed '/^| `share\.h`/d' "$page" >"$work/page.md"
finds "a header that the page lacks" 'page alone: share\.h' "$work/page.md"
sed -i 's/@warning Unstable interface/@warning/' "$work/headers/clusters.h"
finds "a header that does not say so" 'page alone: clusters\.h' "$page"
fresh
sed -i '/^ \* - transport\.h:/d' "$work/headers/hr2d.h"
finds "one that hr2d.h does not list" 'list of hr2d\.h: transport\.h' "$page"
fresh
sed -i '/^\/\* Unstable interface/,$s/share\.h/scene.h/' "$work/headers/hr2d.h"
finds "a stable one among the includes" 'includes of hr2d\.h: scene\.h' "$page"
exit $status
