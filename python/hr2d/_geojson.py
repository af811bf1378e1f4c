# SPDX-License-Identifier: GPL-3.0-or-later
"""Everything that is added to a scene is a GeoJSON text: the library alone knows the rules of
sides, names and rings."""
from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any, Dict

import numpy as np

from ._errors import SceneError


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
        collection = {**shape, "features": [_feature(f, given) for f in shape["features"]]}
    else:
        collection = {"type": "FeatureCollection", "features": [_feature(shape, given)]}
    return _dump(collection, given.get("name") or "a patch")
