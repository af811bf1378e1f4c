#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Results tell where they come from: version, command, options and the SHA-256 of the scene, in
# every format that has a place for it; the same run writes the same bytes.
#
# Environment: HR2D_PROGRAM, the program; HR2D_SCENES, the example scenes; HR2D_SRCDIR, the top of
# the sources.
# shellcheck disable=SC2154 # what expect.sh sets
: "${HR2D_SRCDIR:?names the source directory}"
scenes=${HR2D_SCENES:-$HR2D_SRCDIR/examples/scenes}
. "$HR2D_SRCDIR/tests/program/cli/expect.sh"
for needed in sha256sum python3; do
  command -v $needed >/dev/null 2>&1 || {
    echo "skipped: there is no $needed"
    exit 77
  }
done
scene=$work/room.geojson
cp "$scenes/lit-room.geojson" "$scene"
summed() {
  sha256sum <"$1" | cut -d' ' -f1
}
hash=$(summed "$scene")
version=$(hr2d --version | sed -n '1s/^hr2d \([^ ]*\).*/\1/p')
not() {
  ! "$@" >"$work/not" 2>&1
}

# ---- the hash is that of sha256sum, for each way in which its last block ends
recorded() { # recorded SCENE
  hr2d info "$1" --json - 2>/dev/null | sed -n 's/^ *"sha256": "\(.*\)"$/\1/p'
}
cp "$scene" "$work/padded.geojson"
for rest in 0 1 54 55 56 57 63; do
  while [ $(($(wc -c <"$work/padded.geojson") % 64)) -ne $rest ]; do
    printf ' ' >>"$work/padded.geojson"
  done
  check "the hash of a file of 64 n + $rest bytes" \
    [ "$(recorded "$work/padded.geojson")" = "$(summed "$work/padded.geojson")" ]
done
check "a space more is another hash" [ "$(recorded "$work/padded.geojson")" != "$hash" ]
head -c 2000000 /dev/zero | tr '\0' ' ' | cat "$scene" - >"$work/long.geojson"
check "the hash of a long file" [ "$(recorded "$work/long.geojson")" = "$(summed "$work/long.geojson")" ]
check "the hash of standard input" [ "$(hr2d info - --json - <"$scene" | grep -c "\"sha256\": \"$hash\"")" -eq 1 ]
check "the hash of a file of View2D" [ "$(recorded "$scenes/blk1.vs2")" = "$(summed "$scenes/blk1.vs2")" ]

# ---- JSON
cat >"$work/record.py" <<'END'
import json, sys
path, version, sha256, command, *options = sys.argv[1:]
record = json.load(open(path, encoding="utf-8"))["provenance"]
sys.exit(record != dict(program="hr2d", version=version, command=command, options=options, sha256=sha256))
END
of_command() { # of_command COMMAND OPTION...
  command=$1
  shift
  succeeds "$command" "$scene" --json "$work/x.json" "$@"
  check "the record of $command $*" python3 "$work/record.py" "$work/x.json" "$version" "$hash" \
    "$command" "$@"
}
of_command info
of_command solve --eps 0.5 --at floor:0.5
check "another one would be found" not python3 "$work/record.py" "$work/x.json" "$version" "$hash" \
  solve --eps 0.5
of_command study --steps 2
of_command cost --max-seconds 0.01 --methods size
of_command factors
of_command field --grid 2x2
of_command solve --target-error 0.1 --importance 'red wall'
succeeds solve "$scene" --eps=0.5 --threads 2 --quiet --csv "$work/x.csv" --json "$work/x.json"
check "threads, files and --quiet are left out, and --eps=0.5 is --eps 0.5" \
  python3 "$work/record.py" "$work/x.json" "$version" "$hash" solve --eps 0.5

# ---- other formats have it in one line
tells() { # tells FILE COMMAND OPTIONS
  grep -aqF "hr2d $version: hr2d $2 room.geojson${3:+ $3}; SHA-256 of the scene: $hash" "$1"
}
succeeds solve "$scene" --eps 0.5 --csv "$work/plain.csv"
succeeds solve "$scene" --eps 0.5 --csv "$work/told.csv" --csv-comment
check "CSV is plain by default" lacks '^#' "$work/plain.csv"
check "--csv-comment: the comment" [ "$(sed -n 1p "$work/told.csv")" = \
  "# hr2d $version: hr2d solve room.geojson --eps 0.5; SHA-256 of the scene: $hash" ]
sed 1d "$work/told.csv" >"$work/rest.csv"
check "--csv-comment: the rest" cmp -s "$work/plain.csv" "$work/rest.csv"
usage "--csv-comment needs --csv" solve "$scene" --csv-comment
for command in "study --steps 2" "cost --methods size --max-seconds 0.01" factors "field --grid 2x2"; do
  # shellcheck disable=SC2086 # words
  succeeds ${command%% *} "$scene" ${command#"${command%% *}"} --csv "$work/x.csv" --csv-comment
  check "CSV of $command" [ "$(sed -n 1p "$work/x.csv" | cut -c 1-7)" = "# hr2d " ]
  check "one line of it" [ "$(grep -c '^#' "$work/x.csv")" -eq 1 ]
done
succeeds study "$scene" --steps 2 --csv "$work/s.csv" --csv-comment
succeeds study "$scene" --steps 3 --csv "$work/s.csv" --csv-comment --resume
check "a study goes on behind a comment" [ "$(wc -l <"$work/s.csv")" -eq 5 ]
sed 2d "$work/s.csv" >"$work/headless.csv"
expect 1 "^hr2d: .*: line 2 is not the header of a study" study "$scene" --steps 3 \
  --csv "$work/headless.csv" --resume
succeeds factors "$scene" --mtx "$work/x.mtx" --elmer "$work/x.dat"
check "Matrix Market" tells "$work/x.mtx" factors
check "Elmer's file has no comments" lacks hr2d "$work/x.dat"

# ---- the file of an option tells nothing; names do not break a format
succeeds solve "$scene" --eps 0.5 --at "floor:0.5" --json "$work/x.json" --quiet
odd="$work/it's <&--> x"
cp "$scene" "$odd.geojson"
printf 'x\033]0;owned' >"$work/esc"
succeeds field "$odd.geojson" --grid 2x2 --vtk "$work/x.vti" --csv "$work/x.csv" --csv-comment
check "a name is quoted as shells do" grep -qF "hr2d field 'it'\\''s <&--> x.geojson' --grid 2x2;" "$work/x.csv"
cat >"$work/vti.py" <<'END'
import sys, xml.etree.ElementTree
(text,) = xml.etree.ElementTree.parse(sys.argv[1]).getroot().findall("ImageData/FieldData/DataArray")
print(bytes(int(code) for code in text.text.split()).rstrip(b"\0").decode())
END
python3 "$work/vti.py" "$work/x.vti" >"$work/text"
check "VTK" [ "# $(cat "$work/text")" = "$(sed -n 1p "$work/x.csv")" ]
escape=$work/$(cat "$work/esc").geojson
cp "$scene" "$escape"
succeeds factors "$escape" --csv "$work/x.csv" --csv-comment
check "control characters are not written" grep -qF "hr2d factors 'x?]0;owned.geojson';" "$work/x.csv"

# ---- pictures
cat >"$work/png.py" <<'END'
import struct, sys, zlib
data, at, kinds = open(sys.argv[1], "rb").read(), 8, []
while at < len(data):
    size, kind = struct.unpack(">I4s", data[at : at + 8])
    body = data[at + 8 : at + 8 + size]
    assert struct.unpack(">I", data[at + 8 + size : at + 12 + size])[0] == zlib.crc32(kind + body)
    kinds.append(kind)
    if kind == b"iTXt":
        print(body.removeprefix(b"Comment\0\0\0\0\0").decode())
    at += 12 + size
assert kinds[0] == b"IHDR" and kinds[1] == b"iTXt" and kinds[-1] == b"IEND", kinds
END
cat >"$work/svg.py" <<'END'
import sys, xml.etree.ElementTree
(text,) = xml.etree.ElementTree.parse(sys.argv[1]).getroot().findall("{http://www.w3.org/2000/svg}metadata")
print(text.text)
END
same_again() { # same_again FILE WORDS...: two runs write the same bytes
  file=$1
  shift
  succeeds "$@" "$file"
  cp "$file" "$work/first"
  case $file in *.pdf) sleep 1 ;; esac # a date would have its seconds
  succeeds "$@" "$file"
  check "${file##*.} of $1 is the same again" cmp -s "$file" "$work/first"
}
text="hr2d $version: hr2d solve room.geojson --eps 1 --no-fill; SHA-256 of the scene: $hash"
run solve "$scene" --quiet --eps 4 --draw "$work/probe.svg"
if grep -q 'without cairo' "$work/err"; then
  echo "skipped: pictures, for want of cairo"
  summary provenance
  exit
fi
for format in png svg pdf; do
  same_again "$work/x.$format" solve "$scene" --quiet --eps 1 --no-fill --draw
done
check "PNG" [ "$(python3 "$work/png.py" "$work/x.png")" = "$text" ]
check "SVG" [ "$(python3 "$work/svg.py" "$work/x.svg")" = "$text" ]
check "PDF" tells "$work/x.pdf" solve "--eps 1 --no-fill"
check "PDF has no date" lacks CreationDate "$work/x.pdf"
succeeds solve "$odd.geojson" --quiet --eps 1 --no-fill --draw "$work/x.svg"
check "SVG with an odd name" \
  [ "$(python3 "$work/svg.py" "$work/x.svg" | grep -c "'it'.*'s <&--> x.geojson'")" -eq 1 ]
same_again "$work/film.png" solve "$scene" --quiet --eps 1 --watch
check "a film" [ "$(python3 "$work/png.py" "$work/film.png")" = "${text%%--eps*}--eps 1;${text##*;}" ]
same_again "$work/x.png" solve "$scene" --quiet --eps 1 --tiles
check "tiles" [ "$(python3 "$work/png.py" "$work/x.png")" = "${text%%--eps*}--eps 1;${text##*;}" ]
if command -v gnuplot >/dev/null 2>&1; then
  for format in png svg; do
    same_again "$work/x.$format" study "$scene" --quiet --steps 3 --plot
    check "a plot as $format" [ "$(python3 "$work/$format.py" "$work/x.$format")" = \
      "hr2d $version: hr2d study room.geojson --steps 3; SHA-256 of the scene: $hash" ]
  done
fi
summary provenance
