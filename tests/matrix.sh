#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# matrix.sh [SETTING...]: builds libhr2d with each setting, in matrix/SETTING below the current
# directory, and runs its tests; without a SETTING it takes all of `every` below.  doc/testing.md
# says what each setting is for and what was measured.  The last line is the number of checks that
# passed and failed.
#
# Environment: HR2D_TEST_MULTIPLIER, 0.1 unless set; HR2D_MATRIX_TESTS, the suites to run instead
# of those of the setting.
set -u
source=$(cd "$(dirname "$0")/.." && pwd)
every="gcc-O0 gcc-O1 gcc-O2 gcc-O3-native gcc-lto gcc-fortify gcc-one-thread gcc-no-avx2
  clang-O0 clang-O1 clang-O2 clang-O3-native sanitized thread digits"
jobs=$(nproc 2>/dev/null || echo 1)
passed=0 failed=0
export HR2D_TEST_MULTIPLIER="${HR2D_TEST_MULTIPLIER-0.1}"

# The suites in which the library or the application has several threads, the longest one first;
# check-team has a pthread_create() of its own, which the sanitizer cannot do without.
threaded="tests/unit/clusters/check-clusters.c \
tests/threads/check-threads.c tests/unit/refine/check-refine.c \
tests/unit/refine/check-rows.c tests/unit/solve/check-slices.c \
tests/unit/solve/check-order.c tests/unit/solve/check-solve.c \
tests/unit/visibility/check-exchange-matrix.c tests/unit/visibility/check-exchange-rows.c \
tests/unit/visibility/check-back-visibility.c tests/unit/blocks/check-blocks.c"

# build SETTING CONFIGURE-ARGUMENT...
build() {
  configured "$@" && make -C "matrix/$1" -s -j"$jobs" >"matrix/$1/make.log"
}

configured() {
  folder=matrix/$1
  shift
  rm -rf "$folder"
  mkdir -p "$folder"
  (cd "$folder" && "$source/configure" --quiet --enable-werror "$@" >configure.log)
}

# The objects of the suites that are named: each one adds itself to the program.
objects_of() {
  for suite in tests/suites.c "$@"; do
    echo "${suite%/*}/check_suites-$(basename "$suite" .c).o"
  done
}

# run SETTING SUITES: all tests if there are none.  The program of the library is not built for
# suites that are named, nor other suites.
run() {
  folder=matrix/$1 bad=0 goal=check
  tests=${HR2D_MATRIX_TESTS:-$2}
  [ -z "$tests" ] || goal=check-TESTS
  # shellcheck disable=SC2086 # names are words
  make -C "$folder" -s -j"$jobs" $goal \
    ${tests:+TESTS="$tests" check_PROGRAMS=tests/check-suites} \
    ${tests:+tests_check_suites_OBJECTS="$(objects_of $tests | paste -sd ' ')"} \
    >"$folder/check.log" 2>&1 || bad=1
  sh "$source/tests/summary.sh" "$folder" >"$folder/summary" || bad=1
  [ $bad = 0 ] || cat "$folder/tests/test-suite.log" "$folder/check.log"
  sed '$d' "$folder/summary"
  count=$(tail -n 1 "$folder/summary")
  passed=$((passed + ${count%% *}))
  count=${count#*, }
  failed=$((failed + ${count%% *}))
  return $bad
}

# tested SETTING CONFIGURE-ARGUMENT...
tested() {
  build "$@" && run "$1" ""
}

# What ThreadSanitizer makes of a program with RACE=1 or 0 races: it finds it, and invents none.
control() {
  clang -g -O1 -pthread -fsanitize=thread -DRACE="$1" "$source/tests/threads/race.c" \
    -o matrix/thread/race || return 1
  matrix/thread/race >matrix/thread/race.log 2>&1
  if [ $? = 0 ] && [ "$1" = 0 ]; then return 0; fi
  if grep -q 'data race .*race\.c:' matrix/thread/race.log && [ "$1" = 1 ]; then return 0; fi
  echo "ThreadSanitizer does not see what it should in a program with $1 races:"
  cat matrix/thread/race.log
  return 1
}

# Without a long history reports are dropped whose earlier access is forgotten.
thread() {
  export TSAN_OPTIONS=history_size=7:halt_on_error=1
  configured thread CC=clang CFLAGS='-g -O1' --enable-sanitizers=thread --disable-shared &&
    control 0 && control 1 && run thread "$threaded"
}

# 32-bit x86 with its headers and libraries of the same name: in a chroot, or where
# PKG_CONFIG_LIBDIR finds them.
m32() {
  tested gcc-m32 CC='gcc -m32' CXX='g++ -m32' CFLAGS='-g -O2 -msse2 -mfpmath=sse'
}

# The programs that the settings before have left print the same numbers.
digits() {
  sh "$source/tests/digits.sh" matrix/*/tools/hr2d
}

setting() {
  case $1 in
  # At link time gcc sees less of what is initialised when than it does in a file.
  gcc-lto) tested "$1" CC=gcc CFLAGS='-g -O3 -flto' --disable-shared --disable-werror ;;
  gcc-fortify)
    tested "$1" CC=gcc CFLAGS='-g -O2' CPPFLAGS='-U_FORTIFY_SOURCE -D_FORTIFY_SOURCE=3'
    ;;
  gcc-one-thread) tested "$1" CC=gcc --disable-threads ;;
  gcc-no-avx2) tested "$1" CC=gcc --disable-avx2 ;;
  gcc-m32) m32 ;;
  *-O3-native) tested "$1" CC="${1%%-*}" CFLAGS='-g -O3 -march=native' ;;
  gcc-O[0-3] | clang-O[0-3]) tested "$1" CC="${1%-*}" CFLAGS="-g -${1#*-}" ;;
  sanitized) tested "$1" --enable-sanitizers --disable-shared CFLAGS='-g -O1' ;;
  thread) thread ;;
  digits) digits ;;
  *) echo "matrix.sh: there is no setting '$1', only $every gcc-m32" >&2 && return 2 ;;
  esac
}

# shellcheck disable=SC2086 # names are words
[ $# -gt 0 ] || set -- $every
for name; do
  start=$(date +%s)
  echo "=== $name"
  before=$failed
  if setting "$name"; then colour=green; else colour=RED; fi
  [ $colour = green ] || [ "$failed" -gt "$before" ] || failed=$((failed + 1))
  echo "--- $name: $colour, $(($(date +%s) - start)) s"
done
echo "$passed passed, $failed failed"
exit $((failed > 0))
