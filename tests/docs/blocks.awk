# SPDX-License-Identifier: GPL-3.0-or-later
# blocks.awk -v out=FOLDER PAGE: what a page tells its reader to save and to run.
#
# A block `console` has commands behind "$ ", lines that go on behind "> ", and the output below
# each.  Any other block is a file, and the line above it ends with its name, as in "Save it as
# `room.geojson`:".  FOLDER gets the text of step K as K and K.expected, and FOLDER/steps a
# line for each: "file K LINE NAME" or "command K LINE fails|succeeds".  A command may fail if the
# page shows it, by "$ echo $?" as the next one.
function wrong(line, what) {
  printf "%s:%d: %s\n", FILENAME, line, what >"/dev/stderr"
  bad = 1
}

function open_command(text) {
  at[++steps] = FNR
  kind[steps] = "command"
  name[steps] = "succeeds"
  if (text == "echo $?" && kind[steps - 1] == "command") name[steps - 1] = "fails"
  print text >(out "/" steps)
  printf "" >(out "/" steps ".expected")
}

/^```/ && !inside {
  inside = FNR
  language = substr($0, 4)
  if (language != "console") {
    if (!match(above, /`[^`]+`:$/)) {
      wrong(FNR, "the line above does not end with the name of this file: `NAME`:")
      known = 0
      next
    }
    known = 1
    at[++steps] = FNR
    kind[steps] = "file"
    name[steps] = substr(above, RSTART + 1, RLENGTH - 3)
    printf "" >(out "/" steps)
  }
  next
}
/^```/ { inside = 0; next }
inside && language == "console" {
  if (/^\$ /) open_command(substr($0, 3))
  else if (FNR == inside + 1) wrong(FNR, "a block of commands begins with \"$ \"")
  else if (/^> / && shown != FNR - 1) print substr($0, 3) >(out "/" steps)
  else { print >(out "/" steps ".expected"); shown = FNR }
  next
}
inside && known { print >(out "/" steps); next }
!inside && NF { above = $0; sub(/[ \t]+$/, "", above) }

END {
  if (inside) wrong(inside, "this block does not end")
  printf "" >(out "/steps")
  for (k = 1; k <= steps; k++) print kind[k], k, at[k], name[k] >(out "/steps")
  exit bad
}
