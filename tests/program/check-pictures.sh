#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# The pictures of `hr2d solve` and `hr2d field`: files are whole, colours and isolines are where
# closed forms have them, and options that make no sense are refused.
#
# Environment: HR2D_PROGRAM, the program; HR2D_SRCDIR, the top of the sources; HR2D_BUILDDIR, where
# tests/program/pixels is; HR2D_SCENES, the example scenes.
# shellcheck disable=SC2154 # what expect.sh sets
: "${HR2D_SRCDIR:?names the source directory}"
. "$HR2D_SRCDIR/tests/program/cli/expect.sh"
pixels=$HR2D_BUILDDIR/tests/program/pixels
scenes=$HR2D_SCENES

# patch NAME EMISSION REFLECTANCE COORDINATES: a feature
patch() {
  printf '{"type": "Feature", "properties": {"name": "%s", "emission": %s, "reflectance": %s},
    "geometry": {"type": "LineString", "coordinates": [%s]}}' "$@"
}
# room FILE FEATURES...: a scene
room() {
  file=$1
  shift
  {
    printf '{"type": "FeatureCollection", "features": ['
    separator=
    for feature in "$@"; do printf '%s%s' "$separator" "$feature" && separator=,; done
    printf ']}'
  } >"$file"
}

# A black unit square with a lamp as floor; a furnace of three bands; a room with a block in it.
black=$work/black.geojson
room "$black" "$(patch lamp 1 0 '[0, 0], [1, 0]')" "$(patch wall 0 0 '[1, 0], [1, 1], [0, 1], [0, 0]')"
furnace=$work/furnace.geojson
room "$furnace" "$(patch a '[0.5, 0.25, 0.75]' '[0.5, 0.75, 0.25]' '[0, 0], [1, 0], [1, 1]')" \
  "$(patch b '[1, 0.5, 0.25]' '[0, 0.5, 0.75]' '[1, 1], [0, 1], [0, 0]')"
block=$work/block.geojson
room "$block" "$(patch lamp 1 0.5 '[0, 0], [1, 0]')" "$(patch wall 0 0.5 '[1, 0], [1, 1], [0, 1], [0, 0]')" \
  "$(patch block 0 0.5 '[0.4, 0.4], [0.4, 0.6], [0.6, 0.6], [0.6, 0.4], [0.4, 0.4]')"

# ---- options that contradict each other, or the scene
usage "--no-fill needs --draw" solve "$black" --no-fill
usage "--contours needs --draw" solve "$black" --contours 5
usage "--quantity needs --draw" field "$black" --quantity sky
usage "'solve' has no option --quantity" solve "$black" --draw a.svg --quantity sky
usage "--quantity: 'light' is none of mean, flux, sky, temperature" field "$black" --quantity light
usage "--contours: '0' is not a whole number" solve "$black" --draw a.svg --contours 0
usage "--log and --linear exclude each other" field "$black" --draw a.svg --log --linear
usage "true colour is for --quantity mean" field "$furnace" --draw a.svg --quantity sky --band rgb
usage "true colour excludes --log" field "$furnace" --draw a.svg --band rgb --log
usage "--exposure is for true colour" field "$furnace" --draw a.svg --exposure 2 --band 1
usage "the sky has no --band" field "$furnace" --draw a.svg --quantity sky --band 1
usage "--band: 'red' is neither a number nor all nor rgb" field "$furnace" --draw a.svg --band red
usage "--tiles: 'a.csv' does not end in .svg, .png or .pdf" solve "$black" --tiles a.csv
usage "--target-error and --tiles exclude each other" solve "$black" --target-error 1e-3 --tiles a.png
usage "two outputs go to 'a.svg'" solve "$black" --draw a.svg --tiles a.svg
usage "--watch: 'a.svg' does not end in .png" solve "$black" --watch a.svg
usage "--target-error and --watch exclude each other" solve "$black" --target-error 1e-3 --watch a.png

run solve "$black" --quiet --eps 4 --draw "$work/probe.svg"
if grep -q 'without cairo' "$work/err"; then
  echo "skipped: pictures, for want of cairo"
  summary check-pictures
  exit
fi
usage "true colour needs a scene of 3 bands, and this one has 1" field "$black" \
  --draw "$work/no.svg" --band rgb
usage "--band: the scene has no band 3, only 0 to 2" field "$furnace" --draw "$work/no.svg" --band 3

# ---- cairo is loaded for a picture, and for nothing else
if grep -q '^#define HAVE_LATE_CAIRO 1' "$HR2D_BUILDDIR/config.h"; then
  mkdir "$work/lib"
  echo "no library" >"$work/lib/libcairo.so.2"
  libraries=${LD_LIBRARY_PATH-}
  export LD_LIBRARY_PATH="$work/lib${libraries:+:$libraries}"
  run solve "$black" --quiet --eps 4 --json "$work/late.json"
  check "a solve does not need cairo" [ "$status" -eq 0 ]
  run solve "$black" --quiet --eps 4 --draw "$work/late.svg"
  check "a picture does" [ "$status" -eq 1 ]
  check "and says so" grep -q 'late.svg: cannot be drawn without cairo: ' "$work/err"
  check "and writes none" [ ! -e "$work/late.svg" ]
  LD_LIBRARY_PATH=$libraries
fi

# ---- files are whole
is_xml() {
  if command -v xmllint >/dev/null 2>&1; then
    xmllint --noout "$1" 2>/dev/null
  else
    head -n 1 "$1" | grep -q '^<?xml' && tail -n 1 "$1" | grep -q '^</svg>'
  fi
}
is_no_xml() {
  ! is_xml "$1"
}
for quantity in mean flux sky temperature; do
  succeeds field "$block" --quiet --eps 4 --quantity $quantity --contours 6 --arrows \
    --draw "$work/$quantity.svg"
  check "SVG of $quantity is XML" is_xml "$work/$quantity.svg"
done
head -c -9 "$work/mean.svg" >"$work/half.svg"
check "half an SVG would be found" is_no_xml "$work/half.svg"
succeeds solve "$block" --quiet --eps 4 --contours 4 --arrows --draw "$work/block.pdf"
check "PDF" magic "$work/block.pdf" 25504446
succeeds solve "$block" --quiet --eps 4 --draw "$work/block.png"
check "PNG" "$pixels" "$work/block.png" >"$work/size"
head -c 5000 "$work/block.png" >"$work/half.png"
is_no_png() {
  ! "$pixels" "$1" >/dev/null
}
check "half a PNG would be found" is_no_png "$work/half.png"

# pixel FILE X Y: the colour in the middle of a scene of the unit square, by parts of its width.
# The square is where a picture without names or light has its walls, in points of the page.
succeeds solve "$block" --quiet --eps 4 --no-fill --draw "$work/plain.svg"
wall() { # wall FILE: x, y and size of the square on the page
  sed -n 's/.*stroke-width:1.2;.* d="M \([0-9.]*\) \([0-9.]*\) L \([0-9.]*\) \([0-9.]*\) "\/>.*/\1 \2 \3 \4/p' \
    "$1" | awk '{ for (k = 1; k < 5; k += 2) { if (!n || $k < x) x = $k; if (!n || $k > X) X = $k
                    if (!n || $(k + 1) > y) y = $(k + 1); n = 1 } } END { print x, y, X - x }'
}
pixel() {
  wall "$work/plain.svg" | awk -v x="$2" -v y="$3" \
    '{ printf "%d %d\n", 2 * ($1 + x * $3), 2 * ($2 - y * $3) }' >"$work/where"
  # shellcheck disable=SC2046
  "$pixels" "$1" $(cat "$work/where") | tail -n 1
}
is_white() {
  [ "$(pixel "$@")" = "255 255 255 255" ]
}
is_coloured() {
  ! is_white "$@"
}

# ---- the room is filled, obstacles and what is outside are not
check "between the walls is light" is_coloured "$work/block.png" 0.2 0.7
check "behind the block, too" is_coloured "$work/block.png" 0.5 0.8
check "the block is empty" is_white "$work/block.png" 0.5 0.5
check "outside of the room is nothing" is_white "$work/block.png" 1.03 0.8
succeeds solve "$block" --quiet --eps 4 --no-fill --draw "$work/white.png"
check "--no-fill leaves the room white" is_white "$work/white.png" 0.2 0.7
succeeds solve "$block" --quiet --eps 4 --beams-of lamp:0.5 --draw "$work/beams.png"
check "and so do beams" is_white "$work/beams.png" 0.45 0.8

# ---- images are pale, mirrors are lines, and beams end at both
room "$work/half.geojson" "$(patch floor 1 0.5 '[0, 0], [1, 0]')" \
  "$(patch wall 0 0.5 '[1, 0], [1, 1]')" \
  "$(patch middle 0 0 '[0, 0], [0, 1]' | sed 's/"name": "middle"[^}]*}/"sides": "mirror"}/')"
succeeds solve "$work/half.geojson" --quiet --eps 4 --no-fill --draw "$work/half.svg"
pale='rgb(72%, *72%, *72%)'
check "images are pale" grep -q "$pale" "$work/half.svg"
succeeds solve "$block" --quiet --eps 4 --no-fill --draw "$work/block.svg"
check "a room without mirrors has none" [ "$(grep -c "$pale" "$work/block.svg")" = 0 ]
succeeds solve "$work/half.geojson" --quiet --eps 4 --beams-of floor:0.5 --draw "$work/beams.svg"

# ---- true colour: B = 1 is white, and with an exposure of a half it is grey: 188 in sRGB
succeeds solve "$furnace" --quiet --draw "$work/furnace.png"
check "a furnace is white" is_white "$work/furnace.png" 0.3 0.6
succeeds field "$furnace" --quiet --exposure 0.5 --draw "$work/grey.png"
check "half exposed it is grey: $(pixel "$work/grey.png" 0.3 0.6)" \
  [ "$(pixel "$work/grey.png" 0.3 0.6)" = "188 188 188 255" ]
succeeds field "$furnace" --quiet --band all --draw "$work/all.png"
check "and has a colour on a scale" is_coloured "$work/all.png" 0.3 0.6

# ---- without light there is nothing to fill, and no scale to choose
room "$work/dark.geojson" "$(patch floor 0 0.5 '[0, 0], [1, 0], [1, 1], [0, 1], [0, 0]')"
for quantity in mean flux sky temperature; do
  succeeds field "$work/dark.geojson" --quiet --quantity $quantity --contours 5 --arrows --log \
    --draw "$work/dark.svg"
  check "a dark scene is XML" is_xml "$work/dark.svg"
  check "of numbers" lacks 'nan\|inf[^o]' "$work/dark.svg"
done
succeeds solve "$work/dark.geojson" --quiet --draw "$work/dark.png"
check "and stays white" is_white "$work/dark.png" 0.3 0.6

# ---- isolines of the black room: M is the angle of the lamp, as a part of all directions
succeeds solve "$black" --quiet --eps 1 --contours 8 --draw "$work/black.svg"
# lines FILE: the vertices of all isolines, x y in the square
vertices() {
  sed -n 's/.*stroke-width:0.9;.* d="\([^"]*\)".*/\1/p' "$1" | tr -d 'MLZ' |
    awk -v place="$(wall "$1")" 'BEGIN { split(place, w, " ") }
      { for (k = 1; k < NF; k += 2) print ($k - w[1]) / w[3], (w[2] - $(k + 1)) / w[3] }'
}
# on_levels SHIFT: all vertices but those beside the ends of the lamp are at multiples of 0.05
on_levels() {
  vertices "$work/black.svg" | awk -v shift="$1" '
    { x = $1; y = $2 + shift }
    y < 0.06 && (x < 0.06 || x > 0.94) { next }
    { m = (atan2(x, y) + atan2(1 - x, y)) / (8 * atan2(1, 1)); level = 0.05 * int(m / 0.05 + 0.5)
      seen[level]; n++
      d = m > level ? m - level : level - m; if (d > 2e-3) bad++ }
    END { for (l in seen) levels++; exit bad || n < 100 || levels < 6 }'
}
off_levels() {
  ! on_levels "$1"
}
check "isolines are where the angle of the lamp has them" on_levels 0
check "and would not be, a fiftieth higher" off_levels 0.02

# ---- pages have the shape of their scenes
aspect() { # aspect FILE: width by height
  sed -n 's/.*<svg .*width="\([0-9.]*\)pt" height="\([0-9.]*\)pt".*/\1 \2/p' "$1" |
    awk '{ printf "%.2f", $1 / $2 }'
}
between() {
  awk -v x="$1" -v low="$2" -v high="$3" 'BEGIN { exit !(x >= low && x <= high) }'
}
room "$work/long.geojson" "$(patch a 1 0.5 '[0, 0], [20, 0], [20, 1], [0, 1], [0, 0]')"
room "$work/tall.geojson" "$(patch a 1 0.5 '[0, 0], [1, 0], [1, 20], [0, 20], [0, 0]')"
for shape in long:2.5:5 tall:0.2:0.6; do
  name=${shape%%:*}
  succeeds solve "$work/$name.geojson" --quiet --eps 1 --draw "$work/$name.svg"
  range=${shape#*:}
  check "a $name scene has a $name page: $(aspect "$work/$name.svg")" \
    between "$(aspect "$work/$name.svg")" "${range%:*}" "${range#*:}"
done
check "a square one has not" between "$(aspect "$work/black.svg")" 0.8 1.4
succeeds field "$black" --quiet --box 0.2,0.4,0.6,0.5 --draw "$work/part.svg"
check "a part of the plane: $(aspect "$work/part.svg")" between "$(aspect "$work/part.svg")" 1.9 3
# A solve shows the same part of the same light.
same_pixels() {
  set -- "$1" "$2" 150 220 250 200 350 210 450 190 550 180
  one=$1 two=$2
  shift 2
  test "$("$pixels" "$one" "$@")" = "$("$pixels" "$two" "$@")"
}
succeeds field "$black" --quiet --eps 0.5 --box 0.2,0.4,0.6,0.5 --draw "$work/part.png"
succeeds solve "$black" --quiet --eps 0.5 --box 0.6,0.5,0.2,0.4 --draw "$work/same.png"
check "solve and field draw the same box" same_pixels "$work/part.png" "$work/same.png"
succeeds solve "$black" --quiet --eps 0.5 --draw "$work/other.png"
other_pixels() {
  ! same_pixels "$@"
}
check "the whole is another picture" other_pixels "$work/part.png" "$work/other.png"
usage "--box needs --draw" solve "$black" --eps 0.5 --box 0,0,1,1

# ---- ground that is far longer than all that stands on it goes on beyond the picture, which says
# so; a wall that is only long does not
ground=$(patch ground 0 0.5 '[-1000, 0], [1000, 0]')
room "$work/ground.geojson" "$ground" "$(patch mast 1 0.5 '[0, 1], [0, 3]')" \
  "$(patch post 1 0.5 '[4, 1], [4, 2]')"
succeeds solve "$work/ground.geojson" --quiet --eps 1 --draw "$work/ground.svg"
check "a picture of what stands on the ground: $(aspect "$work/ground.svg")" \
  between "$(aspect "$work/ground.svg")" 0.9 2.5
# Letters are outlines: the sentence makes more of them than there are without it.
room "$work/street.geojson" "$(patch ground 0 0.5 '[-10, 0], [10, 0]')" \
  "$(patch mast 1 0.5 '[0, 1], [0, 3]')" "$(patch post 1 0.5 '[4, 1], [4, 2]')"
succeeds solve "$work/street.geojson" --quiet --eps 1 --draw "$work/street.svg"
check "ground of 20 is shown whole: $(aspect "$work/street.svg")" \
  between "$(aspect "$work/street.svg")" 2.5 8
letters() {
  grep -o '<use ' "$1" | wc -l
}
check "the picture says what it leaves out: $(letters "$work/ground.svg") letters" \
  test "$(letters "$work/ground.svg")" -gt $(($(letters "$work/street.svg") + 40))

# ---- links as tiles: each has one in the rectangle of two patches, which they fill, and two in
# the square of more patches
tiled() { # tiled SCENE NAME OPTIONS...
  scene=$1
  name=$2
  shift 2
  succeeds solve "$scene" --quiet --no-error "$@" --tiles "$work/$name.svg" --json "$work/$name.json"
  check "tiles of $name are XML" is_xml "$work/$name.svg"
}
# tiles FILE: x y width height of each, in its place of the page; a tile has a white outline
tiles() {
  sed -n 's/.*fill:none;.*stroke:rgb(100%, *100%, *100%);.* d="M \(.*\) Z.*/\1/p' "$1" | tr -d 'L' |
    awk '{ printf "%.6f %.6f %.6f %.6f\n", $1, $2, $5 - $1, $6 - $2 }'
}
links() {
  sed -n 's/.*"links": \([0-9]*\).*/\1/p' "$1" | head -n 1
}
# covered FILE: the part of the sides of 560 points that tiles cover
covered() {
  awk '{ sum += $3 * $4 / 560 / 560 } END { printf "%.4f", sum }' "$1"
}
tiled "$scenes/par-near.geojson" rectangle --eps 0.3 --variant modified
tiles "$work/rectangle.svg" >"$work/rectangle"
check "as many tiles as links: $(wc -l <"$work/rectangle")" \
  [ "$(wc -l <"$work/rectangle")" = "$(links "$work/rectangle.json")" ]
check "they fill the rectangle: $(covered "$work/rectangle")" [ "$(covered "$work/rectangle")" = 1.0000 ]
sed 1d "$work/rectangle" >"$work/less"
check "one less would be seen: $(covered "$work/less")" [ "$(covered "$work/less")" != 1.0000 ]
tiled "$block" square --eps 0.5 --max-level 4
tiles "$work/square.svg" >"$work/square"
check "two tiles for a link: $(wc -l <"$work/square")" \
  [ "$(wc -l <"$work/square")" = $((2 * $(links "$work/square.json"))) ]
# symmetric FILE: whether the square has the mirror image of each tile about the diagonal from
# (50, 622) to (610, 62), to what is lost when a page is written
symmetric() {
  awk 'function far(a, b) { return a > b + 0.01 || a < b - 0.01 }
    { x[NR] = $1; y[NR] = $2; w[NR] = $3; h[NR] = $4 }
    END { for (i = 1; i <= NR; i++) {
            for (k = 1; k <= NR; k++)
              if (!far(x[k], 672 - y[i] - h[i]) && !far(y[k], 672 - x[i] - w[i]) &&
                  !far(w[k], h[i]) && !far(h[k], w[i])) break
            if (k > NR) exit 1 } }' "$1"
}
asymmetric() {
  ! symmetric "$1"
}
check "the square is symmetric" symmetric "$work/square"
sed 1d "$work/square" >"$work/less"
check "without a tile it is not" asymmetric "$work/less"

# So many that no program would open a page of them: they are an image.
printf '{"type": "FeatureCollection", "features": [%s, %s]}' \
  '{"type": "Feature", "properties": {}, "geometry": {"type": "LineString", "coordinates": [[0, 0], [1, 0]]}}' \
  '{"type": "Feature", "properties": {}, "geometry": {"type": "LineString", "coordinates": [[0, -1], [1, -1]]}}' \
  >"$work/apart.geojson"
succeeds solve "$work/apart.geojson" --quiet --no-error --tiles "$work/apart.svg"
check "no link, no scale of kernels" lacks linearGradient "$work/apart.svg"
check "which there is with links" grep -q linearGradient "$work/rectangle.svg"
succeeds solve "$scenes/par-near.geojson" --quiet --no-error --eps 0.05 --tiles "$work/many.svg"
check "many tiles are XML" is_xml "$work/many.svg"
check "they are an image" grep -q '<image' "$work/many.svg"
check "few are not" lacks '<image' "$work/rectangle.svg"

# tile NAME X Y: the colour of a point of the sides, from below
tile() {
  "$pixels" "$1" "$(awk -v x="$2" 'BEGIN { print int(2 * (50 + 560 * x)) }')" \
    "$(awk -v y="$3" 'BEGIN { print int(2 * (622 - 560 * y)) }')" | tail -n 1
}
green() {
  tile "$@" | cut -d ' ' -f 2
}
succeeds solve "$scenes/par-near.geojson" --quiet --no-error --eps 1 --tiles "$work/tiles.png"
check "where patches face each other the kernel is large: $(tile "$work/tiles.png" 0.47 0.53)" \
  [ "$(green "$work/tiles.png" 0.47 0.53)" -gt 150 ]
check "at their far ends it is small: $(tile "$work/tiles.png" 0.03 0.03)" \
  [ "$(green "$work/tiles.png" 0.03 0.03)" -lt 50 ]
succeeds solve "$scenes/screened-room.geojson" --quiet --no-error --eps 0.2 --tiles "$work/tiles.png"
check "a patch does not see itself" [ "$(tile "$work/tiles.png" 0.1 0.11)" = "255 255 255 255" ]
check "shadows are white" [ "$(tile "$work/tiles.png" 0.52 0.1)" = "255 255 255 255" ]
check "what sees each other is not" [ "$(tile "$work/tiles.png" 0.3 0.105)" != "255 255 255 255" ]
succeeds solve "$work/dark.geojson" --quiet --no-error --tiles "$work/dark.svg"
check "of a dark scene there are tiles, too" is_xml "$work/dark.svg"

# ---- a film: its frames, and that all of its bytes are as PNG wants them
succeeds solve "$block" --quiet --eps 4 --multigrid 32:0.5 --watch "$work/film.png"
check "what plays no films shows the first frame" "$pixels" "$work/film.png" >"$work/size"
tile_in_film() { # tile_in_film X Y: of the middle panel
  "$pixels" "$work/film.png" "$(awk -v x="$1" 'BEGIN { print int(384 + 312 * x) }')" \
    "$(awk -v y="$2" 'BEGIN { print int(396 - 312 * y) }')" | tail -n 1
}
check "it has tiles of links" [ "$(tile_in_film 0.3 0.1)" != "255 255 255 255" ]
check "and of nothing else" [ "$(tile_in_film 0.1 0.1)" = "255 255 255 255" ]
cat >"$work/film.py" <<'END'
import struct, sys, zlib
data = open(sys.argv[1], "rb").read()
assert data[:8] == b"\x89PNG\r\n\x1a\n"
at, number, controls, images, kinds = 8, 0, 0, [], []
while at < len(data):
    size, kind = struct.unpack(">I4s", data[at:at + 8])
    body = data[at + 8:at + 8 + size]
    crc = struct.unpack(">I", data[at + 8 + size:at + 12 + size])[0]
    assert zlib.crc32(data[at + 4:at + 8 + size]) == crc
    if kind == b"acTL": frames = struct.unpack(">I", body[:4])[0]
    if kind in (b"fcTL", b"fdAT"):
        assert struct.unpack(">I", body[:4])[0] == number
        number += 1
    if kind == b"IHDR": width, height = struct.unpack(">II", body[:8])
    if kind == b"fcTL":
        assert struct.unpack(">II", body[4:12]) == (width, height)
        images.append(b"")
    if kind == b"IDAT": images[-1] += body
    if kind == b"fdAT": images[-1] += body[4:]
    kinds.append(kind)
    at += 12 + size
assert kinds[0] == b"IHDR" and kinds[-1] == b"IEND" and kinds[1:3] == [b"iTXt", b"acTL"]
assert len(images) == frames == int(sys.argv[2])
assert all(len(zlib.decompress(image)) == height * (1 + 3 * width) for image in images)
END
if command -v python3 >/dev/null 2>&1; then
  check "a film of four frames" python3 "$work/film.py" "$work/film.png" 4
  not_a_film() {
    ! python3 "$work/film.py" "$@" 2>/dev/null
  }
  check "five would be missed" not_a_film "$work/film.png" 5
  head -c 3000 "$work/film.png" >"$work/broken.png"
  printf x >>"$work/broken.png"
  tail -c +3002 "$work/film.png" >>"$work/broken.png"
  check "a wrong byte would be found" not_a_film "$work/broken.png" 4
fi

# ---- a chart of costs: the curve of the automatic method goes right and up, or stays
if command -v gnuplot >/dev/null 2>&1; then
  succeeds cost "$scenes/square-room.geojson" --methods auto --max-seconds 1 --quiet \
    --against links --plot "$work/cost.svg"
  # forward COLOUR ORDER: whether the path of this colour has x that does not fall, and y that does
  # not grow downwards; ORDER is cat, or tac for its points from the end
  forward() {
    tr '\n' ' ' <"$work/cost.svg" | sed 's/<path/\n&/g' | grep -e "rgb($1)" |
      sed "s/.* d='M\([^']*\)'.*/\1/" | head -n 1 | tr 'M' 'L' | tr 'L' '\n' | tr ',' ' ' | "$2" |
      awk 'NF == 2 { n++; if (n > 1 && ($1 < x - 0.02 || $2 > y + 0.02)) back = 1; x = $1; y = $2 }
           END { exit back || n < 4 }'
  }
  backward() {
    ! forward "$1" tac
  }
  check "auto never goes back" forward '  0, 109,  44' cat
  check "from its end it does" backward '  0, 109,  44'
fi

summary check-pictures
