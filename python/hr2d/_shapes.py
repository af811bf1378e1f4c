# SPDX-License-Identifier: GPL-3.0-or-later
"""Lines of a drawing as features of a scene: what is dropped, which ends meet, which side is the
front.  Readers of files make shapes; nothing here knows a format."""
from __future__ import annotations

import math
from importlib import import_module
from typing import Any, Callable, Dict, Iterable, List, Mapping, NamedTuple, Optional, Tuple

import numpy as np

from ._arrays import Array
from ._errors import SceneError

WELD = 1e-9
"""Ends that are nearer than this part of the drawing are one: more than roundings, less than any
detail that is meant."""


class Shape(NamedTuple):
    """A line through points, in units of the drawing."""

    name: str
    points: Array
    """Of the shape (k, 2); a closed one does not repeat its first point."""
    closed: bool = False
    place: str = ""
    """For messages."""
    sure: bool = False
    """The area of a mesh is on its left."""


class Report:
    """What was left out or changed, counted by kind."""

    def __init__(self, say: Callable[[str], None]) -> None:
        self.say = say
        self._counts: Dict[str, Dict[str, int]] = {}

    def count(self, verb: str, kind: str, number: int = 1) -> None:
        if number:
            kinds = self._counts.setdefault(verb, {})
            kinds[kind] = kinds.get(kind, 0) + number

    def tell(self) -> None:
        """A line for each verb."""
        for verb, kinds in self._counts.items():
            self.say(f"{verb}: " + ", ".join(f"{kind} ({n})" for kind, n in kinds.items()))


def need(module: str, what: str, package: str, pip: str) -> Any:
    """A module that only some files need."""
    try:
        return import_module(module)
    except ModuleNotFoundError as error:
        raise ModuleNotFoundError(f"{what} need {module}: apt install {package}, or "
                                  f"pip install {pip}", name=error.name) from error


# ---- points that are dropped, ends that meet

def area(points: Array) -> float:
    """Of a ring, > 0 if it is counterclockwise."""
    x, y = (points - points[0]).T
    return float(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y)) / 2


def clean(shapes: Iterable[Shape], report: Report) -> List[Shape]:
    """Without repeated points, and without what has no length or no area then."""
    kept = []
    for shape in shapes:
        points = shape.points
        wrong = np.flatnonzero(~np.isfinite(points).all(axis=1))
        if len(wrong):
            raise SceneError(f"{shape.place or shape.name}: point {wrong[0] + 1}: a coordinate is "
                             "not finite")
        repeated = np.append(False, np.all(points[1:] == points[:-1], axis=1))
        points, closed = points[~repeated], shape.closed
        if len(points) > 1 and np.array_equal(points[0], points[-1]):
            points, closed = points[:-1], True
        if len(points) < 2:
            report.count("dropped", "line without length")
            continue
        report.count("dropped", "repeated point", int(repeated.sum()))
        size = float(np.ptp(points, axis=0).max())
        if closed and np.abs(points[0] - points[-1]).max() <= WELD * size:
            points = points[:-1]
        if closed and len(points) == 2:
            closed = False
            report.count("dropped", "way back of a ring of two points")
        if closed and abs(area(points)) <= 1e-15 * size * size:
            report.count("dropped", "ring without area")
            continue
        kept.append(shape._replace(points=points, closed=closed))
    return kept


def _first_of_same(points: Array, tolerance: float) -> List[int]:
    """For each point the index of the first one within the tolerance."""
    cells: Dict[Tuple[int, int], List[int]] = {}
    found = []
    width = tolerance or 1.0
    around = [(i, j) for i in (0, -1, 1) for j in (0, -1, 1)]
    for k, (x, y) in enumerate(points.tolist()):
        column, row = math.floor(x / width), math.floor(y / width)
        first = next((other for i, j in around for other in cells.get((column + i, row + j), ())
                      if math.dist((x, y), points[other]) <= tolerance), k)
        if first == k:
            cells.setdefault((column, row), []).append(k)
        found.append(first)
    return found


def weld(shapes: List[Shape], report: Report) -> List[Shape]:
    """Ends that roundings keep apart become the same."""
    shapes = list(shapes)
    free = [k for k, shape in enumerate(shapes) if not shape.closed]
    if not free:
        return shapes
    everything = np.concatenate([shape.points for shape in shapes])
    reach = WELD * float(np.ptp(everything, axis=0).max())
    points = np.array([shapes[k].points[end] for k in free for end in (0, -1)])
    same = _first_of_same(points, reach)
    for k, first, last in zip(free, same[::2], same[1::2]):
        line = shapes[k].points.copy()
        line[0], line[-1] = points[first], points[last]
        report.count("moved", "end that is within roundings of another one",
                     int(np.sum(np.any(line != shapes[k].points, axis=1))))
        shapes[k] = shapes[k]._replace(points=line)
    return shapes


Node = Tuple[float, float]


class Ends(NamedTuple):
    """Where open shapes meet."""

    of: Dict[int, Tuple[Node, Node]]
    """The first and the last point of each."""
    at: Dict[Node, List[int]]
    """Those that end at a point."""


def meet(shapes: List[Shape]) -> Ends:
    ends = Ends({}, {})
    for k, shape in enumerate(shapes):
        if not shape.closed:
            (a, b), (c, d) = shape.points[[0, -1]].tolist()
            first, last = (a, b), (c, d)
            ends.of[k] = (first, last)
            ends.at.setdefault(first, []).append(k)
            ends.at.setdefault(last, []).append(k)
    return ends


def loops(ends: Ends) -> List[List[Tuple[int, bool]]]:
    """Open shapes that form a ring, each with whether the way round runs against it.  Nothing else
    ends at the ring."""
    found = []
    seen = set()
    for start, (origin, node) in ends.of.items():
        if start in seen:
            continue
        way, shape = [(start, False)], start
        seen.add(start)
        while node != origin and len(ends.at[node]) == 2:
            one, two = ends.at[node]
            shape = two if one == shape else one
            if shape in seen:
                break
            seen.add(shape)
            first, last = ends.of[shape]
            way.append((shape, last == node))
            node = first if last == node else last
        if node == origin and len(ends.at[node]) == 2:
            found.append(way)
    return found


# ---- fronts

def _inner_point(ring: Array) -> Array:
    """A point inside, beside the middle of the longest edge."""
    edges = np.roll(ring, -1, axis=0) - ring
    k = int(np.argmax(np.hypot(edges[:, 0], edges[:, 1])))
    left = np.array([-edges[k, 1], edges[k, 0]]) * (1 if area(ring) > 0 else -1)
    return np.asarray(ring[k] + edges[k] / 2 + 1e-7 * left)


def _contains(ring: Array, point: Array) -> bool:
    (x, y), following = point, np.roll(ring, -1, axis=0)
    crosses = (ring[:, 1] > y) != (following[:, 1] > y)
    a, b = ring[crosses], following[crosses]
    at = a[:, 0] + (y - a[:, 1]) / (b[:, 1] - a[:, 1]) * (b[:, 0] - a[:, 0])
    return bool(np.sum(at > x) % 2)


def depths(rings: List[Array]) -> List[int]:
    """In how many other rings each one lies."""
    if not rings:
        return []
    low = np.array([ring.min(axis=0) for ring in rings])
    high = np.array([ring.max(axis=0) for ring in rings])
    found = []
    for k, ring in enumerate(rings):
        point = _inner_point(ring)
        around = np.all((low <= low[k]) & (high >= high[k]), axis=1)
        around[k] = False
        found.append(sum(_contains(rings[j], point) for j in np.flatnonzero(around)))
    return found


def _reversed(shape: Shape) -> Shape:
    return shape._replace(points=shape.points[::-1])


def _ring(shapes: List[Shape], way: List[Tuple[int, bool]]) -> Array:
    if len(way) == 1:
        return shapes[way[0][0]].points
    return np.concatenate([shapes[k].points[::-1 if back else 1][:-1] for k, back in way])


def orient(shapes: List[Shape], faces: str, front: str, one_sided: Callable[[str], bool],
           report: Report) -> List[Shape]:
    """All fronts on the left.  The fronts of rings look into the area that rings enclose, around
    which there is an odd number of them, or away from it; other lines have a front as drawn."""
    shapes = list(shapes)
    turn = {k: faces == "out" if shape.sure else front == "right"
            for k, shape in enumerate(shapes)}
    alone = {k for k, shape in enumerate(shapes) if not shape.closed and not shape.sure}
    ways = [[(k, False)] for k, shape in enumerate(shapes) if shape.closed] + loops(meet(shapes))
    rings = [_ring(shapes, way) for way in ways]
    for way, ring, depth in zip(ways, rings, depths(rings)):
        known = [back for k, back in way if shapes[k].sure]
        area_on_left = not known[0] if known else (area(ring) > 0) == (depth % 2 == 0)
        against = area_on_left != (faces == "in")
        turn.update((k, back != against) for k, back in way)
        alone.difference_update(k for k, _ in way)
    for k, shape in enumerate(shapes):
        if one_sided(shape.name) and not shape.closed and not shape.sure:
            if k in alone:
                report.count(f"front on the {front}, as drawn", "line that is no part of a ring")
            else:
                report.count("turned", "line of a ring", int(turn[k]))
    return [_reversed(shape) if turn[k] else shape for k, shape in enumerate(shapes)]


# ---- chains and features

def chain(shapes: List[Shape]) -> List[Shape]:
    """Lines of one name that go on where another one ends, and nothing else does, are one."""
    ends = meet(shapes)
    after: Dict[int, int] = {}
    for node, both in ends.at.items():
        if len(both) == 2 and both[0] != both[1]:
            for one, two in (both, both[::-1]):
                if (shapes[one].name == shapes[two].name and ends.of[one][1] == node
                        and ends.of[two][0] == node):
                    after[one] = two
    before = {two: one for one, two in after.items()}
    found: List[Tuple[int, Shape]] = [(k, s) for k, s in enumerate(shapes) if s.closed]
    done = {k for k, _ in found}
    for start in [k for k in ends.of if k not in before] + list(ends.of):
        way = []
        k: Optional[int] = start
        while k is not None and k not in done:
            done.add(k)
            way.append(k)
            k = after.get(k)
        if way:
            closed = way[-1] in after
            points = [shapes[j].points[1 if i else 0:] for i, j in enumerate(way)]
            line = np.concatenate(points)[:-1 if closed else None]
            found.append((start, shapes[start]._replace(points=line, closed=closed)))
    return [shape for _, shape in sorted(found, key=lambda pair: pair[0])]


def straighten(shape: Shape) -> Shape:
    """Without points between edges that go on in the same direction but for roundings."""
    points = shape.points
    one, two = points - np.roll(points, 1, axis=0), np.roll(points, -1, axis=0) - points
    lengths = np.hypot(*one.T) * np.hypot(*two.T)
    bent = ((np.abs(one[:, 0] * two[:, 1] - one[:, 1] * two[:, 0]) > WELD * lengths)
            | (np.sum(one * two, axis=1) < 0))
    if not shape.closed:
        bent[[0, -1]] = True
    return shape._replace(points=points[bent])


def _geometry(shapes: List[Shape], two_sided: bool) -> Tuple[Dict[str, Any], Optional[str]]:
    """The geometry of all shapes of a name, and its "faces"."""
    looks = {"in" if area(shape.points) > 0 else "out" for shape in shapes if shape.closed}
    rings = all(shape.closed for shape in shapes) and (two_sided or len(looks) == 1)
    lines = [(np.append(s.points, s.points[:1], axis=0) if s.closed else s.points).tolist()
             for s in shapes]
    parts: List[Any] = [[line] for line in lines] if rings else lines
    kind = "Polygon" if rings else "LineString"
    geometry = ({"type": kind, "coordinates": parts[0]} if len(parts) == 1 else
                {"type": f"Multi{kind}", "coordinates": parts})
    return geometry, looks.pop() if rings and not two_sided else None


def collection(shapes: List[Shape],
               properties_of: Callable[[str], Mapping[str, Any]]) -> Dict[str, Any]:
    """A feature for each name, with its patches in the order of the drawing."""
    named: Dict[str, List[Shape]] = {}
    for shape in shapes:
        named.setdefault(shape.name, []).append(shape)
    features = []
    for name, members in named.items():
        given = dict(properties_of(name))
        if given.get("sides") in (None, "front"):
            given.pop("sides", None)
        geometry, faces = _geometry(members, "sides" in given)
        features.append({"type": "Feature", "geometry": geometry,
                         "properties": {"name": name, **({"faces": faces} if faces else {}),
                                        **given}})
    return {"type": "FeatureCollection", "features": features}
