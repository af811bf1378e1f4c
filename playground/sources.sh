#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# sources.sh FOLDER: brings the sources of GSL and jansson into FOLDER/gsl and FOLDER/jansson.
# apt takes them from the mirrors that this machine already uses.  Its lists and caches stay as
# they are: all is done in FOLDER, and root is not needed.
set -eu
mkdir -p "$1/parts" "$1/lists/partial" "$1/cache/archives/partial"
cd "$1"

# What sources.list says for packages holds for their sources.
for list in /etc/apt/sources.list /etc/apt/sources.list.d/*.list; do
  [ ! -f "$list" ] || sed -n 's/^deb\([[:space:]]\)/deb-src\1/p' "$list"
done >parts/debian.list
for list in /etc/apt/sources.list.d/*.sources; do
  [ ! -f "$list" ] || sed 's/^Types:.*/Types: deb-src/' "$list" >"parts/${list##*/}"
done

apt() {
  apt-get -qq -o Dir::Etc::sourcelist=/dev/null -o Dir::Etc::sourceparts="$PWD/parts" \
    -o Dir::State::Lists="$PWD/lists" -o Dir::Cache="$PWD/cache" \
    -o APT::Sandbox::User="$(id -un)" "$@"
}

apt update
apt source --download-only gsl jansson >/dev/null
for package in gsl jansson; do
  rm -rf "$package-new" "$package"
  mkdir "$package-new"
  tar -xf "$package"_*.orig.tar.* -C "$package-new" --strip-components=1
  mv "$package-new" "$package"
done
rm -rf parts lists cache
