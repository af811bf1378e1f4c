/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Scenes that climbs and users found, in which errors were up to 1e9 times their bounds: kinks
   in whole patches of which coefficients show nothing, links that were accepted for the sake of
   one patch, kinks beside a lamp that were weighed by the mean of a long floor, and kinks that
   are seen by a dim patch alone.  The truth
   has each patch cut in four, and ten digits; of some scenes it was known before. */
#include <math.h>

#include "support/support.h"

enum { MOST = 12, CUTS = 4 };

/* ax ay bx by E ρ; back to back if two. */
typedef struct found {
  double target;
  int important;              /* the only patch that counts; −1: all do */
  double background, bearing; /* of a sun of irradiance 1; NAN: none */
  hr2d_sky_piece piece;       /* of radiosity 1; from = to: none */
  size_t count;
  double patch[9][6];
  int two[9];
  size_t known; /* of this patch an average of B or, if it is black, of H is known: */
  double value;
} found;

static const found all[] = {
    {0.1,
     -1,
     0,
     -15,
     {0, 0},
     2,
     {{-5, 0, 5, 0, 0, .5}, {-2.8, .5, -3.8, 1.2, 0, .5}},
     {0, 1},
     1,
     .1113976},
    {1e-5,
     2,
     1,
     NAN,
     {0, 0},
     2,
     {{-6, 0, 6, 0, 0, .5}, {-2, .3, -2, .6, 0, .5}},
     {0, 1},
     2,
     .3768847},
    {2e-3,
     -1,
     1,
     NAN,
     {0, 0},
     3,
     {{-6, 0, 6, 0, 0, .39697847181512613},
      {-2.6828838737772696, 1.5652966071183914, -2.7049812886669296, 1.3687452531243653, 0,
       .14594241187031609},
      {-2.0461644854313814, 1.1594171645760587, -1.6623661251238122, .34413967278901186, 0, 0}},
     {0, 1, 1},
     0,
     NAN},
    {0.1,
     0,
     .18404206598484418,
     NAN,
     {42.58274269442807, 43.012017994422031},
     3,
     {{-3.756358690559864, 0, 3.756358690559864, 0, 0, 0},
      {3.1057057529687881, 2.4233690053224564, 3.1991444230079651, 2.4255130887031555, 0,
       .46482495590829864},
      {-1.9682904444634914, 1.2856272719800472, -2.0918911769986153, 1.2994141951203346, 0,
       .94531934572884679}},
     {0, 1, 1},
     0,
     NAN},
    {1.2318825175743934e-8,
     3,
     0,
     NAN,
     {0, 0},
     5,
     {{-1.7818250358104706, 0, 1.7818250358104706, 0, 0, .89999492326946451},
      {-1.5869198814034462, .60004167258739471, -1.6879185661673546, .72301539778709412, 1,
       .46320598907650679},
      {-1.6433484368026257, .36573171243071556, -1.431598961353302, .41997651010751724, 0,
       .86412455393991794},
      {-.7777596227824688, .16486936807632446, -.77512466162443161, .21824926137924194, 0,
       .4430084011092208},
      {.50228221714496613, .30339651554822922, .29364154115319252, .49148454889655113, 0,
       .9319428233113648}},
     {0, 0, 1, 1, 1},
     0,
     NAN},
    {0.0017831151820590749,
     -1,
     0,
     NAN,
     {0, 0},
     9,
     {{0, 0, 1.4029651023447514, 0, .030395228001483865, 0},
      {1.4029651023447514, 0, 2.361390359699726, 0, 0, .23689599751337323},
      {2.361390359699726, 0, 2.361390359699726, 1, 0, .6975673938816698},
      {2.361390359699726, 1, 1.4029651023447514, 1, 0, 0},
      {1.4029651023447514, 1, 0, 1, 0, .6},
      {0, 1, 0, 0, 1, .26477171165153424},
      {1.4029651023447514, 0, 1.4029651023447514, .05414330214262009, 0, 0},
      {1.4029651023447514, .05818415433168411, 1.4029651023447514, 1, 0, 0},
      {1.709782648831606, .4198123887181282, 1.6267630644142628, .45418785512447357, 0,
       .1733029216339996}},
     {0, 0, 0, 0, 0, 0, 1, 1, 1},
     0,
     NAN},
    {0.0010692422498474446,
     -1,
     0,
     NAN,
     {0, 0},
     5,
     {{-2.041935484856367, 0, 2.041935484856367, 0, 0, .7125578439329417},
      {-.8368082419037819, .135988038033247, -.8999808877706528, .10406472906470299, 1,
       .7125578439329417},
      {-1.1553733944892883, .6844005100429058, -1.4002308882772923, .9465788677334785, 0,
       .3248253405914494},
      {1.0445726811885834, .33735954388976097, .07944099232554436, 2.0448554009199142, 0,
       .3763242413920632},
      {.513138435781002, .8150330260396004, .649961668998003, .8437905013561249, 0,
       .9427654916686653}},
     {0, 0, 1, 1, 1},
     0,
     NAN},
    {0.0010127911667040194,
     3,
     0,
     NAN,
     {0, 0},
     5,
     {{-2.703827928751707, 0, 2.703827928751707, 0, 0, .7098353972908792},
      {-.42899566516280174, .01128292828798294, -.4672706872224808, .06163589656352997, 1,
       .4194898591476264},
      {.14084437862038612, 1.4201790913939476, .12582729384303093, 1.4613999500870705, 0,
       .14614716112976872},
      {.28885864838957787, .406184908002615, -.28792449086904526, .4200519882142544, 0,
       .12816683351584224},
      {.8995203785598278, .0759151391685009, .4862557724118233, .4547288492321968, 0,
       .8333333333333334}},
     {0, 0, 1, 1, 1},
     0,
     NAN},
    {0.00101,
     -1,
     0,
     NAN,
     {0, 0},
     8,
     {{0, 0, .5001412332057953, 0, 0, .016736924008115814},
      {.5001412332057953, 0, .5001412332057953, 1, .8857962878272279, .8207304189737681},
      {.5001412332057953, 1, 0, 1, 0, 0},
      {0, 1, 0, 0, 1, .860954441479864},
      {.05360105261206627, 0, .05360105261206627, .5620172582566738, 0, .14496957400100263},
      {.05360105261206627, .5681967288255692, .05360105261206627, 1, 0, 0},
      {.4501095563173294, 0, .4501095563173294, .5012190081179142, 0, .7995238877240023},
      {.4501095563173294, .5687768422067165, .4501095563173294, 1, 0, .8011427189068042}},
     {0, 0, 0, 0, 1, 1, 1, 1},
     0,
     NAN},
    {0.0052431135303516972,
     -1,
     0,
     NAN,
     {0, 0},
     3,
     {{-.8771720975637436, .0040063075721263885, -.8866505809128284, -.033114541321992874, 1,
       .9057879329299806},
      {.2291625812649727, 1.4690151661634445, -.7381012588739395, 1.537367518991232, 0,
       .8916897848534683},
      {-.3488830141723156, .9770851619541645, -.38742953538894653, 1.0344461426138878, 0,
       .21191311936712523}},
     {0, 1, 1},
     0,
     NAN},
};

enum { FOUND = sizeof all / sizeof *all };

/* The scene, with each patch cut in so many. */
static hr2d_scene *make(const found *f, int cuts) {
  hr2d_scene *scene = test_new_scene(NULL);
  for (size_t k = 0; k < f->count; k++)
    for (int c = 0; c < cuts; c++) {
      const double *p = f->patch[k], s = (double)c / cuts, t = (double)(c + 1) / cuts;
      const hr2d_segment at = {{p[0] + s * (p[2] - p[0]), p[1] + s * (p[3] - p[1])},
                               {p[0] + t * (p[2] - p[0]), p[1] + t * (p[3] - p[1])}};
      ck_assert_int_eq(
          test_add_patch(scene, at, p[4], p[5], f->two[k] ? HR2D_SIDES_BOTH : HR2D_SIDES_FRONT),
          HR2D_OK);
    }
  const double turn = f->bearing * acos(-1.) / 180, one = 1;
  const hr2d_sun sun = {{-sin(turn), -cos(turn)}, 1};
  if (f->background > 0)
    ck_assert_int_eq(hr2d_scene_set_background(scene, &f->background, 1), HR2D_OK);
  if (!isnan(f->bearing)) ck_assert_int_eq(hr2d_scene_set_sun(scene, &sun, 1), HR2D_OK);
  if (f->piece.from < f->piece.to)
    ck_assert_int_eq(hr2d_scene_set_sky(scene, &f->piece, 1, &one, 1), HR2D_OK);
  test_commit(scene);
  return scene;
}

/* Averages of B and of H of the patches from those of their parts. */
static size_t averages(const found *f, const hr2d_solution *solution, int cuts,
                       double value[2][MOST]) {
  size_t patches = 0, next = 0;
  for (size_t k = 0; k < f->count; k++) {
    const size_t sides = f->two[k] ? 2 : 1;
    for (size_t side = 0; side < sides; side++, patches++) {
      value[0][patches] = value[1][patches] = 0;
      for (size_t c = 0; c < (size_t)cuts; c++) {
        const size_t part = next + sides * c + side;
        value[0][patches] += hr2d_solution_average(solution, part, 0) / cuts;
        value[1][patches] += hr2d_solution_irradiance(solution, part, 0) / cuts;
      }
    }
    next += sides * (size_t)cuts;
  }
  return patches;
}

static hr2d_account solve(const found *f, int cuts, double error, double value[2][MOST],
                          size_t *patches) {
  hr2d_target target = HR2D_TARGET_INIT;
  hr2d_account account;
  hr2d_solution *solution;
  const size_t important = (size_t)f->important;
  hr2d_scene *scene = make(f, cuts);
  target.error = error;
  target.important = f->important < 0 || cuts > 1 ? NULL : &important;
  target.important_count = target.important != NULL;
  ck_assert_int_eq(hr2d_solve_to(scene, &target, &solution, &account), HR2D_OK);
  *patches = averages(f, solution, cuts, value);
  hr2d_solution_destroy(solution);
  hr2d_scene_destroy(scene);
  return account;
}

static double worst(const found *f, const double is[MOST], const double right[MOST],
                    size_t patches) {
  double max = 0, error = 0;
  for (size_t k = 0; k < patches; k++) max = fmax(max, right[k]);
  for (size_t k = 0; k < patches && max > 0; k++)
    if (f->important < 0 || k == (size_t)f->important)
      error = fmax(error, fabs(is[k] - right[k]) / fmax(right[k], HR2D_FLOOR * max));
  return error;
}

START_TEST(errors_are_bounded) {
  const found *f = &all[_i];
  double is[2][MOST], right[2][MOST];
  size_t patches;
  const hr2d_account fine = solve(f, CUTS, 1e-10, right, &patches);
  const hr2d_account a = solve(f, 1, f->target, is, &patches);
  if (!isnan(f->value)) ck_assert_double_eq_tol(right[0][f->known], f->value, 5.1e-8);
  const double b = worst(f, is[0], right[0], patches), h = worst(f, is[1], right[1], patches);
  ck_assert_double_le(b, a.average.bound + fine.average.bound);
  ck_assert_double_le(h, a.irradiance.bound + fine.irradiance.bound);
  ck_assert_double_le(b, 10 * a.average.estimate + fine.average.bound);
  ck_assert_double_le(h, 10 * a.irradiance.estimate + fine.irradiance.bound);
  ck_assert_double_le(b, f->target);
}
END_TEST

TEST_SUITE("found errors") {
  REPEAT_TESTS(FOUND, "found", errors_are_bounded);
}
