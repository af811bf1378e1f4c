# SPDX-License-Identifier: GPL-3.0-or-later
# awk -v top=DIR -f label.awk -f site.awk FILE: a Markdown page as Doxygen wants it.  Doxygen's
# input filter.
#
# Pages are written for a plain forge view: links are paths from the page, with #heading behind.
# Here headings get labels, and links of pages, headers and examples become references to these.
# A table of doc/figures gets a title.
# A link to anything else in the tree becomes plain text.  Doxygen finds pictures by their names.
# Lines keep their numbers.

# What replaces [text](target).
function link(text, target,    path, part, name) {
  if (target ~ /^[a-z]+:/) return "[" text "](" target ")"
  path = target
  part = index(target, "#") ? substr(target, index(target, "#") + 1) : ""
  sub(/#.*/, "", path)
  path = path == "" ? page : clean(folder path)
  name = path
  sub(/.*\//, "", name)
  if (path ~ /\.md$/) return "[" text "](@ref " label(path, letters(part)) ")"
  if (path ~ /^include\/.*\.h$/ || path ~ /^examples\/.*\.c$/)
    return "[" text "](@ref " name ")"
  if (path == "NEWS" || path == "COPYING") return "<a href=\"" name "\">" text "</a>"
  if (path ~ /^include\/hr2d\/?$/) return "<a href=\"files.html\">" text "</a>"
  if (path ~ /^examples\/?$/) return "<a href=\"examples.html\">" text "</a>"
  if (path == "tools/hr2d.1") return "[" text "](@ref tools_hr2d_1)"
  return text
}

# All links of a text without code blocks.
function rewrite(text,    done, found, cut) {
  done = ""
  while (match(text, /\[[^][]*\]\([^()]*\)/)) {
    found = substr(text, RSTART, RLENGTH)
    cut = index(found, "](")
    done = done substr(text, 1, RSTART - 1)
    text = substr(text, RSTART + RLENGTH)
    if (done ~ /!$/) {
      sub(/\]\([^()]*\//, "](", found)
      done = done found
    } else
      done = done link(substr(found, 2, cut - 2), substr(found, cut + 2, length(found) - cut - 2))
  }
  text = done text
  # Doxygen 1.9 does not see what is strong and begins or ends with code.
  while (match(text, /\*\*[^*]*`\*\*/) || match(text, /\*\*`[^*]*\*\*/))
    text = substr(text, 1, RSTART - 1) "<b>" substr(text, RSTART + 2, RLENGTH - 4) "</b>" \
      substr(text, RSTART + RLENGTH)
  return text
}

function flush() {
  if (held != "") printf "%s", rewrite(held)
  held = ""
}

function heading(line,    title, id) {
  title = line
  sub(/^#+ +/, "", title)
  if (line ~ /^# /) {
    titled = 1
    return page == "README.md" ? line : line " {#" label(page, "") "}"
  }
  id = letters(title)
  if (id in used) id = id used[id]++
  else used[id] = 1
  return line " {#" label(page, id) "}"
}

FNR == 1 {
  page = substr(clean(FILENAME), length(clean(top)) + 2)
  folder = page
  sub(/[^\/]*$/, "", folder)
  blank = 1
  if (page ~ /^doc\/figures\// && !/^#/) {
    title = substr(page, length(folder) + 1)
    sub(/\.md$/, "", title)
    gsub(/-/, " ", title)
    print "# " toupper(substr(title, 1, 1)) substr(title, 2) " {#" label(page, "") "}\n"
  }
}
/^ *(```|~~~)/ { fenced = !fenced }
fenced || /^ *(```|~~~)/ || (/^    / && (blank || indented)) {
  flush()
  indented = /^    /
  print
  next
}
{ indented = 0; blank = /^[ \t]*$/ }
/^#+ / { flush(); print heading($0); next }
# The line below a title is blank.
blank && titled == 1 {
  titled = 2
  if (page ~ /^doc\/[a-z-]*\.md$/) $0 = "\\tableofcontents"
}
{ held = held $0 "\n" }
blank { flush() }
END { flush() }
