/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Reads the state of a solve.  Memory grows with the bytes that were read, not with the sizes
   that the head claims. */
#include <math.h>
#include <string.h>

#include "base/alloc.h"
#include "hierarchy/hierarchy-impl.h"
#include "links/linkset-impl.h"
#include "scene/frozen-temperatures.h"
#include "solution/solution-impl.h"
#include "state/byte-stream.h"
#include "state/state-impl.h"

typedef struct loading {
  hr2di_reader reader;
  hr2di_watch watch;
  hr2d_linkset *links;
  hr2di_state_head head;
  hr2d_refine_counts counts;
  hr2di_store store;
  hr2d_solution *solution;
} loading;

static hr2d_status damaged(loading *l, const char *what) {
  return hr2di_message_fail(&l->links->message, HR2D_ESYNTAX, "the state is damaged: %s", what);
}

static void get_head(loading *l, hr2d_solve_work *work) {
  hr2di_reader *r = &l->reader;
  hr2di_state_head *head = &l->head;
  uint64_t *word[] = {&head->scene,  &head->method, &head->elements, &head->links,
                      &head->solved, &head->order,  &head->bands,    &head->directed};
  uint64_t *counter[HR2DI_STATE_COUNTERS];
  for (size_t k = 0; k < sizeof word / sizeof *word; k++) *word[k] = hr2di_reader_word(r);
  head->epsilon = hr2di_reader_double(r);
  head->residual = hr2di_reader_double(r);
  hr2di_state_counters(&l->counts, work, counter);
  for (int k = 0; k < HR2DI_STATE_COUNTERS; k++) *counter[k] = hr2di_reader_word(r);
}

static hr2d_status check_head(loading *l) {
  const hr2di_state_head *head = &l->head;
  const hr2d_scene *scene = l->links->hierarchy->scene;
  hr2di_message *message = &l->links->message;
  const uint64_t hash = hr2di_state_scene(scene, &l->watch);
  if (l->watch.status) return l->watch.status;
  if (head->scene != hash)
    return hr2di_message_fail(message, HR2D_EINVAL, "the state is that of another scene");
  if (head->method != hr2di_state_method(l->links))
    return hr2di_message_fail(message, HR2D_EINVAL,
                              "the state was made with another oracle or policy");
  const uint64_t n = scene->patches;
  if (head->elements < n || (head->elements - n) % 2 || head->elements > UINT32_MAX)
    return damaged(l, "its number of elements");
  if (head->solved < n || head->solved > head->elements || (head->solved - n) % 2)
    return damaged(l, "the number of elements solved for");
  if (head->order < 1 || head->order > HR2D_MAX_ORDER || head->bands != scene->bands)
    return damaged(l, "its order or number of bands");
  if (head->links > UINT64_MAX / 64 || head->directed > 1)
    return damaged(l, "its number of links");
  return head->epsilon >= 0 && head->residual >= 0 ? HR2D_OK : damaged(l, "its epsilon");
}

/* Whether the input begins like a state; 1 also if its beginning cannot be read. */
static int is_state(hr2di_reader *r) {
  char title[HR2DI_STATE_TITLE_BYTES];
  hr2di_reader_expect(r, sizeof title);
  hr2di_reader_text(r, title, sizeof title);
  return r->status ? r->status != HR2D_ESYNTAX
                   : !memcmp(title, HR2DI_STATE_TITLE, sizeof title);
}

static uint64_t count_temperatures(const hr2d_scene *scene) {
  uint64_t count = 0;
  if (hr2di_scene_is_unsettled(scene))
    for (size_t k = 0; k < hr2di_scene_cell(scene); k++)
      count += (uint64_t)hr2di_scene_has_flux(scene, k);
  return count;
}

static int cuts_images(const loading *l) {
  return hr2di_symmetry_cuts(&l->links->hierarchy->scene->symmetry);
}

static hr2d_status read_head(loading *l, hr2d_solve_work *work) {
  hr2di_reader *r = &l->reader;
  hr2di_reader_expect(r, HR2DI_STATE_HEAD_BYTES);
  get_head(l, work);
  if (r->status) return r->status;
  const hr2d_status status = check_head(l);
  const hr2di_state_head *head = &l->head;
  const uint64_t divisions = (head->elements - l->links->hierarchy->scene->patches) / 2;
  const uint64_t items = head->solved * head->order;
  if (!status && head->bands > UINT64_MAX / 64 / items) return damaged(l, "its size");
  hr2di_reader_expect(
      r, 4 * divisions + 16 * head->links + (uint64_t)(cuts_images(l) ? 40 : 32) * head->bands +
             16 * items * head->bands + 8 * count_temperatures(l->links->hierarchy->scene) + 8);
  return status;
}

/* Items between two declarations of work. */
enum { BATCH = 256 };

/* Asks the watch before some items of `bytes` each. */
static hr2d_status declare(loading *l, uint64_t item, size_t bytes) {
  return item % BATCH == 0 ? hr2di_watch_work(&l->watch, BATCH * bytes / 64) : HR2D_OK;
}

static hr2d_status read_elements(loading *l) {
  hr2d_hierarchy *h = l->links->hierarchy;
  while (h->elements < l->head.elements) {
    const uint32_t element = hr2di_reader_half(&l->reader);
    if (l->reader.status) return l->reader.status;
    const hr2d_status asked = declare(l, h->elements, 32);
    if (asked) return asked;
    if (element >= h->elements || h->element[element].child ||
        !hr2di_element_divisible(h, element) || h->level[element] == UINT16_MAX)
      return damaged(l, "an element that cannot be divided");
    const hr2d_status status = hr2di_hierarchy_reserve(h);
    if (status)
      return hr2di_message_fail(&l->links->message, status, "out of memory for elements");
    hr2di_element_halve(h, element);
  }
  return HR2D_OK;
}

/* An exchange area is at most the length of the shorter element, within rounding.  Images that
   stand for others have a weight besides, which may be negative. */
static int is_link(const hr2d_hierarchy *h, hr2d_pair pair, int directed, double area) {
  if (pair.first >= h->elements || pair.second >= h->elements) return 0;
  const hr2d_element *i = &h->element[pair.first], *j = &h->element[pair.second];
  const double max = 1.01 * fmin(i->length, j->length),
               weight =
                   hr2di_symmetry_weight(&h->scene->symmetry, i->patch, j->patch, directed);
  return i->patch != j->patch && area >= fmin(weight, 0) * max && area <= fmax(weight, 1) * max;
}

static hr2d_status read_links(loading *l) {
  hr2di_reader *r = &l->reader;
  for (uint64_t k = 0; k < l->head.links; k++) {
    hr2d_pair pair;
    pair.first = hr2di_reader_half(r);
    pair.second = hr2di_reader_half(r);
    const double area = hr2di_reader_double(r);
    if (r->status) return r->status;
    const hr2d_status asked = declare(l, k, 16);
    if (asked) return asked;
    if (!is_link(l->links->hierarchy, pair, l->head.directed != 0, area))
      return damaged(l, "a link");
    if (hr2di_store_add(&l->store, &l->links->alloc, &pair, &area, 1))
      return hr2di_message_fail(&l->links->message, HR2D_ENOMEM,
                                "out of memory after %llu links", (unsigned long long)k);
  }
  return HR2D_OK;
}

static hr2d_status read_doubles(loading *l, double *value, size_t count) {
  for (size_t k = 0; k < count; k++) {
    value[k] = hr2di_reader_double(&l->reader);
    if (l->reader.status) return l->reader.status;
    const hr2d_status asked = declare(l, k, 8);
    if (asked) return asked;
    if (!isfinite(value[k])) return damaged(l, "a value that is not finite");
  }
  return HR2D_OK;
}

/* Powers are sums, which may be beyond a double: infinity is allowed. */
static hr2d_status read_power(loading *l, hr2d_power *power) {
  double *part[] = {&power->emitted, &power->received, &power->absorbed, &power->escaped};
  for (int k = 0; k < 4; k++) {
    *part[k] = hr2di_reader_double(&l->reader);
    if (isnan(*part[k])) return damaged(l, "a power that is no number");
  }
  return l->reader.status;
}

static hr2d_status read_solution(loading *l, const hr2d_solve_work *work) {
  const hr2d_allocator *alloc = &l->links->alloc;
  const hr2di_state_head *head = &l->head;
  const size_t bands = (size_t)head->bands, order = (size_t)head->order;
  const size_t count = (size_t)head->solved * order * bands;
  const int cuts = cuts_images(l);
  hr2d_solution *s = l->solution = hr2di_alloc_zero(alloc, 1, sizeof *s);
  if (s) {
    *s = (hr2d_solution){.alloc = *alloc,
                         .links = l->links,
                         .hierarchy = l->links->hierarchy,
                         .elements = (size_t)head->solved,
                         .order = order,
                         .bands = bands,
                         .work = *work,
                         .residual = head->residual};
    s->power = hr2di_alloc(alloc, bands, sizeof *s->power);
    if (cuts) s->power_cut_off = hr2di_alloc(alloc, bands, sizeof *s->power_cut_off);
    s->value = hr2di_alloc(alloc, count, sizeof *s->value);
    s->irradiance = hr2di_alloc(alloc, count, sizeof *s->irradiance);
  }
  if (!s || !s->power || !s->value || !s->irradiance || (cuts && !s->power_cut_off))
    return hr2di_message_fail(&l->links->message, HR2D_ENOMEM,
                              "out of memory for the solution");
  hr2d_status status = HR2D_OK;
  for (size_t band = 0; band < bands && !status; band++) {
    status = read_power(l, &s->power[band]);
    if (!status && s->power_cut_off) status = read_doubles(l, &s->power_cut_off[band], 1);
  }
  if (!status) status = read_doubles(l, s->value, count);
  return status ? status : read_doubles(l, s->irradiance, count);
}

static hr2d_status read_temperatures(loading *l) {
  const hr2d_scene *scene = l->links->hierarchy->scene;
  if (!hr2di_scene_is_unsettled(scene)) return HR2D_OK;
  hr2d_status status = hr2di_frozen_create(scene, &l->solution->own_scene);
  if (status)
    return hr2di_message_fail(&l->links->message, status, "out of memory for the temperatures");
  for (size_t k = 0; k < hr2di_scene_cell(scene) && !status; k++) {
    if (!hr2di_scene_has_flux(scene, k)) continue;
    double radiance;
    status = read_doubles(l, &radiance, 1);
    if (!status && radiance < 0) status = damaged(l, "a temperature");
    if (!status) status = hr2di_frozen_set(l->solution->own_scene, k, radiance);
  }
  return status;
}

static hr2d_status read_all(loading *l) {
  hr2d_solve_work work = {0};
  if (!is_state(&l->reader))
    return hr2di_message_fail(&l->links->message, HR2D_ESYNTAX,
                              "this is not a state, or not of this version");
  hr2d_status status = read_head(l, &work);
  if (!status) status = read_elements(l);
  if (!status) status = read_links(l);
  if (!status) status = read_solution(l, &work);
  if (!status) status = read_temperatures(l);
  if (!status && hr2di_reader_end(&l->reader) == HR2D_ESYNTAX)
    return damaged(l, "its hash is not that of its contents");
  if (!status) status = l->reader.status;
  if (status == HR2D_ESYNTAX && l->reader.status) return damaged(l, "it ends too early");
  if (status && (status == l->reader.status || l->watch.refused))
    return hr2di_message_fail(&l->links->message, status, "reading the state: %s",
                              hr2d_strerror(status));
  return status;
}

static void take(loading *l) {
  hr2d_linkset *links = l->links;
  const hr2d_hierarchy_counts sizes = hr2d_hierarchy_count(links->hierarchy);
  links->store = l->store;
  links->directed = (int)l->head.directed;
  links->epsilon = l->head.epsilon;
  links->counts = l->counts;
  links->counts.levels = sizes.levels;
  links->own_tests = l->counts.visibility_tests;
}

hr2d_status hr2d_state_read(hr2d_linkset *links, hr2d_read_fn read, void *ctx,
                            hr2d_solution **solution) {
  if (!links || !read || !solution) return HR2D_EINVAL;
  hr2d_hierarchy *h = links->hierarchy;
  const size_t roots = h->scene->patches;
  if (hr2di_gas_refuses(h->scene, "states are not read", &links->message))
    return HR2D_EUNSUPPORTED;
  if (links->store.count > 0 || h->elements > roots || hr2di_hierarchy_busy(h))
    return hr2di_message_fail(&links->message, HR2D_ESTATE,
                              "the set or its hierarchy is not empty");
  loading l = {.links = links};
  hr2di_scene_watch(h->scene, &l.watch, NULL, NULL, "state");
  hr2di_reader_init(&l.reader, read, ctx);
  h->refining = 1;
  const hr2d_status status = read_all(&l);
  h->refining = 0;
  if (status) {
    hr2d_solution_destroy(l.solution);
    hr2di_store_clear(&l.store, &links->alloc);
    hr2di_hierarchy_truncate(h, roots);
    return status;
  }
  take(&l);
  *solution = l.solution;
  return HR2D_OK;
}
