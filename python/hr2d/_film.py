# SPDX-License-Identifier: GPL-3.0-or-later
"""Films: pictures of several solutions in the same colours, one after the other."""
from __future__ import annotations

import os
from importlib import import_module
from pathlib import Path
from typing import Any, Callable, Iterable, Optional, Sequence, Tuple, Union

import numpy as np

from . import _draw
from ._arrays import Array
from ._hr2d import lib
from ._solution import Solution

MOVIES = {".mp4", ".mkv", ".webm", ".mov"}
PICTURES = {".png", ".apng", ".gif", ".webp"}


def _writer(path: Path, fps: float) -> Any:
    """matplotlib's writer for a kind of file: of Pillow, or ffmpeg."""
    animation: Any = import_module("matplotlib.animation")
    kind = path.suffix.lower()
    if kind in PICTURES:
        return animation.PillowWriter(fps=fps)
    if kind not in MOVIES:
        raise ValueError(f"{path.name}: a film is one of {', '.join(sorted(PICTURES | MOVIES))}")
    if not animation.FFMpegWriter.isAvailable():
        raise RuntimeError(f"{path.name}: films of this kind need the program ffmpeg; .png needs "
                           "none")
    return animation.FFMpegWriter(fps=fps)


def _view(solutions: Sequence[Solution], box: Optional[Sequence[float]]) -> _draw.View:
    """The same part of the plane in all pictures."""
    views = [_draw.view_of(s.scene, box) for s in solutions]
    low = np.min([v.low for v in views], axis=0)
    high = np.max([v.high for v in views], axis=0)
    edge = 0 if views[0].part else _draw.AROUND * max(high - low)
    return _draw.View(low - edge, high + edge, True, max(v.going_on for v in views))


def _limits(lights: Iterable[_draw.Light]) -> Tuple[float, float]:
    ranges = [light.range for light in lights]
    return min(low for low, _ in ranges), max(high for _, high in ranges)


def film(path: Union[str, "os.PathLike[str]"], solutions: Iterable[Solution], *,
         titles: Sequence[str] = (), fps: float = 10, box: Optional[Sequence[float]] = None,
         band: int = 0, cmap: Any = "viridis", points: int = 33, filled: int = 160,
         show: Optional[Callable[[Array], Array]] = None, label: str = "B",
         limits: Optional[Tuple[float, float]] = None, size: Tuple[float, float] = (7, 4.5),
         dpi: float = 100) -> None:
    """Writes a film with a picture for each solution, of one scene or of several.

    The end of the file's name is its kind: .png (an animated PNG), .gif or .webp need Pillow,
    .mp4, .mkv, .webm or .mov the program ffmpeg.  The solutions are those of a sun that crosses,
    a wall that moves, a furnace that heats up: they may come from a generator, and each may have
    a title.  All pictures show the same part of the plane, in the same colours: over `limits`, or
    the range of all.  `fps` pictures are shown in a second; `size` is in inches.  The other
    arguments are those of Scene.plot().

    The file is written as a whole or not at all.
    """
    path = Path(path)
    writer = _writer(path, fps)
    figures: Any = import_module("matplotlib.figure")
    shown = list(solutions)
    if not shown:
        raise ValueError("a film has one solution or more")
    if titles and len(titles) != len(shown):
        raise ValueError(f"{len(titles)} titles for {len(shown)} solutions")
    view = _view(shown, box)
    lights = [_draw.look(s, view, band, points, filled, show) for s in shown]
    limits = limits or _limits(lights)
    unfinished = path.with_name(f".unfinished-{os.getpid()}-{path.name}")
    figure = figures.Figure(figsize=size, layout="constrained")
    try:
        with writer.saving(figure, str(unfinished), dpi):
            for k, (solution, light) in enumerate(zip(shown, lights)):
                figure.clear()
                ax = figure.add_subplot()
                walls = _draw.paint(ax, solution.scene, view, light, points, cmap, limits)
                figure.colorbar(walls, ax=ax, label=label)
                if titles:
                    ax.set_title(titles[k])
                writer.grab_frame()
        os.replace(unfinished, path)
    finally:
        unfinished.unlink(missing_ok=True)


def radiation_temperature(radiosity: Union[float, Array]) -> Array:
    """T in kelvin of the black body of a radiosity in W/m², (B/σ)^¼: for pictures of heat.

    Of a surface that also reflects it is not the temperature of the surface.
    """
    kept = np.maximum(0, np.asarray(radiosity, dtype=np.float64))
    temperature: Array = (kept / lib.hr2d_black_body(1)) ** .25
    return temperature
