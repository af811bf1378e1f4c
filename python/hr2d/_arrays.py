# SPDX-License-Identifier: GPL-3.0-or-later
"""numpy arrays that C reads or writes."""
from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from ._hr2d import ffi

Array = npt.NDArray[Any]

ELEMENT = np.dtype({
    "names": ["a", "b", "centre", "length", "child", "patch"],
    "formats": [(np.float64, 2)] * 3 + [np.float64, np.uint32, np.uint32],
    "offsets": [ffi.offsetof("hr2d_element", name)
                for name in ("a", "b", "centre", "length", "child", "patch")],
    "itemsize": ffi.sizeof("hr2d_element"),
})
"""An element of a hierarchy.  Coordinates are in units of Scene.unit."""


def doubles(array: Array) -> Any:
    """The numbers of a contiguous array as `double *`, not copied."""
    return ffi.from_buffer("double[]", array) if array.size else ffi.NULL


def writable(array: Array) -> Any:
    """As doubles(), to be written."""
    return ffi.from_buffer("double[]", array, require_writable=True) if array.size else ffi.NULL


def view(pointer: Any, dtype: Any, count: int, owner: Any) -> Array:
    """An array over memory of the library that lives as long as `owner`; not copied."""
    dtype = np.dtype(dtype)
    if count == 0:
        return np.empty(0, dtype)
    held = ffi.gc(pointer, lambda raw, owner=owner: None)
    array = np.frombuffer(ffi.buffer(held, count * dtype.itemsize), dtype)
    array.flags.writeable = False
    return array


def copied(pointer: Any, dtype: Any, count: int) -> Array:
    """A copy of memory that is valid during a callback only."""
    dtype = np.dtype(dtype)
    return np.frombuffer(ffi.buffer(pointer, count * dtype.itemsize), dtype).copy()


def frozen(array: Array) -> Array:
    """An array that may be handed out more than once."""
    array.flags.writeable = False
    return array
