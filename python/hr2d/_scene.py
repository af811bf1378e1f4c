# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes: patches with emission and reflectance."""
from __future__ import annotations

import json
import os
import threading
from contextlib import contextmanager
from functools import cached_property
from importlib import import_module
from typing import (Any, Callable, Dict, Iterator, List, Mapping, NamedTuple, Optional, Sequence,
                    Tuple, Union)

import numpy as np

from . import _draw, _links, _solve
from ._arrays import Array, doubles, frozen, view, writable
from ._calls import POLL, Call, ProgressFunction, keep_exception, owned, thread_count
from ._enclosure import Enclosure
from ._errors import SceneError, StateError, error_of
from ._geojson import collection_of, medium_of, outside_of, region_of, text_of
from ._hr2d import ffi, lib
from ._law import Law
from ._links import Links, Study
from ._operator import Operator
from ._points import PointFactors, point_factors
from ._solution import Solution
from ._solve import Prediction
from ._strategy import OracleLike, PolicyLike

Values = Union[float, Sequence[float], Array]
PatchLike = Union[int, str]


class Sun(NamedTuple):
    """The suns of the bands."""

    direction: Array
    """In which their light travels, (bands, 2)."""
    irradiance: Array
    """On a surface across it, (bands,)."""


class Snap(NamedTuple):
    """What Scene.snap() did."""

    ends: int
    """Ends that were joined to another end."""
    feet: int
    """Points that were moved to stand on a patch."""
    slivers: int
    """Patches that have lost their length, and were dropped."""
    copies: int
    """Patches that have become copies of others, and were dropped."""
    cuts: int
    """Places where patches crossed still, and were cut."""
    farthest: float
    """How far an end was moved at most."""


class SceneWarning(NamedTuple):
    """Something in a scene that is valid, but maybe not meant."""

    code: str
    """For example "loose-end"."""
    text: str
    """A sentence with the place, and what to do."""
    patches: Tuple[int, ...]
    """The patches that it names."""
    at: Optional[Tuple[float, float]]
    """Where a gap is."""
    gap: float
    """Its width; 0 for other warnings."""


@ffi.def_extern(error=lib.HR2D_STOPPED, onerror=keep_exception)
def hr2dpy_warn(ctx: Any, raw: Any) -> int:
    ffi.from_handle(ctx).append(SceneWarning(
        ffi.string(lib.hr2d_warning_name(raw.code)).decode(), ffi.string(raw.text).decode(),
        tuple(raw.patch[k] for k in range(raw.patches)),
        (raw.at.x, raw.at.y) if raw.gap > 0 else None, raw.gap))
    return lib.HR2D_OK


class Scene:
    """Patches: segments of the plane that emit and reflect light.

    A patch runs from a to b, and its front is on the left.  Patches are added until the first
    call that needs all of them, for instance solve(); from then on the scene is only read, and
    several threads may use it.

    `background` is the light from the surroundings, one value or one per band, or that of
    `background_temperature` in kelvin.  `wavelengths` in µm, rising, divide the spectrum of
    temperatures into bands, one more than they are.  `sun` has the arguments of set_sun(),
    `sky` is that of set_sky().
    """

    def __init__(self, background: Optional[Values] = None, *,
                 wavelengths: Optional[Values] = None, sun: Optional[Mapping[str, Any]] = None,
                 sky: Union[None, Mapping[str, Any], Sequence[Any]] = None,
                 background_temperature: Optional[float] = None):
        pointer = ffi.new("hr2d_scene **")
        with Call() as call:
            call.check(lib.hr2d_scene_create(ffi.NULL, pointer))
        self._raw = owned(pointer[0], lib.hr2d_scene_destroy)
        lib.hr2d_scene_set_progress(self._raw, POLL, ffi.NULL)
        self._lock = threading.RLock()
        self._changing = False
        self._committed = False
        self._log: List[Tuple[str, Tuple[Any, ...]]] = []  # the calls that made the scene
        if background is not None:
            self.set_background(background)
        if wavelengths is not None:
            self.set_wavelengths(wavelengths)
        if background_temperature is not None:
            self.add_text(outside_of({"background_temperature": background_temperature}))
        if sun is not None:
            self.set_sun(**sun)
        if sky is not None:
            self.set_sky(sky)

    # Adding

    @contextmanager
    def _change(self, progress: Optional[ProgressFunction] = None) -> Iterator[Call]:
        """A call that changes the scene: one at a time, and none from a callback of one."""
        with self._lock:
            if self._changing:
                raise StateError("called back from a call that changes the scene")
            self._changing = True
            try:
                with Call(progress) as call:
                    yield call
            finally:
                self._changing = False

    def _message(self) -> Any:
        return lib.hr2d_scene_message(self._raw)

    # A copy, and the scene that pickle makes, has the same patches by the same calls, so that
    # each of its bits is the same.

    def __getstate__(self) -> Dict[str, Any]:
        with self._lock:
            return {"log": list(self._log), "committed": self._committed}

    def __setstate__(self, state: Dict[str, Any]) -> None:
        self.__init__()  # type: ignore[misc]
        for name, arguments in state["log"]:
            getattr(self, name)(*arguments)
        if state["committed"]:
            self.commit()

    def set_background(self, background: Values) -> None:
        """Sets the light from the surroundings, one value ≥ 0, or one per band."""
        values = np.atleast_1d(np.ascontiguousarray(background, dtype=np.float64)).ravel()
        with self._change() as call:
            call.check(lib.hr2d_scene_set_background(self._raw, doubles(values), values.size),
                       self._message)
            self._log.append(("set_background", (values,)))

    def set_wavelengths(self, wavelengths: Values) -> None:
        """Divides the spectrum of temperatures into bands, one more than the borders in µm."""
        borders = np.atleast_1d(np.ascontiguousarray(wavelengths, dtype=np.float64)).ravel()
        with self._change() as call:
            call.check(lib.hr2d_scene_set_wavelengths(self._raw, doubles(borders), borders.size),
                       self._message)
            self._log.append(("set_wavelengths", (borders,)))

    def set_weights(self, weights: Any) -> None:
        """Divides what black bodies emit into bands by weights, as weighted sums of grey gases do.

        `weights` has the polynomials in kelvin of the bands behind the first, (bands − 1, terms);
        band 0, the gaps between the lines of the gas, has what they leave.  Before temperatures.

        >>> scene = Scene()
        >>> scene.set_weights([[.5, -1e-4], [0, 2e-4]])
        >>> patches = scene.add([(0, 0), (1, 0)], temperature=1000)
        >>> (scene.emission[0] / black_body(1000)).round(12)
        array([0.4, 0.4, 0.2])
        """
        values = np.atleast_2d(np.ascontiguousarray(weights, dtype=np.float64))
        with self._change() as call:
            call.check(lib.hr2d_scene_set_weights(self._raw, doubles(values), *values.shape),
                       self._message)
            self._log.append(("set_weights", (values,)))

    def force(self, effect: str) -> None:
        """Turns an effect on that the scene does not call for, by its name in `effects`."""
        names = [ffi.string(lib.hr2d_effect_name(k)).decode()
                 for k in range(lib.HR2D_EFFECT_COUNT)]
        if effect not in names:
            raise ValueError(f"{effect!r} is none of {', '.join(names)}")
        with self._change() as call:
            call.check(lib.hr2d_scene_force(self._raw, names.index(effect)), self._message)
            self._log.append(("force", (effect,)))

    def set_sun(self, irradiance: Values, *, bearing: Optional[Values] = None,
                direction: Any = None) -> None:
        """Sets a sun: parallel light of an irradiance on a surface across it.

        `bearing` is where the sun stands, in degrees clockwise from +y, or `direction` (dx, dy)
        is that in which its light travels.  Each may be one value, or one per band.
        """
        sun = {"irradiance": irradiance, "bearing": bearing, "direction": direction}
        self.add_text(outside_of({"sun": {k: v for k, v in sun.items() if v is not None}}))

    def set_sky(self, sky: Union[Mapping[str, Any], Sequence[Any]]) -> None:
        """Sets the sky: pieces (from, to, radiosity), with bearings in degrees clockwise from +y.

        A radiosity is one value, or one per band.  Other directions have the background.  In the
        place of pieces, a mapping is a continuous sky, as "sky" of a scene file is one, and a
        sequence of mappings has one per band.

        >>> scene = square()
        >>> scene.set_sky({"cie": 16, "irradiance": 100})
        >>> scene.sky([0, 60, 120]).round(2).tolist()
        [[115.61], [79.24], [0.0]]
        """
        given: Any = dict(sky) if isinstance(sky, Mapping) else [
            dict(one) if isinstance(one, Mapping) else list(one) for one in sky]
        self.add_text(outside_of({"sky": given}))

    def set_medium(self, absorption: Values, *, temperature: Optional[float] = None,
                   flux: Optional[float] = None, emission: Optional[Values] = None,
                   section: Optional[str] = None) -> None:
        """Fills the scene with a grey gas that absorbs a part of what passes per length.

        Its temperature in kelvin is given, or the heat `flux` that it gives to the patches, 0 if
        it is adiabatic, or its own `emission`; without these it is cold.  `section` is "long"
        (the default) or "flat".  gas.h says what does not go with it yet.

        >>> scene = square()
        >>> scene.set_medium(1)
        >>> scene.absorption, scene.solve(error=1e-9).gas.heat.shape
        (array([1.]), (1,))
        """
        self.add_text(outside_of({"medium": medium_of(absorption, temperature, flux, emission,
                                                      section)}))

    def add_medium(self, border: Any, absorption: Values, *,
                   temperature: Optional[float] = None, flux: Optional[float] = None,
                   emission: Optional[Values] = None, section: Optional[str] = None) -> None:
        """Fills a polygon, `border` of the shape (points, 2), with a gas as set_medium() has it.

        Where borders overlap, the gas counts that was added last.  Needs a closed scene.

        >>> scene = square()
        >>> scene.set_medium(.1, emission=0)
        >>> scene.add_medium([(.2, .2), (.8, .2), (.5, .9)], 2, emission=1)
        >>> scene.absorptions.tolist(), len(scene.solve(error=1e-6).gases)
        ([[0.1], [2.0]], 2)
        """
        ring = np.asarray(border, dtype=np.float64).tolist()
        self.add_text(region_of(ring, medium_of(absorption, temperature, flux, emission, section)))

    @cached_property
    def absorption(self) -> Array:
        """κ of the gas, or of the first one, per scene length, (bands,); 0 without one."""
        return frozen(self.absorptions[0] if len(self.absorptions) else np.zeros(self.bands))

    @cached_property
    def absorptions(self) -> Array:
        """κ of all gases per scene length, (gases, bands)."""
        self.commit()
        gases = range(lib.hr2d_scene_gases(self._raw))
        return frozen(np.array([[lib.hr2d_scene_absorption(self._raw, gas, band)
                                 for band in range(self.bands)] for gas in gases],
                               dtype=np.float64).reshape(len(gases), self.bands))

    def add_mirror(self, a: Any, b: Any) -> None:
        """Adds a mirror: a line through two points, at which the scene is reflected."""
        line = ffi.new("hr2d_segment *", [[float(c) for c in a], [float(c) for c in b]])
        with self._change() as call:
            call.check(lib.hr2d_scene_add_mirror(self._raw, line[0]), self._message)
            self._log.append(("add_mirror", (tuple(map(float, a)), tuple(map(float, b)))))

    def set_period(self, dx: float, dy: float) -> None:
        """Repeats the scene for ever, at each multiple of (dx, dy); (0, 0) for none."""
        period = ffi.new("hr2d_point *", [dx, dy])
        with self._change() as call:
            call.check(lib.hr2d_scene_set_period(self._raw, period[0]), self._message)
            self._log.append(("set_period", (float(dx), float(dy))))

    def add(self, shape: Any, *, emission: Optional[Values] = None,
            reflectance: Optional[Values] = None, temperature: Optional[float] = None,
            flux: Optional[float] = None, heat: Optional[float] = None,
            emissivity: Optional[Values] = None,
            transmittance: Optional[Values] = None, shield: Optional[bool] = None,
            back: Optional[Mapping[str, Any]] = None,
            name: Optional[str] = None, sides: Optional[str] = None,
            faces: Optional[str] = None) -> range:
        """Adds patches and returns their indices.

        `shape` is a list or an array of k points, which are k − 1 patches; a GeoJSON mapping
        (geometry, feature or collection of features); or an object with `__geo_interface__`,
        for instance of shapely.  Several patches are called NAME/1, NAME/2, …

        emission, reflectance
            One value, or one per band; 0 by default.
        temperature, flux, heat
            In place of these: T in kelvin, or the net heat flux that leaves in W/m², 0 on an
            insulated wall, or the net heat of all these patches together in W per metre, as of a
            heater.
        emissivity
            With one of these three: one value, or one per band, or a table of entries
            [T, value] or [T, value per band, …]; 1 by default.
        transmittance
            Of a pane, which scatters light to both sides; with sides="both".
        shield
            True: a sheet of one temperature without net heat, with an emissivity and
            sides="both".
        back
            Properties of the other side where they differ, as {"reflectance": .1}; with
            sides="both".
        sides
            "front", or "both": each patch becomes two, back to back.  "mirror": no patch, but a
            mirror.
        faces
            For polygons, "in" for rooms or "out" for obstacles.

        >>> room = hr2d.Scene(background=1)
        >>> room.add([(0, 0), (4, 0), (4, 3)], emission=[0, 1, 2], reflectance=.5, name="wall")
        range(0, 2)
        >>> room.names, room.bands
        (['wall/1', 'wall/2'], 3)
        """
        return self.add_text(text_of(shape, {"name": name, "emission": emission,
                                             "reflectance": reflectance,
                                             "temperature": temperature, "flux": flux,
                                             "heat": heat,
                                             "emissivity": emissivity,
                                             "transmittance": transmittance, "shield": shield,
                                             "back": back,
                                             "sides": sides, "faces": faces}))

    def add_text(self, text: Union[str, bytes]) -> range:
        """Adds the patches of the text of a scene file, GeoJSON or .vs2."""
        return self._parse(text.encode() if isinstance(text, str) else bytes(text))

    def _parse(self, data: bytes, place: Any = "") -> range:
        with self._change() as call:
            first = len(self)
            call.check(lib.hr2d_scene_parse(self._raw, data, len(data)), self._message, place)
            self._log.append(("add_text", (data,)))
            return range(first, len(self))

    def add_file(self, path: Union[str, "os.PathLike[str]"]) -> range:
        """Adds the patches of a scene file, GeoJSON or .vs2."""
        place = os.fspath(path)
        try:
            with open(path, "rb") as stream:
                data = stream.read()
        except OSError as error:
            raise error_of(lib.HR2D_EIO, f"{os.fsdecode(place)}: cannot open: "
                                         f"{error.strerror}") from error
        return self._parse(data, place)

    def split_crossings(self) -> int:
        """Cuts patches where they cross, and returns the number of cuts."""
        cuts = ffi.new("size_t *")
        with self._change() as call:
            call.check(lib.hr2d_scene_split_crossings(self._raw, cuts), self._message)
            self._log.append(("split_crossings", ()))
        return int(cuts[0])

    def snap(self, tolerance: float) -> Snap:
        """Repairs a drawing: ends within `tolerance` become one, ends beside a patch stand on it.

        Indices of patches change where some are dropped or cut.
        """
        report = ffi.new("hr2d_snap_report *")
        with self._change() as call:
            call.check(lib.hr2d_scene_snap(self._raw, tolerance, report), self._message)
            self._log.append(("snap", (tolerance,)))
        return Snap(*(getattr(report, name) for name in Snap._fields))

    def warnings(self, *, gap: float = 0,
                 progress: Optional[ProgressFunction] = None) -> List[SceneWarning]:
        """What is valid in the scene, but maybe not meant.

        >>> dark = hr2d.Scene()
        >>> [w.code for w in (dark.add([(0, 0), (1, 0)]), dark.warnings())[1]]
        ['dark-scene']

        Warnings about light and views need a scene that can be committed.  Openings below the
        part `gap` of the scene are narrow, 1e-3 by default.
        """
        try:
            self.commit()
        except SceneError:
            pass
        found: List[SceneWarning] = []
        handle, options = ffi.new_handle(found), ffi.new("hr2d_lint_options *", {
            "struct_size": ffi.sizeof("hr2d_lint_options"), "gap": gap})
        with Call(progress) as call:
            call.check(lib.hr2d_scene_lint(self._raw, lib.hr2dpy_warn, handle, options))
        return found

    def commit(self) -> "Scene":
        """Checks the patches against each other.  Other calls do it if they need it."""
        if not self._committed:
            with self._change() as call:
                if not self._committed:
                    call.check(lib.hr2d_scene_commit(self._raw), self._message)
                    self._committed = True
        return self

    # Reading

    def __len__(self) -> int:
        with self._lock:
            return int(lib.hr2d_scene_patches(self._raw))

    def __repr__(self) -> str:
        return f"<hr2d.Scene of {len(self)} patches>"

    def index(self, patch: PatchLike) -> int:
        """The index of a patch that is given by its name or its index.

        >>> square().index("walls/2")
        2
        """
        if isinstance(patch, str):
            found = ffi.new("size_t *")
            with self._lock:
                missing = lib.hr2d_scene_find(self._raw, patch.encode(), found)
            if missing:
                raise KeyError(f"no patch is called {patch!r}")
            return int(found[0])
        index = int(patch)
        if not 0 <= index < len(self):
            raise IndexError(f"there is no patch {patch}")
        return index

    @property
    def names(self) -> List[str]:
        """The names of the patches."""
        with self._lock:
            return [ffi.string(lib.hr2d_scene_name(self._raw, k)).decode()
                    for k in range(len(self))]

    def _geometry(self) -> Tuple[Array, Array]:
        with self._lock:  # the number of patches is asked for twice
            ends, lengths = np.empty((len(self), 2, 2)), np.empty(len(self))
            if len(self):
                lib.hr2dpy_segments(self._raw, writable(ends), writable(lengths))
        return ends, lengths

    @property
    def segments(self) -> Array:
        """The ends of the patches, (patches, 2, 2)."""
        return self._geometry()[0]

    @property
    def lengths(self) -> Array:
        """The lengths of the patches."""
        return self._geometry()[1]

    @property
    def bands(self) -> int:
        """The number of bands."""
        return int(lib.hr2d_scene_bands(self.commit()._raw))

    @property
    def unit(self) -> float:
        """Scene lengths per unit of the coordinates of elements, a power of two."""
        return float(lib.hr2d_scene_unit(self.commit()._raw))

    def _values(self, getter: str) -> Array:
        values = np.empty((len(self), self.bands))
        lib.hr2dpy_scene_values(ffi.addressof(lib, getter), self._raw, writable(values))
        return frozen(values)

    @cached_property
    def emission(self) -> Array:
        """E of each patch, (patches, bands)."""
        return self._values("hr2d_scene_emission")

    @cached_property
    def reflectance(self) -> Array:
        """ρ of each patch, (patches, bands)."""
        return self._values("hr2d_scene_reflectance")

    @cached_property
    def transmittance(self) -> Array:
        """τ of each patch, (patches, bands); 0 but on panes."""
        return self._values("hr2d_scene_transmittance")

    @cached_property
    def other_side(self) -> Array:
        """The patch on the other side of each pane; of other patches the patch itself."""
        self.commit()
        return frozen(np.array([lib.hr2d_scene_other_side(self._raw, k)
                                for k in range(len(self))], dtype=np.intp))

    @property
    def background(self) -> Array:
        """The light from the surroundings, (bands,)."""
        return np.array([lib.hr2d_scene_background(self._raw, band)
                         for band in range(self.bands)])

    @property
    def mirrors(self) -> Array:
        """Two points of each mirror, (mirrors, 2, 2)."""
        lines = [lib.hr2d_scene_mirror(self._raw, k)
                 for k in range(lib.hr2d_scene_mirrors(self._raw))]
        return np.array([[(s.a.x, s.a.y), (s.b.x, s.b.y)] for s in lines]).reshape(-1, 2, 2)

    @property
    def period(self) -> Tuple[float, float]:
        """The period, as it was given; (0, 0) without one."""
        period = lib.hr2d_scene_period(self._raw)
        return period.x, period.y

    @property
    def images(self) -> int:
        """How many images mirrors and a period make of each patch, with the patch itself."""
        return int(lib.hr2d_scene_images(self.commit()._raw))

    def image(self, image: int) -> Array:
        """The ends of an image of each patch, (n, 2, 2); number 0 are the patches themselves."""
        if not 0 <= image < self.images:
            raise IndexError(f"there are images 0 to {self.images - 1}, not {image}")
        lines = [lib.hr2d_scene_image(self._raw, k, image) for k in range(len(self))]
        return np.array([[(s.a.x, s.a.y), (s.b.x, s.b.y)] for s in lines]).reshape(-1, 2, 2)

    @property
    def cut_off(self) -> float:
        """The largest part of the directions from a patch in which images are extrapolated."""
        return float(lib.hr2d_scene_cut_off(self.commit()._raw))

    def sunlight_cut_off(self, band: int = 0) -> float:
        """The irradiance of a sun that shines past more images of a period than there are; 0 of
        others. Fronts may have that much more of it, times a cosine, which no error contains."""
        return float(lib.hr2d_scene_sunlight_cut_off(self.commit()._raw, band))

    @property
    def sun(self) -> Sun:
        """The suns, as they were given; zeros without one."""
        suns = [lib.hr2d_scene_sun(self._raw, band) for band in range(self.bands)]
        return Sun(np.array([(sun.direction.x, sun.direction.y) for sun in suns]),
                   np.array([sun.irradiance for sun in suns]))

    def sky(self, bearing: Any) -> Array:
        """The radiosity of the sky at bearings of any shape, and then the bands."""
        bearing = np.require(bearing, np.float64, "C")
        values = np.empty((*np.shape(bearing), self.bands))
        lib.hr2dpy_sky(self._raw, doubles(bearing), bearing.size, writable(values))
        return values

    @cached_property
    def sunlight(self) -> Array:
        """The part of the average H that comes straight from the sun, (patches, bands)."""
        return self._values("hr2d_scene_sunlight")

    def sunlight_at(self, patch: PatchLike, t: Any) -> Array:
        """The same at points of a patch: fractions of it, of any shape, and then the bands."""
        index, t = self.index(patch), np.require(t, np.float64, "C")
        if not ((t >= 0) & (t <= 1)).all():
            raise ValueError("t is a fraction of the patch, from 0 to 1")
        values = np.empty((*np.shape(t), self.bands))
        lib.hr2dpy_sunlight(self._raw, index, doubles(t), t.size, writable(values))
        return values

    def sunlit_parts(self, patch: PatchLike, band: int = 0) -> Array:
        """Where the sun of a band lights a patch: (parts, 2), fractions of the patch."""
        index = self.index(patch)
        if not 0 <= band < self.bands:
            raise IndexError(f"there is no band {band}")
        count = lib.hr2d_scene_sunlit_parts(self._raw, index, band, ffi.NULL, 0)
        parts = np.empty((count, 2))
        if count:
            lib.hr2d_scene_sunlit_parts(self._raw, index, band,
                                        ffi.cast("double(*)[2]", writable(parts)), count)
        return parts

    @property
    def effects(self) -> Dict[str, str]:
        """The effects that the scene calls for, each with its reason."""
        self.commit()
        found, reason = {}, ffi.new("char **")
        for effect in range(lib.HR2D_EFFECT_COUNT):
            if lib.hr2d_scene_effect(self._raw, effect, reason):
                name = ffi.string(lib.hr2d_effect_name(effect)).decode()
                found[name] = ffi.string(reason[0]).decode()
        return found

    def _emits_as_found(self, index: int) -> bool:
        """Whether E and ρ of a patch follow from a temperature that a solve finds."""
        return (self.bands > 1 and
                lib.hr2d_scene_heat(self._raw, index, ffi.NULL) == lib.HR2D_HEAT_FLUX)

    def _has_heat(self) -> bool:
        return any(lib.hr2d_scene_heat(self._raw, k, ffi.NULL) != lib.HR2D_HEAT_NONE
                   for k in range(len(self)))

    # View factors

    def exchange_areas(self, *, sparse: bool = False, threads: Any = 1,
                       progress: Optional[ProgressFunction] = None) -> Any:
        """AF_ij = A_i F_ij of all patches in scene lengths: symmetric, bit for bit.

        An array (n, n); with `sparse` a scipy.sparse.csr_matrix over the memory of the library.

        >>> area = square().exchange_areas()
        >>> bool((area == area.T).all()), area.shape
        (True, (4, 4))
        """
        self.commit()
        options = ffi.new("hr2d_matrix_options *", {
            "struct_size": ffi.sizeof("hr2d_matrix_options"), "threads": thread_count(threads)})
        if sparse:
            return self._exchange_rows(options, progress)
        area = np.empty((len(self), len(self)))
        with Call(progress) as call:
            call.check(lib.hr2d_exchange_matrix(self._raw, options, writable(area), ffi.NULL))
        return area

    def _exchange_rows(self, options: Any, progress: Optional[ProgressFunction]) -> Any:
        linear: Any = import_module("scipy.sparse")
        pointer, n = ffi.new("hr2d_exchange_rows **"), len(self)
        with Call(progress) as call:
            call.check(lib.hr2d_exchange_rows_create(self._raw, options, pointer, ffi.NULL))
        rows = owned(pointer[0], lib.hr2d_exchange_rows_destroy, self._raw)
        entries = lib.hr2d_exchange_rows_entries(rows)
        return linear.csr_matrix((view(lib.hr2d_exchange_rows_area(rows), np.float64, entries, rows),
                           view(lib.hr2d_exchange_rows_column(rows), np.int32, entries, rows),
                           view(lib.hr2d_exchange_rows_start(rows), np.int64, n + 1, rows)),
                          shape=(n, n), copy=False)

    def factors(self, *, sparse: bool = False, threads: Any = 1,
                progress: Optional[ProgressFunction] = None) -> Any:
        """View factors F_ij: the part of the light from i that reaches j.

        An array (n, n), or with `sparse` a scipy.sparse.csr_matrix without the zeros.

        >>> square().factors().round(4)
        array([[0.    , 0.2929, 0.4142, 0.2929],
               [0.2929, 0.    , 0.2929, 0.4142],
               [0.4142, 0.2929, 0.    , 0.2929],
               [0.2929, 0.4142, 0.2929, 0.    ]])
        """
        area = self.exchange_areas(sparse=sparse, threads=threads, progress=progress)
        lengths = self.lengths
        if sparse:
            area.data = area.data / np.repeat(lengths, np.diff(area.indptr))
            return area
        area /= lengths[:, None]
        return area

    def point_factors(self, points: Any, normals: Any = None, *, threads: Any = 1,
                      progress: Optional[ProgressFunction] = None) -> PointFactors:
        """View factors from points of the plane to all patches, with exact visibility.

        `points` are x and y in scene coordinates, in any shape, as for Solution.field();
        `normals` are dx and dy of each point, or of all of them, of any length but 0.

        >>> see = square().point_factors((.5, .5), normals=(0, 1))
        >>> see.share.round(3), see.factor.round(3), float(see.sky)
        (array([0.25, 0.25, 0.25, 0.25]), array([0.   , 0.146, 0.707, 0.146]), 0.0)
        """
        return point_factors(self.commit(), points, normals, threads, progress)

    # Writing

    def to_geojson(self) -> Dict[str, Any]:
        """The scene as a GeoJSON mapping: a feature for each patch, as it is now.

        Patches that were cut or snapped are so there.  Of a patch of given temperature whose
        emissivity depends on it the emissivity is that at this temperature.  Scene.add() takes
        the mapping, but for its member "hr2d"; add_text(json.dumps(…)) takes all of it.

        >>> square().to_geojson()["features"][0]["properties"]
        {'name': 'floor', 'emission': 1.0, 'reflectance': 0.5}
        """
        return collection_of(self)

    def write(self, path: Union[str, "os.PathLike[str]"]) -> None:
        """Writes to_geojson() as a scene file, which hr2d.read() and the program read."""
        collection = self.to_geojson()
        features = ",\n".join(json.dumps(f) for f in collection.pop("features"))
        head = "".join(f"{json.dumps(key)}: {json.dumps(value)},\n"
                       for key, value in collection.items())
        with open(path, "w", encoding="utf-8") as stream:
            stream.write(f"{{{head}\"features\": [\n{features}\n]}}\n")

    # Solving

    def solve(self, *, error: Optional[float] = None, seconds: Optional[float] = None,
              norm: str = "average", important: Sequence[PatchLike] = (),
              floor: Optional[float] = None, points: bool = False, no_error: bool = False,
              epsilon: Optional[float] = None,
              oracle: OracleLike = None, policy: PolicyLike = None,
              order: Optional[int] = None, max_level: Optional[int] = None,
              closure: Optional[bool] = None,
              start: Union[None, bytes, Solution] = None, max_elements: int = 0, max_links: int = 0,
              max_bytes: int = 0, threads: Any = 1,
              progress: Optional[ProgressFunction] = None) -> Solution:
        """Solves for the radiosity, in one of two ways.

        To a target, which is the way without arguments:

        error
            Relative error of B and H, 1e-6 by default; 0 for as good as doubles allow.
        seconds
            Budget of wall time.  Without `error` the best solution that is ready by then.
        norm
            "average" or "sup", for points.
        important
            Patches, by name or index, whose averages have to reach the target.
        floor
            The part of the largest average below which patches count as equally dark.
        no_error
            The first solve stands, mostly within the target, and no time goes into its error:
            all errors of the account are infinite.

        If the target is not reached, an AccuracyWarning says why, and the best solution is
        returned.

        By the paper's algorithm, with one of these:

        epsilon
            A link is accepted if the oracle estimates its error as at most ε; 0.1 by default.
        oracle
            A name ("size", "size2", "bf", "l1", "l1-grid", "bounds"), an Oracle, or a function
            that takes a Batch and returns an array. One that needs brightness, as "bf", refines
            and solves in rounds, each by the light of the last, until links no longer change.
        policy
            A name ("original", "modified") or a Policy.
        order
            Legendre coefficients per element, 1 by default.
        max_level
            Elements on this level are not divided, 24 by default.
        closure
            Whether the exchange of every leaf is made exact; True by default.
        start
            A solution by links of a larger ε, or its state(), with the same oracle, policy and
            order: its links are refined, and iterations begin with its light.

        >>> s = square().solve(error=1e-6)
        >>> s.B[:, 0].round(4), s.account.reached
        (array([1.1486, 0.2696, 0.3122, 0.2696]), True)

        Both take `points`, which measures errors at points, too (the norm "sup" does that
        anyway), limits, `threads` (a number or "all") and `progress`, a function that is given
        a Progress up to 20 times a second and returns False to stop.
        """
        target = {"error": error, "seconds": seconds, "floor": floor,
                  "norm": None if norm == "average" else norm, "no_error": no_error or None,
                  "important": [self.index(patch) for patch in important] or None}
        paper = {"epsilon": epsilon, "oracle": oracle, "policy": policy, "order": order,
                 "max_level": max_level, "closure": closure, "start": start}
        limits = {"max_elements": max_elements, "max_links": max_links, "max_bytes": max_bytes,
                  "threads": thread_count(threads)}
        of_target = [key for key, value in target.items() if value is not None]
        of_paper = [key for key, value in paper.items() if value is not None]
        if of_target and of_paper:
            raise TypeError(f"{of_paper[0]} does not go with {of_target[0]}: one is for the "
                            "paper's algorithm, one for a target")
        self.commit()
        if of_paper:
            return _solve.by_links(self, paper, limits, points, progress)
        return _solve.to_target(self, target, limits, points, progress)

    def predict(self, *, error: Optional[float] = None, norm: str = "average",
                important: Sequence[PatchLike] = (), floor: Optional[float] = None,
                points: bool = False, no_error: bool = False, max_elements: int = 0,
                max_links: int = 0, max_bytes: int = 0, threads: Any = 1,
                progress: Optional[ProgressFunction] = None) -> Prediction:
        """What solve() to a target will cost, mostly within a factor of 2; see its arguments.

        >>> square().predict(error=1e-6).elements > 4
        True
        """
        target = {"error": error, "seconds": None, "floor": floor, "norm": norm,
                  "no_error": no_error,
                  "important": [self.index(patch) for patch in important] or None}
        limits = {"max_elements": max_elements, "max_links": max_links, "max_bytes": max_bytes,
                  "threads": thread_count(threads)}
        self.commit()
        return _solve.predict(self, target, limits, points, progress)

    def enclose(self, gap: Optional[float] = None, *, max_links: int = 0,
                progress: Optional[ProgressFunction] = None) -> Enclosure:
        """Lower and upper ends of averages of B and H that rest on no assumption.

        They are at most `gap` apart, 1e-3 by default, relative to the largest of the band; where
        a million links or `max_links` do not suffice, an AccuracyWarning says so, and the ends
        are true all the same.

        >>> ends = square().enclose(0.1)
        >>> bool((ends.lower <= square().solve().B).all()), ends.gap <= 0.1
        (True, True)
        """
        return Enclosure(self.commit(), gap, max_links, progress)

    def operator(self, *, error: Optional[float] = None, norm: str = "average",
                 important: Sequence[PatchLike] = (), floor: Optional[float] = None,
                 points: bool = False, max_elements: int = 0, max_links: int = 0,
                 max_bytes: int = 0, threads: Any = 1,
                 progress: Optional[ProgressFunction] = None) -> Operator:
        """Solves for the light of the scene, and keeps what that takes for other light.

        The arguments are those of solve() to a target; they hold for all light.
        """
        target = {"error": error, "seconds": None, "floor": floor, "norm": norm,
                  "no_error": False,
                  "important": [self.index(patch) for patch in important] or None}
        limits = {"max_elements": max_elements, "max_links": max_links, "max_bytes": max_bytes,
                  "threads": thread_count(threads)}
        self.commit()
        return Operator(self, target, limits, points, progress)

    # The paper's experiment

    def refine(self, *, epsilon: Optional[float] = None, oracle: OracleLike = None,
               policy: PolicyLike = None, max_level: Optional[int] = None,
               ordered: bool = False, max_elements: int = 0, max_links: int = 0,
               max_bytes: int = 0, threads: Any = 1,
               progress: Optional[ProgressFunction] = None) -> Links:
        """The links of the paper's algorithm, and no solution.

        The arguments are those of solve(); with `ordered` every ordered pair of patches is
        projected, as the paper words it, and links carry one direction.

        >>> links = square().refine(epsilon=.5)
        >>> links.pairs.shape == (links.L, 2), links.matrix().shape == (links.N, links.N)
        (True, True)
        """
        paper = {"epsilon": epsilon, "oracle": oracle, "policy": policy, "max_level": max_level}
        limits = {"max_elements": max_elements, "max_links": max_links, "max_bytes": max_bytes,
                  "threads": thread_count(threads)}
        self.commit()
        return _links.refine(self, paper, limits, ordered, progress)

    def study(self, epsilon: Union[Sequence[float], Array], *, oracle: OracleLike = None,
              policy: PolicyLike = None, max_level: Optional[int] = None,
              ordered: bool = False, max_elements: int = 0, max_links: int = 0,
              max_bytes: int = 0, threads: Any = 1,
              progress: Optional[ProgressFunction] = None) -> Study:
        """Elements N and links L for each ε: the dots of the paper's Figures 7 and 8.

        Each ε begins with the whole patches, and no link is stored.  The arguments are those
        of refine(); a limit that is reached is an error.

        >>> study = square().study([1, .5, .25])
        >>> study.N.shape, bool((np.diff(study.L) > 0).all())
        ((3,), True)
        """
        paper = {"epsilon": None, "oracle": oracle, "policy": policy, "max_level": max_level}
        limits = {"max_elements": max_elements, "max_links": max_links, "max_bytes": max_bytes,
                  "threads": thread_count(threads)}
        self.commit()
        return _links.study(self, epsilon, paper, limits, ordered, progress)

    def study_law(self, *, oracle: OracleLike = None, policy: PolicyLike = None,
                  progress: Optional[ProgressFunction] = None) -> Law:
        """The numbers of elements and links by the paper's algorithm, before it runs: their means
        over the phases of ε, as sums of powers of ε.

        `oracle` is "size" (default), "size2" or "l1", `policy` is "original" (default) or
        "modified".  Unsupported is raised for others, for scenes with mirrors or a period, and,
        except with "l1", where patches touch and see each other.
        """
        self.commit()
        return _links.law(self, {"oracle": oracle, "policy": policy}, progress)

    # Pictures

    def plot(self, solution: Optional[Solution] = None, *, ax: Any = None, band: int = 0,
             cmap: Any = "viridis", points: int = 33, labels: bool = False,
             colorbar: bool = True, filled: int = 160,
             box: Optional[Sequence[float]] = None,
             show: Optional[Callable[[Array], Array]] = None, label: str = "B") -> Any:
        """Draws the walls, coloured by B if there is a solution; returns matplotlib's axes.

        Backs and fronts are drawn beside each other, each on the side of its front.  The plane
        between them has the mean radiosity of all directions, at `filled` points in its longer
        side; 0 for none.

        `box` is the part of the plane that is shown, (x0, y0, x1, y1).  Without it that is the
        scene; but of patches 20 times as long as the extent of all shorter ones, such as the
        ground under a few things, only what is near these, with a note.  What stands
        around a cell between mirrors or in a period is drawn faintly.

        `show` is a function of arrays of radiosities whose values are shown in their place, for
        instance hr2d.radiation_temperature; `label` is written beside the colours.
        """
        return _draw.plot(self, solution, ax, band, cmap, points, labels, colorbar, filled, box,
                          show, label)

    def _repr_html_(self) -> str:
        return _draw.scene_html(self)


def read(path: Union[str, "os.PathLike[str]"]) -> Scene:
    """The scene of a file, GeoJSON or .vs2."""
    scene = Scene()
    scene.add_file(path)
    return scene


def black_body(kelvin: float, low: float = 0, high: float = float("inf")) -> float:
    """What a black surface emits in W/m², between two wavelengths in µm if they are given.

    >>> round(black_body(300), 3)
    459.3
    """
    part = 1.0 if (low, high) == (0, float("inf")) else lib.hr2d_black_body_part(kelvin, low, high)
    return float(part * lib.hr2d_black_body(kelvin))


def exchange_area(i: Any, j: Any, occluders: Any = ()) -> float:
    """AF_ij of two segments ((ax, ay), (bx, by)), with occluders between them, in scene lengths.

    >>> round(exchange_area([(0, 0), (1, 0)], [(1, 1), (0, 1)]), 6)
    0.414214
    """
    ends = np.ascontiguousarray([i, j, *occluders], dtype=np.float64)
    if ends.shape[1:] != (2, 2):
        raise ValueError("a segment is two points, (x, y) each")
    area = ffi.new("double *")
    segment = ffi.cast("hr2d_segment *", doubles(ends))
    with Call() as call:
        call.check(lib.hr2d_exchange_area_occluded(segment, segment + 1, segment + 2,
                                                   len(ends) - 2, ffi.NULL, area))
    return float(area[0])
