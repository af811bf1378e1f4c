# SPDX-License-Identifier: GPL-3.0-or-later
"""SVG drawings as shapes, by svgelements: paths, lines, polygons, rectangles, circles and ellipses,
with their transforms, in user units and with y upwards."""
from __future__ import annotations

import io
import math
import re
import xml.etree.ElementTree as ET
from typing import Any, Dict, Iterator, List, Optional, Tuple

import numpy as np

from . import _curves, _shapes
from ._arrays import Array
from ._errors import FormatError
from ._shapes import Report, Shape

DRAWN = {"path", "line", "polyline", "polygon", "rect", "circle", "ellipse"}
NOT_DRAWN = {"clipPath", "mask", "marker", "pattern", "symbol", "linearGradient", "radialGradient",
             "filter"}
"""What svgelements would partly draw; a <use> of a symbol is skipped."""
SAYS_NOTHING = {"svg", "g", "a", "switch", "use", "defs", "title", "desc", "metadata", "style",
                "namedview"}
LABEL = "{http://www.inkscape.org/namespaces/inkscape}label"
HREF = "{http://www.w3.org/1999/xlink}href"
MOST_SHAPES = 1_000_000
MARK = "hr2d-mark"
NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?"
PATH = re.compile(rf"(?:[\s,]*(?:[MmZzLlHhVvCcSsQqTtAa]|{NUMBER}))*[\s,]*\Z")
LENGTH = re.compile(rf"\s*(?:{NUMBER}\s*(?:[a-zA-Z]+|%)?|auto)\s*\Z")
LENGTHS = ("x", "y", "width", "height", "x1", "y1", "x2", "y2", "cx", "cy", "r", "rx", "ry")
POINTS = re.compile(rf"(?:[\s,]*{NUMBER})*[\s,]*\Z")
PER_COMMAND = {"m": 2, "l": 2, "h": 1, "v": 1, "c": 6, "s": 4, "q": 4, "t": 2, "z": 0}


def _tag(element: ET.Element) -> str:
    return str(element.tag).rpartition("}")[2]


def _check_path(data: str, place: str) -> None:
    """svgelements ends a path where it is wrong, and does not say so."""
    if not PATH.match(data):
        raise FormatError(f"{place}: no path data: {data[:40]!r}")
    for letter, numbers in re.findall(r"([MmZzLlHhVvCcSsQqTt])([^MmZzLlHhVvCcSsQqTtAa]*)", data):
        count, need = len(re.findall(NUMBER, numbers)), PER_COMMAND[letter.lower()]
        if need and (count == 0 or count % need) or not need and count:
            raise FormatError(f"{place}: {letter} of a path has {count} numbers")


def _check_numbers(element: ET.Element, place: str) -> None:
    """svgelements leaves out a shape whose numbers it cannot read, and does not say so."""
    for key in LENGTHS:
        value = element.get(key)
        if value is not None and not LENGTH.match(value):
            raise FormatError(f"{place}: {key} is no finite length: {value!r}")
    points = element.get("points", "")
    if not POINTS.match(points) or len(re.findall(NUMBER, points)) % 2:
        raise FormatError(f"{place}: points are no pairs of finite numbers: {points[:40]!r}")


def _name(element: ET.Element, above: List[ET.Element], names: str) -> str:
    """By the id, the class or the group, whichever is asked for and then there."""
    groups = (g.get(LABEL) or g.get("id") for g in reversed(above) if _tag(g) == "g")
    found: Dict[str, Optional[str]] = {
        "id": element.get("id"), "class": element.get("class"),
        "group": next((group for group in groups if group), None)}
    order = [names] + [kind for kind in ("id", "class", "group") if kind != names]
    return next((" ".join(str(found[k]).split()) for k in order if found[k]), _tag(element))


class _Marks:
    """Names and places of the shapes of the file, which a mark of each finds again."""

    def __init__(self, root: ET.Element, names: str, report: Report) -> None:
        self.names: List[str] = []
        self.places: List[str] = []
        self.in_definitions: List[bool] = []
        self._by, self._report = names, report
        self._sizes: Dict[str, int] = {}
        self._walk(root, [])

    def _walk(self, element: ET.Element, above: List[ET.Element]) -> int:
        """Returns how many shapes there are, with those of each <use>."""
        number = 0
        for child in list(element):
            tag = _tag(child)
            if tag in NOT_DRAWN:
                element.remove(child)
                if tag == "symbol":
                    self._report.count("skipped", tag)
                continue
            inside = above + [element]
            if tag in DRAWN:
                self._mark(child, inside)
                size = 1
            elif tag == "use":
                size = self._used(child, inside)
            else:
                if tag not in SAYS_NOTHING and "{http://www.w3.org/2000/svg}" in str(child.tag):
                    self._report.count("skipped", tag)
                size = self._walk(child, inside)
            number += size
            self._sizes[child.get("id", "")] = size
        return number

    def _used(self, child: ET.Element, above: List[ET.Element]) -> int:
        """svgelements knows what is above a <use> in the file, and says nothing of the rest."""
        target = child.get("href", child.get(HREF, ""))[1:]
        if any(target and a.get("id") == target for a in above):
            raise FormatError(f"use of {target}: it is in itself")
        size = self._sizes.get(target, 0)
        if size == 0:
            self._report.count("skipped", "use of what is not above it")
        if size > MOST_SHAPES:
            raise FormatError(f"use of {target}: it has {size} shapes")
        return size

    def _mark(self, child: ET.Element, above: List[ET.Element]) -> None:
        name, identity = _name(child, above, self._by), child.get("id")
        place = f"{_tag(child)} {identity or len(self.names) + 1}"
        if _tag(child) == "path":
            _check_path(child.get("d", ""), place)
        else:
            _check_numbers(child, place)
        child.set(MARK, str(len(self.names)))
        self.names.append(name)
        self.places.append(place)
        self.in_definitions.append(any(_tag(a) == "defs" for a in above))


def _arc(segment: Any, tolerance: Optional[float]) -> Array:
    """An elliptic arc: the image of a circle, of which no chord grows more than by the longer half
    axis."""
    n = _curves.steps(float(segment.sweep), max(float(segment.rx), float(segment.ry)), tolerance)
    start = float(segment.get_start_t())
    points = [segment.point_at_t(start + float(segment.sweep) * k / n) for k in range(1, n)]
    return np.array([(p.x, p.y) for p in points + [segment.end]])


def _lines(svg: Any, path: Any, tolerance: Optional[float]) -> Iterator[Tuple[Array, bool]]:
    """The points of each part of a path, and whether it is closed."""
    points: List[Any] = []
    for segment in path:
        kind = type(segment).__name__
        if kind in ("Move", "Close"):
            if len(points) > 1:
                yield np.array(points), kind == "Close"
            # After a close without a move a path goes on from where it began.
            points = [(segment.end.x, segment.end.y)] if segment.end is not None else []
        elif kind == "Line":
            points.append((segment.end.x, segment.end.y))
        elif kind == "Arc" and segment.rx and segment.ry and math.isfinite(segment.sweep):
            points.extend(_arc(segment, tolerance))
        elif kind == "Arc":
            points.append((segment.end.x, segment.end.y))
        else:
            controls = ([segment.control] if kind == "QuadraticBezier"
                        else [segment.control1, segment.control2])
            corners = [(p.x, p.y) for p in [segment.start, *controls, segment.end]]
            points.extend(_curves.bezier(corners, tolerance))
    if len(points) > 1:
        yield np.array(points), False


def _frame(root: ET.Element, svg: Any) -> Tuple[float, float, float]:
    """Width and height of the drawing in user units, and where y is 0 afterwards: at its lower
    edge.  The sizes of the root are taken away, so that no unit but the user's is left."""
    box = [float(v) for v in re.findall(NUMBER, root.get("viewBox", ""))]
    sizes = [root.get("width", ""), root.get("height", "")]
    for key in ("viewBox", "width", "height"):
        root.attrib.pop(key, None)
    if len(box) == 4:
        return box[2], box[3], box[1] + box[3]
    width, height = (float(svg.Length(s).value(ppi=96)) if s and "%" not in s else 0.0
                     for s in sizes)
    return width, height, height


def read(path: str, tolerance: Optional[float], names: str, report: Report) -> List[Shape]:
    svg: Any = _shapes.need("svgelements", "SVG files", "python3-svgelements", "svgelements")
    try:
        root = ET.parse(path).getroot()
    except (ET.ParseError, LookupError, ValueError) as error:
        raise FormatError(f"no XML: {error}") from error
    if _tag(root) != "svg":
        raise FormatError(f"no SVG, but <{_tag(root)}>")
    width, height, bottom = _frame(root, svg)
    try:
        marks = _Marks(root, names, report)
    except RecursionError:
        raise FormatError("elements are nested too deep") from None
    try:
        drawing = svg.SVG.parse(io.BytesIO(ET.tostring(root)), reify=False,
                                width=width or 1000, height=height or 1000)
    except Exception as error:  # of any kind, for it checks little
        raise FormatError(f"no SVG file that svgelements can read: {error}") from error
    shapes, seen = [], set()
    for element in drawing.elements(lambda e: isinstance(e, svg.Shape)):
        mark = int(element.values[MARK])
        seen.add(mark)
        if str(element.values.get("visibility", "")) in ("hidden", "collapse"):
            report.count("skipped", f"{element.values['tag']} that is not shown")
            continue
        for points, closed in _lines(svg, abs(svg.Path(element)), tolerance):
            points = points * [1, -1] + [0, bottom]
            shapes.append(Shape(marks.names[mark], points, closed, marks.places[mark]))
    for mark, place in enumerate(marks.places):
        if mark not in seen:
            kind = "of definitions" if marks.in_definitions[mark] else "not shown or without size"
            report.count("skipped", f"{place.split()[0]} {kind}")
    return shapes
