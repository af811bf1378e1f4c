# SPDX-License-Identifier: GPL-3.0-or-later
# awk -f label.awk -f menu.awk doc/README.md header.html.in: the head of the pages of the site, with
# the menu in the place of @MENU@.  Each section of the list of pages is one of the menu, and the
# first link of each row an entry.

# Where the site has what is at this path of the tree.
function place(path,    name) {
  name = path
  sub(/.*\//, "", name)
  if (path ~ /\.md$/) return label(path) ".html"
  if (path == "include/hr2d") return "files.html"
  if (path == "examples") return "examples.html"
  if (path == "tools/hr2d.1") return label(path) ".html"
  return name
}

FNR == NR && /^## / { menu = menu (menu == "" ? "" : "</ul>\n") "<h2>" substr($0, 4) "</h2>\n<ul>\n" }
FNR == NR && /^\|/ && match($0, /\[[^][]*\]\([^()]*\)/) {
  entry = substr($0, RSTART + 1, RLENGTH - 2)
  cut = index(entry, "](")
  menu = menu "<li><a href=\"$relpath^" place(clean("doc/" substr(entry, cut + 2))) "\">" \
    substr(entry, 1, cut - 1) "</a></li>\n"
}
FNR == NR { next }
/@MENU@/ { print menu "</ul>"; next }
{ print }
