# SPDX-License-Identifier: GPL-3.0-or-later
"""The kept operator: other light on the same geometry, responses, gradients."""
from __future__ import annotations

import warnings
from typing import Any, Dict, List, NamedTuple, Optional, Tuple

import numpy as np

from ._arrays import Array, doubles, frozen, writable
from ._calls import Call, ProgressFunction, owned
from ._errors import AccuracyWarning
from ._hr2d import ffi, lib
from ._solution import Account, Solution
from ._solve import make_target


class Lights(NamedTuple):
    """Solutions for several lights at once, (lights, patches, bands)."""

    B: Array
    H: Array
    account: Account
    """The largest errors over all lights."""


class Gradient(NamedTuple):
    """The derivatives of a functional."""

    emission: Array
    """By E of each patch and band."""
    reflectance: Array
    """By ρ; where a temperature is given E = (1 − ρ)σT⁴ changes, too; NaN where a flux is."""
    temperature: Array
    """By T of each patch; NaN where none is given."""


_AXES = {"emission": "pb", "reflectance": "pb", "temperature": "p", "flux": "p",
         "background": "b", "sun": "b", "sky": "sb"}
"""What an array of each kind has beside lights: patches, bands, pieces of the sky."""


class Operator:
    """What a solve has found out about a scene, for other light: Scene.operator() makes it."""

    def __init__(self, scene: Any, target: Dict[str, Any], limits: Dict[str, int],
                 points: bool, progress: Optional[ProgressFunction]):
        self.scene = scene
        self._target: List[Any] = []
        raw = make_target(target, limits, points, self._target)
        self._target.append(raw)
        pointer, account = ffi.new("hr2d_operator **"), ffi.new("hr2d_account *")
        with Call(progress) as call:
            status = lib.hr2d_operator_create(scene._raw, raw, pointer, account)
            if pointer[0]:
                self._raw = owned(pointer[0], lib.hr2d_operator_destroy, scene._raw)
            call.check_made(status, pointer[0], lambda: account.reason)
        self.account = Account._of(account, status == lib.HR2D_OK)
        """The errors for the light of the scene."""
        if status:
            warnings.warn(self.account.reason, AccuracyWarning, stacklevel=3)

    def __repr__(self) -> str:
        return f"<hr2d.Operator of {len(self.scene)} patches, {self.account.elements} elements>"

    def _sizes(self, axes: str) -> Tuple[Any, ...]:
        size = {"p": len(self.scene), "b": self.scene.bands,
                "s": lib.hr2d_scene_sky_pieces(self.scene._raw)}
        return tuple(size[axis] for axis in axes)

    def _values(self, kind: str, values: Any, axes: str) -> Array:
        """(lights, ...) or (...), where (patches,) stands for (patches, bands) of one band."""
        array, shape = np.asarray(values, np.float64), self._sizes(axes)
        if axes == "pb" and array.ndim == 1:
            array = np.broadcast_to(array[:, None], (len(array), shape[1]))
        if array.ndim not in (len(shape), len(shape) + 1):
            raise ValueError(f"{kind} has the shape {shape}, or one axis of lights before it, "
                             f"not {array.shape}")
        if array.shape[-len(shape):] != shape:
            raise ValueError(f"{kind} ends with {shape}, not {array.shape[-len(shape):]}")
        return array

    def _light(self, given: Dict[str, Any], keep: List[Any]) -> Any:
        """The struct of a light, and whether arrays have an axis of lights."""
        arrays = {kind: self._values(kind, values, _AXES[kind])
                  for kind, values in given.items() if values is not None}
        many = {kind: a.shape[0] for kind, a in arrays.items() if a.ndim > len(_AXES[kind])}
        if len(set(many.values())) > 1:
            raise ValueError("numbers of lights differ: "
                             + ", ".join(f"{kind} {count}" for kind, count in many.items()))
        raw = ffi.new("hr2d_light *")
        lib.hr2d_light_init(raw, ffi.sizeof("hr2d_light"))
        count = next(iter(many.values()), 1)
        if count == 0:
            raise ValueError("there is no light: an array has no lights")
        raw.count = count
        for kind, array in arrays.items():
            shape = (count,) + self._sizes(_AXES[kind])
            packed = np.ascontiguousarray(np.broadcast_to(array, shape))
            keep.append(packed)
            getattr(raw, kind).value = doubles(packed)
        return raw, bool(many)

    def solve(self, *, emission: Any = None, reflectance: Any = None, temperature: Any = None,
              flux: Any = None, background: Any = None, sun: Any = None, sky: Any = None,
              start: Optional[Solution] = None, account: bool = True,
              progress: Optional[ProgressFunction] = None) -> Any:
        """Solves for other light; what is None is as in the scene.

        emission, reflectance
            (patches, bands) or (patches,); NaN for patches whose E or ρ follows from heat.
        temperature, flux
            (patches,), NaN for patches that have none.
        background, sun
            (bands,): radiosity of the surroundings, irradiance of the sun.
        sky
            (pieces, bands).
        start
            A solution of this operator for light that is like this one.
        account
            Whether errors are measured, which takes longer than the solve.

        Returns a Solution; or Lights, if arrays have an axis of lights before the others:
        (lights, patches, bands).  Errors above the target warn: the elements were made for the
        light of the scene.
        """
        given = {"emission": emission, "reflectance": reflectance, "temperature": temperature,
                 "flux": flux, "background": background, "sun": sun, "sky": sky}
        keep: List[Any] = []
        light, many = self._light(given, keep)
        light.no_error = not account
        pointer, told = ffi.new("hr2d_solution **"), ffi.new("hr2d_account *")
        with Call(progress) as call:
            status = lib.hr2d_operator_solve(self._raw, light, start._raw if start else ffi.NULL,
                                             pointer, told)
            if pointer[0]:
                raw = owned(pointer[0], lib.hr2d_solution_destroy, self.scene._raw)
            call.check_made(status, pointer[0], lambda: lib.hr2d_operator_message(self._raw))
        found = Account._of(told, status == lib.HR2D_OK)
        if status:
            warnings.warn(found.reason, AccuracyWarning, stacklevel=2)
        if not many:
            solution = Solution(self.scene, raw, found, (self._target[-1], told, self._target))
            solution._own_light = True
            return solution
        return Lights(self._read(raw, "hr2d_solution_average", light.count),
                      self._read(raw, "hr2d_solution_irradiance", light.count), found)

    def _read(self, raw: Any, getter: str, count: int) -> Array:
        patches, bands = self._sizes("pb")
        values = np.empty((patches, count * bands))
        lib.hr2dpy_values(ffi.addressof(lib, getter), raw, *values.shape, writable(values))
        return frozen(np.moveaxis(values.reshape(patches, count, bands), 1, 0).copy())

    def response(self, *, reflectance: Any = None,
                 progress: Optional[ProgressFunction] = None) -> Array:
        """∂B_i/∂E_j of averages, (patches i, patches j, bands)."""
        keep: List[Any] = []
        light, many = self._light({"reflectance": reflectance}, keep)
        if many:
            raise ValueError("a response is that of one light")
        patches, bands = self._sizes("pb")
        response = np.empty((patches, patches, bands))
        with Call(progress) as call:
            call.check(lib.hr2d_operator_response(self._raw, light, 0, patches,
                                                  writable(response)),
                       lambda: lib.hr2d_operator_message(self._raw))
        return response

    def gradient(self, solution: Solution, B: Any = None, H: Any = None, *,
                 progress: Optional[ProgressFunction] = None) -> Gradient:
        """The gradient of Σ B·solution.B + Σ H·solution.H, weights of (patches, bands)."""
        weights, keep = [], []
        for kind, values in (("B", B), ("H", H)):
            weights.append(ffi.new("hr2d_values *"))
            if values is not None:
                array = self._values(kind, values, "pb")
                if array.ndim > 2:
                    raise ValueError(f"{kind} has no axis of lights")
                keep.append(np.ascontiguousarray(array))
                weights[-1].value = doubles(keep[-1])
        patches, bands = self._sizes("pb")
        found = Gradient(np.empty((patches, bands)), np.empty((patches, bands)),
                         np.empty(patches))
        to = ffi.new("hr2d_gradient *")
        lib.hr2d_gradient_init(to, ffi.sizeof("hr2d_gradient"))
        to.emission, to.reflectance, to.temperature = map(writable, found)
        with Call(progress) as call:
            call.check(lib.hr2d_operator_gradient(self._raw, solution._raw, *weights, to),
                       lambda: lib.hr2d_operator_message(self._raw))
        return found
