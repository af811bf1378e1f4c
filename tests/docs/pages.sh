# SPDX-License-Identifier: GPL-3.0-or-later
# shellcheck shell=sh
# For the scripts that test the pages: sourced, with HR2D_SRCDIR, HR2D_BUILDDIR, HR2D_PROGRAM and
# CC in the environment.
: "${HR2D_SRCDIR:?names the source directory}" "${HR2D_BUILDDIR:?names the build directory}"
: "${HR2D_PROGRAM:?names the program}" "${CC:=cc}"

# all_pages: README.md, the pages of doc/ and the ones below it, from the top.
all_pages() {
  (cd "$HR2D_SRCDIR" && find README.md CODE_OF_CONDUCT.md CONTRIBUTING.md SECURITY.md doc examples -name '*.md' |
    LC_ALL=C sort)
}

# needs_python PAGE: whether a reader runs Python on it.
needs_python() {
  grep -q '^\$ python3 ' "$1"
}

# make_reader FOLDER: the commands of a reader: hr2d, cc and pkg-config with the library that was
# just built.
make_reader() {
  mkdir -p "$1"
  # By its path: a cc of this folder would call itself.
  compiler=$(command -v "${CC%% *}")${CC#"${CC%% *}"}
  printf '#!/bin/sh\nexec %s "$@" %s\n' "$compiler" "${HR2D_CFLAGS-}" >"$1/cc"
  chmod +x "$1/cc"
  export PATH="$1:${HR2D_PROGRAM%/*}:$PATH"
  export PKG_CONFIG_PATH="$HR2D_BUILDDIR${PKG_CONFIG_PATH:+:$PKG_CONFIG_PATH}"
  export LD_LIBRARY_PATH="$HR2D_BUILDDIR/.libs${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}"
}

# returns STATUS: what $? is for the next command
returns() {
  return "$1"
}

# run_page PAGE FOLDER: whether everything that the page shows is so.
run_page() {
  rm -rf "$2" && read_page "$1" "$2" && [ -e "$2/end" ]
}

# The reader has an empty folder, with examples/ in it; one shell runs all commands.
read_page() (
  set +eu
  page=$1 work=$2 result=0 last=0
  mkdir -p "$work/steps" "$work/reader"
  awk -v out="$work/steps" -f "$HR2D_SRCDIR/tests/docs/blocks.awk" "$page" || exit 1
  ln -s "$HR2D_SRCDIR/examples" "$work/reader/examples"
  cd "$work/reader" || exit 1
  while read -r kind step line name <&3; do
    if [ "$kind" = file ]; then
      cp "$work/steps/$step" "$name" || exit 1
      continue
    fi
    # With a command behind it, as bash may replace this shell by the last one of a file.
    { cat "$work/steps/$step" && echo 'last=$?'; } >"$work/steps/$step.run"
    returns "$last"
    # shellcheck disable=SC1090
    . "$work/steps/$step.run" >"$work/steps/$step.printed" 2>&1 </dev/null
    if [ "$last" -ne 0 ] && [ "$name" = succeeds ]; then
      echo "$page:$line: $(cat "$work/steps/$step"): exit status $last"
      result=1
    fi
    awk -f "$HR2D_SRCDIR/tests/docs/compare.awk" "$work/steps/$step.expected" \
      "$work/steps/$step.printed" >"$work/difference" ||
      { echo "$page:$line: $(cat "$work/steps/$step")" && cat "$work/difference" && result=1; }
  done 3<"$work/steps/steps"
  : >"$work/end" # a command of the page may end this shell
  exit "$result"
)
