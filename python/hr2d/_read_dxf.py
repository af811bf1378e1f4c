# SPDX-License-Identifier: GPL-3.0-or-later
"""DXF drawings as shapes, by ezdxf: lines, polylines with bulges, arcs, circles, ellipses, splines
and inserted blocks of the model space."""
from __future__ import annotations

import math
from typing import Any, Iterator, List, Optional, Tuple

import numpy as np

from . import _curves, _shapes
from ._arrays import Array
from ._errors import FormatError
from ._shapes import Report, Shape

UNITS = {1: ("inches", .0254), 2: ("feet", .3048), 4: ("mm", .001), 5: ("cm", .01),
         7: ("km", 1000.0), 14: ("dm", .1)}
"""$INSUNITS: its name, and its length in metres."""


def _turn(start: float, end: float) -> float:
    """From an angle counterclockwise to another one, in radians: > 0, and 2π to itself."""
    angle = math.fmod(end - start, 2 * math.pi)
    return angle if angle > 1e-12 else angle + 2 * math.pi


def _whole(turn: float) -> bool:
    return abs(turn - 2 * math.pi) < 1e-9


def _angles(start: float, turn: float, radius: float, tolerance: Optional[float]) -> Array:
    """Of the ends of chords; a whole turn does not end where it began."""
    n = _curves.steps(turn, radius, tolerance)
    return np.asarray(start + turn / n * np.arange(n if _whole(turn) else n + 1))


def _arc(entity: Any, tolerance: Optional[float]) -> Tuple[Array, bool]:
    radius, centre = float(entity.dxf.radius), entity.dxf.center
    if entity.dxftype() == "CIRCLE":
        start, turn = 0.0, 2 * math.pi
    else:
        start = math.radians(entity.dxf.start_angle)
        turn = _turn(start, math.radians(entity.dxf.end_angle))
    t = _angles(start, turn, radius, tolerance)
    flat = np.stack([centre.x + radius * np.cos(t), centre.y + radius * np.sin(t),
                     np.full(len(t), centre.z)], axis=1)
    return _to_world(entity, flat), _whole(turn)


def _to_world(entity: Any, points: Any) -> Array:
    """From the coordinates of an entity, which may be seen from behind."""
    return np.array([tuple(p) for p in entity.ocs().points_to_wcs(points)]).reshape(-1, 3)


def _ellipse(entity: Any, tolerance: Optional[float]) -> Tuple[Array, bool]:
    """The image of a unit circle, of which no chord grows more than by the longer half axis."""
    major, minor = (np.array(tuple(v)) for v in (entity.dxf.major_axis, entity.minor_axis))
    turn = _turn(entity.dxf.start_param, entity.dxf.end_param)
    t = _angles(entity.dxf.start_param, turn, float(np.linalg.norm(major)), tolerance)[:, None]
    points = np.array(tuple(entity.dxf.center)) + major * np.cos(t) + minor * np.sin(t)
    return points, _whole(turn)


def _spline(entity: Any, tolerance: Optional[float]) -> Array:
    curve = entity.construction_tool()
    corners = np.array([tuple(p) for p in curve.control_points])
    if not np.isfinite(corners).all():
        return corners
    if tolerance is None:
        tolerance = float(np.linalg.norm(np.ptp(corners, axis=0))) / 400
    return np.array([tuple(p) for p in curve.flattening(tolerance or 1.0)])


def _with_bulges(corners: List[Tuple[float, float, float]], closed: bool,
                 tolerance: Optional[float]) -> Array:
    points = [np.array(corners[0][:2])]
    for one, two in zip(corners, corners[1:] + corners[:1] if closed else corners[1:]):
        points.extend(_curves.bulge(np.array(one[:2]), np.array(two[:2]), one[2], tolerance))
    return np.array(points)


def _polyline(entity: Any, tolerance: Optional[float]) -> Tuple[Array, bool]:
    """The points and whether it is closed, of LWPOLYLINE and POLYLINE."""
    closed = bool(entity.closed if entity.dxftype() == "LWPOLYLINE" else entity.is_closed)
    if entity.dxftype() == "LWPOLYLINE":
        corners = [(x, y, b) for x, y, b in entity.get_points("xyb")]
        height = float(entity.dxf.elevation)
    else:
        # The frame of a spline is no part of the line.
        vertices = [v for v in entity.vertices if not v.dxf.flags & 16]
        places = [v.dxf.location for v in vertices]
        if entity.is_3d_polyline:
            return np.array([tuple(p) for p in places], dtype=float).reshape(-1, 3), closed
        corners = [(p.x, p.y, v.dxf.bulge) for p, v in zip(places, vertices)]
        height = entity.dxf.elevation.z
    if not corners:
        return np.empty((0, 3)), closed
    flat = _with_bulges(corners, closed, tolerance)
    return _to_world(entity, np.column_stack([flat, np.full(len(flat), height)])), closed


def _points(entity: Any, tolerance: Optional[float]) -> Optional[Tuple[Array, bool]]:
    """The points in space of an entity and whether it is closed; None of what is no line."""
    kind = entity.dxftype()
    if kind == "LINE":
        return np.array([tuple(entity.dxf.start), tuple(entity.dxf.end)]), False
    if kind in ("ARC", "CIRCLE"):
        return _arc(entity, tolerance)
    if kind == "ELLIPSE":
        return _ellipse(entity, tolerance)
    if kind == "SPLINE":
        return _spline(entity, tolerance), bool(entity.closed)
    if kind == "LWPOLYLINE" or kind == "POLYLINE" and (entity.is_2d_polyline
                                                       or entity.is_3d_polyline):
        return _polyline(entity, tolerance)
    return None


def _entities(entities: Any, layer: str, hidden: Any, report: Report,
              around: Tuple[str, ...] = ()) -> Iterator[Tuple[Any, str]]:
    """The entities with those of inserted blocks, and their layers.  What a block has on layer 0 is
    on the layer on which the block is inserted.  Around are the blocks that are open."""
    def lost(entity: Any, reason: str) -> None:
        report.count("skipped", f"{entity.dxftype()} of a block")

    for entity in entities:
        if not entity.dxf.is_supported("layer"):
            report.count("skipped", entity.dxftype())
            continue
        own = str(entity.dxf.get("layer", "0"))
        own = layer if around and own == "0" else own
        if entity.dxf.get("invisible", 0) or own.lower() in hidden:
            report.count("skipped", f"{entity.dxftype()} that is not shown")
        elif entity.dxftype() != "INSERT":
            yield entity, own
        elif entity.block() is None:
            report.count("skipped", "INSERT without its block")
        elif entity.dxf.name.lower() in around:
            report.count("skipped", "INSERT of a block in itself")
        else:
            for one in entity.multi_insert() if entity.mcount > 1 else [entity]:
                inside = one.virtual_entities(skipped_entity_callback=lost)
                yield from _entities(inside, own, hidden, report,
                                     around + (entity.dxf.name.lower(),))


def _hint(drawing: Any, scale: float, report: Report) -> None:
    name, metres = UNITS.get(int(drawing.header.get("$INSUNITS", 0)), ("", 1.0))
    if name and scale == 1:
        report.say(f"the unit of the drawing is {name}: a scale of {metres:g} makes metres")


def _shapes_of(drawing: Any, tolerance: Optional[float], report: Report) -> List[Shape]:
    hidden = {layer.dxf.name.lower() for layer in drawing.layers
              if layer.is_off() or layer.is_frozen()}
    shapes = []
    for entity, layer in _entities(drawing.modelspace(), "0", hidden, report):
        kind = entity.dxftype()
        found = _points(entity, tolerance)
        if found is None:
            report.count("skipped", kind)
            continue
        points, closed = found
        heights = points[:, 2:]
        if heights.size and np.isfinite(points).all() and np.ptp(heights) > 1e-9 * max(
                float(np.ptp(points[:, :2], axis=0).max()), float(np.ptp(heights))):
            report.count("skipped", f"{kind} out of the plane")
            continue
        handle = entity.dxf.get("handle")
        layer = layer.encode("utf-8", "replace").decode()
        shapes.append(Shape(layer, points[:, :2], closed,
                            f"{kind}{f' #{handle}' if handle else ''} of layer {layer}"))
    for layout in drawing.layouts:
        if layout.name != "Model":
            report.count("skipped", "entity of paper space",
                         sum(entity.dxftype() != "VIEWPORT" for entity in layout))
    return shapes


def read(path: str, tolerance: Optional[float], scale: float, report: Report) -> List[Shape]:
    ezdxf: Any = _shapes.need("ezdxf", "DXF files", "python3-ezdxf", "ezdxf")
    try:
        drawing = ezdxf.readfile(path)
    except (ezdxf.DXFError, OSError, ValueError, IndexError) as error:
        raise FormatError(f"no DXF file that can be read: {error}") from error
    _hint(drawing, scale, report)
    try:
        return _shapes_of(drawing, tolerance, report)
    except ezdxf.DXFError as error:
        raise FormatError(f"no DXF file that can be read: {error}") from error
