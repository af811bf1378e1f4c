#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# run.sh SECONDS FOLDER: runs each harness for that long, on its corpus in FOLDER.  New inputs
# of interest go to fuzz/found, failing inputs to fuzz/fault-*.
seconds=$1
folder=$2
passed=0
failed=0
for harness in scene api pair; do
  mkdir -p "fuzz/found/$harness"
  dictionary=
  [ ! -f "$folder/$harness.dict" ] || dictionary=-dict=$folder/$harness.dict
  # Texts and sequences of calls as long as are worth the time.
  case $harness in scene) longest=6000 ;; *) longest=600 ;; esac
  log=fuzz/$harness.log
  # A unit of some seconds takes a minute and more on a machine with other work.
  if "fuzz/fuzz-$harness" ${dictionary:+"$dictionary"} -max_total_time="$seconds" \
    -max_len=$longest -timeout=200 -rss_limit_mb=2048 -print_final_stats=1 \
    -artifact_prefix="fuzz/fault-$harness-" "fuzz/found/$harness" "$folder/corpus/$harness" \
    >"$log" 2>&1; then
    passed=$((passed + 1))
  else
    failed=$((failed + 1))
    grep -v '^#' "$log" | tail -n 40
  fi
  runs=$(sed -n 's/^stat::number_of_executed_units: *//p' "$log")
  edges=$(sed -n 's/.* cov: \([0-9]*\) .*/\1/p' "$log" | tail -n 1)
  echo "fuzz-$harness: ${runs:-0} runs, ${edges:-0} edges"
done
echo "$passed passed, $failed failed"
[ "$failed" = 0 ]
