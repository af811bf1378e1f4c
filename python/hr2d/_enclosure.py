# SPDX-License-Identifier: GPL-3.0-or-later
"""Ends between which averages are, without an assumption."""
from __future__ import annotations

import warnings
from functools import cached_property
from typing import Any, Optional, Tuple

import numpy as np

from ._arrays import Array, frozen, writable
from ._calls import POLL, Call, ProgressFunction, owned
from ._errors import AccuracyWarning
from ._hr2d import ffi, lib


class Enclosure:
    """Lower and upper ends of averages over patches: Scene.enclose() makes it.

    Arrays are (patches, bands), in the unit of E.
    """

    def __init__(self, scene: Any, gap: Optional[float], max_links: int,
                 progress: Optional[ProgressFunction]):
        if gap is not None and not gap > 0:
            raise ValueError(f"gap is a number above 0, not {gap}")
        self.scene = scene
        options, account = ffi.new("hr2d_enclose_options *"), ffi.new("hr2d_enclosure_account *")
        lib.hr2d_enclose_options_init(options, ffi.sizeof("hr2d_enclose_options"))
        options.gap, options.max_links, options.progress = gap or 0, max_links, POLL
        pointer = ffi.new("hr2d_enclosure **")
        with Call(progress) as call:
            status = lib.hr2d_enclose(scene._raw, options, pointer, account)
            if pointer[0]:
                self._raw = owned(pointer[0], lib.hr2d_enclosure_destroy, scene._raw)
            call.check_made(status, pointer[0], lambda: account.reason)
        self.gap: float = account.gap
        """The largest distance of ends, relative to the largest lower end of its band."""
        self.links: int = account.links
        self.seconds: float = account.seconds
        self.reason: str = ffi.string(account.reason).decode()
        """Why the gap is larger than was asked for."""
        if status:
            warnings.warn(self.reason, AccuracyWarning, stacklevel=3)

    def __repr__(self) -> str:
        return f"<hr2d.Enclosure of {len(self.scene)} patches, gap {self.gap:.1e}>"

    def _ends(self, getter: str) -> Array:
        values = np.empty((len(self.scene), self.scene.bands))
        lib.hr2dpy_ends(ffi.addressof(lib, getter), self._raw, *values.shape, writable(values))
        return frozen(values)

    @cached_property
    def lower(self) -> Array:
        """The average B is not below."""
        return self._ends("hr2d_enclosure_lower")

    @cached_property
    def upper(self) -> Array:
        """The average B is not above."""
        return self._ends("hr2d_enclosure_upper")

    @cached_property
    def lower_H(self) -> Array:
        """The average H is not below."""
        return self._ends("hr2d_enclosure_lower_irradiance")

    @cached_property
    def upper_H(self) -> Array:
        """The average H is not above."""
        return self._ends("hr2d_enclosure_upper_irradiance")

    def error(self, solution: Any, *, floor: float = 0) -> Tuple[float, float]:
        """The relative errors of averages of B and H of a solution, for certain."""
        found = ffi.new("double[2]")
        with Call() as call:
            call.check(lib.hr2d_enclosure_error(self._raw, solution._raw, floor, found, found + 1))
        return found[0], found[1]
