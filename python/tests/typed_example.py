# SPDX-License-Identifier: GPL-3.0-or-later
"""A script with types, for mypy --strict."""
from __future__ import annotations

import numpy as np
import numpy.typing as npt

import hr2d
import hr2d.convert


def brightest(scene: hr2d.Scene) -> tuple[str, float]:
    solution: hr2d.Solution = scene.solve(error=1e-6)
    patch = int(np.argmax(solution.B[:, 0]))
    return scene.names[patch], float(solution.B[patch, 0])


def coarse(batch: hr2d.Batch) -> npt.NDArray[np.float64]:
    larger: npt.NDArray[np.float64] = np.maximum(batch.first["length"], batch.second["length"])
    errors: npt.NDArray[np.float64] = larger / batch.distance
    return errors


def drawing(path: str) -> hr2d.Scene:
    scene = hr2d.Scene()
    scene.add(hr2d.convert.read(path, tolerance=.1, materials={"lamp": {"emission": 1}}))
    return scene


def main() -> None:
    room = hr2d.Scene(background=1.0)
    room.add([(0, 0), (5, 0), (5, 3)], reflectance=.5, name="walls")
    name, value = brightest(room)
    links: hr2d.Links = room.refine(epsilon=.1, oracle=coarse)
    told: hr2d.Prediction = room.predict(error=1e-4)
    ends: hr2d.Enclosure = room.enclose(.1)
    grid: hr2d.Grid = room.solve().field_on_grid(shape=(3, 4))
    print(name, value, links.L, told.seconds, ends.gap, grid.mean.shape)


if __name__ == "__main__":
    main()
