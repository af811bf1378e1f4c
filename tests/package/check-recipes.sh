#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# The recipes of packaging/, as `make recipes` writes them, and the home pages of debian/ agree with
# configure.ac and the tree (recipes.py), and parsers of their languages read them, where these are
# installed.  Faults in copies are found.
set -eu
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
status=0
fail() {
  echo "$*" >&2
  status=1
}
for python in ${PYTHON-} python3 /usr/bin/python3 ''; do
  [ -n "$python" ] || break
  ! "$python" -c 'import json, yaml' 2>/dev/null || break
done
if [ -z "$python" ]; then
  echo "no yaml in python3: YAML is not parsed" >&2
  python=python3
fi
if ! command -v "$python" >/dev/null; then
  echo "no python3: recipes are not tested" >&2
  [ -z "${CI-}" ] || exit 1
  exit 77
fi
export PYTHONDONTWRITEBYTECODE=1
unset HOMEPAGE DOWNLOAD

version=$(sed -n 's/^Version: //p' "$HR2D_BUILDDIR/hr2d.pc")
make_recipes() {
  sh "$HR2D_SRCDIR/packaging/make.sh" "$@" 2>"$work/words" || fail "packaging/make.sh $* fails"
}
make_recipes "$work/recipes" "$version"
grep -q 'checksums are zeros' "$work/words" || fail "no word of checksums that are zeros"
agree() { "$python" "$HR2D_SRCDIR/tests/package/recipes.py" "$HR2D_SRCDIR" "$1"; }
agree "$work/recipes" >&2 || fail "the recipes do not agree with configure.ac and the tree"

# ---- parsers
# parses TOOL NEW-FILE COMMAND...
parses() {
  tool=$1 recipe=$2
  shift 2
  if ! command -v "$tool" >/dev/null; then
    echo "no $tool: $recipe is not parsed" >&2
    return
  fi
  parsed="${parsed-} $tool"
  "$@" "$work/recipes/$recipe" >"$work/words" 2>&1 || fail "$recipe: $(cat "$work/words")"
  # Half of a recipe is none.
  mkdir -p "$work/broken"
  head -n "$(($(wc -l <"$work/recipes/$recipe") / 2))" "$work/recipes/$recipe" >"$work/broken/${recipe##*/}"
  echo 'if (' >>"$work/broken/${recipe##*/}"
  ! "$@" "$work/broken/${recipe##*/}" >/dev/null 2>&1 || fail "half of $recipe would be taken for a whole one"
}
parses ruby homebrew/libhr2d.rb ruby -c
parses rpmspec rpm/libhr2d.spec rpmspec -P
parses nix-instantiate nix/default.nix nix-instantiate --parse
parses bash oss-fuzz/build.sh bash -n

# ---- a tarball has its checksums, and another place its address
echo tarball >"$work/tarball"
export HOMEPAGE=https://a.invalid/b DOWNLOAD=https://c.invalid
make_recipes "$work/others" 9.8.7 "$work/tarball"
sum=$(sha256sum "$work/tarball" | cut -d ' ' -f 1)
grep -q "sha256 = \"$sum\"" "$work/others/nix/default.nix" || fail "a recipe lacks the checksum of the tarball"
grep -q '^  url: https://c.invalid/libhr2d-' "$work/others/conda/recipe.yaml" || fail "DOWNLOAD has no effect"
grep -q '^URL: *https://a.invalid/b$' "$work/others/rpm/libhr2d.spec" || fail "HOMEPAGE has no effect"

# ---- what is wrong would be found
# finds WHAT RECIPE CHANGE: after a change by sed
finds() {
  rm -rf "$work/copy"
  cp -R "$work/recipes" "$work/copy"
  sed -i "$3" "$work/copy/$2"
  ! cmp -s "$work/recipes/$2" "$work/copy/$2" || fail "$2 is not changed by $3"
  ! agree "$work/copy" >"$work/words" || fail "not found: another $1 in $2"
  grep -q "^$2: .*$1" "$work/words" || fail "no word of $1 in: $(cat "$work/words")"
}
for recipe in conda/recipe.yaml vcpkg/vcpkg.json spack/package.py homebrew/libhr2d.rb nix/default.nix \
  rpm/libhr2d.spec; do
  finds version $recipe "s/$version/9.8.7/"
  finds licence $recipe 's/GPL-3.0-or-later"\?;\?$/MIT&/; s/GPL-3.0-or-later"[,)]/MIT&/; s/gpl3Plus/mit/'
  finds 'home page' $recipe '/[Hh]omepage\|^URL/ s|https://libhr2d|https://another|'
  finds 'jansson is no dependency' $recipe 's/jansson/janson/g'
done
finds 'gsl >= 1.9, and' spack/package.py 's/gsl@2.0/gsl@1.9/'
finds 'gsl >= 1.9, and' rpm/libhr2d.spec 's/(gsl) >= 2.0/(gsl) >= 1.9/'
finds 'no option cario' nix/default.nix 's/with-cairo/with-cario/'
finds 'no tests/unit/none.c' rpm/libhr2d.spec 's|tests/unit/solve/check-solve.c|tests/unit/none.c|'
finds 'list of fuzzers' oss-fuzz/build.sh 's/scene state api pair/scene state api/'
finds 'no fuzz/none.dict' oss-fuzz/build.sh 's|fuzz/pair.dict|fuzz/none.dict|'
finds '@VERSION@ is left' vcpkg/portfile.cmake 's/libhr2d-/@VERSION@-/'

[ $status != 0 ] || echo "seven recipes agree with configure.ac; parsed by python3${parsed-}"
exit $status
