#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# The library and the program have the marks of what configure's summary calls hardening, and a
# program that is made without it has none of them.
set -eu
if [ -z "$HR2D_HARDENING" ]; then
  echo "configured without hardening"
  exit 77
fi
if ! command -v readelf >/dev/null; then
  echo "there is no readelf"
  exit 77
fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# marks FILE: the flags of configure that can be seen in a file.  A stack protector calls
# __stack_chk_fail(), a checked copy __memcpy_chk() and the like.
marks() {
  readelf -lW "$1" >"$work/segments"
  readelf -dW "$1" >"$work/dynamic"
  readelf -W --dyn-syms "$1" | grep ' UND ' >"$work/imports" || true
  ! grep -q '__stack_chk_fail' "$work/imports" || echo '-fstack-protector-strong'
  ! grep '__[a-z]*_chk' "$work/imports" | grep -qv __stack_chk || echo '-D_FORTIFY_SOURCE'
  ! grep -q GNU_RELRO "$work/segments" || echo '-Wl,-z,relro'
  ! grep -Eq 'BIND_NOW|FLAGS_1.* NOW' "$work/dynamic" || echo '-Wl,-z,now'
  ! grep -q 'GNU_STACK.* RW  ' "$work/segments" || echo '-Wl,-z,noexecstack'
}

# A level is not seen, nor what the protection of jumps and of the stack's end adds to functions.
for flag in $HR2D_HARDENING; do
  case $flag in -fstack-clash-protection | -fcf-protection) ;; *) echo "${flag%=[0-9]}" ;; esac
done | sort >"$work/expected"

status=0
# With shared libraries tools/hr2d is a script that starts tools/.libs/hr2d.
for file in "$HR2D_BUILDDIR"/.libs/libhr2d.so "$HR2D_BUILDDIR"/tools/.libs/hr2d \
  "$HR2D_BUILDDIR"/tools/hr2d; do
  readelf -h "$file" >/dev/null 2>&1 || continue
  files="${files-} ${file##*/}"
  marks "$file" | sort >"$work/found"
  if comm -23 "$work/expected" "$work/found" | grep . >"$work/missing"; then
    sed "s|^|no mark in $file of |" "$work/missing" >&2
    status=1
  fi
done
if [ -z "${files-}" ]; then
  echo "neither library nor program is an ELF file"
  exit 77
fi

cat >"$work/plain.c" <<'C'
#include <stdio.h>
#include <string.h>
int main(int argc, char **argv) {
  char text[16];
  strcpy(text, argv[argc - 1]);
  return printf("%s\n", text) < 0;
}
C
# shellcheck disable=SC2086 # CC may have options
$CC -w -O2 -fno-stack-protector -U_FORTIFY_SOURCE -Wl,-z,norelro -Wl,-z,lazy -Wl,-z,execstack \
  -o "$work/plain" "$work/plain.c"
if marks "$work/plain" | grep . >"$work/found"; then
  sed 's/^/a program without hardening has the mark of /' "$work/found" >&2
  status=1
fi
echo "$(wc -l <"$work/expected") marks of$files"
exit $status
