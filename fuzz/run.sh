#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# run.sh SECONDS FOLDER [HARNESS]: runs each harness for that long, on its corpus in FOLDER, as
# many at a time as there are processors.  New inputs of interest go to fuzz/found, failing inputs
# to fuzz/fault-*.  With a HARNESS it runs this one alone.
seconds=$1
folder=$2

# The last line of what it prints tells whether the harness HARNESS found anything.
run() {
  harness=$1
  mkdir -p "fuzz/found/$harness"
  dictionary=
  [ ! -f "$folder/$harness.dict" ] || dictionary=-dict=$folder/$harness.dict
  # Texts and sequences of calls as long as are worth the time.
  case $harness in scene) longest=6000 ;; state) longest=3000 ;; *) longest=600 ;; esac
  log=fuzz/$harness.log
  result=passed
  # A unit of some seconds takes a minute and more on a machine with other work.
  if ! "fuzz/fuzz-$harness" ${dictionary:+"$dictionary"} -max_total_time="$seconds" \
    -max_len=$longest -timeout=200 -rss_limit_mb=2048 -print_final_stats=1 \
    -artifact_prefix="fuzz/fault-$harness-" "fuzz/found/$harness" "$folder/corpus/$harness" \
    >"$log" 2>&1; then
    result=failed
    grep -v '^#' "$log" | tail -n 40
  fi
  runs=$(sed -n 's/^stat::number_of_executed_units: *//p' "$log")
  edges=$(sed -n 's/.* cov: \([0-9]*\) .*/\1/p' "$log" | tail -n 1)
  echo "fuzz-$harness $result: ${runs:-0} runs, ${edges:-0} edges"
}

if [ $# -gt 2 ]; then
  run "$3"
  [ $result = passed ]
  exit
fi
# A harness that is killed prints no result, and has failed.
reports=fuzz/reports
set -- scene state api pair
printf '%s\n' "$@" |
  xargs -P "$(nproc 2>/dev/null || echo 1)" -n 1 sh "$0" "$seconds" "$folder" >$reports
cat $reports
passed=$(grep -c '^fuzz-[a-z]* passed: ' $reports)
rm $reports
echo "$passed passed, $(($# - passed)) failed"
[ "$passed" = $# ]
