#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# compile-commands.sh SRCDIR TARGET...: a JSON compilation database of the build in the current
# directory, on standard output.  `make compile_commands.json` runs it.
#
# Nothing is compiled and no tool is needed: `make -n` says how it would compile the targets if
# all C files had just changed.  What libtool, and the tracking of dependencies, put around the
# compiler is taken off.  Environment: MAKE.
set -eu
srcdir=$1
shift
directory=$(pwd)

# As make names them: without ./ in front in a build inside of the source tree.
changed=$(cd "$srcdir" && find bench examples fuzz src tests tools -name '*.c' | sort |
  sed "s|.*|-W $srcdir/&|; s|-W \\./|-W |")
# Words of options are meant to be split.
# shellcheck disable=SC2086
"${MAKE:-make}" -n --no-print-directory V=1 $changed "$@" |
  awk -v directory="$directory" -v srcdir="$srcdir" '
    function quoted(text) {
      gsub(/\\/, "\\\\", text)
      gsub(/"/, "\\\"", text)
      return "\"" text "\""
    }
    / -c -o .*\.c/ {
      command = $0
      sub(/ *(&&|;)? *\\$/, "", command)
      sub(/.* --mode=compile +/, "", command)
      sub(/.*depcomp +/, "", command)
      sub(/ -MT [^ ]+ -MD -MP -MF [^ ]+/, "", command)
      file = command
      sub(/.*[ `]/, "", file)
      if (command ~ /`[^`]*`[^`]*$/) {
        sub(/`[^`]*`[^`]*$/, "", command)
        file = srcdir "/" file
        command = command file
      }
      printf "%s\n  { \"directory\": %s,\n    \"command\": %s,\n    \"file\": %s }", \
        n++ ? "," : "[", quoted(directory), quoted(command), quoted(file)
    }
    END { print n ? "\n]" : "[]"; exit n == 0 }'
