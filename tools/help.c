/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One screen of help per command; the manual page has the rest. */
#include "help.h"

#ifdef HAVE_CONFIG_H
#include "config.h"
#endif

#include <stdio.h>

static const char general[] =
    "Usage: hr2d COMMAND [options]\n"
    "Hierarchical radiosity in the plane.\n"
    "\n"
    "  hr2d info  SCENE      patches, lengths, which effects the scene calls for\n"
    "  hr2d solve SCENE      radiosity of every patch, tables and pictures\n"
    "  hr2d study SCENE      links L against elements N over a sequence of epsilon\n"
    "  hr2d cost  SCENE      error against time and links, for several methods\n"
    "  hr2d factors SCENE    view factors between all patches\n"
    "  hr2d pair  < PAIRS    exchange areas of pairs of segments\n"
    "\n"
    "SCENE is a GeoJSON file or a .vs2 file of the program View2D.\n"
    "'hr2d COMMAND --help' lists the options of a command, 'hr2d --version' prints\n"
    "the version, 'man hr2d' says more.\n"
    "\n"
    "Exit status: 0; 1 for bad input or a failed solve; 2 for bad usage;\n"
    "130 when interrupted.\n";

#define SCENE_OPTIONS                                                                          \
  "  --split-crossings     cut patches where they cross each other\n"                          \
  "  --force EFFECT        turn an effect on that the scene does not call for\n"

static const char info[] =
    "Usage: hr2d info SCENE [options]\n"
    "Patches, total length, bands, bounding box and the effects the scene calls for.\n"
    "\n" SCENE_OPTIONS "  --json FILE|-         write the same as JSON\n"
    "  --quiet               print no table\n";

static const char factors[] =
    "Usage: hr2d factors SCENE [options]\n"
    "View factors F_ij between all patches: the part of the light of patch i that\n"
    "arrives at patch j, around what stands between them.  Prints for each i their\n"
    "sum over j; in a closed scene it is 1.\n"
    "\n" SCENE_OPTIONS
    "  --json FILE|-         factors and sums as JSON; - is standard output\n"
    "  --csv FILE|-          a line of patch names, then a row of F_ij for each i\n"
    "  --threads T           threads; 0 (default) for all processors\n"
    "  --quiet               no table, no progress\n";

static const char solve[] =
    "Usage: hr2d solve SCENE [options]\n"
    "Refines, solves and reports radiosity and irradiance of every patch.\n"
    "\n"
    "  --target-error R      solve until averages of B are known to R, relative\n"
    "  --norm NAME           to R in averages (default) or, with sup, at all points\n"
    "  --time-budget S       the best that S seconds allow\n"
    "  --importance PATCH    only the average of this patch matters\n"
    "\n"
    "or, instead of a target or a budget:\n"
    "  --oracle NAME         size (default), size2, bf, l1 or l1-grid\n"
    "  --eps E               accept links whose estimated error is <= E (0.1)\n"
    "  --order P             Legendre coefficients of each element, 1 (default) to 32\n"
    "  --variant NAME        original (default) or modified: what a refusal splits\n"
    "  --multigrid FROM:R    solve for FROM, FROM*R, ... --eps, each from the last\n"
    "  --state FILE          keep each stage in FILE, or go on from there\n"
    "  --max-level K         elements on level K are not subdivided (24)\n"
    "  --no-closure          leave rows of the kernel as coarse links make them\n"
    "  --error, --no-error   whether to measure the error (up to 200 patches)\n"
    "\n"
    "  --max-links M         give up beyond M links\n"
    "  --max-elements M      give up beyond M elements\n"
    "  --threads T           threads; 0 (default) for all processors\n" SCENE_OPTIONS "\n"
    "  --at PATCH:T          B and H at fraction T of a patch (index or name)\n"
    "  --json FILE|-         the result as JSON; - is standard output\n"
    "  --csv FILE|-          one row per leaf element\n"
    "  --draw FILE           the scene coloured by B, as .svg, .png or .pdf\n"
    "  --links-of PATCH:T    draw the links that serve this point, too\n"
    "  --link-level K        of these only those of the element on level K\n"
    "  --link-parents        with the refused pairs that these come from\n"
    "  --quiet               no table, no progress\n";

static const char study[] =
    "Usage: hr2d study SCENE [options]\n"
    "Counts elements N and links L over a geometric sequence of epsilon and fits\n"
    "L = a + b N + c N^2 by least squares.\n"
    "\n"
    "  --from E              first epsilon (1; bf: 0.25; l1: longest patch/64)\n"
    "  --to E                last epsilon (--from/64; size2: /4096; bf: /256;\n"
    "                        l1: /262144)\n"
    "  --steps K             how many of them (13)\n"
    "  --oracle NAME         size (default), size2, bf, l1 or l1-grid\n"
    "  --variant NAME        original (default) or modified: what a refusal splits\n"
    "  --max-level K         elements on level K are not subdivided (24)\n"
    "  --max-links M         give up beyond M links\n"
    "  --max-elements M      give up beyond M elements\n"
    "  --threads T           threads for a count; 0 (default) for all "
    "processors\n" SCENE_OPTIONS "\n"
    "  --json FILE|-         rows and fit as JSON; - is standard output\n"
    "  --csv FILE|-          one row per epsilon, kept up to date during the sweep\n"
    "  --resume              count only what the file of --csv does not have yet\n"
    "  --plot FILE           dots and fitted curve by gnuplot, as .svg, .png or .pdf\n"
    "  --plot-log            on logarithmic axes, with the slope of log L on log N\n"
    "  --quiet               no table, no progress\n";

static const char cost[] =
    "Usage: hr2d cost SCENE [options]\n"
    "What each digit of average B costs: error against elements N, links L, bytes and\n"
    "seconds for several methods.  Errors are distances from a solution of a target\n"
    "error of 1e-14, whose own bound is printed.\n"
    "\n"
    "  size, size2, bf, l1, l1-grid    the paper's algorithm with these oracles\n"
    "  multigrid                       with size, each epsilon from the last one\n"
    "  order-2, order-4, order-8, order-16\n"
    "                                  with size and so many coefficients\n"
    "  auto, auto-solve                solve --target-error for 0.1 ... 1e-13, with\n"
    "                                  and without its account of the error\n"
    "  dense                           the full matrix of equal pieces, solved by LU\n"
    "\n"
    "  --methods LIST        some of these, separated by commas\n"
    "  --max-seconds S       for all together (10), in equal shares\n"
    "  --predict             print what a target error will cost, and no more\n"
    "  --max-level K         elements on level K are not subdivided (24)\n"
    "  --no-closure          leave rows of the kernel as coarse links make them\n"
    "  --threads T           threads; 1 by default, 0 for all "
    "processors\n" SCENE_OPTIONS "\n"
    "  --json FILE|-         rows and fits as JSON; - is standard output\n"
    "  --csv FILE|-          one row per method and parameter\n"
    "  --plot FILE           a curve per method by gnuplot, as .svg, .png or .pdf\n"
    "  --against LIST        of seconds (default), links, bytes; a panel for each\n"
    "  --quiet               no table, no progress\n";

static const char pair[] =
    "Usage: hr2d pair [--oracle NAME] < PAIRS\n"
    "Each line of standard input holds 8 numbers, decimal or hexadecimal,\n"
    "  ax ay bx by cx cy dx dy\n"
    "for the segments i = a->b and j = c->d, whose fronts are on their left.\n"
    "Prints AF F_ij F_ji ERROR with 17 significant digits: the exchange area\n"
    "AF = A_i F_ij = A_j F_ji, the two view factors, and the oracle's estimate,\n"
    "nan where the segments cross or overlap.  Blank lines and\n"
    "lines that start with # are skipped.\n"
    "\n"
    "  --oracle NAME         size (default), size2, bf, l1 or l1-grid\n";

void print_help(int command) {
  switch (command) {
  case INFO:
    fputs(info, stdout);
    break;
  case SOLVE:
    fputs(solve, stdout);
    break;
  case STUDY:
    fputs(study, stdout);
    break;
  case COST:
    fputs(cost, stdout);
    break;
  case FACTORS:
    fputs(factors, stdout);
    break;
  case PAIR:
    fputs(pair, stdout);
    break;
  default:
    fputs(general, stdout);
  }
}

void print_version(void) {
#ifdef PACKAGE_VERSION
  const char *program = PACKAGE_VERSION;
#else
  const char *program = HR2D_VERSION;
#endif
  printf("hr2d %s (library %s)\n"
         "License GPL-3.0-or-later; there is no warranty, to the extent permitted by law.\n",
         program, hr2d_version());
}
