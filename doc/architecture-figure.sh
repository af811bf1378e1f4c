#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# architecture-figure.sh SRC BUILD: the storeys of SRC/LAYERS as SVG on standard output.  A dot
# says that a storey includes a header of another one, or that its objects in BUILD call it.
# `make architecture-figure` writes doc/figures/architecture.svg with it.
set -eu
src=${1:?names the folder with the sources}
build=${2:?names the folder with their objects}

# A line "use FROM TO" for each two folders.
uses() {
  find "$src" -mindepth 2 -name '*.[ch]' | sort | while read -r file; do
    from=$(basename "$(dirname "$file")")
    sed -n 's|^ *# *include *"\([a-z]*\)/.*|use '"$from"' \1|p' "$file"
  done
  objects=$(find "$build" -name '*.o' ! -path '*/.libs/*' | sort)
  [ -n "$objects" ] || objects=$(find "$build" -name '*.o' | sort)
  for object in $objects; do
    echo "FILE $(echo "$object" | sed 's|/\.libs/|/|; s|.*/\([^/]*\)/[^/]*$|\1|')"
    ${NM:-nm} "$object" | sed 's/^[0-9a-f]* *//'
  done | awk '
    $1 == "FILE" { folder = $2; next }
    $1 ~ /^[TDBRC]$/ { home[$2] = folder }
    $1 == "U" { n++; caller[n] = folder; symbol[n] = $2 }
    END { for (k = 1; k <= n; k++) if (symbol[k] in home)
            print "use", caller[k], home[symbol[k]] }'
}

{
  grep -v '^#' "$src/LAYERS" | sed 's/^/layer /'
  uses | sort -u
} | awk '
  BEGIN {
    row = 27; left = 440; column = 23; top = 92
    what["base"] = "memory, messages, numerical rules"
    what["geometry"] = "segments, exact signs, exchange areas"
    what["triangulation"] = "the plane between walls"
    what["sight"] = "beams, and the classes they end in"
    what["occlusion"] = "a pair of segments and the walls between"
    what["scene"] = "patches, and what commit finds out"
    what["repair"] = "drawings that are slightly off"
    what["formats"] = "GeoJSON and .vs2"
    what["visibility"] = "what a point, a patch, all patches see"
    what["lint"] = "valid, but maybe not meant"
    what["hierarchy"] = "trees of elements"
    what["oracle"] = "error estimates, ways to subdivide"
    what["blocks"] = "p × p coefficients of a pair"
    what["clusters"] = "many patches with many"
    what["links"] = "the link set"
    what["solution"] = "radiosity on the elements"
    what["field"] = "light between the patches"
    what["refine"] = "ProjectKernel: pairs become links"
    what["solve"] = "transport, closure, the linear system"
    what["mesh"] = "the elements that a target needs"
    what["estimate"] = "the error of a solve, a posteriori"
    what["enclosure"] = "answers between two strips"
    what["accuracy"] = "solving to a target error"
    what["state"] = "a stage of a solve on disk"
    # A hue for each group of storeys: ground, scene, objects, calls.
    split("base geometry triangulation sight occlusion", name); for (k in name) hue[name[k]] = "#5b6b7a"
    split("scene repair formats visibility lint", name2); for (k in name2) hue[name2[k]] = "#2f7d6d"
    split("hierarchy oracle blocks clusters links solution", name3)
    for (k in name3) hue[name3[k]] = "#2d6aa0"
    split("field refine solve mesh estimate enclosure accuracy state", name4); for (k in name4) hue[name4[k]] = "#a05a2c"
  }
  $1 == "layer" { layer[++layers] = $2; at[$2] = layers }
  $1 == "use" && $2 != $3 { used[$2, $3] = 1 }
  function y(k) { return top + (layers - k) * row }
  function x(k) { return left + (k - 0.5) * column }
  END {
    width = left + layers * column + 24
    height = top + layers * row + 34
    printf "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %d %d\" ", width, height
    printf "width=\"%d\" height=\"%d\" font-family=\"sans-serif\" font-size=\"13\">\n", width, height
    print "<title>The storeys of src/ and what each uses</title>"
    printf "<rect width=\"%d\" height=\"%d\" rx=\"6\" fill=\"#fff\"/>\n", width, height
    for (k = 1; k <= layers; k++) {
      f = layer[k]; c = hue[f]
      printf "<rect x=\"16\" y=\"%d\" width=\"%d\" height=\"%d\" rx=\"3\" fill=\"%s\" fill-opacity=\"0.09\"/>\n", \
        y(k) + 1, width - 32, row - 2, c
      printf "<rect x=\"16\" y=\"%d\" width=\"112\" height=\"%d\" rx=\"3\" fill=\"%s\"/>\n", \
        y(k) + 1, row - 2, c
      printf "<text x=\"28\" y=\"%d\" fill=\"#fff\" font-weight=\"bold\">%s</text>\n", y(k) + 18, f
      printf "<text x=\"142\" y=\"%d\" fill=\"#222\">%s</text>\n", y(k) + 18, what[f]
      printf "<text transform=\"translate(%.1f %d) rotate(-55)\" fill=\"%s\" font-size=\"12\">%s</text>\n", \
        x(k) + 3, top - 8, c, f
      for (m = 1; m < k; m++)
        if ((f, layer[m]) in used)
          printf "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"5.5\" fill=\"%s\"/>\n", \
            x(m), y(k) + row / 2, hue[layer[m]]
        else
          printf "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"1.5\" fill=\"#999\"/>\n", x(m), y(k) + row / 2
      printf "<rect x=\"%.1f\" y=\"%.1f\" width=\"9\" height=\"9\" fill=\"none\" stroke=\"%s\" stroke-width=\"1.5\"/>\n", \
        x(k) - 4.5, y(k) + row / 2 - 4.5, c
    }
    printf "<text x=\"16\" y=\"%d\" fill=\"#555\" font-size=\"12\">", height - 12
    print "A storey uses those below it: a dot stands for one that it includes or calls.</text>"
    print "</svg>"
  }'
