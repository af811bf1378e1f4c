# SPDX-License-Identifier: GPL-3.0-or-later
# awk -f texts.awk schemas/*.json: the files as strings of C, a line each, as a string of a whole file
# is longer than what every compiler takes.
function quoted(text) {
  gsub(/\\/, "\\\\", text)
  gsub(/"/, "\\\"", text)
  return "\"" text "\""
}
BEGIN { print "/* Made by tools/schema/texts.awk. */\n#include \"schema/texts.h\"\n\n#include <stddef.h>" }
FNR == 1 {
  if (count) print "    NULL};"
  name[++count] = FILENAME
  sub(/.*\//, "", name[count])
  sub(/\.json$/, "", name[count])
  print "\nstatic const char *const schema_" count "[] = {"
}
/^  "title": / && !title[count] {
  title[count] = $0
  sub(/^  "title": "/, "", title[count])
  sub(/",$/, "", title[count])
}
{ print "    " quoted($0) "," }
END {
  print "    NULL};\n\nconst schema_text schema_texts[] = {"
  for (k = 1; k <= count; k++)
    print "    {" quoted(name[k]) ", " quoted(title[k]) ", schema_" k "},"
  print "    {NULL, NULL, NULL}};"
}
