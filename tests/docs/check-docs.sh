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

# ---- the gallery: each picture that its page shows is kept, and drawn by a command of the page
# gallery PAGE FOLDER: pictures that the page does not show, keep or draw as it should
gallery() {
  grep -o '](gallery/[^()]*)' "$1" | sed 's|.*gallery/||; s|)$||' | sort >"$work/shown"
  sed -n 's/^[$>].*--\(draw\|plot\|tiles\|watch\) \([^ ]*\).*/\2/p' "$1" | sort >"$work/drawn"
  (cd "$2" && ls) | sort >"$work/kept"
  diff "$work/shown" "$work/drawn" | sed -n 's/^</not drawn:/p; s/^>/not shown:/p'
  diff "$work/shown" "$work/kept" | sed -n 's/^</not kept:/p; s/^>/kept, not shown:/p'
  (cd "$HR2D_SRCDIR/doc/figures" && ls) | grep -xF -f "$work/kept" | sed 's/^/as in doc\/figures: /'
}
page=$HR2D_SRCDIR/doc/gallery.md
pictures=$HR2D_SRCDIR/doc/gallery
check "pictures of the gallery are those of its commands; not $(gallery "$page" "$pictures")" \
  [ -z "$(gallery "$page" "$pictures")" ]
sed 's/--draw walls.png/--draw wall.png/; /(gallery\/hall.png)/d' "$page" >"$work/page.md"
check "others would be found" [ "$(gallery "$work/page.md" "$pictures" | sort | tr '\n' ';')" = \
  'kept, not shown: hall.png;not drawn: walls.png;not shown: hall.png;not shown: wall.png;' ]

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

# ---- structs that can grow
# absent PAGE: those of the headers that the tables of the page do not have
absent() {
  awk '/^typedef struct/ { name = $3 } / size_t struct_size;/ { print name }' \
    "$HR2D_SRCDIR"/include/hr2d/*.h | while read -r name; do
    grep -q "^|.*\`$name\`" "$1" || echo "$name"
  done
}
compatibility=$HR2D_SRCDIR/doc/compatibility.md
check "doc/compatibility.md has all structs that can grow; not $(absent "$compatibility")" \
  [ -z "$(absent "$compatibility")" ]
sed 's/`hr2d_beam`//' "$compatibility" >"$work/page.md"
check "one that it lacks would be found" [ "$(absent "$work/page.md")" = hr2d_beam ]

# ---- links
# astray PAGE...: links of pages, by their paths from the top, that lead to no file
astray() {
  for page; do
    grep -o '\[[^][]*\]([^()]*)' "$page" | sed 's/.*](//; s/[)#].*//' | grep -v -e '^$' -e '^[a-z]*:' |
      while read -r link; do
        [ -e "$(dirname "$page")/$link" ] || echo "$page: $link"
      done
  done
}
cd "$HR2D_SRCDIR" || exit 99
# shellcheck disable=SC2046
check "links of pages lead to files; not: $(astray $(cat "$work/pages"))" \
  [ -z "$(astray $(cat "$work/pages"))" ]
printf '[a](page.md) and [b](none.md#x), [c](https://d.e)\n' >"$work/page.md"
check "one that does not would be found" \
  [ "$(astray "$work/page.md")" = "$work/page.md: none.md" ]

# nowhere PAGE...: paths of this tree in code that lead to no file, and to no program made of one
nowhere() {
  for page; do
    grep -o '`\(src\|include\|tools\|tests\|bench\|petsc\|python\)/[A-Za-z0-9_./-]*`' "$page" |
      tr -d '`' | while read -r path; do
      [ -e "$path" ] || [ -e "$path.c" ] || echo "$page: $path"
    done
  done
}
# shellcheck disable=SC2046
check "paths in pages lead to files; not: $(nowhere $(cat "$work/pages"))" \
  [ -z "$(nowhere $(cat "$work/pages"))" ]

# unnamed FILE...: names of C files without a folder, in code of pages and in comments, that no file
# has; room.c is the reader's own.
find src include tools tests bench petsc fuzz examples -name '*.[ch]' | sed 's|.*/||' | sort -u >"$work/names"
unnamed() {
  for file; do
    case $file in
    *.md) grep -o '`[a-z0-9][a-z0-9-]*\.[ch]`' "$file" | tr -d '`' ;;
    *) grep -oE '(^|[ (])[a-z0-9]+(-[a-z0-9]+)+\.[ch]\b' "$file" | tr -d ' (' ;;
    esac | grep -vxF -e room.c -f "$work/names" | sed "s|^|$file: |"
  done
}
find src -name '*.[ch]' >"$work/sources"
# shellcheck disable=SC2046
check "names of files exist; not: $(unnamed $(cat "$work/pages" "$work/sources"))" \
  [ -z "$(unnamed $(cat "$work/pages" "$work/sources"))" ]
# shellcheck disable=SC2016
printf '`no-such.c` and `walls.h`\n' >"$work/named.md"
check "one that does not would be found" [ "$(unnamed "$work/named.md")" = "$work/named.md: no-such.c" ]
# shellcheck disable=SC2016
printf '`src/LAYERS`, `bench/rows` and `src/none.c`\n' >"$work/page.md"
check "one that does not would be found" \
  [ "$(nowhere "$work/page.md")" = "$work/page.md: src/none.c" ]

# misnumbered PAGE: equations whose numbers do not count from 1 on, and numbers of no equation
misnumbered() {
  awk '
    /^    .* \([0-9]+\)$/ {
      number = $NF
      if (number != "(" ++n ")") print number " is equation " n
      next
    }
    { text = text " " $0 }
    END {
      if (n == 0) print "no equations"
      while (match(text, /[^a-z0-9_^]\([0-9][0-9]?\)/)) {
        number = substr(text, RSTART + 2, RLENGTH - 3)
        if (number + 0 > n || number + 0 == 0) print "there is no (" number ")"
        text = substr(text, RSTART + RLENGTH)
      }
    }' "$1" | sed -n '1p'
}
check "equations of doc/method.md have their numbers; not: $(misnumbered doc/method.md)" \
  [ -z "$(misnumbered doc/method.md)" ]
printf '    a = b   (1)\n    c = d   (3)\n' >"$work/page.md"
check "a wrong number would be found" [ "$(misnumbered "$work/page.md")" = "(3) is equation 2" ]
printf '    a = b   (1)\nBy (2)\n' >"$work/page.md"
check "the number of no equation would be found" \
  [ "$(misnumbered "$work/page.md")" = "there is no (2)" ]

# nameless PAGE: words of the glossary without a name in the literature, a meaning or a place
nameless() {
  awk -F ' *[|] *' '
    /^## / { on = /Glossary/ }
    on && /^[|]/ && (NF < 6 || !$3 || !$4 || !$5) { print $2 }' "$1"
}
architecture=doc/architecture.md
check "the glossary has all names; not of: $(nameless $architecture)" \
  [ -z "$(nameless $architecture)" ]
sed 's/^| patch | [^|]* |/| patch | |/' $architecture >"$work/page.md"
check "a word without one would be found" [ "$(nameless "$work/page.md")" = patch ]

# outgrown PAGE: the lines of src/ that the page names, if they are not within a tenth of today's
outgrown() {
  today=$(cat src/*/*.[ch] | wc -l)
  page_lines=$(sed -n 's/.*`src\/` had \([0-9,]*\) lines.*/\1/p' "$1" | tr -d ,)
  if [ "$((${page_lines:-0} * 10))" -lt "$((today * 9))" ] ||
    [ "$((${page_lines:-0} * 10))" -gt "$((today * 11))" ]; then
    echo "${page_lines:-none} for $today"
  fi
}
check "the coverage of doc/testing.md is of today's src/; not $(outgrown doc/testing.md)" \
  [ -z "$(outgrown doc/testing.md)" ]
sed 's/`src\/` had [0-9,]* lines/`src\/` had 10,169 lines/' doc/testing.md >"$work/page.md"
check "a table of less code would be found" [ -n "$(outgrown "$work/page.md")" ]

# unlisted LIST: pages that doc/README.md, the menu of the site, does not have
unlisted() {
  grep -v -e '^doc/README.md' -e '^doc/figures/' "$work/pages" | while read -r page; do
    case $page in
    doc/*) grep -q -F "](${page#doc/})" "$1" ;;
    *) grep -q -F "](../$page)" "$1" ;;
    esac || echo "$page"
  done
}
check "doc/README.md lists all pages; not $(unlisted doc/README.md)" \
  [ -z "$(unlisted doc/README.md)" ]
grep -v vs2 doc/README.md >"$work/page.md"
check "a page that is not in it would be found" \
  [ "$(unlisted "$work/page.md")" = doc/tutorial/vs2.md ]

# `make doc` looks at the links of the site.
leads() {
  mkdir -p "$work/site" && echo '<a id="there"></a>' >"$work/site/b.html"
  echo "$1" >"$work/site/a.html"
  awk -f doc/check-links.awk "$work"/site/*.html "$work"/site/*.html 2>"$work/found"
}
leads_astray() {
  ! leads "$1"
}
check "links that lead somewhere" \
  leads '<a href="b.html#there">, <a href="#here" id="here">, <a href="https://a.b/c">'
for link in '<a href="c.html">' '<a href="b.html#here">' '<a href="#there">' '<img src="c.png">' \
  '<script src="https://a.b/c.js">' '<link href="https://a.b/c.css">' 'no link'; do
  check "would be found: $link" leads_astray "$link"
done

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
page '```' '$ true' '```'
check "a block that is neither a file nor commands would be found" is_refused
page 'a file' '```json' '{}' '```'
check "a file without a name would be found" is_refused
page '```console' '$ exit 0' '$ false' '```'
check "a command that ends the shell would be found" is_refused
page '```console' '$ true'
check "a block without an end would be found" is_refused

summary check-docs
