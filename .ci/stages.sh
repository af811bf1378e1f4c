# SPDX-License-Identifier: GPL-3.0-or-later
# shellcheck shell=bash
# What .ci/run, .ci/deep and .ci/machine have in common; they begin at the top of the tree.
jobs=$(nproc)
passed=0
times=()
export CONFIGURE_FLAGS=--enable-werror # of the tree of ./bootstrap

finish() {
  printf '%s\n' "${times[@]}" "$(printf '%6d s in all' "$SECONDS")"
  echo "$passed passed, $1 failed"
  exit $(($1 > 0))
}

# stage TITLE COMMAND...: if the command's last line counts checks, these are added
# up, else the stage counts as one.
stage() {
  local title=$1 log=build-ci-$$.log status=0 last start=$SECONDS aside_took=
  shift
  echo "=== $title"
  TIMEFORMAT="--- $title: %0R s, of processors %0U s and %0S s for the system"
  time { "$@" 2>&1 | tee "$log"; } || status=1
  last=$(tail -n 1 "$log")
  rm -f "$log"
  [ ! -f build-ci-aside.took ] || aside_took=", $(cat build-ci-aside.took) s beside others"
  rm -f build-ci-aside.took
  times+=("$(printf '%6d s %s%s' $((SECONDS - start)) "$title" "$aside_took")")
  [ $status = 0 ] || times[-1]+=": RED"
  [ $status = 0 ] || echo "--- $title: RED"
  if [[ $last =~ ^([0-9]+)\ passed,\ ([0-9]+)\ failed$ ]]; then
    passed=$((passed + BASH_REMATCH[1]))
    [ $status = 0 ] || finish $((BASH_REMATCH[2] > 0 ? BASH_REMATCH[2] : 1))
  else
    [ $status = 0 ] || finish 1
    passed=$((passed + 1))
  fi
}

# What has begun ends with this script.
trap 'kill $(jobs -p) 2>/dev/null' EXIT

# begin COMMAND...: what often leaves a processor idle, beside the stages after it; `join` ends it.
begin() {
  local start=$SECONDS
  rm -f build-ci-aside.*
  {
    "$@" >build-ci-aside.log 2>&1
    echo $? >build-ci-aside.status
    echo $((SECONDS - start)) >build-ci-aside.seconds
  } &
  aside=$!
}

# Stages are in pipes, and so in other shells than what has begun.
join() {
  local status
  tail --pid="$aside" -f /dev/null
  status=$(cat build-ci-aside.status) || status=1
  cat build-ci-aside.log
  mv build-ci-aside.seconds build-ci-aside.took
  rm -f build-ci-aside.{log,status}
  return "$status"
}

# suite FOLDER TARGET [VARIABLE=VALUE]: runs the tests of a tree that is built and counts them.
suite() {
  local status=0
  find "$1" -name '*.trs' -delete
  make -C "$1" -s -j"$jobs" "${@:2}" VERBOSE=1 || status=1
  sh tests/summary.sh "$1" || status=1
  return "$status"
}

# configured FOLDER CONFIGURE-ARGUMENT...: a fresh tree.
configured() {
  local folder=$1
  shift
  rm -rf "$folder" && mkdir "$folder" && (cd "$folder" && ../configure --quiet "$@")
}

# build FOLDER CONFIGURE-ARGUMENT...: a fresh tree with its library and programs.
build() {
  configured "$@" && make -C "$1" -s -j"$jobs" >/dev/null
}

