#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# make.sh FOLDER VERSION [TARBALL]: the recipes beside this script, complete, in FOLDER.  Without the
# tarball, whose checksums they have, these are zeros.
#
# Environment: HOMEPAGE, instead of the one in the file homepage; DOWNLOAD, the folder of tarballs,
# if that is another place.
set -eu
here=$(dirname "$0")
folder=$1 version=$2 tarball=${3-}
homepage=${HOMEPAGE:-$(cat "$here/homepage")}
download=${DOWNLOAD:-$homepage}
if [ -n "$tarball" ]; then
  sha256=$(sha256sum "$tarball" | cut -d ' ' -f 1)
  sha512=$(sha512sum "$tarball" | cut -d ' ' -f 1)
else
  sha256=$(printf '%064d' 0)
  sha512=$(printf '%0128d' 0)
  echo "recipes: no tarball; checksums are zeros" >&2
fi
(cd "$here" && find . -name '*.in') | while read -r recipe; do
  made=$folder/${recipe%.in}
  mkdir -p "$(dirname "$made")"
  sed -e "s|@VERSION@|$version|g; s|@HOMEPAGE@|$homepage|g; s|@DOWNLOAD@|$download|g" \
    -e "s|@SHA256@|$sha256|g; s|@SHA512@|$sha512|g" "$here/$recipe" >"$made"
done
