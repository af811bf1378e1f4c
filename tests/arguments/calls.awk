# SPDX-License-Identifier: GPL-3.0-or-later
# Reads the preprocessed public headers and writes tests/arguments/calls.inc: for each public
# function a C function that calls it with good arguments (case 0), and with one wrong argument at
# a time.  A type or a parameter for which there is no good value ends the build: a new function
# has to say here what its arguments are.

function fail(text) { print "calls.awk: " text > "/dev/stderr"; failed = 1; exit 1 }
function trim(s) { gsub(/^ +| +$/, "", s); return s }

# What a good value is, by type; "F.P" overrides it for parameter P of hr2d_F.
BEGIN {
  good["const hr2d_scene *"] = "s->scene"; good["hr2d_scene *"] = "s->drawn"
  good["const hr2d_hierarchy *"] = "s->hierarchy"; good["hr2d_hierarchy *"] = "s->free_hierarchy"
  good["const hr2d_linkset *"] = "s->links"; good["hr2d_linkset *"] = "s->links"
  good["const hr2d_solution *"] = "s->solution"; good["hr2d_clusters *"] = "s->clusters"
  good["const hr2d_clusters *"] = "s->clusters"; good["const hr2d_exchange_rows *"] = "s->rows"
  good["hr2d_scene **"] = "&s->made_scene"; good["hr2d_hierarchy **"] = "&s->made_hierarchy"
  good["hr2d_linkset **"] = "&s->made_links"; good["hr2d_solution **"] = "&s->made_solution"
  good["hr2d_clusters **"] = "&s->made_clusters"
  good["hr2d_exchange_rows **"] = "&s->made_rows"
  good["const hr2d_enclosure *"] = "s->enclosure"; good["hr2d_enclosure **"] = "&s->made_enclosure"
  good["hr2d_enclosure *"] = "s->enclosure"
  good["hr2d_operator *"] = good["const hr2d_operator *"] = "s->op"
  good["hr2d_operator **"] = "&s->made_op"; good["operator_solve.start"] = "s->op_solution"
  good["operator_gradient.solution"] = "s->op_solution"
  good["operator_response.first"] = "0"; good["operator_response.columns"] = "1"
  good["double *"] = "s->number"; good["const double *"] = "s->half"; good["double"] = "0.5"
  good["int"] = "1"; good["double (*)[2]"] = "s->part"; good["uint32_t *"] = "s->index"; good["size_t *"] = "&s->size"
  good["size_t"] = "1"; good["uint64_t"] = "0"; good["uint32_t"] = "0"; good["unsigned"] = "1"
  good["const char *"] = "\"HR2D_OK\""; good["const char **"] = "&s->text"
  good["void *"] = "s"; good["hr2d_link *"] = "s->link"; good["const hr2d_link *"] = "s->link"
  good["const hr2d_point *"] = "s->point"; good["const hr2d_segment *"] = "s->segment"
  good["hr2d_point"] = "s->point[0]"; good["hr2d_segment"] = "s->segment[0]"
  good["hr2d_effect"] = good["hr2d_status"] = good["hr2d_warning_code"] = "0"
  good["const hr2d_sun *"] = "&s->sun"; good["const hr2d_sky_piece *"] = "&s->piece"
  good["const hr2d_study_row *"] = good["hr2d_study_row *"] = "s->row"

  # Where a parameter needs another one than its type says.
  good["hierarchy_set_order.order"] = "2"; good["hierarchy_pull.field"] = "s->field"
  good["hierarchy_push.field"] = good["solution_adopt.field"] = "s->field"
  good["hierarchy_divide.element"] = "0"; good["scene_find.name"] = "\"wall\""
  good["oracle_find.name"] = "\"size\""; good["policy_find.name"] = "\"original\""
  good["refine_count.links"] = good["refine_visit.links"] = "s->free_links"
  good["study_run.links"] = good["refine.links"] = good["state_read.links"] = "s->free_links"
  good["study_law.links"] = "s->pair_links"
  good["linkset_create.hierarchy"] = "s->free_hierarchy"
  good["scene_parse.text"] = "s->file"; good["scene_parse.size"] = "strlen(s->file)"
  good["scene_read.path"] = "s->path"; good["state_read_scene.scene"] = "s->empty"
  good["scene_commit.scene"] = good["scene_set_wavelengths.scene"] = "s->drawn"
  good["scene_set_weights.scene"] = "s->drawn"
  good["scene_set_period.period"] = "((hr2d_point){9, 0})"
  good["solution_element.element"] = good["element_level.element"] = "0"
  good["element_parent.element"] = "0"; good["hierarchy_leaf.patch"] = "1"
  good["scene_absorption.gas"] = good["solution_gas.gas"] = "0"
  good["scene_mirror.mirror"] = good["scene_image.image"] = "0"
  good["scene_mirror.scene"] = "s->mirrored"
  good["exchange_area_occluded.j"] = good["exchange_area_past.j"] = "s->segment + 1"
  good["exchange_area.j"] = good["kernel.j"] = "s->segment + 1"
  good["leaf_sums.row_from"] = "0"; good["leaf_sums.row_to"] = "1"
  good["study_fit_rows.count"] = "4"; good["study_fit_rows.rows"] = "s->row"
  good["hierarchy_originals.original"] = "s->index"; good["hierarchy_pull.bands"] = "2"
  good["hierarchy_push.bands"] = "2"; good["black_body_part.to"] = "2"
  good["state_read.read"] = "read_state"; good["state_read_scene.read"] = "read_scene"
  good["exchange_area_occluded.occluder"] = good["exchange_area_past.occluder"] = "s->segment + 2"
  good["scene_set_sky.pieces"] = "1"; good["sky_perez.clearness"] = "1.5"; good["scene_sunlit_parts.room"] = "4"
  good["scene_sunlight_over.from"] = "0"; good["linkset_read.first"] = "0"

  # Pointers that may be NULL, by type or by "F.P".  A callback of progress may be missing.
  n = split("void *|const char **|hr2d_progress_fn|const hr2d_allocator *|const hr2d_oracle *|" \
    "const hr2d_policy *|const hr2d_target *|hr2d_account *|hr2d_error *|hr2d_refine_counts *|" \
    "hr2d_matrix_counts *|hr2d_field_counts *|hr2d_snap_report *|const hr2d_account *|" \
    "const hr2d_field_values *|const hr2d_field_grid *|const hr2d_refine_options *|" \
    "const hr2d_solve_options *|const hr2d_matrix_options *|const hr2d_clusters_options *|" \
    "const hr2d_field_options *|const hr2d_lint_options *|const hr2d_past_options *|" \
    "scene_add.index|scene_add_thermal.index|scene_add_gas.index|solution_gas.emission|" \
    "solution_gas.heat|scene_split_crossings.cuts|study_run.done|" \
    "scene_heat.value|hierarchy_divide.child|leaf_sums.front|leaf_sums.back|" \
    "field_rows_visit.normal|const hr2d_enclose_options *|hr2d_enclosure_account *|" \
    "const hr2d_light *|operator_solve.start|operator_gradient.v|operator_gradient.w|" \
    "sky_clearness.brightness|enclosure_error.average|enclosure_error.irradiance", list, "|")
  for (k = 1; k <= n; k++) optional[list[k]] = 1
  required["refine_count.counts"] = required["refine_visit.counts"] = 1

  # Numbers of items of an array: too large a one cannot be noticed.
  n = split("count size bands pieces room important_count emission_bands reflectance_bands " \
    "transmittance_bands absorption_bands emissivity_bands kelvins terms order columns rows first " \
    "from to", list, " ")
  for (k = 1; k <= n; k++) counts[list[k]] = 1
  # A number is as good as any other; or the value of a wrong argument is a text all the same.
  n = split("linkset_read.first options_init.size hierarchy_set_order.order", list, " ")
  for (k = 1; k <= n; k++) any[list[k]] = 1
  any["scene_read.path"] = any["strerror.status"] = any["scene_temperature.irradiance"] = 1
}

# Statements outside of braces, one after the other.
{ text = text " " $0 }
END {
  if (failed) exit 1
  gsub(/[ \t]+/, " ", text)
  depth = 0
  for (at = 1; at <= length(text); at++) {
    c = substr(text, at, 1)
    if (c == "{") depth++
    if (c == "}") depth--
    if (c == ";" && depth == 0) { statement(trim(one)); one = "" } else one = one c
  }
  print "static const struct call {\n  const char *name;\n  int (*make)(stage *s, int *k);\n  int changes; /* an object of the stage */\n} calls[] = {"
  for (k = 1; k <= functions; k++)
    printf "  {\"%s\", call_%s, %d},\n", name_of[k], name_of[k], changes[name_of[k]]
  print "};"
}

function statement(t) {
  if (t !~ /hr2d_/) return
  if (t ~ /^typedef enum/) { sub(/.*\} */, "", t); enumeration[t] = 1; return }
  if (t ~ /^enum/) return
  if (t ~ /^typedef struct [a-z0-9_]+ \{/) { structure(t); return }
  if (t ~ /^typedef (const )?[a-z0-9_]+ \**\(\*hr2d_/) {
    sub(/^[^(]*\(\*/, "", t); sub(/\).*/, "", t)
    callback[t] = 1; return
  }
  if (t ~ /^(typedef )?struct /) return
  if (t !~ /\)$/) fail("what is this: " t)
  declaration(t)
}

# Splits "type name" into T and N.
function part(p,    k) {
  p = trim(p)
  if (p ~ /\(\*[a-z_]+\)\[2\]/) { N = p; sub(/.*\(\*/, "", N); sub(/\).*/, "", N); T = "double (*)[2]"; return }
  N = p; sub(/.*[ *]/, "", N)
  T = trim(substr(p, 1, length(p) - length(N)))
  sub(/\*$/, " *", T); gsub(/ +/, " ", T); gsub(/\* \*/, "**", T)
  sub(/^struct /, "", T); sub(/const struct /, "const ", T)
}

function wrong(lines) { body = body "  TRY(" lines ");\n" }
function refused(lines) { wrong(lines " must = 1;") }
function survived(lines) { wrong(lines) }

# A struct: a function that makes wrong one member after the other.
function structure(t,    name, list, n, k, m, i, each) {
  name = t; sub(/^typedef struct /, "", name); sub(/ .*/, "", name)
  is_struct[name] = 1
  sub(/^[^{]*\{/, "", t); sub(/\}[^}]*$/, "", t)
  body = ""
  n = split(t, list, ";")
  for (k = 1; k <= n; k++) {
    m = trim(list[k])
    if (m == "") continue
    i = 1
    if (m ~ /\(\*[a-z_]+\)\(/) { sub(/[^(]*\(\*/, "", m); sub(/\).*/, "", m); T = "callback"; N = m }
    else { i = split(m, each, ","); part(each[1]) }
    member(name, T, N)
    for (; i > 1; i--) member(name, T, trim(each[i]))
  }
  printf "__attribute__((unused)) static void spoil_%s(stage *s, %s *x, int *k) {\n  (void)s, (void)x, (void)k;\n%s}\n\n", \
    name, name, body
}

function member(name, type, n) {
  if (n ~ /\[/) return
  if (n == "struct_size") { sized[name] = 1; return }
  if (type == "hr2d_share *") {
    body = body "  x->" n " = wrong_share(s, k);\n"
  } else if (type == "callback" || type in callback || type ~ /\*$/) {
    if (n !~ /ctx$/) wrong("x->" n " = NULL;")
    if (type == "const char *") wrong("x->" n " = s->broken;")
    if (type == "const hr2d_solution *") wrong("x->" n " = s->other;")
    if (type == "const hr2d_allocator *") wrong("x->" n " = &s->no_hooks;")
  } else if (type == "double") {
    wrong("x->" n " = NAN;"); wrong("x->" n " = -1;")
    wrong("x->" n " = INFINITY;"); wrong("x->" n " = 1e308;")
  } else if (type in enumeration) {
    wrong("x->" n " = (" type ")77;"); wrong("x->" n " = (" type ")-1;")
  } else if (type == "hr2d_point") {
    wrong("x->" n ".x = NAN;"); wrong("x->" n ".y = INFINITY;")
  } else if (n in counts || n == "threads") {
    wrong("x->" n " = 0;")
  } else if (type ~ /^(size_t|unsigned|int|uint32_t|uint64_t)$/) {
    wrong("x->" n " = (" type ")-1;"); wrong("x->" n " = 1;")
  }
}

function parameter(f, type, n,    bare, value) {
  if (type ~ /^hr2d_(scene|hierarchy|linkset|solution|clusters|exchange_rows) \*$/) changes[f] = 1
  bare = type; sub(/^const /, "", bare); sub(/ \*$/, "", bare)
  if ((f "." n) in good) value = good[f "." n]
  else if (type in good) value = good[type]
  else if (type in callback) value = "on_" substr(type, 6)
  else if (bare in is_struct) value = "&x_" n
  else fail("hr2d_" f "(): no good value for " type " " n)
  if (value ~ /^&x_/) start = start "  " bare " x_" n " = s->good_" substr(bare, 6) ";\n"
  if (type == "double (*)[2]") start = start "  double (*" n ")[2] = " value ";\n"
  else start = start "  " type (type ~ /\*$/ ? "" : " ") n " = " value ";\n"
  if (type == "void *") return
  if (type ~ /\*$/ || type in callback || type ~ /\)\[2\]/) {
    if (((type in optional) || ((f "." n) in optional)) && !((f "." n) in required))
      survived(n " = NULL;")
    else
      refused(n " = NULL;")
    if (type == "const hr2d_scene *") survived(n " = s->drawn;")
    if (type == "const char *" && f != "scene_parse" && !((f "." n) in any)) refused(n " = s->broken;")
    if (value ~ /^&x_/ && type ~ /^const/) {
      if (bare in sized) body = body "  for (size_t size = 0; size < sizeof x_" n "; size += size < 8 ? 1 : 4)\n" \
        "    TRY(" n " = cut(s, &x_" n ", size); must = size < sizeof size;);\n"
      body = body "  spoil_" bare "(s, &x_" n ", k);\n"
    }
  } else if (type == "double") {
    survived(n " = NAN;"); survived(n " = -1;"); survived(n " = INFINITY;")
    survived(n " = 1e308;"); survived(n " = -1e-320;")
  } else if (type in enumeration) {
    if ((f "." n) in any) { survived(n " = (" type ")77;"); survived(n " = (" type ")-1;") }
    else { refused(n " = (" type ")77;"); refused(n " = (" type ")-1;") }
  } else if (type ~ /^(int|size_t|unsigned|uint32_t|uint64_t)$/) {
    if (n in counts || (f "." n) in any) survived(n " = 0;")
    else { refused(n " = (" type ")-1;"); refused(n " = 77777;") }
    if (n == "order") { refused(n " = 0;"); refused(n " = 77;") }
  } else if (type == "hr2d_point") survived(n ".x = NAN;")
  else if (type == "hr2d_segment") survived(n ".b.y = INFINITY;")
}

# The answer to a wrong argument that has to be refused.
function judged(type, call) {
  if (type == "void") return "  " call ";\n  return 1;\n"
  if (type == "hr2d_status")
    return "  const hr2d_status r = " call ";\n  return must ? r == HR2D_EINVAL : !good || r == HR2D_OK;\n"
  if (type == "double") return "  const double r = " call ";\n  return !must || isnan(r);\n"
  if (type == "const char *")
    return "  const char *r = " call ";\n  return !must || !r || !*r;\n"
  if (type ~ /\*$/) return "  return !" call " || !must;\n"
  if (type in is_struct) return "  " call ";\n  return 1;\n"
  return "  const uint64_t r = (uint64_t)" call ";\n  return !must || r == 0 || r == HR2D_NO_ELEMENT;\n"
}

function declaration(t,    f, type, list, n, k, names) {
  k = index(t, "(")
  part(substr(t, 1, k - 1)); f = N; type = T
  t = substr(t, k + 1); sub(/\)$/, "", t)
  sub(/^hr2d_/, "", f)
  if (t ~ /^ *void *$/) t = ""
  body = ""; start = ""; names = ""
  if (f ~ /_destroy$/) { # what is destroyed cannot be used again
    part(t)
    start = "  " T N " = NULL;\n"; names = N
  } else {
    n = split(t, list, ",")
    for (k = 1; k <= n; k++) {
      part(list[k])
      names = names (k > 1 ? ", " : "") N
      parameter(f, T, N)
    }
  }
  printf "static int call_%s(stage *s, int *k) {\n%s  int good = 0, must = 0;\n", f, start
  printf "  (void)s, (void)good, (void)must;\n  TRY(good = 1;);\n%s", body
  printf "  if (*k >= 0) return 1;\n%s}\n\n", judged(type, "hr2d_" f "(" names ")")
  name_of[++functions] = f
}
