# SPDX-License-Identifier: GPL-3.0-or-later
"""Solutions: radiosity, irradiance and their errors."""
from __future__ import annotations

import dataclasses
import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple, Optional, Tuple, Union

import numpy as np

from . import _draw
from ._arrays import ELEMENT, doubles, frozen, view, writable
from ._calls import Call, ProgressFunction, thread_count
from ._hr2d import ffi, lib


class Bounded(NamedTuple):
    """A relative error: the most likely one, and one that is not exceeded."""

    estimate: float
    bound: float

    @classmethod
    def _of(cls, raw: Any) -> "Bounded":
        return cls(raw.estimate, raw.bound)

    @classmethod
    def _if_measured(cls, raw: Any) -> Optional["Bounded"]:
        return None if math.isnan(raw.estimate) else cls._of(raw)


class Power(NamedTuple):
    """Balance of a band: emitted + received = absorbed + escaped."""

    emitted: float
    received: float
    absorbed: float
    escaped: float


class Points(NamedTuple):
    """Values at points, each of the shape of the points and then the bands."""

    B: np.ndarray
    H: np.ndarray

    @property
    def net_flux(self) -> np.ndarray:
        """B − H; negative where the patch gains."""
        return self.B - self.H


class Temperatures(NamedTuple):
    """Temperatures of patches and the heat that leaves them, with bounds of their errors.

    Bounds are NaN where the solve did not measure errors of H.
    """

    kelvin: np.ndarray
    """T of the average; NaN unless it is given or found."""
    bound: np.ndarray
    """The error of T in kelvin is no larger."""
    heat: np.ndarray
    """W per metre, over all bands; negative where a patch gains."""
    heat_bound: np.ndarray
    """The error of the heat is no larger."""
    state: Tuple[str, ...]
    """"none", "given", "found", "impossible" (it cannot lose so much), "unlit"."""


STATES = {lib.HR2D_TEMPERATURE_NONE: "none", lib.HR2D_TEMPERATURE_GIVEN: "given",
          lib.HR2D_TEMPERATURE_FOUND: "found", lib.HR2D_TEMPERATURE_UNLIT: "unlit",
          lib.HR2D_TEMPERATURE_IMPOSSIBLE: "impossible"}


class Field(NamedTuple):
    """The light at points of the plane, each array of the shape of the points.

    Points on a patch have the limit from its front; points that no light can reach have NaN.
    """

    mean: np.ndarray
    """The mean radiosity of all directions, (…, bands)."""
    flux: np.ndarray
    """∫ (B/2) ω dω, (…, bands, 2): its product with n is H(n) − H(−n)."""
    sky: np.ndarray
    """The part of all directions in which nothing is."""
    place: np.ndarray
    """0 between the patches, 1 on a patch, 2 where no light can be."""
    cut_off: np.ndarray
    """The part of all directions past the images of a period, which is extrapolated."""
    error: np.ndarray
    """A bound of the error of `mean`, (…, bands), that of `flux` is π times as large; NaN unless
    it was asked for."""
    irradiance: np.ndarray
    """H(n) = ∫ (B/2) n·ω dω over n·ω > 0, (…, bands): of planes with the normals; NaN without."""
    irradiance_error: np.ndarray
    """A bound of its error, (…, bands); NaN unless it was asked for."""


@dataclass(frozen=True)
class Account:
    """The errors of a solution, and what it took.

    Errors of B and H are relative: of averages over patches, and with `sup` at points: None
    unless solve() was asked for `points` or the norm "sup".  Of a solution by links `sup` is of
    values without a gather.
    """

    average: Bounded
    sup: Optional[Bounded]
    irradiance: Bounded
    irradiance_sup: Optional[Bounded]
    order: int
    elements: int
    leaves: int
    links: int
    seconds: Optional[float]
    reached: bool
    reason: str

    @classmethod
    def _of(cls, raw: Any, reached: bool) -> "Account":
        return cls(Bounded._of(raw.average), Bounded._if_measured(raw.sup),
                   Bounded._of(raw.irradiance), Bounded._if_measured(raw.irradiance_sup),
                   raw.order, raw.elements, raw.leaves, raw.links, raw.seconds, reached,
                   ffi.string(raw.reason).decode())

    def _repr_html_(self) -> str:
        return _draw.account_html(self)


class Solution:
    """The radiosity of a scene: Scene.solve() makes it."""

    def __init__(self, scene: Any, raw: Any, account: Optional[Account], told: Any = None,
                 points: bool = False):
        self.scene = scene
        self._raw = raw
        self._account = account
        self._told = told or (ffi.NULL, ffi.NULL)  # target and account of hr2d_solve_to()
        self._own_light = False  # E and ρ are not those of the scene
        self._points = points  # whether a solution by links is measured at points, too

    def __repr__(self) -> str:
        return f"<hr2d.Solution of {len(self.scene)} patches, {len(self.elements)} elements>"

    def _averages(self, getter: str) -> np.ndarray:
        values = np.empty((len(self.scene), self.scene.bands))
        lib.hr2dpy_values(ffi.addressof(lib, getter), self._raw, *values.shape,
                          writable(values))
        return frozen(values)

    @cached_property
    def B(self) -> np.ndarray:
        """The radiosity: averages over the patches, (patches, bands), in the unit of E."""
        return self._averages("hr2d_solution_average")

    @cached_property
    def H(self) -> np.ndarray:
        """The irradiance: averages over the patches, (patches, bands)."""
        return self._averages("hr2d_solution_irradiance")

    @cached_property
    def net_flux(self) -> np.ndarray:
        """B − H, (patches, bands); negative where a patch gains."""
        return self._averages("hr2d_solution_net_flux")

    @cached_property
    def temperatures(self) -> Temperatures:
        """Temperatures, and the heat that leaves each patch."""
        found = [np.empty(len(self.scene)) for _ in range(4)]
        state = np.empty(len(self.scene), np.uint8)
        to = ffi.new("hr2d_temperatures *", {
            "struct_size": ffi.sizeof("hr2d_temperatures"), "kelvin": writable(found[0]),
            "bound": writable(found[1]), "heat": writable(found[2]),
            "heat_bound": writable(found[3]),
            "state": ffi.cast("unsigned char *", ffi.from_buffer(state))})
        with Call() as call:
            call.check(lib.hr2d_solution_temperatures(self._raw, *self._told[:2], to))
        return Temperatures(*map(frozen, found), tuple(STATES[s] for s in state))

    @cached_property
    def power(self) -> Tuple[Power, ...]:
        """The balance of power of each band."""
        raws = [lib.hr2d_solution_power(self._raw, band) for band in range(self.scene.bands)]
        return tuple(Power(r.emitted, r.received, r.absorbed, r.escaped) for r in raws)

    @cached_property
    def power_cut_off(self) -> Tuple[float, ...]:
        """What images of a period that are cut off may make of `power`, per band."""
        return tuple(lib.hr2d_solution_power_cut_off(self._raw, band)
                     for band in range(self.scene.bands))

    @cached_property
    def account(self) -> Account:
        """The errors with their bounds, and what the solution took.

        A solution by links is measured at the first use, which takes longer than its solve.
        """
        return self._account or self._measured()

    def _measure(self, points: bool) -> Any:
        target, raw = ffi.new("hr2d_target *"), ffi.new("hr2d_account *")
        lib.hr2d_target_init(target, ffi.sizeof("hr2d_target"))
        target.points = bool(points)
        with Call() as call:
            call.check(lib.hr2d_solution_account(self._raw, target, raw))
        return raw

    def _measured(self) -> Account:
        raw = self._measure(self._points)
        self._account = dataclasses.replace(Account._of(raw, True), seconds=None)
        self._told = (ffi.NULL, raw)
        return self._account

    def at(self, patch: Union[int, str], t: Any, *, gather: bool = True) -> Points:
        """B and H at points of a patch.

        `t` has fractions of the patch in [0, 1], counted from its start, in any shape.  Light
        is gathered once more with exact kernel and visibility.  Without `gather` the values are
        those of the elements: faster, and less accurate.
        """
        index, t = self.scene.index(patch), np.require(t, np.float64, "C")
        if not ((t >= 0) & (t <= 1)).all():
            raise ValueError("t is a fraction of the patch, from 0 to 1")
        shape = (*np.shape(t), self.scene.bands)
        if not gather:
            return Points(self._point_values("hr2d_solution_at", index, t, shape),
                          self._point_values("hr2d_solution_irradiance_at", index, t, shape))
        H = np.empty(shape)
        with Call() as call:
            call.check(lib.hr2d_solution_gather_irradiance(self._raw, index, doubles(t), t.size,
                                                           writable(H)))
        if self._own_light or self.scene._emits_as_found(index):
            B = np.empty(shape)
            with Call() as call:
                call.check(lib.hr2d_solution_gather(self._raw, index, doubles(t), t.size,
                                                    writable(B)))
            return Points(B, H)
        # B' = E + ρ H' is what hr2d_solution_gather() would gather again.
        return Points(self.scene.emission[index] + self.scene.reflectance[index] * H, H)

    def field(self, points: Any, *, normals: Any = None, errors: bool = False,
              threads: Any = 1, progress: Optional[ProgressFunction] = None) -> Field:
        """The light at points of the plane, with exact visibility.

        `points` are x and y, in any shape: `np.mgrid[0:5:200j, 0:3:100j]`, or two arrays.
        `normals` are x and y of the normals of planes there, of any length: two numbers, or
        arrays of the shape of the points.  The planes are sensors or panels of any tilt, which
        hide no light, and get an irradiance.
        With `errors` those of the values are measured, in the time of some gathers for each
        leaf element.  They follow from the errors at points; if solve() was not asked for
        these, they are measured first, which takes longer than the solve.
        """
        x, y = np.broadcast_arrays(*(np.asarray(c, dtype=np.float64) for c in points))
        at = np.stack([x.ravel(), y.ravel()], axis=1)
        bands = self.scene.bands
        f = Field(np.empty((*x.shape, bands)), np.empty((*x.shape, bands, 2)),
                  np.empty(x.shape), np.empty(x.shape, np.uint8), np.empty(x.shape),
                  *np.full((3, *x.shape, bands), np.nan))
        normal = np.empty((0, 2))
        if normals is not None:
            nx, ny = (np.broadcast_to(np.asarray(n, dtype=np.float64), x.shape) for n in normals)
            normal = np.stack([nx.ravel(), ny.ravel()], axis=1)
        values = ffi.new("hr2d_field_values *", {
            "struct_size": ffi.sizeof("hr2d_field_values"), "mean": writable(f.mean),
            "flux": writable(f.flux), "sky": writable(f.sky),
            "cut_off": writable(f.cut_off),
            "error": writable(f.error) if errors else ffi.NULL,
            "irradiance": writable(f.irradiance) if len(normal) else ffi.NULL,
            "irradiance_error":
                writable(f.irradiance_error) if errors and len(normal) else ffi.NULL,
            "place": ffi.cast("unsigned char *", ffi.from_buffer(f.place))})
        options = ffi.new("hr2d_field_options *", {
            "struct_size": ffi.sizeof("hr2d_field_options"), "threads": thread_count(threads),
            "account": self._point_account if errors else ffi.NULL,
            "normal": ffi.cast("hr2d_point *", doubles(normal)), "normals": len(normal)})
        with Call(progress) as call:
            call.check(lib.hr2d_field_at(self._raw, ffi.cast("hr2d_point *", doubles(at)),
                                         len(at), options, values))
        return f

    @cached_property
    def _point_account(self) -> Any:
        """An account in C that has the errors at points."""
        told = self._told[1]
        known = told != ffi.NULL and not math.isnan(told.sup.estimate)
        return told if known else self._measure(points=True)

    def _point_values(self, getter: str, patch: int, t: np.ndarray, shape: Any) -> np.ndarray:
        values = np.empty(shape)
        lib.hr2dpy_point_values(ffi.addressof(lib, getter), self._raw, patch, doubles(t),
                                t.size, shape[-1], writable(values))
        return values

    @cached_property
    def elements(self) -> np.ndarray:
        """The elements as a structured array over the memory of the library.

        Members are `a`, `b`, `centre`, `length` (in units of Scene.unit), `child` (0 for
        leaves; the second child follows) and `patch`.
        """
        tree = lib.hr2d_linkset_hierarchy(lib.hr2d_solution_links(self._raw))
        return view(lib.hr2d_hierarchy_elements(tree), ELEMENT,
                    lib.hr2d_hierarchy_count(tree).elements, self._raw)

    @cached_property
    def element_B(self) -> np.ndarray:
        """B of each element, (elements, bands)."""
        values = np.empty((len(self.elements), self.scene.bands))
        lib.hr2dpy_element_values(self._raw, *values.shape, writable(values))
        return frozen(values)

    def _repr_html_(self) -> str:
        return _draw.solution_html(self)
