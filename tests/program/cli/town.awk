# SPDX-License-Identifier: GPL-3.0-or-later
# awk -v seed=S -v rows=R -v houses=H -v faces=WORD -f town.awk >TOWN.geojson
#
# Footprints of a made-up town, with the faults that footprints of maps have: R rows of H terraced
# houses each, in metres, written to millimetres.  Neighbours share a party wall, exactly, or over a
# part of it; or a slit of 1 to 20 mm is between them, or they overlap by as much.  One house in ten is
# L-shaped, one in fifteen has a garden wall behind it whose end is up to 2 cm short of the house or
# behind its wall, or a closed plate 1 to 30 mm thick.  Most features have no name.
function random() { seed = (seed * 16807) % 2147483647; return seed / 2147483647 }
function between(low, high) { return low + (high - low) * random() }
function mm(x) { return sprintf("%.3f", x) }
function point(x, y) { return "[" mm(x) ", " mm(y) "]" }
function feature(properties, type, coordinates) {
  printf "%s{ \"type\": \"Feature\", \"properties\": {%s}, \"geometry\": { \"type\": \"%s\", \"coordinates\": %s } }",
    count++ ? ",\n" : "", properties, type, coordinates
}
function properties(wanted) {
  text = wanted ", \"reflectance\": 0.3"
  if (random() < .1) text = text ", \"name\": \"house " count "\""
  if (random() < .3) text = text ", \"building\": \"yes\", \"height\": \"" int(between(4, 20)) "\""
  return text
}
function house(left, right, front, back) {
  if (random() < .1) {
    middle = (left + right) / 2; step = front + (back - front) * .6
    feature(properties(look), "Polygon", "[[" point(left, front) ", " point(right, front) ", " \
      point(right, step) ", " point(middle, step) ", " point(middle, back) ", " point(left, back) ", " \
      point(left, front) "]]")
  } else
    feature(properties(look), "Polygon", "[[" point(left, front) ", " point(right, front) ", " \
      point(right, back) ", " point(left, back) ", " point(left, front) "]]")
}
function garden(right, back) {
  feature(properties("\"sides\": \"both\""), "LineString",
    "[" point(right - 1, back + between(-.02, .02)) ", " point(right - 1, back + 5) "]")
}
function plate(left, back) {
  thick = between(.001, .03)
  feature(properties(look), "Polygon", "[[" point(left + 1, back + 2) ", " point(left + 3, back + 2) ", " \
    point(left + 3, back + 2 + thick) ", " point(left + 1, back + 2 + thick) ", " point(left + 1, back + 2) "]]")
}
BEGIN {
  seed = seed % 2147483646 + 1
  look = faces ? "\"faces\": \"" faces "\"" : "\"use\": \"residential\""
  print "{ \"type\": \"FeatureCollection\", \"hr2d\": { \"background\": 1 }, \"features\": ["
  for (row = 0; row < rows; row++) {
    x = between(0, 3); depth = between(8, 14); y = row * 40
    for (k = 0; k < houses; k++) {
      width = between(5, 12)
      back = random() < .5 ? y + depth : y + depth + between(-2, 2)
      house(x, x + width, y, back)
      if (random() < .07) garden(x + width, back)
      if (random() < .05) plate(x, back)
      kind = random()
      x += width
      if (kind < .25) x += between(.001, .02)       # a slit
      else if (kind < .35) x -= between(.001, .02)  # an overlap
      else if (kind < .5) x += between(2, 6)        # a passage
    }
  }
  print "\n] }"
}
