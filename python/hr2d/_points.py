# SPDX-License-Identifier: GPL-3.0-or-later
"""View factors from points of the plane to patches."""
from __future__ import annotations

from typing import Any, List, NamedTuple, Optional

import numpy as np

from ._arrays import Array, copied, doubles
from ._calls import Call, ProgressFunction, keep_exception, thread_count
from ._hr2d import ffi, lib


class PointFactors(NamedTuple):
    """What points see, each array of the shape of the points, then the patches.

    `share @ B` is the mean radiosity of all directions, and `factor @ B` the irradiance of a
    line with the normal, for any B that is constant on each patch.
    """

    share: Array
    """The part of all directions in which a patch is seen, (…, patches)."""
    sky: Array
    """The part with nothing, (…)."""
    back: Array
    """The part with backs, which are black, (…)."""
    factor: Optional[Array]
    """The form factor to each patch from a line with the normal, (…, patches); None without
    normals."""
    sky_factor: Optional[Array]
    """The form factor to nothing, (…)."""
    back_factor: Optional[Array]
    """The form factor to backs, (…)."""
    place: Array
    """0 between the patches, 1 on a patch, 2 where no light can be, (…)."""


class _Rows:
    """Takes the rows; those of points are independent of each other."""

    def __init__(self, points: int, patches: int, directed: bool):
        self.share = np.zeros((points, patches))
        self.factor = np.zeros((points, patches)) if directed else None
        self.rest = np.zeros((4, points))
        self.place = np.zeros(points, np.uint8)


@ffi.def_extern(error=lib.HR2D_ECALLBACK, onerror=keep_exception)
def hr2dpy_row(ctx: Any, raw: Any) -> int:
    rows, k = ffi.from_handle(ctx), raw.point
    if raw.count:
        patch = copied(raw.patch, np.uint32, raw.count)
        rows.share[k, patch] = copied(raw.share, np.float64, raw.count)
        if rows.factor is not None:
            rows.factor[k, patch] = copied(raw.factor, np.float64, raw.count)
    rows.rest[:, k] = raw.sky, raw.back, raw.sky_factor, raw.back_factor
    rows.place[k] = raw.place
    return lib.HR2D_OK


def point_factors(scene: Any, points: Any, normals: Any, threads: Any,
                  progress: Optional[ProgressFunction]) -> PointFactors:
    x, y = np.broadcast_arrays(*np.asarray(points, dtype=np.float64))
    at = np.stack([x.ravel(), y.ravel()], axis=1)
    towards = None
    if normals is not None:
        nx, ny = (np.broadcast_to(n, x.shape) for n in np.asarray(normals, dtype=np.float64))
        towards = np.stack([nx.ravel(), ny.ravel()], axis=1)
    rows = _Rows(len(at), len(scene), towards is not None)
    handle = ffi.new_handle(rows)
    options = ffi.new("hr2d_field_options *", {
        "struct_size": ffi.sizeof("hr2d_field_options"), "threads": thread_count(threads)})
    with Call(progress) as call:
        call.check(lib.hr2d_field_rows_visit(
            scene._raw, ffi.cast("hr2d_point *", doubles(at)),
            ffi.NULL if towards is None else ffi.cast("hr2d_point *", doubles(towards)), len(at),
            options, lib.hr2dpy_row, handle))

    def shaped(values: Array) -> Array:
        return values.reshape((*x.shape, *values.shape[1:]))

    sky, back, sky_factor, back_factor = map(shaped, rows.rest)
    if rows.factor is None:
        return PointFactors(shaped(rows.share), sky, back, None, None, None, shaped(rows.place))
    return PointFactors(shaped(rows.share), sky, back, shaped(rows.factor), sky_factor,
                        back_factor, shaped(rows.place))
