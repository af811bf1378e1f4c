/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Asks the library. */
#include "adversary/answer.h"

#include <math.h>
#include <string.h>
#include <time.h>

adv_points adv_choose_points(adv_random *r, int bits) {
  adv_points points;
  int levels = bits > 32 ? 52 - bits : 20;
  double step = ldexp(1, -levels);
  for (int k = 0; k < ADV_PATCHES; k++) {
    double *t = points.t[k];
    t[0] = 0, t[1] = 1, t[2] = step, t[3] = 1 - step;
    for (int j = 4; j < ADV_POINTS; j++)
      t[j] = step * (2 * floor(adv_real(r, 0, ldexp(1, levels - 1))) + 1);
  }
  return points;
}

int adv_is_asked(const adv_question *question, size_t patch) {
  for (size_t k = 0; k < question->important_count; k++)
    if (question->important[k] == patch) return 1;
  return !question->important_count;
}

static double now(void) {
  struct timespec t;
  timespec_get(&t, TIME_UTC);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* When a solve is stopped: by the clock, and by the processor's time. */
typedef struct stop {
  double time, work;
} stop;

static double work(void) {
  return (double)clock() / CLOCKS_PER_SEC;
}

static hr2d_status enough(void *ctx, const hr2d_progress *progress) {
  (void)progress;
  const stop *s = ctx;
  return now() > s->time || work() > s->work ? HR2D_STOPPED : HR2D_OK;
}

static void brighter(double *max, double value) {
  if (value > *max) *max = value;
}

static void read_averages(adv_answer *a) {
  for (size_t k = 0; k < a->scene->count; k++)
    for (size_t band = 0; band < a->scene->bands; band++) {
      a->average[ADV_B][k][band] = hr2d_solution_average(a->solution, k, band);
      a->average[ADV_H][k][band] = hr2d_solution_irradiance(a->solution, k, band);
      for (int q = 0; q < ADV_QUANTITIES; q++) {
        brighter(&a->brightest[q][band], a->average[q][k][band]);
        brighter(&a->sup[q][band], a->average[q][k][band]);
      }
    }
  for (size_t band = 0; band < a->scene->bands; band++) {
    a->power[band] = hr2d_solution_power(a->solution, band);
    a->power_cut_off[band] = hr2d_solution_power_cut_off(a->solution, band);
  }
}

/* B and H at a point of a patch of this scene; NaN if they cannot be had.  Where images are cut
   off that patches can see, they may be refused; see symmetry.h. */
static void read_point(adv_answer *a, size_t patch, double t, double *b, double *h) {
  hr2d_status status = hr2d_solution_gather(a->solution, patch, &t, 1, b);
  if (!status) status = hr2d_solution_gather_irradiance(a->solution, patch, &t, 1, h);
  const int none = a->cut_off > 0 && status == HR2D_EUNSUPPORTED;
  a->pointless |= none;
  for (size_t band = 0; band < a->scene->bands; band++) {
    if (status) b[band] = h[band] = none ? 0 : NAN;
    brighter(&a->sup[ADV_B][band], b[band]);
    brighter(&a->sup[ADV_H][band], h[band]);
  }
}

/* The points of the original that are on this patch of its copy. */
static void read_points(adv_answer *a, const adv_points *points) {
  for (size_t k = 0; k < a->scene->count; k++) {
    const adv_patch *p = &a->scene->patch[k];
    for (int j = 0; p->source >= 0 && j < ADV_POINTS; j++) {
      double t = (points->t[p->source][j] - p->from) / (p->to - p->from);
      if (t >= 0 && t <= 1)
        read_point(a, k, t, a->point[ADV_B][p->source][j], a->point[ADV_H][p->source][j]);
    }
  }
}

/* What a sun lights may be much brighter than all around it, and narrow. */
static void look_into_sunlight(adv_answer *a) {
  double part[16][2], b[ADV_BANDS], h[ADV_BANDS];
  for (size_t k = 0; k < a->scene->count; k++)
    for (size_t band = 0; band < a->scene->bands; band++) {
      size_t parts = hr2d_scene_sunlit_parts(a->built, k, band, part, 16);
      for (size_t m = 0; m < parts && m < 16; m++)
        for (int j = 0; j <= 4; j++)
          read_point(a, k, part[m][0] + j / 4.0 * (part[m][1] - part[m][0]), b, h);
    }
}

void adv_ask(const adv_scene *scene, adv_question question, const adv_points *points,
             adv_answer *answer) {
  memset(answer, 0, sizeof *answer);
  answer->scene = scene;
  answer->question = question;
  hr2d_target target = HR2D_TARGET_INIT;
  target.error = question.error;
  target.norm = question.norm;
  target.points = 1;
  target.seconds = question.seconds;
#if ADV_ACCOUNT_OF_H
  target.floor = question.floor;
#endif
  if (question.important_count) {
    target.important = answer->question.important;
    target.important_count = question.important_count;
  }
  const double start = now();
  stop deadline = {start + 4 * question.seconds, INFINITY};
  if (question.stop > 0) deadline = (stop){INFINITY, work() + question.stop};
  target.progress = enough;
  target.progress_ctx = &deadline;
  answer->status = adv_build(scene, &answer->built);
  if (!answer->status)
    answer->status = hr2d_solve_to(answer->built, &target, &answer->solution, &answer->account);
  answer->seconds = now() - start;
  if (!answer->solution) return;
  answer->cut_off = hr2d_scene_cut_off(answer->built);
  read_averages(answer);
  if (adv_has_sun(scene)) look_into_sunlight(answer);
  read_points(answer, points);
}

/* Beside the ends of a patch a lit gap may be as narrow as that. */
enum { HALVINGS = 44 };

/* Elements end where what lights them begins and are short beside it. */
static void read_leaves(adv_answer *a) {
  const hr2d_hierarchy *h = hr2d_linkset_hierarchy(hr2d_solution_links(a->solution));
  const hr2d_element *element = hr2d_hierarchy_elements(h);
  const uint64_t count = hr2d_hierarchy_count(h).elements;
  double b[ADV_BANDS], irradiance[ADV_BANDS];
  for (uint64_t k = 0; k < count; k++) {
    const hr2d_element *one = &element[k], *root = &element[one->patch];
    const double x = one->centre.x - root->a.x, y = one->centre.y - root->a.y;
    if (!one->child) read_point(a, one->patch, hypot(x, y) / root->length, b, irradiance);
  }
}

void adv_look_closely(adv_answer *answer) {
  double b[ADV_BANDS], h[ADV_BANDS];
  for (size_t k = 0; answer->solution && k < answer->scene->count; k++) {
    for (int j = 0; j <= 32; j++)
      read_point(answer, k, 0.5 - 0.5 * cos(3.14159265358979323846 * j / 32), b, h);
    for (int j = 2; j <= HALVINGS; j++) {
      read_point(answer, k, ldexp(1, -j), b, h);
      read_point(answer, k, 1 - ldexp(1, -j), b, h);
    }
  }
  if (answer->solution) read_leaves(answer);
}

void adv_forget(adv_answer *answer) {
  hr2d_solution_destroy(answer->solution);
  hr2d_scene_destroy(answer->built);
  answer->solution = NULL;
  answer->built = NULL;
}
