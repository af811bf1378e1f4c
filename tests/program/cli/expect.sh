# SPDX-License-Identifier: GPL-3.0-or-later
# For the scripts that test the program: sourced, with HR2D_PROGRAM in the environment, and
# HR2D_BUILDDIR, where it was built, if it is libtool's wrapper.
: "${HR2D_PROGRAM:?names the program}"

# The program itself: libtool's wrapper opens files, forks, and takes longer than most runs.
if [ -x "${HR2D_BUILDDIR:-.}/libtool" ]; then
  HR2D_PROGRAM=$("${HR2D_BUILDDIR:-.}/libtool" --mode=execute echo "$HR2D_PROGRAM")
  LD_LIBRARY_PATH=${HR2D_BUILDDIR:-.}/.libs${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}
  export HR2D_PROGRAM LD_LIBRARY_PATH
fi
work=$(mktemp -d) || exit 99
trap 'rm -rf "$work"' EXIT
passed=0
failed=0

# check WHAT COMMAND...: counts whether the command succeeds
check() {
  what=$1
  shift
  if "$@"; then
    passed=$((passed + 1))
  else
    failed=$((failed + 1))
    echo "FAILED: $what"
  fi
}

hr2d() {
  "$HR2D_PROGRAM" "$@"
}

# run ARGUMENTS...: runs the program; its status and streams are kept
run() {
  hr2d "$@" >"$work/out" 2>"$work/err" </dev/null
  status=$?
}

# expect STATUS REGEX ARGUMENTS...: status, and one line on stderr that matches
matches() {
  [ "$status" -eq "$1" ] && [ "$(wc -l <"$work/err")" -eq 1 ] && grep -q -e "$2" "$work/err"
}
expect() {
  wanted=$1
  message=$2
  shift 2
  run "$@"
  check "hr2d $* -> $wanted, $message; was $status, $(head -n 1 "$work/err")" \
    matches "$wanted" "$message"
}
usage() {
  message=$1
  shift
  expect 2 "^hr2d: $message.*; try 'hr2d\( [a-z]*\)\{0,1\} --help'\$" "$@"
}
succeeds() {
  run "$@"
  check "hr2d $* -> 0; was $status, $(head -n 1 "$work/err")" [ "$status" -eq 0 ]
}

near() { # near VALUE REFERENCE RELATIVE
  awk -v x="$1" -v y="$2" -v e="$3" \
    'BEGIN { d = x - y; if (d < 0) d = -d; if (y < 0) y = -y; exit !(d <= e * y) }'
}
small() { # small VALUE BOUND
  awk -v x="$1" -v e="$2" 'BEGIN { if (x < 0) x = -x; exit !(x == x + 0 && x <= e) }'
}
lacks() {
  ! grep -q -e "$1" "$2"
}
magic() { # magic FILE HEX
  [ "$(od -An -tx1 -N4 "$1" | tr -d ' \n')" = "$2" ]
}

# summary NAME: at the end; the outcome is that of the script
summary() {
  echo "$1: $passed passed, $failed failed"
  [ "$failed" -eq 0 ]
}
