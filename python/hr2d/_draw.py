# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures: matplotlib's axes, and small SVGs for notebooks, which need no matplotlib."""
from __future__ import annotations

import html
from importlib import import_module
from typing import Any, List, Tuple

import numpy as np

from ._arrays import Array

ROWS = 12
"""A table in a notebook has at most so many patches."""


def _strokes(scene: Any, points: int, shift: float) -> Tuple[Array, Array]:
    """Each patch as points − 1 pieces, moved to the side of its front: (n, pieces, 2, 2)."""
    ends = scene.segments
    along = ends[:, 1] - ends[:, 0]
    normal = np.stack([-along[:, 1], along[:, 0]], axis=1) / scene.lengths[:, None]
    t = np.linspace(0, 1, points)
    line = ends[:, None, 0] + t[None, :, None] * along[:, None] + shift * normal[:, None]
    return np.stack([line[:, :-1], line[:, 1:]], axis=2), (t[1:] + t[:-1]) / 2


def _colours(scene: Any, solution: Any, t: Array, band: int) -> Array:
    return np.stack([solution.at(k, t, gather=False).B[:, band] for k in range(len(scene))])


def _extent(scene: Any) -> float:
    ends = scene.segments.reshape(-1, 2)
    return float(np.ptp(ends, axis=0).max()) if len(ends) else 1.0


def _fill(ax: Any, scene: Any, solution: Any, band: int, filled: int, like: Any) -> None:
    """The mean radiosity between the walls, in the colours of the walls."""
    ends = scene.segments.reshape(-1, 2)
    low, high = ends.min(axis=0), ends.max(axis=0)
    flat = np.where(high == low, 0.1 * _extent(scene), 0)
    low, high = low - flat, high + flat
    steps = np.maximum(2, np.ceil(filled * (high - low) / max(high - low))).astype(int)
    x, y = (a + (b - a) * (np.arange(n) + .5) / n for a, b, n in zip(low, high, steps))
    mean = solution.field(np.meshgrid(x, y)).mean[..., band]
    seen = np.concatenate([mean[np.isfinite(mean)], np.ravel(like.get_array())])
    like.set_clim(seen.min(), seen.max())
    ax.imshow(mean, origin="lower", extent=(low[0], high[0], low[1], high[1]),
              cmap=like.get_cmap(), norm=like.norm, zorder=0)


def plot(scene: Any, solution: Any, ax: Any, band: int, cmap: Any, points: int, labels: bool,
         colorbar: bool, filled: int) -> Any:
    plt: Any = import_module("matplotlib.pyplot")
    collections: Any = import_module("matplotlib.collections")

    if solution is not None and solution.scene is not scene:
        raise ValueError("this is a solution of another scene")
    ax = plt.gca() if ax is None else ax
    pieces, t = _strokes(scene, points if solution is not None else 2, 0.006 * _extent(scene))
    walls = collections.LineCollection(pieces.reshape(-1, 2, 2), linewidths=3, capstyle="projecting")
    if solution is None:
        walls.set_color("0.35")
    else:
        walls.set_array(_colours(scene, solution, t, band).ravel())
        walls.set_cmap(cmap)
    ax.add_collection(walls)
    if solution is not None and filled:
        _fill(ax, scene, solution, band, filled, walls)
    if solution is not None and colorbar:
        ax.figure.colorbar(walls, ax=ax, label="B")
    if labels:
        for name, (a, b) in zip(scene.names, scene.segments):
            ax.annotate(name, (a + b) / 2, fontsize="small", ha="center", va="center")
    ax.set_aspect("equal")
    ax.use_sticky_edges = False
    ax.autoscale_view()
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
    extent, ends = _extent(scene), scene.segments.reshape(-1, 2)
    pieces, t = _strokes(scene, 17 if solution is not None else 2, 0.006 * extent)
    low, high = ends.min(axis=0) - 0.03 * extent, ends.max(axis=0) + 0.03 * extent
    scale = width / max(high - low)
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
