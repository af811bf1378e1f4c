#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# summary.sh BUILD: a line for each test that the last `make check` in BUILD ran, the ends of the
# logs of those that failed, then how many checks passed and failed.  A script counts as one check,
# and so does a program that ended without Check's summary.
set -eu
cd "$1"
results=$(find tests fuzz -name '*.trs' | sed 's|\.trs$||' | sort)
[ -n "$results" ] || { echo "0 passed, 1 failed"; exit 1; }

result_of() { sed -n 's/^:test-result: //p' "$1.trs"; }

counts=$(for test in $results; do
  line=$(grep -E '^[0-9]+%: Checks: ' "$test.log" | tail -n 1)
  echo "$test|$(result_of "$test")|$line"
done | awk -F '|' '
  { printf "%-40s %s\n", $1, $3 ? $3 : $2
    split($3, count, /[^0-9]+/)          # percent, checks, failures, errors
    bad = count[3] + count[4]
    if ($2 !~ /^(PASS|SKIP)/ && !bad) bad = 1
    passed += $3 ? count[2] - count[3] - count[4] : $2 ~ /^PASS/
    failed += bad }
  END { printf "%d passed, %d failed\n", passed, failed }')
echo "$counts" | sed '$d'

# Check writes failed assertions last.  With twenty lines a test, those of three are within the
# last hundred lines of a run.
for test in $results; do
  case $(result_of "$test") in
  PASS* | SKIP*) ;;
  *)
    printf '\n%s.log ends with:\n' "$test"
    tail -n 20 "$test.log" || echo "there is no such log"
    ;;
  esac
done

echo "$counts" | tail -n 1
case $counts in *", 0 failed") ;; *) exit 1 ;; esac
