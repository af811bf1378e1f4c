#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# A long solve that is stopped in the middle goes on from its last stage, with the same bits;
# a state that does not fit is refused and left alone.
#
# Environment: HR2D_PROGRAM, the program; HR2D_SRCDIR, the top of the sources.
# shellcheck disable=SC2154 # what expect.sh sets
: "${HR2D_SRCDIR:?names the source directory}"
scenes=${HR2D_SCENES:-$HR2D_SRCDIR/examples/scenes}
. "$HR2D_SRCDIR/tests/program/cli/expect.sh"
room=$scenes/lit-room.geojson
state=$work/state

stages() { # stages EPS ARGUMENTS...
  eps=$1
  shift
  run solve "$room" --no-error --quiet --multigrid 1:0.5 --eps "$eps" "$@"
}
unchanged() {
  cmp -s "$state" "$work/copy"
}
lacks_bits() {
  ! cmp -s "$1" "$2"
}
keep() {
  cp "$state" "$work/copy"
}

# ---- what the usage is
usage "'info' has no option --state" info "$room" --state x
usage "--state: the file name is empty" solve "$room" --state ''
usage "--state wants a file that can be read back" solve "$room" --state -
usage "--target-error and --state exclude each other" \
  solve "$room" --target-error 1e-3 --state x
usage "two outputs go to 'x'" solve "$room" --state x --json x
expect 1 "^hr2d: $work/no/s: cannot be written" solve "$room" --state "$work/no/s"

# ---- stopped by a budget: the state of the last whole stage stays
stages 0.01 --csv "$work/through.csv"
check "a run without a state; was $status" [ "$status" -eq 0 ]
stages 0.01 --state "$state" --max-links 200000 --csv "$work/cut.csv"
check "a budget ends it; was $status" [ "$status" -eq 1 ]
check "and says where the state is" \
  grep -q "^hr2d: $state: has the state of epsilon 0.[0-9]*, to go on from\$" "$work/err"
check "and writes no result" [ ! -e "$work/cut.csv" ]
keep
stages 0.01 --state "$state" --csv "$work/resumed.csv"
check "it goes on; was $status" [ "$status" -eq 0 ]
check "with the same bits" cmp -s "$work/through.csv" "$work/resumed.csv"
check "and keeps the next state" [ "$(wc -c <"$state")" -gt "$(wc -c <"$work/copy")" ]
run solve "$room" --no-error --multigrid 1:0.5 --eps 0.01 --state "$state" --csv "$work/again.csv"
check "what is done is made once more" \
  grep -q "^          from epsilon 0.01 in $state\$" "$work/out"
check "with the same bits, too" cmp -s "$work/through.csv" "$work/again.csv"
run solve "$room" --no-error --multigrid 1:0.5 --eps 0.01 --state "$state" --no-closure \
  --csv "$work/open.csv"
check "but with other options it is another one" lacks_bits "$work/through.csv" "$work/open.csv"

# ---- what does not fit
keep
refused() { # refused MESSAGE ARGUMENTS...
  message=$1
  shift
  expect 1 "^hr2d: $state: $message\$" "$@" --quiet --state "$state"
  check "and the state is left alone" unchanged
}
refused 'is the state of epsilon 0.01, which is finer than --eps 0.1' solve "$room"
refused 'the state is that of another scene' solve "$scenes/partition.geojson" --eps 1e-3
refused 'the state was made with another oracle or policy' solve "$room" --eps 1e-3 --oracle l1
refused 'the state was made with another oracle or policy' \
  solve "$room" --eps 1e-3 --variant modified
head -c 100000 "$work/copy" >"$state"
keep
refused 'the state is damaged: it ends too early' solve "$room" --eps 0.01
printf 'garbage' >"$state"
keep
refused 'this is not a state, or not of this version' solve "$room" --eps 0.01
: >"$state"
keep
refused 'this is not a state, or not of this version' solve "$room" --eps 0.01
rm "$state"
stages 0.1 --state "$state"
printf 'x' >>"$state"
keep
refused 'something follows the state' solve "$room" --eps 0.01

# 143: before there was anything to be told.
ended() {
  [ "$status" -eq 130 ] || [ "$status" -eq 143 ] || [ "$status" -eq 0 ]
}

# ---- stopped by a signal, whenever: the file is whole, and the end is the same
rm "$state"
stages 0.008 --csv "$work/through.csv"
for delay in 0.05 0.1 0.2 0.3 0.4 0.5; do
  "$HR2D_PROGRAM" solve "$room" --no-error --quiet --multigrid 1:0.5 --eps 0.008 \
    --state "$state" --csv "$work/late.csv" >"$work/out" 2>"$work/err" &
  child=$!
  sleep "$delay"
  kill -TERM "$child" 2>/dev/null
  wait "$child"
  status=$?
  check "stopped or done; was $status" ended
done
check "no temporary file is left" [ -z "$(find "$work" -name '.hr2d-*')" ]
run solve "$room" --no-error --multigrid 1:0.5 --eps 0.008 --state "$state" \
  --csv "$work/resumed.csv"
check "goes on; was $status, $(head -n 1 "$work/err")" [ "$status" -eq 0 ]
# A signal may have come when the last stage was kept already; it is then made once more.
grep -q "^          from epsilon 0.008 in $state\$" "$work/out" ||
  check "the same bits again" cmp -s "$work/through.csv" "$work/resumed.csv"

summary check-resume
