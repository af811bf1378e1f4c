#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# One table has the options of the program, tools/cli/option-table.c.  The parser, --help and the
# manual page agree with it: a new option that one of them lacks is found here.
#
# Environment: HR2D_PROGRAM, the program; HR2D_SRCDIR, the top of the sources.
# shellcheck disable=SC2154 # what expect.sh sets
: "${HR2D_SRCDIR:?names the source directory}"
. "$HR2D_SRCDIR/tests/program/cli/expect.sh"
manual=$HR2D_SRCDIR/tools/hr2d.1
commands="info solve study cost factors field pair schema"

sed -n 's/^ *{"\([a-z0-9-]*\)", .*GROUP_.*/\1/p' "$HR2D_SRCDIR/tools/cli/option-table.c" |
  sort >"$work/table"
check "the table is read" [ "$(wc -l <"$work/table")" -ge 39 ]
check "each option is in it once" [ -z "$(uniq -d "$work/table")" ]

# takes COMMAND OPTION: whether the parser does not refuse the option for this command
takes() {
  run "$1" "--$2"
  ! grep -q 'lacks its argument' "$work/err" || run "$1" "--$2=x"
  ! grep -q -e "has no option --$2 (of" -e 'unknown option' "$work/err"
}
for command in $commands; do
  while read -r option; do
    ! takes "$command" "$option" || echo "$option"
  done <"$work/table" >"$work/$command"
done
for option in help version; do
  for command in $commands; do
    check "$command takes --$option" grep -qx "$option" "$work/$command"
  done
  check "the manual page has --$option" grep -q -e "\\\\-\\\\-$option" "$manual"
done
while read -r option; do
  check "some command takes --$option" grep -qx "$option" "$work/info" "$work/solve" \
    "$work/study" "$work/cost" "$work/factors" "$work/field" "$work/pair"
done <"$work/table"

# ---- --help lists the options that a command takes, in two columns
columns_are_aligned() {
  awk '/^For example:/ { exit }
       !/^  --/ && !begun { next }
       { begun = 1 }
       /^$/ || /^[a-z ,]*:$/ { next }
       /^  --/ { match($0, /^  --[^ ]+( [^ ]+)? +/) }
       !/^  --/ { match($0, /^ */) }
       RLENGTH != 24 { bad = 1 }
       END { exit bad || !begun }' "$1"
}
for command in $commands; do
  [ "$command" != schema ] || continue # it has no options
  succeeds "$command" --help
  check "columns of '$command --help'" columns_are_aligned "$work/out"
  sed -n 's/^  --\([a-z0-9-]*\).*/\1/p' "$work/out" | sort >"$work/listed"
  grep -vx -e help -e version "$work/$command" >"$work/taken"
  check "'$command --help' lists what $command takes: $(diff "$work/taken" "$work/listed")" \
    cmp -s "$work/taken" "$work/listed"
done
are_crooked() {
  ! columns_are_aligned "$1"
}
succeeds solve --help
sed -i 's/^  --eps E /  --eps E/' "$work/out"
check "crooked columns would be found" are_crooked "$work/out"

# ---- the manual page has each option under each command that takes it
# documented MANUAL: lines "COMMAND OPTION".  An entry is for the commands that the heading of its
# section names, all if it names none, and for those in its text.  A paragraph of a section may
# name options of other sections.
documented() {
  sed 's/\\-/-/g; s/\\f.//g' "$1" | awk -v commands="$commands" '
    function names(text, name) { return (" " text " ") ~ ("[^a-z-]" name "[^a-z-]") }
    function flush(k, o, c) {
      for (k = 1; k <= n; k++) for (o in own)
        if (section[command[k]] || names(text, command[k])) print command[k], o
      while (loose && match(text, /--[a-z0-9-]+/)) {
        o = substr(text, RSTART + 2, RLENGTH - 2)
        text = substr(text, RSTART + RLENGTH)
        for (k = 1; k <= n; k++) if (section[command[k]]) print command[k], o
      }
      split("", own); text = ""; loose = tag = 0
    }
    BEGIN { n = split(commands, command, " ") }
    /^\.SH/ { flush(); inside = /OPTIONS/; next }
    !inside { next }
    /^\.SS/ {
      flush(); some = 0
      for (k = 1; k <= n; k++) some += section[command[k]] = names(tolower($0), command[k])
      for (k = 1; k <= n; k++) if (!some) section[command[k]] = 1
      next
    }
    /^\.PP/ { flush(); loose = 1; next }
    /^\.TP/ { flush(); tag = 1; next }
    /^\.TQ/ { tag = 1; next }
    tag { rest = $0
          while (match(rest, /--[a-z0-9-]+/)) { own[substr(rest, RSTART + 2, RLENGTH - 2)] = 1
                                                rest = substr(rest, RSTART + RLENGTH) }
          tag = 0; next }
    { text = text " " $0 }
    END { flush() }' | sort -u
}
missing() { # missing MANUAL: the options that the program takes and the page does not have
  documented "$1" >"$work/documented"
  for command in $commands; do
    grep -vx -e help -e version "$work/$command" | sed "s/^/$command /"
  done | sort | comm -23 - "$work/documented"
}
unknown() { # unknown FILE: the options that the text names and the table does not have
  sed 's/\\-/-/g; s/\\f.//g' "$1" | grep -o -e '--[a-z][a-z0-9-]*' | sed 's/^--//' | sort -u |
    comm -23 - "$work/table"
}
check "the manual page has all options; it lacks $(missing "$manual")" [ -z "$(missing "$manual")" ]
check "and no others; it has $(unknown "$manual")" [ -z "$(unknown "$manual")" ]
for command in "" $commands; do
  # shellcheck disable=SC2086
  succeeds $command --help
  check "'$command --help' names no other option; $(unknown "$work/out")" \
    [ -z "$(unknown "$work/out")" ]
done

# Without these, a page that lacks an option, or has one too many, would pass.
for option in steps max-level; do
  sed "s/\\\\-\\\\-$(echo "$option" | sed 's/-/\\\\-/g')/&x/" "$manual" >"$work/other.1"
  check "a page without --$option would be found" [ -n "$(missing "$work/other.1")" ]
  check "and with --${option}x" [ "$(unknown "$work/other.1")" = "${option}x" ]
done

summary check-help
