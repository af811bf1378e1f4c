# SPDX-License-Identifier: GPL-3.0-or-later
# Sourced by check-program-faults.sh: interrupts at random moments, once and twice.

draw() { # draw MOST: $after is a number below it
  seed=$(awk -v s="$seed" 'BEGIN { print (s * 16807) % 2147483647 }')
  after=$(awk -v s="$seed" -v m="$1" 'BEGIN { printf "%.4f", s / 2147483647 * m }')
}
seconds_of() { # seconds_of COMMAND
  start=$(date +%s.%N)
  # shellcheck disable=SC2046
  run $(arguments "$1")
  date +%s.%N | awk -v s="$start" '{ print $1 - s }'
}
# Before the work starts nothing is there to be cleaned up: the signal ends the program.
ended() { # ended SIGNAL
  case $status in
  0) [ ! -s "$work/err" ] ;;
  130) [ ! -s "$work/err" ] || grep -q '^hr2d: .*interrupted$' "$work/err" ;;
  129 | 143) [ ! -s "$work/err" ] ;;
  *) return 1 ;;
  esac
}
# Signals are as at login, whatever started this script, as far as env can see to that.
clean=
! env --default-signal=INT,TERM,HUP true 2>/dev/null || clean='env --default-signal=INT,TERM,HUP'
interrupt() { # interrupt SIGNAL SECONDS FLAG ARGUMENTS...
  signal=$1
  after=$2
  flag=$3
  shift 3
  # shellcheck disable=SC2086
  $clean timeout --preserve-status $flag -s "$signal" "$after" "$HR2D_PROGRAM" "$@" \
    >"$work/out" 2>"$work/err" </dev/null
  status=$?
}

interrupted=0
for command in solve target stages study cost factors; do
  undisturbed $command
  most=$(seconds_of $command)
  for _ in $(seq "$(share 5)"); do
    for signal in INT TERM HUP; do
      # With --foreground it comes once, else twice.
      for flag in --foreground ''; do
        draw "$most"
        make_old
        # shellcheck disable=SC2046
        interrupt $signal "$after" "$flag" $(arguments $command)
        check "$command, SIG$signal after $after s: ends as it should; $(said)" ended
        check "$command, SIG$signal after $after s: what is there is whole" whole
        [ "$status" -eq 0 ] || interrupted=$((interrupted + 1))
      done
    done
  done
done
echo "$interrupted runs were interrupted"

# The long ones, as long as they work and as long as they write.  Undisturbed they would take
# minutes, so that one that does not end is noticed whatever the machine is busy with; how soon a
# stop acts tests/faults/check-polls.c counts, without a clock.
ends_soon() { # ends_soon SIGNAL FLAG ARGUMENTS...
  signal=$1
  flag=$2
  shift 2
  start=$(date +%s)
  interrupt "$signal" 0.7 "$flag" "$@"
  check "$* ends after SIG$signal" [ $(($(date +%s) - start)) -le 60 ]
  check "$* ends with 130; $(said)" [ "$status" -eq 130 ]
  check "$* says so; $(said)" [ "$(grep -c '^hr2d: .*interrupted$' "$work/err")" -eq 1 ]
  check "$* leaves no file" untouched
}
make_old
ends_soon INT --foreground solve "$scene" --eps 1e-5 --max-level 16 --csv "$new/x.csv"
ends_soon TERM --foreground cost "$scenes/partition.geojson" --max-seconds 100 --json "$new/x.json"
ends_soon HUP --foreground solve "$scenes/occluders-200.geojson" --target-error 1e-10 --json "$new/x.json"
ends_soon INT '' solve "$scene" --eps 1e-5 --max-level 16 --csv "$new/x.csv"
if [ -n "$plot" ]; then
  mkdir "$work/bin"
  printf '#!/bin/sh\nexec sleep 3\n' >"$work/bin/gnuplot"
  chmod 700 "$work/bin/gnuplot"
  PATH=$work/bin:$PATH
  ends_soon TERM --foreground study "$scene" --steps 2 --quiet --plot "$new/x.svg"
fi
# A target that is missed is told before the field is looked at, 16 million views.
make_old
: >"$work/err" # what the run before said is not what this one says
"$HR2D_PROGRAM" field "$scenes/screened-room.geojson" --target-error 1e-18 --grid 4000x4000 \
  --csv "$new/x.csv" >"$work/out" 2>"$work/err" </dev/null &
child=$!
for _ in $(seq 600); do
  [ ! -s "$work/err" ] || break
  sleep 0.1
done
kill -TERM "$child"
wait "$child"
status=$?
check "a target is missed; $(said)" grep -q '; the error is about ' "$work/err"
check "an interrupt after that ends with 130; $(said)" [ "$status" -eq 130 ]
make_old
trap '' HUP
"$HR2D_PROGRAM" solve "$scene" --eps 0.005 --no-error --json "$new/x.json" \
  >"$work/out" 2>"$work/err" </dev/null &
child=$!
sleep 0.1
kill -HUP "$child"
wait "$child"
status=$?
trap - HUP
check "what is ignored stays so, as under nohup; $(said)" [ "$status" -eq 0 ]
