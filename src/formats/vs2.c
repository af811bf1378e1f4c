/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Scenes from View2D's .vs2 files: one record per line, whose first letter says its kind.  As
   in View2D, vertices and surfaces are numbered from 1 in the order of the file, and a vertex
   comes before the surfaces that end at it. */
#ifndef _POSIX_C_SOURCE
#define _POSIX_C_SOURCE 200809L
#endif
#include <string.h>

#include "base/alloc.h"
#include "formats/scene-file.h"
#include "formats/vs2-impl.h"
#include "scene/scene-impl.h"

/* The letter of a record in upper case.  E, '*' or '/' for any word that begins with it, as in
   "End of data"; 0 for any other word of more than one letter. */
static char record_letter(hr2di_vs2_span word) {
  const char c = *word.at, upper = c >= 'a' && c <= 'z' ? (char)(c - 'a' + 'A') : c;
  if (upper == 'E' || upper == '*' || upper == '/') return upper;
  return word.end - word.at == 1 ? upper : '\0';
}

/* Comments do not decide the format: some JSON has comments, too, against its rules. */
int hr2di_vs2_recognise(const char *text, size_t size) {
  hr2di_vs2_span rest = {text, text + size}, line, word;
  while (hr2di_vs2_line(&rest, &line)) {
    if (!hr2di_vs2_word(&line, &word)) continue;
    const char letter = record_letter(word);
    if (letter != '/') return letter && strchr("TCGVSOFX*", letter) != NULL;
  }
  return 0;
}

static hr2d_status end_of_record(hr2di_vs2 *reader, hr2di_vs2_span *line) {
  hr2di_vs2_span rest = *line, word;
  if (!hr2di_vs2_word(&rest, &word)) return HR2D_OK;
  hr2d_status status = hr2di_vs2_field(reader, line, "text behind the last field");
  if (status) return status;
  return hr2di_message_fail(reader->message, HR2D_ESYNTAX,
                            "line %zu: text behind the last field: %s", reader->line,
                            hr2di_vs2_quote(reader).text);
}

/* Reads the number of a vertex or surface, which must be before + 1. */
static hr2d_status read_sequence(hr2di_vs2 *reader, hr2di_vs2_span *line, const char *what,
                                 size_t before) {
  long long number;
  hr2d_status status = hr2di_vs2_integer(reader, line, "number", &number);
  if (status) return status;
  if (number > 0 && (unsigned long long)number == before + 1) return HR2D_OK;
  if (number > 0 && (unsigned long long)number <= before)
    return hr2di_message_fail(reader->message, HR2D_ESYNTAX,
                              "line %zu: %s %lld is there already", reader->line, what, number);
  return hr2di_message_fail(reader->message, HR2D_ESYNTAX,
                            "line %zu: %s %s where %zu comes next", reader->line, what,
                            hr2di_vs2_quote(reader).text, before + 1);
}

static hr2d_status read_geometry(hr2di_vs2 *reader, hr2di_vs2_span *line) {
  long long dimensions;
  hr2d_status status = hr2di_vs2_integer(reader, line, "geometry", &dimensions);
  if (!status && dimensions != 2)
    status = hr2di_message_fail(reader->message, HR2D_ESYNTAX,
                                "line %zu: geometry must be 2, not %s", reader->line,
                                hr2di_vs2_quote(reader).text);
  return status ? status : end_of_record(reader, line);
}

static hr2d_status read_vertex(hr2di_vs2 *reader, hr2di_vs2_span *line) {
  hr2d_point point;
  hr2d_status status = read_sequence(reader, line, "vertex", reader->vertices);
  if (!status) status = hr2di_vs2_number(reader, line, "x", &point.x);
  if (!status) status = hr2di_vs2_number(reader, line, "y", &point.y);
  if (!status) status = end_of_record(reader, line);
  if (status) return status;
  if (hr2di_alloc_reserve(reader->alloc, &reader->vertex, &reader->vertex_capacity,
                          reader->vertices + 1, sizeof *reader->vertex))
    return hr2di_message_fail(reader->message, HR2D_ENOMEM, "line %zu: out of memory",
                              reader->line);
  reader->vertex[reader->vertices++] = point;
  return HR2D_OK;
}

static hr2d_status read_end(hr2di_vs2 *reader, hr2di_vs2_span *line, const char *what,
                            hr2d_point *point) {
  long long number;
  hr2d_status status = hr2di_vs2_integer(reader, line, what, &number);
  if (status) return status;
  if (number < 1 || (unsigned long long)number > reader->vertices)
    return hr2di_message_fail(reader->message, HR2D_ESCENE,
                              "line %zu: %s: there is no vertex %s above this line",
                              reader->line, what, hr2di_vs2_quote(reader).text);
  *point = reader->vertex[number - 1];
  return HR2D_OK;
}

/* obs, bas and cmb tell View2D what to leave out or to add up.  Here they must be integers, and
   are not used. */
static hr2d_status skip_integers(hr2di_vs2 *reader, hr2di_vs2_span *line) {
  static const char *const names[] = {"obs", "bas", "cmb"};
  hr2d_status status = HR2D_OK;
  long long ignored;
  for (size_t k = 0; !status && k < sizeof names / sizeof *names; k++)
    status = hr2di_vs2_integer(reader, line, names[k], &ignored);
  return status;
}

static hr2d_status read_reflectance(hr2di_vs2 *reader, hr2di_vs2_span *line,
                                    double *reflectance) {
  double emittance;
  hr2d_status status = hr2di_vs2_number(reader, line, "emit", &emittance);
  if (status) return status;
  if (!(emittance >= 0 && emittance <= 1))
    return hr2di_message_fail(reader->message, HR2D_ESCENE,
                              "line %zu: emit must be between 0 and 1, not %s", reader->line,
                              hr2di_vs2_quote(reader).text);
  *reflectance = 1 - emittance;
  return HR2D_OK;
}

static hr2d_status read_surface(hr2di_vs2 *reader, hr2di_vs2_span *line) {
  double reflectance;
  hr2d_patch patch = {.reflectance = &reflectance, .reflectance_bands = 1};
  hr2d_status status = read_sequence(reader, line, "surface", reader->surfaces);
  if (!status) status = read_end(reader, line, "v1", &patch.a);
  if (!status) status = read_end(reader, line, "v2", &patch.b);
  if (!status) status = skip_integers(reader, line);
  if (!status) status = read_reflectance(reader, line, &reflectance);
  if (!status) status = hr2di_vs2_name(reader, line);
  if (!status) status = end_of_record(reader, line);
  if (status) return status;
  patch.name = reader->word;
  status = hr2d_scene_add(reader->scene, &patch, NULL);
  if (status)
    return hr2di_message_fail(reader->message, status, "line %zu: %s", reader->line,
                              reader->message->text);
  reader->surfaces++;
  return HR2D_OK;
}

static hr2d_status read_record(hr2di_vs2 *reader, hr2di_vs2_span line, char letter) {
  hr2d_status status = hr2di_vs2_field(reader, &line, "the record");
  if (status) return status;
  switch (letter) {
  case 'T': /* T: the title; C: how View2D computes */
  case 'C':
    return HR2D_OK;
  case 'G':
    return read_geometry(reader, &line);
  case 'V':
    return read_vertex(reader, &line);
  case 'S':
    return read_surface(reader, &line);
  case 'O':
    return hr2di_message_fail(
        reader->message, HR2D_EUNSUPPORTED,
        "line %zu: an obstruction (O) is not supported by this version; a "
        "surface (S) obstructs as well",
        reader->line);
  default:
    return hr2di_message_fail(reader->message, HR2D_ESYNTAX, "line %zu: unknown record %s",
                              reader->line, hr2di_vs2_quote(reader).text);
  }
}

static hr2d_status read_records(hr2di_vs2 *reader, hr2di_vs2_span text) {
  hr2d_status status = HR2D_OK;
  hr2di_vs2_span line, word;
  int ended = 0;
  while (!status && hr2di_vs2_line(&text, &line)) {
    reader->line++;
    status = hr2di_watch_work(reader->watch, 10);
    if (status) break;
    hr2di_vs2_span rest = line;
    const char letter = hr2di_vs2_word(&rest, &word) ? record_letter(word) : '/';
    if (letter == '/') continue;
    if (ended)
      return hr2di_message_fail(reader->message, HR2D_ESYNTAX,
                                "line %zu: text behind the end of the data", reader->line);
    ended = letter == 'E' || letter == '*';
    if (!ended) status = read_record(reader, line, letter);
  }
  if (!status && reader->surfaces == 0)
    return hr2di_message_fail(reader->message, HR2D_ESCENE,
                              "line %zu: the data end without a surface", reader->line);
  return status;
}

hr2d_status hr2di_vs2_read(hr2d_scene *scene, const char *text, size_t size,
                           hr2di_watch *watch) {
  hr2di_vs2 reader = {.scene = scene,
                      .alloc = hr2di_scene_allocator(scene),
                      .message = hr2di_scene_message(scene),
                      .watch = watch};
  if (hr2di_c_locale_create(&reader.numbers))
    return hr2di_message_fail(reader.message, HR2D_ENOMEM, "out of memory for a locale");
  const hr2d_status status = read_records(&reader, (hr2di_vs2_span){text, text + size});
  hr2di_c_locale_destroy(reader.numbers);
  hr2di_alloc_free(reader.alloc, reader.word);
  hr2di_alloc_free(reader.alloc, reader.vertex);
  return status;
}
