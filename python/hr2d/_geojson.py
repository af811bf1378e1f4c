# SPDX-License-Identifier: GPL-3.0-or-later
"""Everything that is added to a scene is a GeoJSON text: the library alone knows the rules of
sides, names and rings."""
from __future__ import annotations

import json
import math
from collections.abc import Mapping
from typing import Any, Dict

import numpy as np

from ._errors import SceneError
from ._hr2d import ffi, lib


def _plain(value: Any) -> Any:
    """What json.dumps() asks about numpy's numbers and arrays."""
    if isinstance(value, (np.ndarray, np.generic)):
        return value.tolist()
    raise TypeError(f"{type(value).__name__} is neither a number nor a list of numbers")


def _geometry(shape: Any) -> Any:
    """The GeoJSON of coordinates, of a GeoJSON mapping, or of an object of shapely."""
    if not isinstance(shape, Mapping):
        shape = getattr(shape, "__geo_interface__", shape)
    if not isinstance(shape, Mapping):
        points = np.asarray(shape, dtype=np.float64)
        if points.ndim != 2 or points.shape[0] < 2 or points.shape[1] < 2:
            raise ValueError("coordinates are two points or more, (x, y) each, not an array of "
                             f"shape {points.shape}")
        if np.any(np.all(points[1:, :2] == points[:-1, :2], axis=1)):
            raise SceneError("two points that follow each other are the same: a patch has no "
                             "length")
        shape = {"type": "LineString", "coordinates": points[:, :2]}
    if shape.get("type") == "LinearRing":
        shape = {**shape, "type": "LineString"}
    return shape


def _feature(shape: Any, properties: Dict[str, Any]) -> Dict[str, Any]:
    if shape.get("type") == "Feature":
        old = shape.get("properties") or {}
        return {**shape, "geometry": shape.get("geometry") and _geometry(shape["geometry"]),
                "properties": {**old, **properties}}
    return {"type": "Feature", "properties": properties, "geometry": shape}


def _dump(collection: Any, what: str) -> bytes:
    try:
        return json.dumps(collection, default=_plain, allow_nan=False).encode()
    except ValueError as error:
        raise SceneError(f"{what}: a number is not finite") from error


def outside_of(members: Dict[str, Any]) -> bytes:
    """The text of a collection without patches, with members of "hr2d"."""
    return _dump({"type": "FeatureCollection", "hr2d": members, "features": []}, *members)


def text_of(shape: Any, properties: Dict[str, Any]) -> bytes:
    """The text of a collection; `properties` go before those of its features."""
    given = {key: value for key, value in properties.items() if value is not None}
    shape = _geometry(shape)
    if shape.get("type") == "FeatureCollection":
        collection: Any = {**shape, "features": [_feature(f, given) for f in shape["features"]]}
    else:
        collection = {"type": "FeatureCollection", "features": [_feature(shape, given)]}
    return _dump(collection, given.get("name") or "a patch")


def medium_of(absorption: Any, temperature: Any, flux: Any, emission: Any,
              section: Any) -> Dict[str, Any]:
    """A medium with what is given of it."""
    medium = {"absorption": absorption, "temperature": temperature, "flux": flux,
              "emission": emission, "section": section}
    return {key: value for key, value in medium.items() if value is not None}


def region_of(ring: Any, medium: Any) -> bytes:
    """The text of a gas within a ring, which may be open."""
    closed = ring if ring and ring[0] == ring[-1] else ring + ring[:1]
    return _dump({"type": "FeatureCollection", "features": [
        {"type": "Feature", "properties": {"medium": medium},
         "geometry": {"type": "Polygon", "coordinates": [closed]}}]}, "a medium")


def _regions(scene: Any) -> Any:
    """The features that are gases, as they were given."""
    for text in _texts(scene):
        features = text.get("features") if isinstance(text, dict) else None
        for feature in features if isinstance(features, list) else []:
            if isinstance(feature, dict) and (feature.get("properties") or {}).get("medium"):
                yield feature


def _plain_number(values: Any) -> Any:
    """A number where one holds for all bands."""
    values = [float(value) for value in values]
    return values[0] if len(set(values)) == 1 else values


def _texts(scene: Any) -> Any:
    """The GeoJSON that was added; .vs2 files have nothing of what is asked for here."""
    for name, arguments in scene._log:
        if name == "add_text":
            try:
                yield json.loads(arguments[0])
            except ValueError:
                pass


def _members(scene: Any) -> Dict[str, Any]:
    """The members of "hr2d" that the library does not tell: the last ones that were given."""
    found: Dict[str, Any] = {}
    for text in _texts(scene):
        given = (text.get("hr2d") if isinstance(text, dict) else None) or {}
        found.update({key: given[key] for key in ("wavelengths", "weights", "sky", "medium")
                      if given.get(key) is not None})
    for name, arguments in scene._log:
        if name == "set_wavelengths":
            found["wavelengths"] = arguments[0].tolist()
        if name == "set_weights":
            found["weights"] = arguments[0].tolist()
    return found


def _knots(value: Any, found: Any) -> Any:
    """Temperatures of all tables of emissivity: between them an emissivity is linear."""
    if isinstance(value, dict):
        table = value.get("emissivity")
        if isinstance(table, list) and table and isinstance(table[0], list):
            found.update(float(entry[0]) for entry in table)
        for item in value.values():
            _knots(item, found)
    elif isinstance(value, list):
        for item in value:
            _knots(item, found)
    return found


def _emissivity(scene: Any, patch: int, knots: Any) -> Any:
    bands = range(scene.bands)
    values = [lib.hr2d_scene_emissivity(scene._raw, patch, band) for band in bands]
    if not any(math.isnan(value) for value in values):
        return _plain_number(values)
    return [[kelvin] + [lib.hr2d_scene_emissivity_at(scene._raw, patch, band, kelvin)
                        for band in bands] for kelvin in sorted(knots)]


def _surface(scene: Any, patch: int, knots: Any) -> Dict[str, Any]:
    given = ffi.new("double *")
    kind = lib.hr2d_scene_heat(scene._raw, patch, given)
    if kind == lib.HR2D_HEAT_NONE:
        return {"emission": _plain_number(scene.emission[patch]),
                "reflectance": _plain_number(scene.reflectance[patch])}
    if kind == lib.HR2D_HEAT_SHIELD:
        return {"shield": True, "emissivity": _emissivity(scene, patch, knots)}
    key = "temperature" if kind == lib.HR2D_HEAT_TEMPERATURE else "flux"
    return {key: given[0], "emissivity": _emissivity(scene, patch, knots)}


def _sides(scene: Any, patch: int, knots: Any) -> Dict[str, Any]:
    """A patch, or both sides of a pane."""
    front, other = _surface(scene, patch, knots), int(scene.other_side[patch])
    if other == patch:
        return front
    back = {k: v for k, v in _surface(scene, other, knots).items() if front.get(k) != v}
    tau = {} if "shield" in front else {
        "transmittance": _plain_number(scene.transmittance[patch])}
    return {**front, **tau, "sides": "both", **({"back": back} if back else {})}


def _line(ends: Any, properties: Dict[str, Any]) -> Dict[str, Any]:
    return {"type": "Feature", "properties": properties,
            "geometry": {"type": "LineString", "coordinates": np.asarray(ends).tolist()}}


def _outside(scene: Any) -> Dict[str, Any]:
    members = _members(scene)
    if any(scene.background):
        members["background"] = _plain_number(scene.background)
    if scene.period != (0, 0):
        members["period"] = list(scene.period)
    if any(scene.sun.irradiance):
        members["sun"] = {"direction": [d if any(d) else [0.0, -1.0]
                                        for d in scene.sun.direction.tolist()],
                          "irradiance": scene.sun.irradiance.tolist()}
    return members


def collection_of(scene: Any) -> Dict[str, Any]:
    """A scene as a collection: a feature for each patch and mirror."""
    scene.commit()
    knots: Any = set()
    for text in _texts(scene):
        _knots(text, knots)
    features = [_line(ends, {"name": name, **_sides(scene, k, knots)})
                for k, (name, ends) in enumerate(zip(scene.names, scene.segments))
                if k <= scene.other_side[k]]
    features += [_line(ends, {"sides": "mirror"}) for ends in scene.mirrors]
    features += _regions(scene)
    members = _outside(scene)
    return {"type": "FeatureCollection", **({"hr2d": members} if members else {}),
            "features": features}
