# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures: matplotlib's axes, and small SVGs for notebooks, which need no matplotlib."""
from __future__ import annotations

import html
from importlib import import_module
from typing import Any, Callable, List, NamedTuple, Optional, Sequence, Tuple

import numpy as np

from ._arrays import Array

ROWS = 12
"""A table in a notebook has at most so many patches."""


FAR_LONGER = 20
"""So many times as long as the extent of all shorter ones is a patch that goes on beyond a picture."""
MORE, AROUND = .1, .06
"""Parts of the extent: of what goes on or stands around a cell, and around all."""
SHIFT = 2.0
"""So far is the line of B from its wall, to the side of its front; points, or pixels of an SVG."""


class View(NamedTuple):
    """A part of the plane."""

    low: Array
    high: Array
    part: bool
    """Not all patches are in it."""
    going_on: int
    """So many patches go on beyond it."""


def _strokes(ends: Array, points: int) -> Tuple[Array, Array]:
    """Each patch as points − 1 pieces, (n, pieces, 2, 2), and the middles of these."""
    t = np.linspace(0, 1, points)
    line = ends[:, None, 0] + t[None, :, None] * (ends[:, 1] - ends[:, 0])[:, None]
    return np.stack([line[:, :-1], line[:, 1:]], axis=2), (t[1:] + t[:-1]) / 2


def _fronts(scene: Any) -> Array:
    """The unit normals of all patches, (n, 2)."""
    along = scene.segments[:, 1] - scene.segments[:, 0]
    normals: Array = np.stack([-along[:, 1], along[:, 0]], axis=1) / scene.lengths[:, None]
    return normals


def _part(ends: Array, low: Array, high: Array) -> Array:
    """The ends of the parts of patches that are within a box, (m, 2), after Liang and Barsky."""
    along = ends[:, 1] - ends[:, 0]
    with np.errstate(divide="ignore", invalid="ignore"):
        cuts = np.stack([low - ends[:, 0], high - ends[:, 0]]) / along
    cuts = np.where(np.isnan(cuts), 0, cuts)  # on the side of the box, along it
    s = np.maximum(0, cuts.min(axis=0).max(axis=1))
    t = np.minimum(1, cuts.max(axis=0).min(axis=1))
    found = s <= t
    return np.concatenate([ends[found, 0] + u[found, None] * along[found] for u in (s, t)])


def _passing(ends: Array, low: Array, high: Array) -> Array:
    """Of long patches, the points where they pass a box: beside it along them, and no farther from
    it across them than it is large."""
    extent, points = max(high - low), []
    for a, b in ends:
        along = int(np.argmax(np.abs(b - a)))
        across = 1 - along
        ends_of_box = np.array([low[along] - MORE * extent, high[along] + MORE * extent])
        s, t = np.sort((ends_of_box - a[along]) / (b - a)[along])
        if s > 1 or t < 0:
            continue
        for point in (a + u * (b - a) for u in (max(0, s), min(1, t))):
            if low[across] - extent <= point[across] <= high[across] + extent:
                points.append(point)
    return np.array(points).reshape(-1, 2)


def _around(points: Array) -> Tuple[Array, Array]:
    return points.min(axis=0), points.max(axis=0)


def _what_matters(scene: Any) -> View:
    """The box of all patches, but for those far longer than the extent of all shorter ones."""
    order = np.argsort(scene.lengths)
    ends, lengths = scene.segments[order], scene.lengths[order]
    lows = np.minimum.accumulate(ends.min(axis=1))
    highs = np.maximum.accumulate(ends.max(axis=1))
    far = lengths[1:] >= FAR_LONGER * (highs - lows).max(axis=1)[:-1]
    far[:max(0, (len(ends) + 1) // 2 - 1)] = False  # at least half of them matter
    rest = int(np.argmax(far)) + 1 if far.any() else len(ends)
    low, high = lows[rest - 1], highs[rest - 1]
    if rest == len(ends):
        return View(low, high, False, 0)
    edge = AROUND * max(high - low)
    low, high = _around(np.concatenate([[low, high], _passing(ends[rest:], low, high)]))
    return View(low - edge, high + edge, True, len(ends) - rest)


def _images(scene: Any) -> List[Array]:
    """What stands around a cell; known once the scene has been committed."""
    count = scene.images if scene._committed else 1
    return [scene.image(k) for k in range(1, count)]


def view_of(scene: Any, box: Optional[Sequence[float]]) -> View:
    if box is not None:
        corners = np.array(box, dtype=float).reshape(2, 2)
        return View(*_around(corners), True, 0)
    images = _images(scene)
    if not images:
        return _what_matters(scene)
    low, high = _around(scene.segments.reshape(-1, 2))
    more = MORE * max(high - low)
    near = [_around(np.clip(ends.reshape(-1, 2), low - more, high + more)) for ends in images]
    edge = AROUND * max(high - low)
    return View(np.min([low, *(a for a, _ in near)], axis=0) - edge,
                np.max([high, *(b for _, b in near)], axis=0) + edge, True, 0)


def _colours(scene: Any, solution: Any, t: Array, band: int) -> Array:
    return np.stack([solution.at(k, t, gather=False).B[:, band] for k in range(len(scene))])


class Light(NamedTuple):
    """What a picture shows of a solution."""

    walls: Array
    """Along each patch, (n, pieces)."""
    between: Optional[Array]
    """At a grid of the view, (rows, columns); None if it is not filled."""
    extent: Tuple[float, float, float, float]
    """Of that grid: left, right, low, high."""

    @property
    def range(self) -> Tuple[float, float]:
        shown = [np.ravel(a) for a in (self.walls, self.between) if a is not None]
        seen = np.concatenate(shown)
        seen = seen[np.isfinite(seen)]
        return (float(seen.min()), float(seen.max())) if len(seen) else (0.0, 1.0)


def look(solution: Any, view: View, band: int, points: int, filled: int,
         show: Optional[Callable[[Array], Array]]) -> Light:
    """The light of a solution in a view: B along the walls, and the mean radiosity between."""
    low, high = view.low, view.high
    flat = np.where(high == low, 0.1 * (max(high - low) or 1), 0)
    low, high = low - flat, high + flat
    extent = (float(low[0]), float(high[0]), float(low[1]), float(high[1]))
    _, t = _strokes(solution.scene.segments, points)
    walls, between = _colours(solution.scene, solution, t, band), None
    if filled:
        steps = np.maximum(2, np.ceil(filled * (high - low) / max(high - low))).astype(int)
        x, y = (a + (b - a) * (np.arange(n) + .5) / n for a, b, n in zip(low, high, steps))
        between = solution.field(np.meshgrid(x, y)).mean[..., band]
    if show is not None:
        walls, between = show(walls), None if between is None else show(between)
    return Light(walls, between, extent)


def _walls(ax: Any, scene: Any, points: int) -> Any:
    """The patches as lines, shifted in points of the page to the sides of their fronts."""
    collections: Any = import_module("matplotlib.collections")
    pieces, _ = _strokes(scene.segments, points)
    walls = collections.LineCollection(pieces.reshape(-1, 2, 2), linewidths=3,
                                       capstyle="projecting")
    walls.set_offset_transform(ax.figure.dpi_scale_trans)
    walls.set_offsets(np.repeat(SHIFT / 72 * _fronts(scene), points - 1, axis=0))
    ax.add_collection(walls, autolim=False)
    return walls


def _surroundings(ax: Any, scene: Any) -> None:
    """What stands around a cell, faintly; mirrors are broken lines."""
    collections: Any = import_module("matplotlib.collections")
    pale = _images(scene)
    if pale:
        ax.add_collection(collections.LineCollection(
            np.concatenate(pale), linewidths=1.5, colors="0.6", zorder=1), autolim=False)
    for a, b in scene.mirrors:
        ax.axline(a, b, color="0.4", linewidth=1, linestyle="-.")


def _frame(ax: Any, scene: Any, view: View) -> None:
    ax.set_aspect("equal")
    if view.part:
        ax.set(xlim=(view.low[0], view.high[0]), ylim=(view.low[1], view.high[1]))
    else:
        ax.update_datalim(scene.segments.reshape(-1, 2))
        ax.use_sticky_edges = False
        ax.autoscale_view()
    if view.going_on:
        low, high = _around(scene.segments.reshape(-1, 2))
        goes = "patch goes" if view.going_on == 1 else "patches go"
        ax.annotate(f"{view.going_on} {goes} on beyond the picture: the scene is from "
                    f"({low[0]:g}, {low[1]:g}) to ({high[0]:g}, {high[1]:g})",
                    (0, 1), (0, 4), xycoords="axes fraction", textcoords="offset points",
                    fontsize="small")


def paint(ax: Any, scene: Any, view: View, light: Optional[Light], points: int, cmap: Any,
          limits: Optional[Tuple[float, float]] = None) -> Any:
    """Paints a scene and its light, with colours over these limits or its own range; returns the
    lines of the walls."""
    walls = _walls(ax, scene, points if light is not None else 2)
    if light is None:
        walls.set_color("0.35")
    else:
        walls.set_array(light.walls.ravel())
        walls.set_cmap(cmap)
        walls.set_clim(*(limits or light.range))
        if light.between is not None:
            ax.imshow(light.between, origin="lower", extent=light.extent, cmap=walls.get_cmap(),
                      norm=walls.norm, zorder=0)
    _surroundings(ax, scene)
    _frame(ax, scene, view)
    return walls


def plot(scene: Any, solution: Any, ax: Any, band: int, cmap: Any, points: int, labels: bool,
         colorbar: bool, filled: int, box: Optional[Sequence[float]],
         show: Optional[Callable[[Array], Array]], label: str) -> Any:
    plt: Any = import_module("matplotlib.pyplot")

    if solution is not None and solution.scene is not scene:
        raise ValueError("this is a solution of another scene")
    ax = plt.gca() if ax is None else ax
    view = view_of(scene, box)
    light = None if solution is None else look(solution, view, band, points, filled, show)
    walls = paint(ax, scene, view, light, points, cmap)
    if light is not None and colorbar:
        ax.figure.colorbar(walls, ax=ax, label=label)
    if labels:
        for name, ends in zip(scene.names, scene.segments):
            middle = _part(ends[None], view.low, view.high)
            if len(middle):
                ax.annotate(name, middle.mean(axis=0), fontsize="small", ha="center", va="center")
    return ax


def _ramp(value: float) -> str:
    """A colour from dark blue over red to yellow, for values from 0 to 1."""
    stops = np.array([[38, 24, 84], [168, 42, 110], [240, 120, 60], [252, 230, 120]])
    place = min(max(value, 0), 1) * (len(stops) - 1)
    k = min(int(place), len(stops) - 2)
    colour = stops[k] + (place - k) * (stops[k + 1] - stops[k])
    return "#" + "".join(f"{round(c):02x}" for c in colour)


def _svg(scene: Any, solution: Any = None, width: float = 360) -> str:
    """The walls; coloured by B of the first band if there is a solution."""
    if len(scene) == 0:
        return ""
    low, high, *_ = view_of(scene, None)
    edge = 0.03 * max(high - low)
    low, high = low - edge, high + edge
    scale = width / max(high - low)
    pieces, t = _strokes(scene.segments, 17 if solution is not None else 2)
    pieces = pieces + SHIFT / scale * _fronts(scene)[:, None, None]
    strokes = np.full(pieces.shape[:2], "currentColor", dtype=object)
    if solution is not None:
        colours = _colours(scene, solution, t, 0)
        span = colours.max() - colours.min() or 1
        strokes = np.vectorize(_ramp, otypes=[object])((colours - colours.min()) / span)
    lines: List[str] = []
    for name, patch, colour in zip(scene.names, (pieces - low) * scale, strokes):
        lines.append(f"<g><title>{html.escape(name)}</title>")
        lines += [f'<line x1="{a[0]:.2f}" y1="{a[1]:.2f}" x2="{b[0]:.2f}" y2="{b[1]:.2f}" '
                  f'stroke="{c}"/>' for (a, b), c in zip(patch, colour)]
        lines.append("</g>")
    w, h = (high - low) * scale
    return (f'<svg xmlns="http://www.w3.org/2000/svg" width="{w:.0f}" height="{h:.0f}" '
            f'viewBox="0 0 {w:.2f} {h:.2f}"><g transform="matrix(1 0 0 -1 0 {h:.2f})" '
            f'stroke-width="3" stroke-linecap="square">{"".join(lines)}</g></svg>')


def _table(head: List[str], rows: List[List[str]]) -> str:
    cells = "".join(f"<th>{html.escape(cell)}</th>" for cell in head)
    body = "".join("<tr>" + "".join(f"<td>{html.escape(cell)}</td>" for cell in row) + "</tr>"
                   for row in rows)
    return f"<table><thead><tr>{cells}</tr></thead><tbody>{body}</tbody></table>"


def scene_html(scene: Any) -> str:
    return f"<p>{len(scene)} patches</p>{_svg(scene)}"


def _numbers(values: Array) -> str:
    return " ".join(f"{value:.6g}" for value in values)


def solution_html(solution: Any) -> str:
    scene, names = solution.scene, solution.scene.names
    rows = [[names[k], _numbers(solution.B[k]), _numbers(solution.H[k]),
             _numbers(solution.net_flux[k])] for k in range(min(len(names), ROWS))]
    if len(names) > ROWS:
        rows.append([f"… {len(names) - ROWS} more", "", "", ""])
    account = account_html(solution.account) if solution._account else ""
    return (f"{_svg(scene, solution)}{_table(['patch', 'B', 'H', 'B − H'], rows)}{account}")


def account_html(account: Any) -> str:
    errors = [("B, averages", account.average), ("B, points", account.sup),
              ("H, averages", account.irradiance), ("H, points", account.irradiance_sup)]
    rows = [[name, f"{error.estimate:.1e}", f"{error.bound:.1e}"]
            for name, error in errors if error is not None]
    return (_table(["relative error", "estimate", "bound"], rows)
            + f"<p>{account.elements} elements, {account.links} links, order {account.order}"
            + (f"; {html.escape(account.reason)}" if account.reason else "") + "</p>")
