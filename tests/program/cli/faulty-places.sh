# SPDX-License-Identifier: GPL-3.0-or-later
# Sourced by check-program-faults.sh: scenes that cannot be read, places that cannot be
# written, limits, pipes that close, a gnuplot that fails.

# ---- scenes
mkdir "$work/folder"
: >"$work/empty"
mkfifo "$work/pipe"
for command in info solve study cost factors; do
  expect 1 "^hr2d: $work/none: cannot open: ." $command "$work/none"
  expect 1 "^hr2d: $work/folder: cannot read: ." $command "$work/folder"
  expect 1 "^hr2d: $work/empty: ." $command "$work/empty"
  expect 1 "^hr2d: $work/empty/scene: cannot open: ." $command "$work/empty/scene"
  expect 1 "^hr2d: /dev/null: ." $command /dev/null
  cat "$scene" >"$work/pipe" &
  run $command "$work/pipe" --quiet --json "$work/x.json"
  check "$command reads a pipe; $(said)" [ "$status" -eq 0 ]
  wait $!
done
head -c 300 "$scene" >"$work/pipe" &
run info "$work/pipe"
check "a pipe that ends too soon" tells "$work/pipe"
wait $!
if [ "$(id -u)" -ne 0 ]; then
  cp "$scene" "$work/secret"
  chmod 0 "$work/secret"
  expect 1 "^hr2d: $work/secret: cannot open: Permission" info "$work/secret"
fi
# shellcheck disable=SC3045
limited() { # limited LIMIT ARGUMENTS...
  limit=$1
  shift
  # shellcheck disable=SC2086
  (ulimit $limit && exec "$HR2D_PROGRAM" "$@") >"$work/out" 2>"$work/err" </dev/null
  status=$?
}
limited '-v 300000' info "$scene"
if [ "$status" -eq 0 ]; then # a program with a sanitizer takes more
  limited '-v 300000' info /dev/zero
  check "a file beyond memory; $(said)" tells /dev/zero
  check "is called so" grep -q 'memory' "$work/err"
  awk 'BEGIN { printf "{\"a\": ["; for (k = 0; k < 2000000; k++) printf "[],"; print "0]}" }' \
    >"$work/large"
  limited '-v 150000' info "$work/large"
  check "a scene beyond memory; $(said)" tells "$work/large"
fi

# ---- places
for command in solve study factors; do
  for option in --json --csv; do
    expect 1 "^hr2d: $work/no/x: cannot be written: ." $command "$scene" $option "$work/no/x"
    expect 1 "^hr2d: $work/folder: cannot be written: ." $command "$scene" $option "$work/folder"
    expect 1 "^hr2d: $scene/x: cannot be written: ." $command "$scene" $option "$scene/x"
    mkfifo "$work/output"
    cat "$work/output" >"$work/copy" &
    run $command "$scene" --quiet $option "$work/output"
    check "$command $option into a pipe" [ "$status" -eq 0 -a -p "$work/output" ]
    wait $!
    check "is written" [ -s "$work/copy" ]
    rm "$work/output"
    echo old >"$work/far"
    ln -s far "$work/near"
    ln -s near "$work/nearer"
    succeeds $command "$scene" --quiet $option "$work/nearer"
    check "links stay links" [ -L "$work/nearer" -a -L "$work/near" -a ! -L "$work/far" ]
    check "and lead to the new file" lacks '^old$' "$work/far"
    rm "$work/far"
    succeeds $command "$scene" --quiet $option "$work/nearer"
    check "also to one that was not there" [ -L "$work/nearer" -a -L "$work/near" -a -s "$work/far" ]
    ln -sf no/x "$work/near"
    expect 1 "^hr2d: $work/nearer: cannot be written: ." $command "$scene" $option "$work/nearer"
    ln -sf near "$work/nearer"
    ln -sf nearer "$work/near"
    expect 1 "^hr2d: $work/nearer: cannot be written: ." $command "$scene" $option "$work/nearer"
    rm -f "$work/near" "$work/nearer" "$work/far"
  done
done
make_old
chmod 640 "$new/x.csv"
succeeds factors "$scene" --csv "$new/x.csv"
check "permissions stay" [ "$(stat -c %a "$new/x.csv")" = 640 ]
if [ "$(id -u)" -ne 0 ]; then
  chmod 440 "$new/x.json"
  expect 1 "^hr2d: $new/x.json: cannot be written: Permission" factors "$scene" --json "$new/x.json"
  check "a protected file stays" grep -qx old "$new/x.json"
  chmod 500 "$new"
  expect 1 "^hr2d: $new/x.pdf: cannot be written: Permission" factors "$scene" --json "$new/x.pdf"
  chmod 700 "$new"
fi

# ---- full disks: a limit stops a write in the middle, as a full disk does
for command in solve study cost factors; do
  undisturbed $command
  for blocks in 1 2 4 8 16 32; do
    make_old
    # shellcheck disable=SC2046
    limited "-f $blocks" $(arguments $command)
    check "$command, $blocks blocks: what is there is whole" whole
    [ "$status" -eq 0 ] || check "$command, $blocks blocks: it is told; $(said)" tells "$new/x.*"
  done
done
for command in solve study cost factors info pair; do
  case $command in
  pair) set -- pair ;;
  cost) set -- cost "$scene" --methods size --max-seconds 0.01 ;;
  *) set -- "$command" "$scene" ;;
  esac
  echo 0 0 1 0 1 1 0 1 >"$work/in"
  for target in /dev/full '&-'; do
    [ "$target" != /dev/full ] || [ -c /dev/full ] || continue
    eval "\"\$HR2D_PROGRAM\" \"\$@\" <\"\$work/in\" >$target 2>\"\$work/err\""
    status=$?
    check "$command >$target; $(said)" tells 'standard output'
  done
  "$HR2D_PROGRAM" "$@" <"$work/in" >"$work/out" 2>&-
  check "$command without standard error" [ $? -eq 0 ]
done
"$HR2D_PROGRAM" solve "$work/none" 2>&-
check "a failure without standard error" [ $? -eq 1 ]
"$HR2D_PROGRAM" pair <&- >"$work/out" 2>"$work/err"
status=$?
check "pair without standard input; $(said)" tells 'standard input'
"$HR2D_PROGRAM" factors "$scene" --quiet --csv "$work/x.csv" <&- >&- 2>&-
check "a file alone, without any stream" [ -s "$work/x.csv" ]

# ---- pipes that close
for output in --csv --json; do
  { "$HR2D_PROGRAM" solve "$scene" --eps 0.05 --no-error $output - 2>"$work/err"
    echo $? >"$work/status"; } | head -n 1 >"$work/out"
  status=$(cat "$work/status")
  # All may have gone into the pipe before it closed.
  [ "$status" -eq 0 ] || check "$output to a closed pipe; $(said)" tells -
done
{ sleep 0.3
  "$HR2D_PROGRAM" solve "$scene" --no-error --csv - 2>"$work/err"
  echo $? >"$work/status"; } | :
status=$(cat "$work/status")
check "a pipe closed from the start; $(said)" tells -

# ---- a gnuplot that fails
if [ -n "$plot" ]; then
  mkdir "$work/bin"
  plots() { # plots SCRIPT: runs a study with that as gnuplot
    printf '#!/bin/sh\n%s\n' "$1" >"$work/bin/gnuplot"
    chmod 700 "$work/bin/gnuplot"
    make_old
    PATH=$work/bin:$PATH "$HR2D_PROGRAM" study "$scene" --steps 2 --quiet \
      --plot "$new/x.svg" >"$work/out" 2>"$work/err"
    status=$?
  }
  fails() { # fails SCRIPT REGEX
    plots "$1"
    check "gnuplot: $1; $(said)" matches 1 "^hr2d: $new/x.svg: $2"
    check "the old plot stays" untouched
  }
  fails 'exit 1' 'gnuplot failed: no reason given$'
  fails 'echo boom >&2; exit 3' 'gnuplot failed: boom$'
  fails "cat >/dev/null; echo '<svg'; exit 1" 'gnuplot failed: no reason given$'
  fails "echo '<svg'; kill -9 \$\$" 'gnuplot failed: no reason given$'
  fails 'cat >/dev/null' 'gnuplot failed: no reason given$'
  fails 'exit 127' 'cannot be plotted: gnuplot is not installed$'
  plots "echo '<svg/>'"
  check "a gnuplot that does not read; $(said)" [ "$status" -eq 0 ]
  plots "head -c 200000 /dev/zero"
  check "a large plot; $(said)" [ "$status" -eq 0 -a "$(wc -c <"$new/x.svg")" -eq 200000 ]
  printf '#!/bin/sh\nexec cat /dev/zero\n' >"$work/bin/gnuplot"
  make_old
  (PATH=$work/bin:$PATH && ulimit -f 200 && exec "$HR2D_PROGRAM" study "$scene" --steps 2 \
    --quiet --plot "$new/x.svg") >"$work/out" 2>"$work/err"
  status=$?
  check "an endless plot on a disk that is not; $(said)" tells "$new/x.svg"
  check "leaves the old one" untouched
  # gnuplot itself does not look whether it could write, and ends with 0.
  printf '#!/bin/sh\ntrap "" XFSZ\nhead -c 300000 /dev/zero 2>/dev/null\nexit 0\n' >"$work/bin/gnuplot"
  make_old
  (PATH=$work/bin:$PATH && ulimit -f 200 && exec "$HR2D_PROGRAM" study "$scene" --steps 2 \
    --quiet --plot "$new/x.svg") >"$work/out" 2>"$work/err"
  status=$?
  check "a gnuplot that does not notice a full disk; $(said)" tells "$new/x.svg"
  check "leaves the old one, too" untouched
  chmod 600 "$work/bin/gnuplot"
  PATH=$work/bin "$HR2D_PROGRAM" study "$scene" --steps 2 --quiet --plot "$new/x.svg" \
    >"$work/out" 2>"$work/err"
  status=$?
  check "no gnuplot at all; $(said)" tells "$new/x.svg"
  check "the old plot stays" untouched
  rm -r "${work:?}/bin"
fi
