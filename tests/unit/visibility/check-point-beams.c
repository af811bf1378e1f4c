/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The beams from a point: their borders, their factors, and what they end at, against the
   nearest patch in some direction of each.

   HR2D_TEST_SEED and HR2D_TEST_MULTIPLIER in the environment change the scenes. */
#include <check.h>
#include <hr2d/symmetry.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "independent/point-sweep.h"
#include "support/grid-plans.h"
#include "support/plane.h"
#include "support/support.h"

enum { MOST = 4000 };

typedef struct look {
  size_t count, stop_at;
  hr2d_beam beam[MOST];
} look;

/* Beams are compared by their bytes: those between the members are 0. */
static void copy(hr2d_beam *to, const hr2d_beam *from) {
  memset(to, 0, sizeof *to);
  to->struct_size = from->struct_size;
  to->seen = from->seen;
  to->patch = from->patch;
  to->from = from->from;
  to->to = from->to;
  to->factor = from->factor;
  to->right = from->right;
  to->left = from->left;
  to->end = from->end;
}

static hr2d_status take(void *ctx, const hr2d_beam *beam) {
  look *l = ctx;
  ck_assert_uint_lt(l->count, MOST);
  ck_assert_uint_eq(beam->struct_size, sizeof *beam);
  copy(&l->beam[l->count++], beam);
  return l->stop_at && l->count == l->stop_at ? (hr2d_status)77 : HR2D_OK;
}

static void see(const hr2d_scene *scene, size_t patch, double t, look *l) {
  l->count = l->stop_at = 0;
  ck_assert_int_eq(hr2d_beams_visit(scene, patch, t, take, l), HR2D_OK);
}

static int same(hr2d_point p, hr2d_point q) {
  return p.x == q.x && p.y == q.y;
}

/* Whether the beams fill the half plane in front of the patch, one beside the other. */
static int is_whole(const hr2d_scene *scene, size_t patch, const look *l) {
  const hr2d_segment s = hr2d_scene_segment(scene, patch);
  const double length = plane_length(s);
  const hr2d_point axis = {(s.b.x - s.a.x) / length, (s.b.y - s.a.y) / length};
  double sum = 0;
  if (!l->count || plane_distance(l->beam[0].right, axis) > 1e-15 ||
      plane_distance(l->beam[l->count - 1].left, (hr2d_point){-axis.x, -axis.y}) > 1e-15)
    return 0;
  for (size_t k = 0; k < l->count; k++) {
    const hr2d_beam *b = &l->beam[k];
    if (k > 0 && plane_distance(b[-1].left, b->right) > 1e-13) return 0;
    sum += b->factor;
  }
  return fabs(sum - 1) <= 1e-14;
}

static void check_members(const hr2d_scene *scene, size_t patch, const look *l) {
  for (size_t k = 0; k < l->count; k++) {
    const hr2d_beam *b = &l->beam[k];
    const int front = b->seen == HR2D_SEEN_FRONT;
    ck_assert(b->factor > 0 && b->factor <= 1);
    ck_assert_double_eq_tol(hypot(b->right.x, b->right.y), 1, 1e-15);
    ck_assert_double_eq_tol(hypot(b->left.x, b->left.y), 1, 1e-15);
    ck_assert(front ? 0 <= b->from && b->from < b->to && b->to <= 1
                    : b->from == 0 && b->to == 0 && b->patch == 0);
    if (b->seen == HR2D_SEEN_SKY)
      ck_assert(same(b->end.a, (hr2d_point){0, 0}) && same(b->end.b, (hr2d_point){0, 0}));
    if (!front) continue;
    ck_assert_uint_ne(b->patch, patch);
    const hr2d_segment s = hr2d_scene_segment(scene, b->patch);
    ck_assert_double_le(plane_distance(b->end.a, plane_along(s, b->from)), 1e-13);
    ck_assert_double_le(plane_distance(b->end.b, plane_along(s, b->to)), 1e-13);
  }
}

/* A scene as the sweep takes it. */
typedef struct stage {
  hr2d_scene *scene;
  sweep_patches all;
  double (*at)[4];
  sweep_span *span;
} stage;

static stage stage_of(hr2d_scene *scene) {
  stage s = {.scene = scene};
  const size_t n = hr2d_scene_patches(scene);
  s.at = malloc(n * sizeof *s.at);
  s.span = malloc((2 * n + 2) * sizeof *s.span);
  ck_assert(s.at && s.span);
  for (size_t k = 0; k < n; k++) {
    const hr2d_segment p = hr2d_scene_segment(scene, k);
    memcpy(s.at[k], (double[]){p.a.x, p.a.y, p.b.x, p.b.y}, sizeof *s.at);
  }
  s.all = (sweep_patches){n, (const double(*)[4])s.at};
  return s;
}

static void stage_clear(stage *s) {
  hr2d_scene_destroy(s->scene);
  free(s->at);
  free(s->span);
}

/* How far it is in a direction to the line of ab; infinite if a and b are on one side. */
static real distance_to(spot a, spot b, real angle) {
  const spot ray = {sinl(angle), cosl(angle)}, d = {b.x - a.x, b.y - a.y};
  const real at_a = sweep_cross(ray, a), at_b = sweep_cross(ray, b);
  const real far = sweep_cross(a, b) / sweep_cross(ray, d);
  return (at_a > 0) != (at_b > 0) && far > 0 ? far : HUGE_VALL;
}

/* Patches along the line of the point's own, such as its other side, are not in front of it. */
static real nearest(const stage *s, const sweep_frame *f, real angle) {
  real min = HUGE_VALL;
  for (size_t k = 0; k < s->all.count; k++) {
    const spot a = sweep_local(f, sweep_place(&s->all, k, 0)),
               b = sweep_local(f, sweep_place(&s->all, k, 1));
    if (a.y < 1e-12L && b.y < 1e-12L) continue;
    const real far = distance_to(a, b, angle);
    min = far < min ? far : min;
  }
  return min;
}

static spot spot_of(hr2d_point p) {
  return (spot){p.x, p.y};
}

static real angle_of(const sweep_frame *f, hr2d_point direction) {
  const spot place = {f->origin.x + direction.x, f->origin.y + direction.y};
  return sweep_angle(sweep_local(f, place));
}

/* Whether in a direction within a beam the sweep sees what the beam ends at, and as far away.
 */
static int is_seen(const stage *s, const sweep_frame *f, size_t spans, const hr2d_beam *b,
                   real angle) {
  size_t k = 0;
  while (k < spans && !(s->span[k].low < angle && angle < s->span[k].high)) k++;
  if (k == spans) return 1; /* an end of a patch */
  const size_t seen = s->span[k].seen;
  const size_t expected = b->seen == HR2D_SEEN_SKY    ? SWEEP_SKY
                          : b->seen == HR2D_SEEN_BACK ? SWEEP_BACK
                                                      : b->patch;
  if (seen != expected) return 0;
  if (seen == SWEEP_SKY) return nearest(s, f, angle) == HUGE_VALL;
  const real far =
      distance_to(sweep_local(f, spot_of(b->end.a)), sweep_local(f, spot_of(b->end.b)), angle);
  return fabsl(far - nearest(s, f, angle)) <= 1e-9L * far;
}

/* How many beams are not what the sweep sees. */
static size_t wrong_beams(stage *s, size_t patch, double t, const look *l, randoms *r) {
  const sweep_frame f = sweep_frame_at(&s->all, patch, t);
  const size_t spans = sweep_all(&s->all, &f, s->span);
  size_t wrong = 0;
  for (size_t k = 0; k < l->count; k++) {
    const real right = angle_of(&f, l->beam[k].right), left = angle_of(&f, l->beam[k].left);
    if (right - left < 1e-6L) continue;
    const real angle = left + random_between(r, .01, .99) * (right - left);
    wrong += !is_seen(s, &f, spans, &l->beam[k], angle);
  }
  return wrong;
}

static const double ends[] = {0, .5, 1};

/* In closed rooms (1) and open scenes (0). */
START_TEST(walls_on_a_grid) {
  static look l;
  randoms r = randoms_stream(test_seed(), 1 + _i);
  size_t kinds[3] = {0, 0, 0};
  for (int k = test_count(300); k > 0; k--) {
    plan p = grid_plan(&r, _i);
    stage s = stage_of(plan_try_scene(&p, NULL));
    for (int m = 0; m < 20; m++) {
      const size_t patch = (size_t)(random_bits(&r) % s.all.count);
      const double t = m % 4 ? random_between(&r, .01, .99) : ends[random_below(&r, 3)];
      see(s.scene, patch, t, &l);
      check_members(s.scene, patch, &l);
      ck_assert(is_whole(s.scene, patch, &l));
      for (size_t b = 0; b < l.count; b++) kinds[l.beam[b].seen]++;
      if (m % 4 && test_has_long_double())
        ck_assert_uint_eq(wrong_beams(&s, patch, t, &l, &r), 0);
    }
    stage_clear(&s);
    plan_free(&p);
  }
  printf("%zu fronts, %zu backs, %zu of the sky\n", kinds[0], kinds[1], kinds[2]);
  ck_assert(kinds[0] && (_i ? !kinds[1] && !kinds[2] : kinds[1] && kinds[2]));
}
END_TEST

static int is_within(hr2d_point p, double size) {
  return fabs(p.x) <= size && fabs(p.y) <= size;
}

/* Turned, far from the origin, and every end moved by an ulp: beams lie side by side, and end
   in the scene, seen from ends of patches, too. */
START_TEST(jittered_walls) {
  static const double at[] = {0, 0x1p-1074, 1e-16, .3, .5, 1 - 0x1p-53, 1};
  static look l;
  randoms r = randoms_stream(test_seed(), 30 + _i);
  int accepted = 0, count = 0;
  for (int k = test_count(1000); k > 0; k--, count++) {
    plan p = grid_plan(&r, _i);
    const double angle = random_between(&r, 0, 6.3), far = k % 3 ? 0 : 1e4;
    plan_jitter(&r, &p, (similarity){cos(angle), sin(angle), far, -far});
    hr2d_scene *scene = plan_try_scene(&p, NULL);
    double size = 0;
    for (size_t m = 0; m < p.walls; m++)
      size = fmax(size, fmax(fmax(fabs(p.wall[m].a.x), fabs(p.wall[m].a.y)),
                             fmax(fabs(p.wall[m].b.x), fabs(p.wall[m].b.y))));
    for (int m = 0; m < 20 && scene; m++) {
      const size_t patch = (size_t)(random_bits(&r) % hr2d_scene_patches(scene));
      see(scene, patch, at[random_below(&r, 7)], &l);
      if (!is_whole(scene, patch, &l)) plan_print(&p);
      ck_assert(is_whole(scene, patch, &l));
      for (size_t b = 0; b < l.count; b++)
        ck_assert(is_within(l.beam[b].end.a, (1 + 1e-15) * size) &&
                  is_within(l.beam[b].end.b, (1 + 1e-15) * size));
    }
    accepted += scene != NULL;
    hr2d_scene_destroy(scene);
    plan_free(&p);
  }
  printf("%d of %d scenes accepted\n", accepted, count);
  ck_assert_int_gt(accepted, count / 4);
}
END_TEST

/* Every kind of fault in the beams of a view is found by what the tests above ask. */
START_TEST(wrong_beams_are_noticed) {
  static look l, other;
  randoms r = randoms_stream(test_seed(), 10);
  plan p = grid_plan(&r, 1);
  stage s = stage_of(plan_try_scene(&p, NULL));
  see(s.scene, 0, .37, &l);
  ck_assert_uint_ge(l.count, 2);
  ck_assert_uint_eq(wrong_beams(&s, 0, .37, &l, &r), 0);
  other = l;
  other.count--;
  ck_assert(!is_whole(s.scene, 0, &other));
  other = l;
  other.beam[1].factor += 1e-12;
  ck_assert(!is_whole(s.scene, 0, &other));
  other = l;
  other.beam[0].left.x += 1e-9;
  ck_assert(!is_whole(s.scene, 0, &other));
  other = l;
  for (size_t k = 0; k < l.count; k++) {
    other.beam[k].end.a.x += .001;
    other.beam[k].end.a.y += .001;
  }
  ck_assert(!test_has_long_double() || wrong_beams(&s, 0, .37, &other, &r) > 0);
  other = l;
  for (size_t k = 0; k < l.count; k++) other.beam[k].patch++;
  ck_assert(!test_has_long_double() || wrong_beams(&s, 0, .37, &other, &r) == l.count);
  stage_clear(&s);
  plan_free(&p);
}
END_TEST

/* A square room and a one-sided patch outside of it, with or without the effect. */
static hr2d_scene *plain_scene(int forced, const hr2d_allocator *hooks) {
  static const double at[][4] = {{0, 0, 3, 0}, {3, 0, 3, 2}, {3, 2, 0, 2}, {-1, -1, -1, 5}};
  hr2d_scene *scene = test_new_scene(hooks);
  for (size_t k = 0; k < sizeof at / sizeof *at; k++) test_add_black(scene, at[k]);
  if (forced) ck_assert_int_eq(hr2d_scene_force(scene, HR2D_EFFECT_OCCLUSION), HR2D_OK);
  test_commit(scene);
  ck_assert_int_eq(hr2d_scene_effect(scene, HR2D_EFFECT_OCCLUSION, NULL), forced);
  return scene;
}

START_TEST(the_effect_changes_no_bit) {
  static look l, other;
  hr2d_scene *plain = plain_scene(0, NULL), *forced = plain_scene(1, NULL);
  for (size_t patch = 0; patch < 4; patch++)
    for (int k = 0; k <= 8; k++) {
      see(plain, patch, k / 8., &l);
      see(forced, patch, k / 8., &other);
      ck_assert(is_whole(plain, patch, &l));
      ck_assert_uint_eq(l.count, other.count);
      ck_assert_mem_eq(l.beam, other.beam, l.count * sizeof *l.beam);
    }
  ck_assert_int_eq(hr2d_scene_effect(plain, HR2D_EFFECT_OCCLUSION, NULL), 0);
  hr2d_scene_destroy(plain);
  hr2d_scene_destroy(forced);
}
END_TEST

START_TEST(a_room_by_hand) {
  static look l;
  hr2d_scene *scene = plain_scene(0, NULL);
  see(scene, 0, .5, &l);
  ck_assert_uint_eq(l.count, 3);
  ck_assert_uint_eq(l.beam[0].patch, 1);
  ck_assert_uint_eq(l.beam[1].patch, 2);
  ck_assert_int_eq(l.beam[2].seen, HR2D_SEEN_BACK);
  ck_assert_double_eq_tol(l.beam[1].factor, .6, 1e-15); /* sine of atan(1.5 / 2) */
  ck_assert_double_eq_tol(l.beam[1].right.x, .6, 1e-15);
  ck_assert_double_eq_tol(l.beam[1].left.y, .8, 1e-15);
  ck_assert_double_eq(l.beam[1].end.a.x, 3);
  ck_assert_double_eq(l.beam[1].end.b.x, 0);
  ck_assert_double_eq_tol(l.beam[2].end.a.y, 10. / 3, 1e-14);
  ck_assert_double_eq(l.beam[2].end.b.x, -1);
  ck_assert_double_eq_tol(l.beam[2].end.b.y, 0, 1e-14);
  hr2d_scene_destroy(scene);
}
END_TEST

static hr2d_status refuse(void *ctx, const hr2d_progress *progress) {
  ck_assert_str_eq(progress->phase, "factors");
  ++*(int *)ctx;
  return HR2D_STOPPED;
}

START_TEST(wrong_calls) {
  static look l;
  int asked = 0;
  hr2d_scene *scene = test_new_scene(NULL);
  l = (look){.count = 0};
  test_add_black(scene, (double[]){0, 0, 1, 0});
  ck_assert_int_eq(hr2d_beams_visit(scene, 0, .5, take, &l), HR2D_ESTATE);
  test_commit(scene);
  ck_assert_int_eq(hr2d_beams_visit(scene, 1, .5, take, &l), HR2D_EINVAL);
  ck_assert_int_eq(hr2d_beams_visit(scene, 0, -0x1p-1074, take, &l), HR2D_EINVAL);
  ck_assert_int_eq(hr2d_beams_visit(scene, 0, 1 + 0x1p-52, take, &l), HR2D_EINVAL);
  ck_assert_int_eq(hr2d_beams_visit(scene, 0, NAN, take, &l), HR2D_EINVAL);
  ck_assert_uint_eq(l.count, 0);
  see(scene, 0, 1, &l);
  ck_assert(l.count == 1 && l.beam[0].seen == HR2D_SEEN_SKY && l.beam[0].factor == 1);
  hr2d_scene_destroy(scene);

  plan p = {.walls = 0};
  plan_room(&p, 1000, 1000);
  for (int k = 0; k < 20000; k++)
    plan_add(&p, (hr2d_point){1 + .04 * k, 900}, (hr2d_point){1.02 + .04 * k, 901},
             HR2D_SIDES_BOTH);
  plan_add(&p, (hr2d_point){1, 500}, (hr2d_point){999, 500}, HR2D_SIDES_FRONT);
  scene = plan_try_scene(&p, NULL);
  ck_assert_ptr_nonnull(scene);
  l = (look){.stop_at = 3};
  const size_t last = hr2d_scene_patches(scene) - 1;
  ck_assert_int_eq(hr2d_beams_visit(scene, last, .5, take, &l), 77);
  ck_assert_uint_eq(l.count, 3);
  hr2d_scene_set_progress(scene, refuse, &asked);
  l = (look){.stop_at = 0};
  ck_assert_int_eq(hr2d_beams_visit(scene, last, .5, take, &l), HR2D_STOPPED);
  ck_assert_int_eq(asked, 1);
  hr2d_scene_destroy(scene);
  plan_free(&p);
}
END_TEST

/* Each allocation in turn, once and from then on; in a plane of its own, too. */
START_TEST(allocations_fail_one_by_one) {
  static look l, whole;
  test_memory memory = {.until_failure = -1};
  const hr2d_allocator hooks = test_hooks(&memory);
  hr2d_scene *scene = plain_scene(_i / 2, &hooks);
  const long live = memory.live;
  long k = 0;
  see(scene, 2, .3, &whole);
  for (int failed = 1; failed; k++) {
    l.count = l.stop_at = 0;
    memory = (test_memory){.until_failure = k, .for_good = _i % 2, .live = live};
    const hr2d_status status = hr2d_beams_visit(scene, 2, .3, take, &l);
    failed = memory.failures > 0;
    ck_assert_int_eq(status, failed ? HR2D_ENOMEM : HR2D_OK);
    ck_assert_int_eq(memory.live, live);
  }
  ck_assert_int_gt(k, _i / 2 ? 1 : 10);
  ck_assert_mem_eq(l.beam, whole.beam, whole.count * sizeof *l.beam);
  memory.until_failure = -1;
  hr2d_scene_destroy(scene);
  ck_assert_int_eq(memory.live, 0);
}
END_TEST

/* A beam that ends at an image has the number that it has among the patches of the whole. */
START_TEST(images_are_seen) {
  hr2d_scene *half = test_new_scene(NULL), *whole = test_new_scene(NULL);
  const hr2d_segment s[] = {{{0, 0}, {2, 0}}, {{2, 0}, {2, 3}}, {{.5, 1}, {1, 1.5}}};
  static look one, other;
  for (int k = 0; k < 3; k++) test_add_patch(half, s[k], 1, .5, HR2D_SIDES_FRONT);
  ck_assert_int_eq(hr2d_scene_add_mirror(half, (hr2d_segment){{0, 0}, {0, 1}}), HR2D_OK);
  test_commit(half);
  for (size_t k = 0; k < 6; k++)
    test_add_patch(whole, hr2d_scene_image(half, k % 3, k / 3), 1, .5, HR2D_SIDES_FRONT);
  test_commit(whole);
  size_t images = 0;
  for (int k = 0; k <= 10; k++) {
    see(half, 0, k / 10., &one);
    see(whole, 0, k / 10., &other);
    ck_assert(is_whole(half, 0, &one));
    ck_assert_uint_eq(one.count, other.count);
    for (size_t m = 0; m < one.count; m++) {
      ck_assert_int_eq(one.beam[m].seen, other.beam[m].seen);
      ck_assert_uint_eq(one.beam[m].patch, other.beam[m].patch);
      ck_assert_double_eq_tol(one.beam[m].factor, other.beam[m].factor, 1e-15);
      images += one.beam[m].patch >= 3;
    }
  }
  ck_assert_uint_gt(images, 10);
  ck_assert_int_eq(hr2d_beams_visit(half, 3, .5, take, &one), HR2D_EINVAL);
  hr2d_scene_destroy(half);
  hr2d_scene_destroy(whole);
}
END_TEST

/* Between two plates that repeat for ever the rest is past the images, on both sides. */
START_TEST(what_is_past_the_images_is_told) {
  hr2d_scene *scene = test_new_scene(NULL);
  static look l;
  double past = 0;
  test_add_patch(scene, (hr2d_segment){{0, 0}, {1, 0}}, 1, .5, HR2D_SIDES_FRONT);
  test_add_patch(scene, (hr2d_segment){{1, 1}, {0, 1}}, 1, .5, HR2D_SIDES_FRONT);
  ck_assert_int_eq(hr2d_scene_set_period(scene, (hr2d_point){1, 0}), HR2D_OK);
  test_commit(scene);
  see(scene, 0, .5, &l);
  ck_assert(is_whole(scene, 0, &l));
  ck_assert_int_eq(l.beam[0].seen, HR2D_SEEN_PAST);
  ck_assert_int_eq(l.beam[l.count - 1].seen, HR2D_SEEN_PAST);
  for (size_t k = 0; k < l.count; k++) {
    past += l.beam[k].seen == HR2D_SEEN_PAST ? l.beam[k].factor : 0;
    ck_assert(l.beam[k].seen == HR2D_SEEN_PAST || l.beam[k].patch % 2 == 1);
  }
  ck_assert_double_eq_tol(past, hr2d_scene_cut_off(scene), 1e-3 * past);
  hr2d_scene_destroy(scene);
}
END_TEST

TEST_SUITE("beams from a point") {
  REPEAT_TESTS(2, "sweep", walls_on_a_grid, jittered_walls);
  ADD_TESTS("sweep", wrong_beams_are_noticed);
  ADD_TESTS("calls", the_effect_changes_no_bit, a_room_by_hand, wrong_calls);
  ADD_TESTS("images", images_are_seen, what_is_past_the_images_is_told);
  REPEAT_TESTS(4, "memory", allocations_fail_one_by_one);
}
