#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# The storeys of src/ and tools/ hold; src/LAYERS and tools/LAYERS name them.
#
# - A file includes headers of its own folder, of the folders before it in LAYERS, and public ones.
# - Its object calls no function of a later folder.
# - No two files call each other in a circle.
# - No two headers of src/ declare a function of the same name.
# - doc/architecture.md has the number of storeys of src/, and each of them in a table, in order.
#
# Each rule has a negative control: a planted fault has to be found.
set -eu
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# includes TREE: the includes that break the rule, a line each.
includes() (
  cd "$1"
  find . -name '*.[ch]' | sort | xargs awk '
    FILENAME == "LAYERS" { if (!/^#/ && NF) storey[$1] = ++n; next }
    FNR == 1 {
      file = own = substr(FILENAME, 3)
      if (!sub("/[^/]*$", "", own)) own = "."
      if (!(own in storey)) print file ": its folder is not in LAYERS"
    }
    /^ *# *include *"/ {
      split($0, quoted, "\"")
      header = to = quoted[2]
      sub("/.*", "", to)
      if (header == "config.h") next
      if (header !~ "/") print file ": \"" header "\" names no folder"
      else if (!(to in storey) || storey[to] > storey[own]) print file ": may not include " header
      else if ((getline line < header) < 0) print file ": this tree has no " header
      close(header)
    }' LAYERS
)

# calls FOLDER SOURCES: a line "CALLER CALLED SYMBOL" for each symbol that an object in the folder
# takes from another one.  Objects lie in .libs/ if no static library is built; those without a
# source are left over from before a move.
calls() (
  cd "$1"
  objects=$(find . -name '*.o' ! -path '*/.libs/*' | sort)
  [ -n "$objects" ] || objects=$(find . -name '*.o' | sort)
  for object in $objects; do
    echo "$object"
  done | sed 'h; s|/\.libs/|/|; s|/[^/-]*hr2d[^/-]*-\([^/]*\)\.o$|/\1|; s|\.o$||
      s|^\./\(.*/\)|\1|; G; s|\n| |' |
    while read -r file object; do
      [ ! -f "$2/$file.c" ] || echo "$object $file"
    done >"$work/files"
  # /dev/null makes nm print the name of a single object, too.
  cut -d ' ' -f 1 "$work/files" | xargs ${NM:-nm} /dev/null 2>/dev/null | awk -v files="$work/files" '
    BEGIN { while ((getline line < files) > 0) { split(line, part, " "); of[part[1] ":"] = part[2] } }
    $1 in of { file = of[$1]; next }
    { sub(/^[0-9a-f]* */, "") }
    $1 ~ /^[TDBRC]$/ { home[$2] = file }
    $1 == "U" { n++; caller[n] = file; symbol[n] = $2 }
    END {
      for (k = 1; k <= n; k++)
        if (symbol[k] in home) print caller[k], home[symbol[k]], symbol[k]
    }'
)

# upward LAYERS CALLS: the calls that go to a later folder.
upward() {
  awk -v layers="$1" '
    BEGIN { while ((getline line < layers) > 0) if (line !~ /^#/) storey[line] = ++n }
    { split($1, from, "/"); split($2, to, "/") }
    storey[to[1]] > storey[from[1]] { print $1 " calls " $3 "() of " $2 }' "$2"
}

# circles CALLS: the files that call each other in a circle.
circles() {
  cut -d ' ' -f 1,2 "$1" | { tsort >/dev/null || true; } 2>&1
}

# homonyms TREE: the functions that more than one header declares.
homonyms() {
  find "$1" -name '*.h' | while read -r header; do
    sed -n 's/^[a-z].*[ *]\(hr2di_[a-z0-9_]*\)(.*/\1/p' "$header" | sort -u
  done | sort | uniq -d
}

# differs LAYERS PAGE: where the page, its number and its table, differs from LAYERS.
differs() {
  grep '^[^#]' "$1" >"$work/storeys"
  grep -q "^| .src/. .* $(wc -l <"$work/storeys") storeys" "$2" ||
    echo "LAYERS has $(wc -l <"$work/storeys") storeys"
  awk '/^\| storey/ { on = 1; next } !/^\|/ { on = 0 } on' "$2" |
    sed -n 's/^| .\([a-z]*\). |.*/\1/p' | diff "$work/storeys" - || true
}

status=0
# none WHAT FILE: the file is empty.
none() {
  [ ! -s "$2" ] || { sed "s|^|$1: |" "$2" >&2; status=1; }
}
# some WHAT TEXT FILE: the file has the text, as a fault was planted.
some() {
  grep -q -e "$2" "$3" || { echo "$1 was planted and not found" >&2; status=1; }
}

for tree in src tools; do
  layers=$HR2D_SRCDIR/$tree/LAYERS calls=$work/$tree-calls
  includes "$HR2D_SRCDIR/$tree" >"$work/found"
  none "include in $tree" "$work/found"
  calls "$HR2D_BUILDDIR/$tree" "$HR2D_SRCDIR/$tree" >"$calls"
  upward "$layers" "$calls" >"$work/found"
  none "call in $tree" "$work/found"
  circles "$calls" >"$work/found"
  none "circle in $tree" "$work/found"
  [ "$(wc -l <"$calls")" -gt 100 ] || { echo "$tree has too few calls" >&2; status=1; }
  echo "$tree: $(grep -c '^[^#]' "$layers") storeys, $(wc -l <"$calls") calls between files"
done
homonyms "$HR2D_SRCDIR/src" >"$work/found"
none "function of two headers" "$work/found"

page=$HR2D_SRCDIR/doc/architecture.md
differs "$HR2D_SRCDIR/src/LAYERS" "$page" >"$work/found"
none "$page" "$work/found"
differs "$HR2D_SRCDIR/tools/LAYERS" "$page" >"$work/found"
some "another number of storeys" "LAYERS has" "$work/found"
sed '/^| .occlusion. |/d' "$page" >"$work/page"
differs "$HR2D_SRCDIR/src/LAYERS" "$work/page" >"$work/found"
some "a table without a storey" "< occlusion" "$work/found"

# plant FILE TEXT: one file with one include in a tree of its own.
plant() {
  rm -rf "$work/planted"
  mkdir -p "$work/planted/${1%/*}"
  cp "$HR2D_SRCDIR/tools/LAYERS" "$work/planted"
  echo "#include \"$2\"" >"$work/planted/$1"
  includes "$work/planted" >"$work/found"
}
plant output/planted.c run/run.h
some "an include of a later folder" "output/planted.c: may not include run/run.h" "$work/found"
plant run/planted.c alloc.h
some "an include without a folder" "names no folder" "$work/found"
plant run/planted.c base/alloc.h
some "an include of a folder of src/" "may not include base/alloc.h" "$work/found"
plant cost/planted.c solve/equation.h
some "a header of src/ in a folder of the same name" "has no solve/equation.h" "$work/found"
plant other/planted.c output/csv.h
some "a folder that is not in LAYERS" "not in LAYERS" "$work/found"

# object FILE CALLED: an object with one function, which is called like the file and calls another.
object() {
  mkdir -p "$work/planted/${1%/*}"
  echo "void $2(void); void ${1#*/}(void); void ${1#*/}(void) { $2(); }" >"$work/planted/$1.c"
  $CC -c -o "$work/planted/${1%/*}/hr2d-${1#*/}.o" "$work/planted/$1.c"
}
object output/sooner later
object pair/later sooner
calls "$work/planted" "$work/planted" >"$work/calls"
upward "$HR2D_SRCDIR/tools/LAYERS" "$work/calls" >"$work/found"
some "a call of a later folder" "output/sooner calls later() of pair/later" "$work/found"
circles "$work/calls" >"$work/found"
some "a circle" "pair/later" "$work/found"
echo "double hr2di_dot(const double *u);" >"$work/planted/output/sooner.h"
echo "static inline int hr2di_dot(int u) { return u; }" >"$work/planted/pair/later.h"
homonyms "$work/planted" >"$work/found"
some "a function of two headers" "hr2di_dot" "$work/found"

exit $status
