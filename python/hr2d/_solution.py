# SPDX-License-Identifier: GPL-3.0-or-later
"""Solutions: radiosity, irradiance and their errors."""
from __future__ import annotations

import dataclasses
import math
from dataclasses import dataclass
from functools import cached_property
from importlib import import_module
from typing import TYPE_CHECKING, Any, Dict, NamedTuple, Optional, Tuple, Union

import numpy as np

from . import _draw, _state
from ._arrays import ELEMENT, Array, doubles, frozen, view, writable
from ._calls import Call, ProgressFunction, thread_count
from ._errors import Unsupported
from ._hr2d import ffi, lib

if TYPE_CHECKING:
    from ._links import Links


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


class Gas(NamedTuple):
    """What a solution says of a gas, per band."""

    emission: Array
    """E_g: the radiosity of a black body as hot as the gas."""
    heat: Array
    """What it gives to patches and to other gases, less what it gets from them, per length of the
    enclosure."""


class Points(NamedTuple):
    """Values at points, each of the shape of the points and then the bands."""

    B: Array
    H: Array

    @property
    def net_flux(self) -> Array:
        """B − H; negative where the patch gains."""
        return self.B - self.H


class Temperatures(NamedTuple):
    """Temperatures of patches and the heat that leaves them, with bounds of their errors.

    Bounds are NaN where the solve did not measure errors of H.
    """

    kelvin: Array
    """T of the average; NaN unless it is given or found."""
    bound: Array
    """The error of T in kelvin is no larger."""
    heat: Array
    """W per metre, over all bands; negative where a patch gains."""
    heat_bound: Array
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

    mean: Array
    """The mean radiosity of all directions, (…, bands)."""
    flux: Array
    """∫ (B/2) ω dω, (…, bands, 2): its product with n is H(n) − H(−n)."""
    sky: Array
    """The part of all directions in which nothing is."""
    place: Array
    """0 between the patches, 1 on a patch, 2 where no light can be."""
    cut_off: Array
    """The part of all directions past the images of a period, which is extrapolated."""
    error: Array
    """A bound of the error of `mean`, (…, bands), that of `flux` is π times as large; NaN unless
    it was asked for."""
    irradiance: Array
    """H(n) = ∫ (B/2) n·ω dω over n·ω > 0, (…, bands): of planes with the normals; NaN without."""
    irradiance_error: Array
    """A bound of its error, (…, bands); NaN unless it was asked for."""

    @classmethod
    def _empty(cls, shape: Tuple[int, ...], bands: int) -> "Field":
        return cls(np.empty((*shape, bands)), np.empty((*shape, bands, 2)), np.empty(shape),
                   np.empty(shape, np.uint8), np.empty(shape),
                   *np.full((3, *shape, bands), np.nan))

    def _wanted(self, errors: bool, planes: bool = False) -> Any:
        """The arrays for the library."""
        return ffi.new("hr2d_field_values *", {
            "struct_size": ffi.sizeof("hr2d_field_values"), "mean": writable(self.mean),
            "flux": writable(self.flux), "sky": writable(self.sky),
            "cut_off": writable(self.cut_off),
            "error": writable(self.error) if errors else ffi.NULL,
            "irradiance": writable(self.irradiance) if planes else ffi.NULL,
            "irradiance_error":
                writable(self.irradiance_error) if errors and planes else ffi.NULL,
            "place": ffi.cast("unsigned char *", ffi.from_buffer(self.place))})


def _normals(normals: Any, shape: Tuple[int, ...]) -> Array:
    """The normals of planes at points of a shape: x and y of each, or none."""
    if normals is None:
        return np.empty((0, 2))
    x, y = (np.broadcast_to(np.asarray(n, dtype=np.float64), shape) for n in normals)
    return np.stack([x.ravel(), y.ravel()], axis=1)


def _nodes(low: float, high: float, count: int) -> Array:
    """Where the library has them, bit for bit."""
    if count < 2:
        return np.array([low])
    part = np.arange(count) / (count - 1)
    return np.where(part < .5, low + part * (high - low), high - (1 - part) * (high - low))


class Grid(NamedTuple):
    """The light at the nodes of a grid; see Field, whose points have the shape (rows, columns)."""

    x: Array
    """Of the columns."""
    y: Array
    """Of the rows."""
    mean: Array
    flux: Array
    sky: Array
    place: Array
    cut_off: Array
    error: Array
    irradiance: Array
    irradiance_error: Array
    interpolated: int
    """How many nodes are."""

    def to_xarray(self) -> Any:
        """As an xarray.Dataset with the dimensions y, x, band, and axis of the flux."""
        xarray: Any = import_module("xarray")

        dims = ("y", "x", "band")
        return xarray.Dataset(
            {"mean": (dims, self.mean), "flux": ((*dims, "axis"), self.flux),
             "sky": (dims[:2], self.sky), "place": (dims[:2], self.place),
             "cut_off": (dims[:2], self.cut_off), "error": (dims, self.error),
             "irradiance": (dims, self.irradiance),
             "irradiance_error": (dims, self.irradiance_error)},
            coords={"x": self.x, "y": self.y, "axis": ["x", "y"]})


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


_OF_PICKLE = ("B", "H", "net_flux", "net_power", "power", "power_cut_off", "temperatures",
              "element_B", "residual")


class Solution:
    """The radiosity of a scene: Scene.solve() makes it."""

    def __init__(self, scene: Any, raw: Any, account: Optional[Account], told: Any = None,
                 points: bool = False):
        self.scene = scene
        self._made = raw  # None behind pickle, until something needs it
        self._kept: Any = None  # by pickle
        self._account = account
        self._told = told or (ffi.NULL, ffi.NULL)  # target and account of hr2d_solve_to()
        self._own_light = False  # E and ρ are not those of the scene
        self._points = points  # whether a solution by links is measured at points, too

    @property
    def _raw(self) -> Any:
        if self._made is None:
            self._made = _state.adopt(self.scene, self._kept)
        return self._made

    def __copy__(self) -> "Solution":
        return self  # which nothing changes

    def __deepcopy__(self, memo: Any) -> "Solution":
        return self

    def __getstate__(self) -> Dict[str, Any]:
        """What pickle keeps: arrays of averages, the account, and elements, from which at() and
        field() follow, to roundings."""
        if self._own_light:
            raise Unsupported("a solution of an Operator has other light than its scene: keep "
                              "its arrays")
        if self._kept is not None:
            kept, values = self._kept, {k: self.__dict__[k] for k in _OF_PICKLE
                                        if k in self.__dict__}
        else:
            kept = _state.keep_elements(self)
            values = {name: getattr(self, name) for name in _OF_PICKLE
                      if name != "temperatures" or self.scene._has_heat()}
        account, told = self.account, self._told[1]
        return {"scene": self.scene, "kept": kept, "values": values, "account": account,
                "told": b"" if told == ffi.NULL else bytes(ffi.buffer(told)),
                "points": self._points}

    def __setstate__(self, state: Dict[str, Any]) -> None:
        told = ffi.NULL
        if state["told"]:
            told = ffi.new("hr2d_account *")
            ffi.buffer(told)[:] = state["told"]
        self.__init__(state["scene"], None, state["account"],  # type: ignore[misc]
                      (ffi.NULL, told), state["points"])
        self._kept = state["kept"]
        self.__dict__.update(state["values"], elements=state["kept"]["elements"])

    def state(self) -> bytes:
        """A solution by links as bytes, which are the same on all machines: the argument `start`
        of Scene.solve() goes on from there with the bits of a run without a break, and they are
        what the program keeps in the file of its option --state.

        >>> coarse = square().solve(epsilon=.5)
        >>> fine = square().solve(epsilon=.1, start=coarse.state())
        """
        if self._kept is not None:
            raise Unsupported("pickle keeps no links: keep state() itself")
        return _state.write_state(self._raw)

    @cached_property
    def links(self) -> "Links":
        """The links that the solution was made with; of a target without those of clusters."""
        from ._links import Links

        if self._kept is not None:
            raise Unsupported("pickle keeps no links")
        links = lib.hr2d_solution_links(self._raw)
        raw = self._raw
        return Links(self.scene, ffi.gc(ffi.cast("hr2d_linkset *", links),
                                        lambda pointer, owner=raw: None))

    @cached_property
    def residual(self) -> float:
        """The largest relative residual of the equation over the bands."""
        return float(lib.hr2d_solution_residual(self._raw))

    def __repr__(self) -> str:
        return f"<hr2d.Solution of {len(self.scene)} patches, {len(self.elements)} elements>"

    def _averages(self, getter: str) -> Array:
        values = np.empty((len(self.scene), self.scene.bands))
        lib.hr2dpy_values(ffi.addressof(lib, getter), self._raw, *values.shape,
                          writable(values))
        return frozen(values)

    @cached_property
    def B(self) -> Array:
        """The radiosity: averages over the patches, (patches, bands), in the unit of E."""
        return self._averages("hr2d_solution_average")

    @cached_property
    def H(self) -> Array:
        """The irradiance: averages over the patches, (patches, bands)."""
        return self._averages("hr2d_solution_irradiance")

    @cached_property
    def net_flux(self) -> Array:
        """B − H, (patches, bands); negative where a patch gains."""
        return self._averages("hr2d_solution_net_flux")

    @cached_property
    def net_power(self) -> Array:
        """B − H over the length, (patches, bands), in the unit of E times a scene length; with
        temperatures in W per metre.

        >>> s = square().solve(error=1e-9)
        >>> s.net_power.shape, abs(float(s.net_power.sum())) < 1e-9
        ((4, 1), True)
        """
        return self._averages("hr2d_solution_net_power")

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
        kelvin, bound, heat, heat_bound = map(frozen, found)
        return Temperatures(kelvin, bound, heat, heat_bound, tuple(STATES[s] for s in state))

    @cached_property
    def power(self) -> Tuple[Power, ...]:
        """The balance of power of each band, in the unit of E times a scene length.

        >>> p, = square().solve(error=1e-9).power
        >>> p.emitted, round(p.absorbed, 6), round(p.escaped, 6)
        (1.0, 1.0, 0.0)
        """
        raws = [lib.hr2d_solution_power(self._raw, band) for band in range(self.scene.bands)]
        return tuple(Power(r.emitted, r.received, r.absorbed, r.escaped) for r in raws)

    @cached_property
    def gas(self) -> Optional[Gas]:
        """The gas, or the first one; None without one."""
        return self.gases[0] if self.gases else None

    @cached_property
    def gases(self) -> Tuple[Gas, ...]:
        """All gases, in their order."""
        return tuple(self._gas(gas) for gas in range(lib.hr2d_scene_gases(self.scene._raw)))

    def _gas(self, gas: int) -> Gas:
        numbers = np.empty((2, self.scene.bands))
        with Call() as call:
            for band in range(self.scene.bands):
                call.check(lib.hr2d_solution_gas(self._raw, gas, band,
                                                 writable(numbers[0, band:]),
                                                 writable(numbers[1, band:])))
        return Gas(frozen(numbers[0]), frozen(numbers[1]))

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

        >>> s = square().solve(error=1e-9)
        >>> s.at("walls/1", [0, .5, 1]).H.round(4)
        array([[0.7287],
               [0.525 ],
               [0.3952]])
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
        if (self._own_light or self.scene._emits_as_found(index)
                or self.scene.other_side[index] != index):
            B = np.empty(shape)
            with Call() as call:
                call.check(lib.hr2d_solution_gather(self._raw, index, doubles(t), t.size,
                                                    writable(B)))
            return Points(B, H)
        # But on panes B' = E + ρ H' is what hr2d_solution_gather() would gather again.
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

        >>> field = square().solve(error=1e-9).field((.5, .5))
        >>> field.mean.shape, field.flux.shape, field.sky.shape
        ((1,), (1, 2), ())
        """
        x, y = np.broadcast_arrays(*(np.asarray(c, dtype=np.float64) for c in points))
        at = np.stack([x.ravel(), y.ravel()], axis=1)
        f = Field._empty(x.shape, self.scene.bands)
        normal = _normals(normals, x.shape)
        with Call(progress) as call:
            call.check(lib.hr2d_field_at(self._raw, ffi.cast("hr2d_point *", doubles(at)),
                                         len(at), self._field_options(errors, threads, normal),
                                         f._wanted(errors, len(normal) > 0)))
        return f

    def field_on_grid(self, box: Any = None, shape: Tuple[int, int] = (64, 64), *,
                      tolerance: float = 0, normals: Any = None, errors: bool = False,
                      threads: Any = 1, progress: Optional[ProgressFunction] = None) -> Grid:
        """The light at the nodes of a grid of (rows, columns) in a box (x0, y0, x1, y1).

        Without a box it is around all patches.  With a `tolerance`, a part of the range of the
        mean in [0, 1], nodes are interpolated where that adds no larger error; 0: every node is
        as field() finds it.  `errors` as for field(), and `normals`, without a tolerance.

        >>> grid = square().solve().field_on_grid(shape=(3, 5), tolerance=.01)
        >>> grid.mean.shape, grid.x
        ((3, 5, 1), array([0.  , 0.25, 0.5 , 0.75, 1.  ]))
        """
        rows, columns = (int(n) for n in shape)
        if box is None:
            ends = self.scene.segments.reshape(-1, 2)
            box = (*ends.min(axis=0), *ends.max(axis=0))
        x0, y0, x1, y1 = (float(side) for side in box)
        x, y = _nodes(x0, x1, columns), _nodes(y0, y1, rows)
        grid = ffi.new("hr2d_field_grid *", {
            "struct_size": ffi.sizeof("hr2d_field_grid"), "low": {"x": x0, "y": y0},
            "high": {"x": x1, "y": y1}, "columns": columns, "rows": rows,
            "tolerance": tolerance})
        counts = ffi.new("hr2d_field_counts *")
        f = Field._empty((rows, columns), self.scene.bands)
        normal = _normals(normals, (rows, columns))
        with Call(progress) as call:
            call.check(lib.hr2d_field_on_grid(
                self._raw, grid, self._field_options(errors, threads, normal),
                f._wanted(errors, len(normal) > 0), counts))
        return Grid(x, y, *f, counts.interpolated)

    def _field_options(self, errors: bool, threads: Any, normal: Array) -> Any:
        return ffi.new("hr2d_field_options *", {
            "struct_size": ffi.sizeof("hr2d_field_options"), "threads": thread_count(threads),
            "account": self._point_account if errors else ffi.NULL,
            "normal": ffi.cast("hr2d_point *", doubles(normal)), "normals": len(normal)})

    def temperature_at(self, patch: Union[int, str], t: Any) -> Array:
        """Temperatures in kelvin at points of a patch, as at(): of the shape of `t`."""
        index, t = self.scene.index(patch), np.require(t, np.float64, "C")
        kelvin = np.empty(np.shape(t))
        with Call() as call:
            call.check(lib.hr2d_solution_gather_temperature(self._raw, index, doubles(t), t.size,
                                                            writable(kelvin)))
        return kelvin

    def to_dataframe(self) -> Any:
        """A pandas.DataFrame with a row for each patch and band: B, H, B − H in the unit of E, and
        B − H over the length; T in kelvin and the heat in W per metre, over all bands, where
        temperatures, fluxes or heats are given."""
        pandas: Any = import_module("pandas")

        patches, bands = self.B.shape
        columns = {"patch": np.repeat(np.arange(patches), bands),
                   "name": np.repeat(np.array(self.scene.names, dtype=object), bands),
                   "band": np.tile(np.arange(bands), patches),
                   "length": np.repeat(self.scene.lengths, bands),
                   "B": self.B.ravel(), "H": self.H.ravel(), "net_flux": self.net_flux.ravel(),
                   "net_power": self.net_power.ravel()}
        if self.scene._has_heat():
            columns["temperature"] = np.repeat(self.temperatures.kelvin, bands)
            columns["heat"] = np.repeat(self.temperatures.heat, bands)
        return pandas.DataFrame(columns)

    def write_npz(self, path: Any) -> None:
        """Writes an .npz file of numpy: B, H, net_flux, net_power, names, segments and lengths of
        the patches, and elements with element_B.

        numpy.load(path)["B"] reads it again.
        """
        np.savez_compressed(path, B=self.B, H=self.H, net_flux=self.net_flux,
                            net_power=self.net_power,
                            names=np.array(self.scene.names), segments=self.scene.segments,
                            lengths=self.scene.lengths, unit=self.scene.unit,
                            element_B=self.element_B,
                            **{f"element_{name}": self.elements[name] for name in
                               ("a", "b", "child", "patch")})

    def to_xarray(self) -> Any:
        """An xarray.Dataset of B, H, net_flux and net_power with the dimensions patch and band, and the
        names and lengths of the patches; temperatures and heat as in to_dataframe()."""
        xarray: Any = import_module("xarray")

        dims = ("patch", "band")
        values: Dict[str, Any] = {name: (dims, getattr(self, name)) for name in
                                  ("B", "H", "net_flux", "net_power")}
        if self.scene._has_heat():
            values["temperature"] = (dims[:1], self.temperatures.kelvin)
            values["heat"] = (dims[:1], self.temperatures.heat)
        return xarray.Dataset(values, coords={"name": ("patch", self.scene.names),
                                              "length": ("patch", self.scene.lengths)})

    @cached_property
    def _point_account(self) -> Any:
        """An account in C that has the errors at points."""
        told = self._told[1]
        known = told != ffi.NULL and not math.isnan(told.sup.estimate)
        return told if known else self._measure(points=True)

    def _point_values(self, getter: str, patch: int, t: Array, shape: Any) -> Array:
        values = np.empty(shape)
        lib.hr2dpy_point_values(ffi.addressof(lib, getter), self._raw, patch, doubles(t),
                                t.size, shape[-1], writable(values))
        return values

    @cached_property
    def elements(self) -> Array:
        """The elements as a structured array over the memory of the library.

        Members are `a`, `b`, `centre`, `length` (in units of Scene.unit), `child` (0 for
        leaves; the second child follows) and `patch`.
        """
        tree = lib.hr2d_linkset_hierarchy(lib.hr2d_solution_links(self._raw))
        return view(lib.hr2d_hierarchy_elements(tree), ELEMENT,
                    lib.hr2d_hierarchy_count(tree).elements, self._raw)

    @cached_property
    def element_B(self) -> Array:
        """B of each element, (elements, bands)."""
        values = np.empty((len(self.elements), self.scene.bands))
        lib.hr2dpy_element_values(self._raw, *values.shape, writable(values))
        return frozen(values)

    def _repr_html_(self) -> str:
        return _draw.solution_html(self)
