# SPDX-License-Identifier: GPL-3.0-or-later
# What pages of the site are called; for site.awk and menu.awk.

# The letters and digits of a heading, or of the part behind # of a link to it.
function letters(text) {
  text = tolower(text)
  gsub(/[^a-z0-9]/, "", text)
  return text
}

# The label of a page by its path from the top, of a heading in it if one is given.
function label(path, heading) {
  if (path == "README.md" && heading == "") return "index"
  sub(/\.md$/, "", path)
  gsub(/[^A-Za-z0-9]/, "_", path)
  return tolower(path) (heading == "" ? "" : "-" heading)
}

# A path without . and ..
function clean(path) {
  path = path "/"
  while (sub(/\/\.\//, "/", path) || sub(/[^\/]*[^\/.][^\/]*\/\.\.\//, "", path)) {}
  sub(/\/$/, "", path)
  return path
}
