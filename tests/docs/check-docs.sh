#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# What README.md and the pages of doc/ tell a reader to save and to run does what they show.
# check-python.sh runs the pages with Python.  A page that draws is not run where the program
# cannot draw; where CI is set, that is a failure.
#
# Environment: HR2D_PROGRAM, the program; HR2D_SRCDIR and HR2D_BUILDDIR, the tops of the sources and
# of the build; CC and HR2D_CFLAGS, the compiler.
# shellcheck disable=SC2154 # what expect.sh sets
: "${HR2D_SRCDIR:?names the source directory}"
. "$HR2D_SRCDIR/tests/program/cli/expect.sh"
. "$HR2D_SRCDIR/tests/docs/pages.sh"
make_reader "$work/bin"

# ---- all pages
run solve "$HR2D_SRCDIR/examples/scenes/corner.geojson" --quiet --draw "$work/x.svg"
drawing=$status
missing() { # missing PAGE: what the page needs and this machine does not have
  if grep -q '^[$>] .*--draw' "$1" && [ "$drawing" -ne 0 ]; then echo cairo; fi
  if grep -q '^[$>] .*--plot' "$1" && ! command -v gnuplot >/dev/null; then echo gnuplot; fi
}
all_pages >"$work/pages"
while read -r page; do
  needs_python "$HR2D_SRCDIR/$page" && continue
  lack=$(missing "$HR2D_SRCDIR/$page")
  if [ -n "$lack" ] && [ -z "${CI-}" ]; then
    echo "not run: $page, for want of $lack"
  else
    check "$page shows what happens" run_page "$HR2D_SRCDIR/$page" "$work/page"
  fi
done <"$work/pages"
check "there are pages" [ "$(wc -l <"$work/pages")" -ge 25 ]

# ---- commands that are shown and not run name commands and options that exist
# unknown PAGE...: options of `hr2d COMMAND` in code, which the program does not know
unknown() {
  awk '
    /^```console/ { skip = 1 }
    /^```/ && !/console/ { skip = 0 }
    skip { next }
    /^    .*\\$/ { sub(/\\$/, ""); held = held $0; next }
    { $0 = held $0; held = "" }
    /^    +hr2d [a-z]/ { sub(/^ +/, ""); print; next }
    { while (match($0, /`hr2d [a-z][^`]*`/)) {
        print substr($0, RSTART + 1, RLENGTH - 2)
        $0 = substr($0, RSTART + RLENGTH) } }' "$@" |
    while read -r program command rest; do
      "$program" "$command" --help >"$work/help" 2>&1 || echo "$program $command"
      for word in $(echo "$rest" | grep -o -e '--[a-z][a-z-]*'); do
        grep -q -e "^  $word\\>" -e "^  --[a-z-]*, $word\\>" "$work/help" ||
          [ "$word" = --help ] || echo "$program $command $word"
      done
    done
}
(cd "$HR2D_SRCDIR" && tr '\n' '\0' <"$work/pages" | xargs -0 cat) >"$work/all.md"
check "all options exist; not: $(unknown "$work/all.md")" [ -z "$(unknown "$work/all.md")" ]
# shellcheck disable=SC2016
printf '    hr2d solve SCENE \\\n      --epps 2\nand `hr2d sulve X`\n' >"$work/page.md"
check "an option that does not exist would be found" \
  [ "$(unknown "$work/page.md" | tr '\n' ,)" = 'hr2d solve --epps,hr2d sulve,' ]

# ---- without these, a page with mistakes would pass
page() { # page LINE...
  printf '%s\n' "$@" >"$work/page.md"
}
good() {
  page 'Save `a.c`:' '```c' "$1" '```' '' '```console' \
    '$ cc a.c -o a $(pkg-config --cflags --libs hr2d) &&' '>   ./a' "$2" \
    '$ hr2d info examples/scenes/corner.geojson |' '>   grep bands' "$3" \
    '$ hr2d info none.geojson' "$4" '$ echo $?' "$5" '```'
}
program='#include <hr2d/hr2d.h>
#include <stdio.h>
int main(void) { printf("%g\n", HR2D_FLOOR); }'
no_file='hr2d: none.geojson: cannot open: No such file or directory'
passes() {
  run_page "$work/page.md" "$work/page"
}
is_refused() {
  ! passes >"$work/found" 2>&1
}
good "$program" 1e-06 "$(printf 'bands         1\n  bands            off  one band')" "$no_file" 1
check "a page without mistakes" passes
good "$program" 1e-... ... 'hr2d: ...: No such ...' 1
check "with numbers left out" passes
wrong() { # wrong WHAT ARGUMENTS-OF-GOOD...
  what=$1
  shift
  good "$@"
  check "$what would be found" is_refused
}
wrong "a program that is none" 'int main(void) { return x; }' 1e-06 ... ... 1
wrong "a wrong number" "$program" 1e-07 ... ... 1
wrong "a number that is not printed" "$program" "$(printf '1e-06\n1')" ... ... 1
wrong "a number that is not shown" "$program" "" ... ... 1
wrong "a wrong number behind others" "$program" 1e-06 "bands ... 2
..." ... 1
wrong "too few lines" "$program" 1e-06 "bands ... 1" ... 1
wrong "a line too many" "$program" 1e-06 "$(printf '...\none more')" ... 1
wrong "another exit status" "$program" 1e-06 ... ... 2
page '```console' '$ hr2d info none.geojson' "$no_file" '```'
check "a command that fails unseen would be found" is_refused
page '```console' 'hr2d info none.geojson' '```'
check "a command without a prompt would be found" is_refused
page 'a file' '```json' '{}' '```'
check "a file without a name would be found" is_refused
page '```console' '$ exit 0' '$ false' '```'
check "a command that ends the shell would be found" is_refused
page '```console' '$ true'
check "a block without an end would be found" is_refused

summary check-docs
