#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# The bill of materials of `make sbom` is SPDX 2.3: it has the version of the library, what the library
# is linked with, in the versions that are here, and the licences that reuse finds in the tree.
set -eu
if ! command -v python3 >/dev/null; then
  echo "no python3: the bill of materials is not tested" >&2
  [ -z "${CI-}" ] || exit 1
  exit 77
fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
status=0
fail() {
  echo "$*" >&2
  status=1
}
export PYTHONDONTWRITEBYTECODE=1
unset HOMEPAGE SOURCE_DATE_EPOCH
sbom() { python3 "$HR2D_SRCDIR/packaging/sbom.py" "$HR2D_SRCDIR" "$@"; }

# asks FILE: what is wrong with a bill, a line for each fault.
cat >"$work/asks.py" <<'PY'
import json, re, subprocess, sys
bill, version = json.load(open(sys.argv[1])), sys.argv[2]
packages = {package["name"]: package for package in bill["packages"]}
identifiers = [part["SPDXID"] for part in [bill] + bill["packages"] + bill["files"]]
ends = {relation[end] for relation in bill["relationships"] for end in ("spdxElementId", "relatedSpdxElement")}
to_us = {relation["spdxElementId"]: relation["relationshipType"] for relation in bill["relationships"]
         if relation["relatedSpdxElement"] == "SPDXRef-libhr2d"}
def needs(good, what):
    if not good:
        print(what)
needs(bill["spdxVersion"] == "SPDX-2.3" and bill["dataLicense"] == "CC0-1.0", "this is not SPDX 2.3")
needs(bill["documentNamespace"].startswith("https://"), "the document has no name of its own")
needs(re.fullmatch(r"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\dZ", bill["creationInfo"]["created"]), "a wrong date")
needs(all(re.fullmatch(r"SPDXRef-[A-Za-z0-9.-]+", name) for name in identifiers), "a wrong identifier")
needs(len(set(identifiers)) == len(identifiers) and ends == set(identifiers), "parts without a relation, or twice")
needs(packages["libhr2d"]["versionInfo"] == version, "another version of libhr2d")
needs(packages["libhr2d"]["licenseDeclared"] == "GPL-3.0-or-later", "another licence of libhr2d")
for name, kind in [("gsl", "DEPENDENCY_OF"), ("jansson", "DEPENDENCY_OF"), ("cairo", "OPTIONAL_DEPENDENCY_OF")]:
    needs(to_us.get(f"SPDXRef-{name}") == kind, f"{name} is missing")
    here = subprocess.run(["pkg-config", "--modversion", name], capture_output=True, text=True).stdout.strip()
    needs(packages.get(name, {}).get("versionInfo", "") == here, f"another version of {name}")
for linked in sys.argv[3:]:
    needs(to_us.get(f"SPDXRef-{linked}") == "DEPENDENCY_OF", f"{linked}, which the library is linked with, is missing")
PY
version=$(sed -n 's/^Version: //p' "$HR2D_BUILDDIR/hr2d.pc")
linked=
if [ -e "$HR2D_BUILDDIR/.libs/libhr2d.so" ] && command -v readelf >/dev/null; then
  # GSL brings its own BLAS; the others are of the C library and of compilers.
  linked=$(readelf -dW "$HR2D_BUILDDIR/.libs/libhr2d.so" | sed -n 's/.*(NEEDED).*\[lib\(.*\)\.so.*/\1/p' |
    grep -Ev '^(c|m|pthread|gslcblas|gcc_s|[alut]*san)$|^ld-')
fi
# shellcheck disable=SC2086 # names are words
asks() { python3 "$work/asks.py" "$1" "$version" $linked; }

sbom >"$work/bill.json" || fail "no bill is made"
asks "$work/bill.json" >"$work/found" || fail "the bill is not what SPDX asks for"
[ ! -s "$work/found" ] || fail "$(cat "$work/found")"
sbom | cmp - "$work/bill.json" || fail "a second bill is another one"
MAKEFLAGS='' make -s -C "$HR2D_BUILDDIR" sbom >/dev/null || fail "make sbom fails"
asks "$HR2D_BUILDDIR/libhr2d-$version.spdx.json" >"$work/found" && [ ! -s "$work/found" ] ||
  fail "the bill of make sbom: $(cat "$work/found")"

# A tarball has its checksum; a date may be given.
echo tarball >"$work/libhr2d.tar.gz"
SOURCE_DATE_EPOCH=86400 sbom "$work/libhr2d.tar.gz" >"$work/dated.json"
grep -q "$(sha256sum "$work/libhr2d.tar.gz" | cut -d ' ' -f 1)" "$work/dated.json" || fail "no checksum of the tarball"
grep -q '"created": "1970-01-02T00:00:00Z"' "$work/dated.json" || fail "SOURCE_DATE_EPOCH has no effect"

# licences: those of parts of the tree, as reuse finds them
if command -v reuse >/dev/null && [ -e "$HR2D_SRCDIR/.git" ]; then
  (cd "$HR2D_SRCDIR" && reuse spdx) 2>/dev/null | sed -n 's/^LicenseInfoInFile: //p' | sort -u >"$work/reuse"
  { echo GPL-3.0-or-later && sed -n '/"licenseInfoInFiles"/,/]/p' "$work/bill.json" |
    sed -n 's/^ *"\([^"]*\)",\{0,1\}$/\1/p'; } | sort -u | cmp - "$work/reuse" ||
    fail "reuse finds these licences: $(cat "$work/reuse")"
else
  echo "no reuse, or no repository: licences are not compared" >&2
fi

# ---- what is wrong would be found
finds() { # finds WHAT CHANGE
  sed "$2" "$work/bill.json" >"$work/wrong.json"
  asks "$work/wrong.json" >"$work/found"
  grep -q "$1" "$work/found" || fail "not found: $1"
}
finds 'another version of libhr2d' "s/\"versionInfo\": \"$version\"/\"versionInfo\": \"9.8.7\"/"
finds 'jansson is missing' 's/"spdxElementId": "SPDXRef-jansson"/"spdxElementId": "SPDXRef-gsl"/'
finds 'without a relation' 's/"SPDXID": "SPDXRef-gsl"/"SPDXID": "SPDXRef-glas"/'
finds 'not SPDX 2.3' 's/SPDX-2.3/SPDX-2.1/'
[ -z "$linked" ] || finds 'linked with, is missing' 's/"relationshipType": "DEPENDENCY_OF"/"relationshipType": "OTHER"/'
[ $status != 0 ] || echo "the bill of materials has$(printf ' %s' ${linked:-gsl jansson})"
exit $status
