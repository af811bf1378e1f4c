/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The matrix as a block of an input file of MOOSE (https://mooseframework.inl.gov):
   ConstantViewFactorSurfaceRadiation has a row of factors for each boundary, in their order. */
#include <stdio.h>
#include <string.h>

#include "factors/factors.h"
#include "output/complain.h"
#include "output/output.h"
#include "output/printable.h"
#include "output/provenance.h"

/* In lists blanks part names, which have no quotation marks. */
static int is_boundary(const char *name) {
  return name && *name && !name[strcspn(name, " \t\r\n'\"[];=#$")];
}

static int check_names(const factors *f) {
  const char *scene = f->options->scene;
  for (size_t i = 0; i < f->count; i++) {
    char name[64];
    printable_copy(name, sizeof name, f->name[i] ? f->name[i] : "");
    if (!is_boundary(f->name[i]))
      return complain(scene,
                      "--moose: row %zu (\"%s\") has no name that a boundary may have: "
                      "letters, digits, _, - and /",
                      i, name);
    for (size_t j = 0; j < i; j++)
      if (!strcmp(f->name[i], f->name[j]))
        return complain(scene,
                        "--moose: rows %zu and %zu are both \"%s\": boundaries have names "
                        "of their own; --group makes one of patches of one name",
                        j, i, name);
  }
  return 0;
}

static void write_matrix(const factors *f, FILE *stream) {
  for (size_t i = 0; i < f->count && !ferror(stream); i++) {
    const double *row = factors_row(f, i);
    fputs(i ? ";\n                    " : "    view_factors = '", stream);
    for (size_t j = 0; j < f->count; j++) fprintf(stream, "%s%.17g", j ? " " : "", row[j]);
  }
  fputs("'\n", stream);
}

int factors_write_moose(const factors *f) {
  output out;
  int status = check_names(f);
  if (!status) status = output_open(&out, f->options->moose);
  if (status) return status;
  status = provenance_print(out.stream, "# ", "\n");
  fputs("[UserObjects]\n  [radiation]\n    type = ConstantViewFactorSurfaceRadiation\n"
        "    boundary = '",
        out.stream);
  for (size_t i = 0; i < f->count; i++) fprintf(out.stream, "%s%s", i ? " " : "", f->name[i]);
  fputs("'\n", out.stream);
  write_matrix(f, out.stream);
  fputs("  []\n[]\n", out.stream);
  return output_close(&out, status);
}
