/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Every public function, with good arguments and with one wrong argument at a time: NULL, an
   index of nothing, a struct of another size or with a member that is wrong, a text that is not
   UTF-8. What is refused has the answer that hr2d/status.h promises.  The rest must be
   survived: under the sanitizers any access beyond an object ends the test.  calls.awk makes
   the calls of the headers. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "arguments/stage.h"
#include "support/support.h"

/* In calls.inc: does something if it is the case's turn. */
#define TRY(...)                                                                               \
  do {                                                                                         \
    if (*k >= 0 && (*k)-- == 0) {                                                              \
      __VA_ARGS__                                                                              \
    }                                                                                          \
  } while (0)

static hr2d_share *wrong_share(stage *s, int *k);

#include "tests/arguments/calls.inc"

/* NULL: all wrong shares are through. */
static hr2d_share *wrong_share(stage *s, int *k) {
  hr2d_share *wrong = NULL;
  for (size_t size = 0; size < sizeof s->good_share; size += 4)
    TRY(wrong = cut(s, &s->good_share, size););
  if (wrong) return wrong;
  spoil_hr2d_share(s, &s->good_share, k);
  TRY(s->good_share.number = s->good_share.count;);
  TRY(s->good_share.count = 0;);
  return &s->good_share;
}

START_TEST(test_call) {
  const struct call *call = &calls[_i];
  int more = 1;
  stage *s = stage_make();
  for (int number = 0; more; number++) {
    int k = number;
    const int right = call->make(s, &k);
    more = k < 0;
    ck_assert_msg(right, "hr2d_%s(), case %d in calls.inc", call->name, number);
    if (!call->changes) stage_renew(s);
    if (!call->changes || !more) continue;
    stage_end(s);
    s = stage_make();
  }
  stage_end(s);
}
END_TEST

TEST_SUITE("arguments") {
  REPEAT_TESTS(sizeof calls / sizeof *calls, "calls", test_call);
}
