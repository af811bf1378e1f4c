#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Completions for bash, zsh and fish offer the commands and options of the program.  A shell that
# is not there is left out.
#
# Environment: HR2D_PROGRAM, the program; HR2D_SRCDIR, the top of the sources.
# shellcheck disable=SC2154 # what expect.sh sets
: "${HR2D_SRCDIR:?names the source directory}"
. "$HR2D_SRCDIR/tests/program/cli/expect.sh"
folder=$(cd "$HR2D_SRCDIR/tools/completions" && pwd)
case $HR2D_PROGRAM in /*) ;; *) HR2D_PROGRAM=$PWD/$HR2D_PROGRAM ;; esac
! libraries=$(cd "${HR2D_BUILDDIR:-.}/.libs" 2>/dev/null && pwd) || export LD_LIBRARY_PATH="$libraries"
# As it is called in the completed line.
mkdir "$work/bin" "$work/here"
printf '#!/bin/sh\nexec "%s" "$@"\n' "$HR2D_PROGRAM" >"$work/bin/hr2d"
chmod +x "$work/bin/hr2d"
PATH=$work/bin:$PATH
cd "$work/here" || exit 99
touch room.geojson

# listed COMMAND: its options as --help lists them
listed() {
  "$HR2D_PROGRAM" help "$1" | sed -n 's/^  \(--[a-z0-9-]*\).*/\1/p' | sort
}

# in_bash WORD...: what bash offers for the last word
in_bash() {
  bash --norc -c '. "$0/bash/hr2d"
    COMP_WORDS=("$@") COMP_CWORD=$(($# - 1))
    _hr2d hr2d "${@: -1}" "${@: -2:1}"
    [ ${#COMPREPLY[@]} = 0 ] || printf "%s\n" "${COMPREPLY[@]}"' "$folder" "$@"
}
# in_fish WORD...: what fish offers for the last word
in_fish() {
  # shellcheck disable=SC2016
  fish --no-config -c 'source $argv[1]/hr2d.fish; complete -C "$argv[2..]"' "$folder" "$@" |
    sed 's/\t.*//' | grep -v '^$'
}
offers() { # offers SHELL EXPECTED WORD...: the expected words, in any order
  shell=$1
  expected=$2
  shift 2
  [ "$("in_$shell" "$@" | sort | tr '\n' ' ')" = "$expected" ]
}

for shell in bash fish; do
  command -v $shell >/dev/null || { echo "not tried: $shell" && continue; }
  check "$shell: commands" offers $shell 'schema solve study ' hr2d s
  check "$shell: commands of help" offers $shell 'factors field ' hr2d help f
  check "$shell: options" offers $shell '--max-elements --max-level --max-links ' hr2d solve --max
  check "$shell: a scene" offers $shell 'room.geojson ' hr2d solve roo
  check "$shell: a file of an option" offers $shell 'room.geojson ' hr2d solve --json roo
  check "$shell: no options of other commands" offers $shell '' hr2d info --eps
  for command in info solve study cost factors field pair schema; do
    "in_$shell" hr2d $command -- | grep -vx -e --help | sort >"$work/offered"
    listed $command >"$work/listed"
    check "$shell: all options of $command: $(diff "$work/listed" "$work/offered")" \
      cmp -s "$work/listed" "$work/offered"
  done
done
if command -v bash >/dev/null; then
  check "bash: a number is not completed" offers bash '' hr2d solve --eps roo
fi

# in_zsh KEYS WANTED: what zsh shows after KEYS and Tab, up to WANTED
cat >"$work/complete.zsh" <<'END'
zmodload zsh/zpty
zpty z zsh -f -i
zpty -w z "PS1=; fpath=($1 \$fpath); autoload -U compinit; compinit -u -D; print REA''DY"
zpty -r -m z shown '*READY*'
zpty -w -n z "$2"$'\t'
for k in {1..100}; do
  sleep .1
  while zpty -r -t z shown; do seen+=$shown; done
  [[ $seen == *$3* ]] && break
done
print -r -- "$seen"
zpty -d z
END
in_zsh() {
  zsh -f "$work/complete.zsh" "$folder" "$1" "$2"
}
if command -v zsh >/dev/null && zsh -f -c 'zmodload zsh/zpty' 2>/dev/null; then
  completes() {
    in_zsh "$1" "$2" | grep -q -e "$2"
  }
  check "zsh: a command" completes 'hr2d fie' 'hr2d field'
  check "zsh: an option" completes 'hr2d solve --target' 'hr2d solve --target-error'
  check "zsh: a scene" completes 'hr2d solve roo' 'hr2d solve room.geojson'
else
  echo "not tried: zsh"
fi

summary check-completion
