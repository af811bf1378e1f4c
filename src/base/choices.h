/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The choices between ways, and how much is spent.  Another value changes time, memory and the
   number of elements; an account sees what it sees on these, and fewer contacts and gaps show
   it less of errors at points.  Each row says what it decides and what is known of its value.
   `bench/choices.sh [NAME=VALUE...]` solves nine scenes to 1e-2, 1e-3, 1e-4 and 1e-6 with
   other values.  Ratios are processor times in terms of that with the value here: the geometric
   mean over the scenes whose elements, links or kernels changed, and their range.  "Half and
   twice change nothing" means none of the 36 solves.  "Ablation" is of six scenes at seven
   targets.  Where another program calibrates a row, it is named.  "Not moved" means that nobody
   has tried another value: what no solve to averages sees, and threads.

   Bounds of errors are not choices: they stand with their derivation.  Nor are sizes of batches
   and arrays that bound nothing but memory. */
#ifndef HR2D_SRC_BASE_CHOICES_H
#define HR2D_SRC_BASE_CHOICES_H

/* Which elements a target begins with: strategy.c.

   An error of averages is reached in one of two ways.  Error indicators begin with few elements
   and halve those that matter (a posteriori); selected events divide elements where radiosity
   has kinks, as far as these matter (a priori).  Ablation: indicators at every target take .19
   to .67 times as long on small scenes at 1e-4 to 1e-6, but 2 to 8 times at 1e-8 to 1e-10;
   events alone take 1.3 to 4.4 times as long at 1e-2 and 1e-3. */

/* The smallest target that begins with indicators, in scenes of more patches than
   HR2DI_CHOICE_MANY_EVENTS, and in others.  Without them at that target, which twice the value
   does: 1.9 (1.0 to 3.6) and 2.4 (1.4 to 3.4). */
#define HR2DI_CHOICE_INDICATORS_ERROR       1e-4
#define HR2DI_CHOICE_INDICATORS_ERROR_SMALL 1e-3

/* Where the first solve with indicators shows that a patch has less than this part of the
   largest H, the next one has selected events as well, in scenes of no more patches than
   HR2DI_CHOICE_MANY_EVENTS.  A patch that gets little light past the ends of others shows kinks
   of which whole patches know nothing: errors were up to 9 times the target where H was 5e-5 of
   the largest, 2.5 times at 4e-3 and 20 times at 2e-2.  Half and twice change nothing, as none
   of the nine scenes is so dim; in six dim ones of up to a dozen patches: 1.7 (.80 to 3.1) at
   1e-2, 1.4 (.48 to 3.6) at 1e-3. */
#define HR2DI_CHOICE_DIM 3e-2

/* Their least order below HR2DI_CHOICE_ORDER_3_ERROR: blocks of shaded pairs take about as long
   at any low order, and links become fewer.  2: 1.2 (.90 to 1.9) at 1e-3, 2.2 (1.1 to 5.5) at
   1e-4.  10: 1.2 (.79 to 1.6), 1.4 (.76 to 2.9). */
#define HR2DI_CHOICE_INDICATORS_ORDER 5

/* Scenes of more patches have so many visibility events that elements do not end at all of them
   at first, at targets that are no smaller than the error.  128 patches: 3.5 in occluders-200
   at 1e-4.  Otherwise half and twice change nothing. */
#define HR2DI_CHOICE_MANY_EVENTS       64
#define HR2DI_CHOICE_MANY_EVENTS_ERROR 1e-3

/* Scenes of more patches have too many events to weigh one by one: at targets that are no
   smaller than HR2DI_CHOICE_MANY_EVENTS_ERROR, and at smaller ones.  Half and twice change
   nothing. */
#define HR2DI_CHOICE_WEIGHED_EVENTS      512
#define HR2DI_CHOICE_WEIGHED_EVENTS_FINE 1000

/* No more events than that are found: they cost more than they gain.  Half: 1.5 at 1e-6, in two
   scenes.  Twice changes nothing. */
#define HR2DI_CHOICE_EVENTS 30000

/* Two coefficients, or none of the events, reach an error below this so seldom that to try
   takes longer; with events to be chosen from also somewhat larger ones.  Half and twice change
   nothing. */
#define HR2DI_CHOICE_ORDER_3_ERROR 3e-3

/* The part of the target at which the order is chosen where errors of many corners and elements
   add up.  1: 1.5 (.97 to 3.5) at 1e-6, in three scenes.  Half and twice change nothing. */
#define HR2DI_CHOICE_MANY_PARTS 0.25

/* Few patches may be rooms in a row, where the light of the last comes by one door after the
   other; in scenes of more, indicators without signs add up to more than the error.  Half: .86
   at 1e-6, in one scene. */
#define HR2DI_CHOICE_ROOMS 128

/* What elements beside a corner make of averages falls with their length like h^(1+2γ), so that
   short ones need not converge as fast: below 2^−this of a patch they shrink to quarters.  2:
   1.1 (.88 to 2.0) at 1e-4, .97 (.91 to 1.0) at 1e-6.  10: 1.1, 1.05 (.88 to 1.3). */
#define HR2DI_CHOICE_QUARTERS 5

/* Events whose bounds are so much of the largest one are looked at together, as each time all
   those in the leaf are weighed again.  Half and twice: .99 and 1.0 at 1e-6. */
#define HR2DI_CHOICE_EVENTS_TOGETHER 0.25

/* The parts of a target.

   What the solve may leave of it; what roundings of single precision may be, over all
   reflections; the accuracy of links of clusters, which is that of the largest kernel between
   them; and what these are to leave when they are blamed for an error.  Near a short lamp
   patches see it at grazing angles, and have little light: the error of their B was up to 500
   times the accuracy of clusters, in a round room of 100,000 patches.  SINGLE, half and
   twice: 1.0 at 1e-4, in one scene.  Half and twice of the others change nothing. */
#define HR2DI_CHOICE_UNSOLVED       0.01
#define HR2DI_CHOICE_SINGLE         (1. / 32)
#define HR2DI_CHOICE_CLUSTERS       1e-3
#define HR2DI_CHOICE_CLUSTERS_LEAVE 0.1

/* Clusters: from so many patches on they save more than they cost, but where patches see no
   more than so many others in the mean they find nothing that is worth their search.  A pair of
   patches costs as much as so many products of points of a link; pairs of patches are put off
   where so few are left; and looking into two clusters costs so many products.  Half and twice
   change nothing: the largest of the nine scenes, a city, has 1,000 patches. */
#define HR2DI_CHOICE_CLUSTERS_PATCHES 256
#define HR2DI_CHOICE_CLUSTERS_SEEN    100
#define HR2DI_CHOICE_CLUSTERS_PAIR    8
#define HR2DI_CHOICE_CLUSTERS_PUT_OFF 256
#define HR2DI_CHOICE_CLUSTERS_LOOK    100

/* How a search goes on.

   So many attempts; after a solve that does not converge the next one has at least the safe
   order.  A divided mesh is kept although its estimate is so many times the best one, as what
   is left comes of links of low order, and varies.  Averages that are off by more than the part
   OFF of the target are made better, for the part AIM of it; bounds of the indicators of leaves
   are tried that fall by STEP each; a leaf is halved DEEP times at once.  At 1e-2, 1e-3, 1e-4:
     OFF   .175  1.0, 1.0, 1.1 (.93 to 1.3)     .7  1.1, .99, 1.1 (.78 to 2.0)
     AIM   .175  1.2, 1.2, 1.0 (.95 to 1.4)     .7  1.2, 1.2, 1.2 (.75 to 2.2)
     STEP  .4    1.1, 1.0, 1.1 (.99 to 1.2)     .9  .92, .96, .95 (.84 to 1.04)
     DEEP  1     .87, 1.1, 1.3 (.63 to 1.6)     6   1.2 at 1e-4 (1.0 to 1.3)
   Half and twice of the first three change nothing. */
#define HR2DI_CHOICE_ATTEMPTS        8
#define HR2DI_CHOICE_SAFE_ORDER      6
#define HR2DI_CHOICE_VARIES          2
#define HR2DI_CHOICE_INDICATORS_OFF  0.35
#define HR2DI_CHOICE_INDICATORS_AIM  0.35
#define HR2DI_CHOICE_INDICATORS_STEP 0.8
#define HR2DI_CHOICE_INDICATORS_DEEP 3

/* With a budget of seconds: the parts for the factors of the first answer, and for all of it.
   `bench-budgets` shows what is kept. */
#define HR2DI_CHOICE_FALLBACK_FACTORS 0.8
#define HR2DI_CHOICE_FALLBACK         0.95

/* Bytes for what patches see, where the caller counts none.  Not moved. */
#define HR2DI_CHOICE_SEEN_BYTES 0x40000000

/* Contacts and gaps where an account gathers H, in scenes of up to CONTACTS_PATCHES patches,
   and in others, where each takes as long as there are patches.  Not moved. */
#define HR2DI_CHOICE_CONTACTS_PATCHES 1000
#define HR2DI_CHOICE_CONTACTS         64
#define HR2DI_CHOICE_CONTACTS_LARGE   8
#define HR2DI_CHOICE_GAPS             16
#define HR2DI_CHOICE_GAPS_LARGE       4

/* An enclosure divides the leaves that make so much of the gap; of those that a budget leaves
   no room for half as many, but no less than so much.  Not moved. */
#define HR2DI_CHOICE_ENCLOSURE_MARKED 0.8
#define HR2DI_CHOICE_ENCLOSURE_LEAST  0.1

/* Prediction: times of a whole call in terms of the coarse solve that is timed, with lights of
   patches, without reflection, and with equal elements; with temperatures; gathers and
   iterations of an account; work that is not counted.  `bench-prediction` compares predictions
   with the time that calls take: one solve is within the factor PREDICT_SURE. */
#define HR2DI_CHOICE_PREDICT_CALLS      2.6
#define HR2DI_CHOICE_PREDICT_LIT        3.2
#define HR2DI_CHOICE_PREDICT_DARK       2.5
#define HR2DI_CHOICE_PREDICT_FLAT       1.2
#define HR2DI_CHOICE_PREDICT_HEAT       2.5
#define HR2DI_CHOICE_PREDICT_GATHERS    20
#define HR2DI_CHOICE_PREDICT_ITERATIONS 2.5
#define HR2DI_CHOICE_PREDICT_REST       1.75
#define HR2DI_CHOICE_PREDICT_SURE       3.0

/* Work that is worth another thread (bench-threads), which takes 20 µs to begin: patches to
   grade, events to look at, links to integrate, leaves that see a background, products of a
   sweep over links. Not moved. */
#define HR2DI_CHOICE_TEAM_PATCHES  64
#define HR2DI_CHOICE_TEAM_EVENTS   256
#define HR2DI_CHOICE_TEAM_LINKS    256
#define HR2DI_CHOICE_TEAM_LEAVES   64
#define HR2DI_CHOICE_TEAM_PRODUCTS 100000

/* Through gas, elements that are deeper than this are not distant: e^−κr takes as many points
   as lines.  Not moved; bench/gas.sh measures what gas costs. */
#define HR2DI_CHOICE_GAS_DEPTH 4

/* Shares: one with so many times the mean of the links is too many, and links are dealt anew.
   Not moved. */
#define HR2DI_CHOICE_UNEVEN 1.12

#endif
