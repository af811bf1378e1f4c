# SPDX-License-Identifier: GPL-3.0-or-later
# compare.awk EXPECTED ACTUAL: whether a command printed what a page shows.
#
# In what is shown "..." stands for any text, and a line "..." for any lines.  All else is equal,
# but for blanks at ends of lines.
function same(shown, line,    part, n, k, from) {
  n = split(shown, part, /\.\.\./)
  if (n < 2) return shown == line
  if (substr(line, 1, length(part[1])) != part[1]) return 0
  from = length(part[1]) + 1
  for (k = 2; k < n; k++) {
    if (!index(substr(line, from), part[k])) return 0
    from += index(substr(line, from), part[k]) + length(part[k]) - 1
  }
  return length(line) - from + 1 >= length(part[n]) &&
    substr(line, length(line) - length(part[n]) + 1) == part[n]
}

{ sub(/[ \t]+$/, "") }
FILENAME == ARGV[1] { shown[++wanted] = $0; next }
{ line[++got] = $0 }

END {
  for (j = i = 1; i <= wanted; i++) {
    if (shown[i] == "...") { skip = 1; continue }
    while (skip && j <= got && !same(shown[i], line[j])) j++
    if (j > got || !same(shown[i], line[j])) {
      print "  shown:   " shown[i]
      print "  printed: " (j > got ? "(nothing more)" : line[j])
      exit 1
    }
    skip = 0
    j++
  }
  if (!skip && j <= got) {
    print "  shown:   (nothing more)"
    print "  printed: " line[j]
    exit 1
  }
}
