/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A phrase for every status. */
#include <hr2d/status.h>
#include <stddef.h>

static const char *const phrases[] = {
    [HR2D_OK] = "success",
    [HR2D_STOPPED] = "stopped by a callback",
    [HR2D_ENOMEM] = "out of memory",
    [HR2D_EINVAL] = "invalid argument",
    [HR2D_ESTATE] = "object not in the state this call needs",
    [HR2D_ERANGE] = "beyond the range of a double",
    [HR2D_EIO] = "file cannot be read",
    [HR2D_ESYNTAX] = "file is malformed",
    [HR2D_ESCENE] = "scene is not valid",
    [HR2D_EUNSUPPORTED] = "scene calls for an effect that is not supported",
    [HR2D_ECALLBACK] = "callback failed",
    [HR2D_EMAX_ELEMENTS] = "limit on elements reached",
    [HR2D_EMAX_LINKS] = "limit on links reached",
    [HR2D_EMAX_BYTES] = "limit on memory reached",
    [HR2D_ENO_SOLUTION] = "radiosity equation has no solution",
    [HR2D_ENOT_CONVERGED] = "no convergence within the iteration limit",
    [HR2D_EACCURACY] = "the accuracy asked for was not reached",
};

const char *hr2d_strerror(hr2d_status status) {
  /* The enumeration may be signed; a negative value becomes a large size_t. */
  const size_t index = (size_t)status;
  const size_t count = sizeof phrases / sizeof *phrases;
  return index < count && phrases[index] ? phrases[index] : "unknown status";
}
