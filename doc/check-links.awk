# SPDX-License-Identifier: GPL-3.0-or-later
# awk -f check-links.awk html/*.html html/*.html: whether every link of the site leads somewhere, and
# nothing is loaded from elsewhere.  The first pass collects the anchors, the second one looks at
# the links.

# Calls found(name, value) for each attribute id, name, href and src of a line.
function attributes(    text, value) {
  text = $0
  while (match(text, /(id|name|href|src)="[^"]*"/)) {
    value = substr(text, RSTART, RLENGTH)
    text = substr(text, RSTART + RLENGTH)
    found(substr(value, 1, index(value, "=") - 1), \
      substr(value, index(value, "\"") + 1, length(value) - index(value, "\"") - 1))
  }
}

function wrong(what) {
  print FILENAME ":" FNR ": " what >"/dev/stderr"
  bad = 1
}

function exists(file,    line) {
  if (!(file in known)) known[file] = (getline line <file) >= 0
  close(file)
  return known[file]
}

function found(name, value,    part, file) {
  if (pass == 1) {
    if (name == "id" || name == "name") anchor[folder page "#" value] = 1
    return
  }
  if (name == "id" || name == "name" || value ~ /^(javascript|mailto):/) return
  links++
  if (value ~ /^[a-z]*:?\/\//) {
    if (name == "src" || /<link /) wrong("loaded from elsewhere: " value)
    return
  }
  gsub(/&amp;/, "\\&", value)
  part = index(value, "#") ? substr(value, index(value, "#") + 1) : ""
  file = value
  sub(/[#?].*/, "", file)
  file = file == "" ? page : file
  if (!exists(folder file)) wrong("no file " value)
  else if (part != "" && file ~ /\.html$/ && !((folder file "#" part) in anchor))
    wrong("no anchor " value)
}

FNR == 1 {
  if (FILENAME == ARGV[1]) pass++
  folder = page = FILENAME
  sub(/[^\/]*$/, "", folder)
  sub(/.*\//, "", page)
}
{ attributes() }
END {
  if (!links) { print "no links" >"/dev/stderr"; bad = 1 }
  exit bad
}
