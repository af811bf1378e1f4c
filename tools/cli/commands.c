/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The commands in the order of --help. */
#include "cli/commands.h"

#define ON_SCENE "SCENE", "SCENE [options]"

static const command_entry commands[] = {
    {"info", INFO, ON_SCENE, "patches, lengths, which effects the scene calls for",
     "Patches, total length, bands, bounding box and the effects the scene calls for.\n", NULL,
     "  hr2d info room.geojson\n"},

    {"solve", SOLVE, ON_SCENE, "radiosity of every patch, tables and pictures",
     "Refines, solves and reports radiosity and irradiance of every patch.\n",
     "or, instead of a target or a budget:\n",
     "  hr2d solve room.geojson --target-error 1e-6 --draw room.svg\n"},

    {"study", STUDY, ON_SCENE, "links L against elements N over a sequence of epsilon",
     "Counts elements N and links L over a geometric sequence of epsilon and fits\n"
     "L = a + b N + c N^2 by least squares.\n",
     NULL, "  hr2d study room.geojson --oracle l1 --steps 60 --plot study.svg\n"},

    {"cost", COST, ON_SCENE, "error against time and links, for several methods",
     "What each digit of average B costs: error against elements N, links L, bytes and\n"
     "seconds for several methods.  Errors are distances from a solution of a target\n"
     "error of 1e-14, whose own bound is printed.\n"
     "\n"
     "  size, size2, bf, l1, l1-grid, bounds\n"
     "                                  the paper's algorithm with these oracles\n"
     "  multigrid                       with size, each epsilon from the last one\n"
     "  order-2, order-4, order-8, order-16\n"
     "                                  with size and so many coefficients\n"
     "  auto, auto-solve                solve --target-error for 0.1 ... 1e-13, with\n"
     "                                  and without its account of the error\n"
     "  factors                         view factors of equal pieces, and conjugate\n"
     "                                  gradients\n",
     NULL, "  hr2d cost room.geojson --max-seconds 60 --plot cost.svg\n"},

    {"factors", FACTORS, ON_SCENE, "view factors between all patches",
     "View factors F_ij between all patches: the part of the light of patch i that\n"
     "arrives at patch j, around what stands between them.  Prints for each i their\n"
     "sum over j; in a closed scene it is 1.\n",
     NULL, "  hr2d factors room.geojson --csv factors.csv\n"},

    {"field", FIELD, ON_SCENE, "light at points between the patches",
     "Solves, and looks from points between the patches: mean radiosity over all\n"
     "directions, net flux, and the part of all directions that sees the sky.  Points\n"
     "that no light can reach, outside of rooms or within obstacles, have no numbers.\n",
     NULL,
     "  hr2d field room.geojson --target-error 1e-4 --draw light.png --contours 8\n"
     "  echo 1.5 2 | hr2d field room.geojson --points - --csv -\n"},

    {"pair", PAIR, "< PAIRS", "[--oracle NAME] < PAIRS", "exchange areas of pairs of segments",
     "Each line of standard input holds 8 numbers, decimal or hexadecimal,\n"
     "  ax ay bx by cx cy dx dy\n"
     "for the segments i = a->b and j = c->d, whose fronts are on their left.\n"
     "Prints AF F_ij F_ji ERROR with 17 significant digits: the exchange area\n"
     "AF = A_i F_ij = A_j F_ji, the two view factors, and the oracle's estimate,\n"
     "nan where the segments cross or overlap.  Blank lines and\n"
     "lines that start with # are skipped.\n",
     NULL, "  echo 0 0 1 0 1 1 0 1 | hr2d pair\n"},

    {"schema", SCHEMA, "[NAME]", "[NAME]", "what scenes and results in JSON are",
     "Prints a JSON Schema (draft 2020-12), against which other programs check scenes\n"
     "and the output of --json.  Without NAME it lists them.\n",
     NULL,
     "  hr2d schema\n"
     "  hr2d schema scene >scene-schema.json\n"}};

const command_entry *command_at(size_t k) {
  return k < sizeof commands / sizeof *commands ? &commands[k] : NULL;
}
