#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# .ci/release in a clone of the tree: what `prepare --dry-run` would change, that it changes nothing,
# that a second run has nothing to do, and that it refuses what is not ready.
set -eu
if [ ! -e "$HR2D_SRCDIR/.git" ] || ! git -C "$HR2D_SRCDIR" rev-parse HEAD >/dev/null 2>&1; then
  echo "releases are made from a repository, and this is none"
  exit 77
fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export GIT_AUTHOR_NAME=test GIT_AUTHOR_EMAIL=test@localhost
export GIT_COMMITTER_NAME=test GIT_COMMITTER_EMAIL=test@localhost

fail() {
  echo "$*" >&2
  cat "$work/out" >&2
  exit 1
}

git clone -q --shared "$HR2D_SRCDIR" "$work/tree"
cd "$work/tree"
git config user.useConfigOnly true
# What is tested is the script of the tree, in a commit or not.
cp "$HR2D_SRCDIR/.ci/release" .ci/release
former=$(sed -n 's/^AC_SUBST(\[HR2D_VERSION_INFO\], \[\(.*\)\])$/\1/p' configure.ac)
current=${former%%:*} age=${former##*:} revision=${former#*:}
revision=${revision%:*}
number=$((current - age)) next=$((current + 1))

# news LINE...: NEWS with a section of these lines above the others, committed.
news() {
  { printf '%s\n' "libhr2d NEWS" "" "$@" "" && sed 1,2d "$HR2D_SRCDIR/NEWS"; } >NEWS
  git add -A
  git commit -q --allow-empty -m "News"
}

prepare() { .ci/release prepare "$@" >"$work/out" 2>&1; }

# refused WHY ARGUMENT...
refused() {
  why=$1
  shift
  if prepare "$@"; then fail "not refused: $why"; fi
  grep -q "$why" "$work/out" || fail "no word of '$why' in:"
}

# would CHANGE LINE...: files would have these lines after CHANGE, and nothing has changed yet.
would() {
  change=$1
  shift
  prepare 9.8.7 --interface "$change" --dry-run || fail "the dry run of a change '$change' fails"
  for line; do
    sed -n 's/^[+ ]//p' "$work/out" | grep -Fx -e "$line" >/dev/null || fail "not in the dry run of a change '$change': $line"
  done
  [ -z "$(git status --porcelain)" ] || fail "the dry run has changed files"
}

news "9.8.6 (not released)" "" "Highlights" "* It is there."
refused "NEWS has no section 9.8.7" 9.8.7 --interface added
news "9.8.7 (not released)" "" "Added" "* No highlight."
refused "has 0 highlights" 9.8.7 --interface added
news "9.8.7 (not released)" "" "Highlights" "* One." "" "Truth" "* All of it."
refused "other heads.*Truth" 9.8.7 --interface added
news "9.8.7 (not released)" "" "Highlights" "* hr2d_kernels() and hr2d_kernel()."
refused "no header has: hr2d_kernels()$" 9.8.7 --interface added
news "9.8.7 (not released)" "" "Highlights" "* hr2d_kernel()." "" "Removed" "* hr2d_kernels()."
refused "a version is as 1.2.3" 9.8 --interface added
refused "CHANGE is" 9.8.7 --interface much --dry-run
echo >>README.md
refused "in no commit" 9.8.7 --interface added
git checkout -q README.md

today=$(date -u +%F)
would none "AC_SUBST([HR2D_VERSION_INFO], [$current:$((revision + 1)):$age])"
would added "AC_SUBST([HR2D_VERSION_INFO], [$next:0:$((age + 1))])" \
  "| 9.8.7 | $next:0:$((age + 1)) | \`libhr2d.so.$number\` |"
would incompatible "AC_SUBST([HR2D_VERSION_INFO], [$next:0:0])" \
  "| 9.8.7 | $next:0:0 | \`libhr2d.so.$next\` |" \
  "m4_define([hr2d_major], [9])" "m4_define([hr2d_minor], [8])" "m4_define([hr2d_patch], [7])" \
  "9.8.7 ($today)" "version: 9.8.7" "date-released: $today" \
  "libhr2d (9.8.7-0upstream1) unstable; urgency=medium" "Package: libhr2d$next" \
  "HR2D_$next {" " hr2d_version@HR2D_$next 9.8.7" \
  "libhr2d.so.$next libhr2d$next #MINVER#"

# After these changes nothing is left to do, and the tag may be set, once.
sed -n '/^diff /,/^would build/p' "$work/out" | sed '$d' >"$work/changes"
git apply --index "$work/changes"
git commit -q -m "Release 9.8.7"
prepare 9.8.7 --interface incompatible || fail "a second run fails"
grep -q "prepared already" "$work/out" || fail "a second run does something"
.ci/release finish --dry-run >"$work/out" 2>&1 || fail "finish --dry-run fails"
grep -q "set v9.8.7" "$work/out" || fail "finish would set no tag"
git tag -a -m "Elsewhere" v9.8.7 HEAD~1
if .ci/release finish --dry-run >"$work/out" 2>&1; then fail "a tag would be moved"; fi
echo "a release is prepared in three ways, and refused in eight"
