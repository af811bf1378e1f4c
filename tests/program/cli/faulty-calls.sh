# SPDX-License-Identifier: GPL-3.0-or-later
# Sourced by check-program-faults.sh: the k-th call of the system fails, for each k that
# touches a file of ours, by strace(1).

trace() { # trace OPTIONS ARGUMENTS...
  options=$1
  shift
  # A leak checker would want to be a tracer itself.
  # shellcheck disable=SC2086
  ASAN_OPTIONS=${ASAN_OPTIONS:+$ASAN_OPTIONS:}detect_leaks=0 \
    strace -y -qq $options -o "$work/log" "$HR2D_PROGRAM" "$@" >"$work/out" 2>"$work/err" \
    </dev/null
  status=$?
}
calls() { # calls CALL: the numbers of those that touch our files, in the log
  awk -v call="$1" -v folder="$work/" '
    index($0, call "(") == 1 { n++; if (index($0, folder)) print n }' "$work/log"
}
some_of() { # some_of MOST: so many of the numbers that come in, at equal distances
  awk -v most="$1" '{ line[NR] = $0 }
    END { step = NR > most ? NR / most : 1; for (k = 0; k < NR && k < most; k++)
          print line[1 + int(k * step)] }'
}
fault() { # fault COMMAND CALL K ERROR
  make_old
  # shellcheck disable=SC2046
  trace "-e trace=$2 -e inject=$2:error=$4:when=$3" $(arguments "$1")
  check "$1, $2 $3 $4: what is there is whole" whole
  if [ "$status" -eq 0 ]; then
    check "$1, $2 $3 $4: nothing old is left" every_one_new
  else
    check "$1, $2 $3 $4: it is told; $(said)" tells "\($new/x.*\|$scene\|standard output\)"
  fi
}
every_one_new() {
  for file in $(arguments "$command"); do
    case $file in "$new"/*) lacks '^old$' "$file" || return 1 ;; esac
  done
}

if strace -qq -e trace=read -e inject=read:error=EIO:when=65535 -o /dev/null true 2>/dev/null; then
  faults=0
  for command in solve target stages study cost factors; do
    undisturbed $command
    # shellcheck disable=SC2046
    trace '-e trace=openat,read,write,fsync,fchmod,rename,close' $(arguments $command)
    cp "$work/log" "$work/calls"
    check "$command can be traced; $(said)" [ "$status" -eq 0 ]
    for pair in openat:EMFILE openat:EINTR read:EIO write:ENOSPC write:EINTR fchmod:EPERM \
      fsync:EIO rename:EACCES close:EIO; do
      call=${pair%:*}
      cp "$work/calls" "$work/log"
      for k in $(calls "$call" | some_of "$(share 3)"); do
        fault $command "$call" "$k" "${pair#*:}"
        faults=$((faults + 1))
      done
    done
  done
  # A file system that cannot tell whether it has written is no reason to fail.
  undisturbed factors
  make_old
  # shellcheck disable=SC2046
  trace '-e trace=fsync -e inject=fsync:error=EINVAL' $(arguments factors)
  check "fsync that is not supported; $(said)" [ "$status" -eq 0 ]
  check "and the files are there" every_one_new
  echo "$faults calls failed"
else
  echo "skipped: calls of the system that fail, which takes a strace(1) that may trace"
fi
