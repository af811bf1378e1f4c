/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Each option with its reader, its member of `options` and its help.  The compiler refuses a
   member that does not have the type of its reader.

   Within a group the order is that of --help.  Of several options that break a rule the first
   one is reported. */
#include "cli/option-table.h"

enum { MAX_LEVEL = 1000, MAX_THREADS = 1024, MAX_STEPS = 10000, MAX_CONTOURS = 30 };

/* clang-format off */
#define MEMBER(reader, m)     _Generic(((options *)0)->m, type_of_##reader: offsetof(options, m))
#define VALUE(reader, m)      value_##reader, MEMBER(reader, m), {0, 0}
#define WHOLE(m, min, max) value_unsigned, MEMBER(unsigned, m), {min, max}
#define COUNT(m)              value_count, MEMBER(count, m), {1, UINT64_MAX}

enum { WITH_SCENE = INFO | SOLVE | STUDY | COST | FACTORS | FIELD, ALL = WITH_SCENE | PAIR };

static const option_entry table[] = {
  {"help", NULL, GROUP_OUTPUT, VALUE(flag, help), .help = {{ALL, NULL}}},
  {"version", NULL, GROUP_OUTPUT, VALUE(flag, version), .help = {{ALL, NULL}}},

  {"at", "PATCH:T", GROUP_OUTPUT, VALUE(places, at),
   .help = {{SOLVE, "B and H at fraction T of a patch (index or name)"}}},
  {"json", "FILE|-", GROUP_OUTPUT, VALUE(path, json),
   .help = {{INFO, "write the same as JSON"},
            {SOLVE, "the result as JSON; - is standard output"},
            {STUDY, "rows and fit as JSON; - is standard output"},
            {COST, "rows and fits as JSON; - is standard output"},
            {FACTORS, "factors and sums as JSON; - is standard output"},
            {FIELD, "an object per point as JSON; - is standard output"}},
   .rules = IS_OUTPUT},
  {"csv", "FILE|-", GROUP_OUTPUT, VALUE(path, csv),
   .help = {{SOLVE, "one row per leaf element"},
            {STUDY, "one row per epsilon, kept up to date during the sweep"},
            {COST, "one row per method and parameter"},
            {FACTORS, "a line of patch names, then a row of F_ij for each i"},
            {FIELD, "x,y,band,mean,flux_x,flux_y,sky,error by point, band"}},
   .rules = IS_OUTPUT | NOT_WITH_PREDICT},
  {"mtx", "FILE|-", GROUP_OUTPUT, VALUE(path, mtx),
   .help = {{FACTORS, "the F_ij that are not 0, as Matrix Market coordinates"}},
   .rules = IS_OUTPUT},
  {"elmer", "FILE|-", GROUP_OUTPUT, VALUE(path, elmer),
   .help = {{FACTORS, "the F_ij that are not 0, as ViewFactors.dat of Elmer"}},
   .rules = IS_OUTPUT},
  {"vtk", "FILE", GROUP_OUTPUT, VALUE(path, vtk),
   .help = {{FIELD, "a grid as VTK image data (.vti), for ParaView"}}, .rules = IS_OUTPUT},
  {"resume", NULL, GROUP_OUTPUT, VALUE(flag, resume),
   .help = {{STUDY, "count only what the file of --csv does not have yet"}}},
  {"draw", "FILE", GROUP_OUTPUT, VALUE(picture, draw),
   .help = {{SOLVE, "the scene filled with its light, as .svg, .png or .pdf"},
            {FIELD, "a picture of the light, as .svg, .png or .pdf"}},
   .rules = IS_OUTPUT},
  {"quantity", "NAME", GROUP_OUTPUT, VALUE(light, quantity),
   .help = {{FIELD, "fill with mean (default), flux, sky or temperature"}},
   .needs = "draw"},
  {"no-fill", NULL, GROUP_OUTPUT, VALUE(flag, no_fill),
   .help = {{SOLVE, "leave the room white"}}, .needs = "draw"},
  {"band", "NAME", GROUP_OUTPUT, VALUE(band, band),
   .help = {{FIELD, "a number from 0, all, or rgb: true colour (of 3 bands)"}},
   .needs = "draw"},
  {"exposure", "X", GROUP_OUTPUT, VALUE(positive, exposure),
   .help = {{FIELD, "in true colour: 1/X is white (chosen by default)"}},
   .needs = "draw"},
  {"contours", "N", GROUP_OUTPUT, WHOLE(contours, 1, MAX_CONTOURS),
   .help = {{SOLVE | FIELD, "with about N isolines at round values"}}, .needs = "draw"},
  {"arrows", NULL, GROUP_OUTPUT, VALUE(flag, arrows),
   .help = {{SOLVE | FIELD, "with arrows along the flux"}}, .needs = "draw"},
  {"log", NULL, GROUP_OUTPUT, VALUE(flag, log_scale),
   .help = {{SOLVE | FIELD, "a logarithmic scale (default where most is dark)"}},
   .needs = "draw"},
  {"linear", NULL, GROUP_OUTPUT, VALUE(flag, linear_scale),
   .help = {{FIELD, "a linear scale"}}, .needs = "draw"},
  {"tiles", "FILE", GROUP_OUTPUT, VALUE(picture, tiles),
   .help = {{SOLVE, "links as tiles of patch x patch, as .svg, .png or .pdf"}},
   .rules = IS_OUTPUT | NOT_WITH_TARGET},
  {"watch", "FILE", GROUP_OUTPUT, VALUE(film, watch),
   .help = {{SOLVE, "a film (.png) of links, tiles and light as E falls"}},
   .rules = IS_OUTPUT | NOT_WITH_TARGET},
  {"links-of", "PATCH:T", GROUP_OUTPUT, VALUE(place, links_of),
   .help = {{SOLVE, "draw the links that serve this point, too"}}, .needs = "draw"},
  {"link-level", "K", GROUP_OUTPUT, WHOLE(link_level, 0, MAX_LEVEL),
   .help = {{SOLVE, "of these only those of the element on level K"}}, .needs = "links-of"},
  {"link-parents", NULL, GROUP_OUTPUT, VALUE(flag, link_parents),
   .help = {{SOLVE, "with the refused pairs that these come from"}}},
  {"beams-of", "PATCH:T", GROUP_OUTPUT, VALUE(places, beams_of),
   .help = {{SOLVE, "draw what this point sees, too; may be repeated"}}, .needs = "draw"},
  {"plot", "FILE", GROUP_OUTPUT, VALUE(picture, plot),
   .help = {{STUDY, "dots and fitted curve by gnuplot, as .svg, .png or .pdf"},
            {COST, "a curve per method by gnuplot, as .svg, .png or .pdf"}},
   .rules = IS_OUTPUT | NOT_WITH_PREDICT | NOT_WITH_EXPONENTS},
  {"plot-log", NULL, GROUP_OUTPUT, VALUE(flag, plot_log),
   .help = {{STUDY, "on logarithmic axes, with the slope of log L on log N"}},
   .needs = "plot"},
  {"law", NULL, GROUP_OUTPUT, VALUE(flag, law),
   .help = {{STUDY, "the law of N and L in table, files and plot"}}},
  {"against", "LIST", GROUP_OUTPUT, VALUE(against, against),
   .help = {{COST, "of seconds (default), links, bytes; a panel for each"}},
   .needs = "plot"},
  {"quiet", NULL, GROUP_OUTPUT, VALUE(flag, quiet),
   .help = {{INFO, "print no table"},
            {SOLVE | STUDY | COST | FACTORS | FIELD, "no table, no progress"}}},

  {"target-error", "R", GROUP_QUESTION, VALUE(positive, target_error),
   .help = {{SOLVE | FIELD, "solve until averages of B are known to R, relative"}}},
  {"norm", "NAME", GROUP_QUESTION, VALUE(norm, norm),
   .help = {{SOLVE, "to R in averages (default) or, with sup, at all points"}},
   .rules = ONLY_WITH_TARGET},
  {"time-budget", "S", GROUP_QUESTION, VALUE(positive, time_budget),
   .help = {{SOLVE | FIELD, "the best that S seconds allow"}}},
  {"importance", "PATCH", GROUP_QUESTION, VALUE(patches, importance),
   .help = {{SOLVE, "only averages of this patch matter; may be repeated"}},
   .rules = ONLY_WITH_TARGET},
  {"floor", "X", GROUP_QUESTION, VALUE(part, floor),
   .help = {{SOLVE, "averages below X of the largest count as X of it (1e-6)"}}},
  {"enclose", "GAP", GROUP_QUESTION, VALUE(positive, enclose),
   .help = {{SOLVE, "averages from below and above, GAP apart at most"}}},
  {"from", "E", GROUP_QUESTION, VALUE(positive, from),
   .help = {{STUDY, "first epsilon (1; bf: 0.25; l1: longest patch/64)"}}},
  {"to", "E", GROUP_QUESTION, VALUE(positive, to),
   .help = {{STUDY, "last epsilon (--from/64; size2: /4096; bf: /256;\n"
                    "l1: /262144)"}}},
  {"steps", "K", GROUP_QUESTION, WHOLE(steps, 2, MAX_STEPS),
   .help = {{STUDY, "how many of them (13)"}}},
  {"methods", "LIST", GROUP_QUESTION, VALUE(methods, methods),
   .help = {{COST, "some of these, separated by commas"}},
   .rules = NOT_WITH_PREDICT | NOT_WITH_EXPONENTS},
  {"exponents", NULL, GROUP_QUESTION, VALUE(flag, exponents),
   .help = {{COST, "how L grows with 1/error: oracles, variants, orders"}}},
  {"predict", NULL, GROUP_QUESTION, VALUE(flag, predict),
   .help = {{COST, "print what a target error will cost, and no more"}}, .rules = NOT_WITH_EXPONENTS},

  {"grid", "WxH", GROUP_QUESTION, value_grid, MEMBER(grid, grid), {1, 100000},
   .help = {{FIELD, "nodes of a grid (64 along the longer side of the box)"}}},
  {"box", "X0,Y0,X1,Y1", GROUP_QUESTION, VALUE(box, box),
   .help = {{FIELD, "where the grid begins and ends (around all patches)"}}},
  {"points", "FILE|-", GROUP_QUESTION, VALUE(path, points),
   .help = {{FIELD, "instead of a grid, lines \"x y\" or \"x y nx ny\"; or -"}}},
  {"normal", "X,Y", GROUP_QUESTION, VALUE(vector, normal),
   .help = {{FIELD, "irradiance of planes at the points, of any tilt, too"}}},
  {"tolerance", "T", GROUP_QUESTION, VALUE(part, tolerance),
   .help = {{FIELD, "interpolate nodes of a grid within T of the range"}}},

  {"oracle", "NAME", GROUP_METHOD, VALUE(oracle, oracle),
   .help = {{SOLVE | STUDY | PAIR, "size (default), size2, bf, l1, l1-grid or bounds"}},
   .rules = NOT_WITH_TARGET},
  {"eps", "E", GROUP_METHOD, VALUE(positive, epsilon),
   .help = {{SOLVE | FIELD, "accept links whose estimated error is <= E (0.1)"}},
   .rules = NOT_WITH_TARGET},
  {"variant", "NAME", GROUP_METHOD, VALUE(policy, policy),
   .help = {{SOLVE | STUDY, "original (default) or modified: what a refusal splits"}},
   .rules = NOT_WITH_TARGET},
  {"multigrid", "FROM:R", GROUP_METHOD, VALUE(sequence, multigrid),
   .help = {{SOLVE, "solve for FROM, FROM*R, ... --eps, each from the last"}},
   .rules = NOT_WITH_TARGET},
  {"order", "P", GROUP_METHOD, WHOLE(order, 1, HR2D_MAX_ORDER),
   .help = {{SOLVE | FIELD, "Legendre coefficients of each element, 1 (default) to 32"}},
   .rules = NOT_WITH_TARGET},
  {"max-level", "K", GROUP_METHOD, WHOLE(max_level, 0, MAX_LEVEL),
   .help = {{SOLVE | STUDY | COST, "elements on level K are not subdivided (24)"}},
   .rules = NOT_WITH_TARGET | NOT_WITH_PREDICT},
  {"no-closure", NULL, GROUP_METHOD, VALUE(flag, no_closure),
   .help = {{SOLVE | COST, "leave rows of the kernel as coarse links make them"}},
   .rules = NOT_WITH_TARGET | NOT_WITH_EXPONENTS},
  {"error", NULL, GROUP_METHOD, VALUE(flag, error),
   .help = {{SOLVE, "measure the error (default for up to 200 patches)"}}},
  {"no-error", NULL, GROUP_METHOD, VALUE(flag, no_error),
   .help = {{SOLVE, "do not measure it (default for more without a target)"}}},
  {"state", "FILE", GROUP_METHOD, VALUE(file, state),
   .help = {{SOLVE, "keep each stage in FILE, or go on from there"}},
   .rules = IS_OUTPUT | NOT_WITH_TARGET},

  {"max-links", "M", GROUP_WORK, COUNT(max_links),
   .help = {{SOLVE | STUDY, "give up beyond M links"}}},
  {"max-elements", "M", GROUP_WORK, COUNT(max_elements),
   .help = {{SOLVE | STUDY, "give up beyond M elements"}}},
  {"max-seconds", "S", GROUP_WORK, VALUE(positive, most_seconds),
   .help = {{COST, "for all methods together (10), in equal shares"}},
   .rules = NOT_WITH_PREDICT | NOT_WITH_EXPONENTS},
  {"threads", "T", GROUP_WORK, WHOLE(threads, 0, MAX_THREADS),
   .help = {{SOLVE | FACTORS | FIELD, "threads; 0 (default) for all processors"},
            {STUDY, "threads for a count; 0 (default) for all processors"},
            {COST, "threads; 1 by default, 0 for all processors"}}},
  {"split-crossings", NULL, GROUP_WORK, VALUE(flag, split_crossings),
   .help = {{WITH_SCENE, "cut patches where they cross each other"}}},
  {"snap", "TOL", GROUP_WORK, VALUE(positive, snap),
   .help = {{WITH_SCENE, "join what is nearer than TOL: ends, feet of walls"}}},
  {"strict", NULL, GROUP_WORK, VALUE(flag, strict),
   .help = {{INFO | SOLVE, "warnings about the scene are errors"}}},
  {"force", "EFFECT", GROUP_WORK, VALUE(effect, force),
   .help = {{WITH_SCENE, "turn an effect on that the scene does not call for"}}},
};
/* clang-format on */

#define OPTIONS (sizeof table / sizeof *table)

_Static_assert(OPTIONS <= MOST_OPTIONS, "given_options has no room");

const option_entry *option_at(size_t k) {
  return k < OPTIONS ? &table[k] : NULL;
}

const option_text *option_text_of(const option_entry *x, int command) {
  for (size_t k = 0; k < sizeof x->help / sizeof *x->help; k++)
    if (x->help[k].commands & (unsigned)command) return &x->help[k];
  return NULL;
}
