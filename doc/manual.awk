# SPDX-License-Identifier: GPL-3.0-or-later
# manual.awk FILE: a manual page as a page of Doxygen, for the macros that tools/hr2d.1 uses.

function text(s) {
  gsub(/&/, "\\&amp;", s); gsub(/</, "\\&lt;", s); gsub(/>/, "\\&gt;", s)
  gsub(/\\fI/, "<em>", s); gsub(/\\f[PR]/, "</em>", s)
  gsub(/\\-/, "-", s); gsub(/\\~/, "\\&#160;", s); gsub(/\\&amp;/, "", s); gsub(/\\e/, "\\&#92;", s)
  gsub(/\\\(\*r/, "ρ", s); gsub(/\\\(\*e/, "ε", s); gsub(/\\\(\*p/, "π", s)
  gsub(/\\\(\*F/, "Φ", s); gsub(/\\\(\*s/, "σ", s)
  gsub(/\\\(\*w/, "ω", s); gsub(/\\\(\*S/, "Σ", s); gsub(/\\\(is/, "∫", s)
  gsub(/\\\(->/, "→", s); gsub(/\\\(-&gt;/, "→", s); gsub(/\\\(mu/, "×", s); gsub(/\\\(sr/, "√", s)
  gsub(/\\\(S2/, "²", s); gsub(/\\\(pt/, "∝", s); gsub(/\\\(~~/, "≈", s)
  gsub(/\\\(:u/, "ü", s); gsub(/\\\(dq/, "\"", s)
  if (s ~ /\\/) { print FILENAME ":" FNR ": " s >"/dev/stderr"; failed = 1 }
  return s
}

# The words of a line, of which quotation marks may hold several together.
function words(s, word,    n) {
  n = 0
  while (match(s, /"[^"]*"|[^ ]+/)) {
    word[++n] = substr(s, RSTART, RLENGTH)
    gsub(/"/, "", word[n])
    s = substr(s, RSTART + RLENGTH)
  }
  return n
}

function font(letter, s) {
  if (letter == "B") return "<b>" s "</b>"
  if (letter == "I") return "<em>" s "</em>"
  return s
}

# A line in its fonts: .B and .I have one, .BR and the like take turns from word to word.
function line(s,    macro, word, n, k, done) {
  if (s !~ /^\./) return text(s)
  macro = s
  sub(/ .*/, "", macro)
  sub(/^\.[A-Z]+ */, "", s)
  if (length(macro) == 2) {
    gsub(/"/, "", s)
    return font(substr(macro, 2), text(s))
  }
  n = words(s, word)
  for (k = 1; k <= n; k++) done = done font(substr(macro, 3 - k % 2, 1), text(word[k]))
  return done
}

function close_list() {
  if (list[level]) print (list[level] == "dl" ? "</dd></dl>" : "</li></ul>")
  list[level] = ""
}
function open_list(kind) {
  if (list[level] == kind) print (kind == "dl" ? "</dd>" : "</li>")
  else { close_list(); print "<" kind ">" }
  list[level] = kind
}
function close_lists() {
  for (; level > 0; level--) close_list()
  close_list()
}
function heading(depth, s) {
  close_lists()
  gsub(/"/, "", s)
  print "<h" depth ">" text(depth == 2 ? substr(s, 1, 1) tolower(substr(s, 2)) : s) "</h" depth ">"
}

NR == 1 {
  level = 0
  print "/** @page tools_hr2d_1 The program hr2d\n@htmlonly"
}
/^\.\\"/ || /^\.TH/ { next }
/^\.SH/ { heading(2, substr($0, 5)); next }
/^\.SS/ { heading(3, substr($0, 5)); next }
/^\.TP/ { open_list("dl"); tag = 1; next }
/^\.TQ/ { print "</dd>"; tag = 1; next }
/^\.IP *$/ { print "<p>"; next }
/^\.IP/ { open_list("ul"); print "<li>"; next }
/^\.RS/ { level++; next }
/^\.RE/ { close_list(); level--; next }
/^\.PP/ { close_list(); print "<p>"; next }
/^\.br/ { print "<br>"; next }
/^\.nf/ { print "<pre class=\"fragment\">"; next }
/^\.fi/ { print "</pre>"; next }
/^\.[^BIR]/ { print FILENAME ":" FNR ": " $0 >"/dev/stderr"; failed = 1; next }
tag { print "<dt>" line($0) "</dt>\n<dd>"; tag = 0; next }
{ print line($0) }
END { close_lists(); print "@endhtmlonly */"; exit failed }
