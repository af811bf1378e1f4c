# SPDX-License-Identifier: GPL-3.0-or-later
import re
import xml.etree.ElementTree as xml
from pathlib import Path

import numpy as np
import pytest

import hr2d


def test_walls_have_the_colours_of_b(room):
    pytest.importorskip("matplotlib")
    s = room.solve(error=1e-4)
    axes = room.plot(s, points=9, labels=True)
    walls = axes.collections[0]
    assert len(walls.get_segments()) == 7 * 8
    values = np.asarray(walls.get_array()).reshape(7, 8)
    assert values == pytest.approx(np.array(
        [s.at(k, (np.arange(8) + .5) / 8, gather=False).B[:, 0] for k in range(7)]))
    assert {text.get_text() for text in axes.texts} >= {"table", "table (back)"}
    other = hr2d.Scene()
    other.add([(0, 0), (1, 0)])
    with pytest.raises(ValueError, match="another scene"):
        other.plot(s)
    assert len(room.plot().collections[-1].get_segments()) == 7


def test_the_plane_is_filled(room):
    pyplot = pytest.importorskip("matplotlib.pyplot")
    s = room.solve(error=1e-4)
    axes = room.plot(s, ax=pyplot.figure().gca(), filled=40)
    image, walls = axes.images[0], axes.collections[0]
    assert image.get_array().shape[1] == 40 and image.norm is walls.norm
    # The light of the opening is brighter than any wall.
    assert walls.get_clim()[1] > .4 > walls.get_array().max()
    assert not room.plot(s, ax=pyplot.figure().gca(), filled=0).images
    line = hr2d.Scene()
    line.add([(0, 0), (1, 0)], emission=1)
    assert line.plot(line.solve(), ax=pyplot.figure().gca(), filled=8).images


def test_fronts_and_backs_are_apart(room):
    pytest.importorskip("matplotlib")
    from matplotlib import pyplot

    front, back = room.plot(ax=pyplot.figure().gca()).collections[0].get_segments()[5:]
    assert front[0][1] > .75 > back[0][1]


def svg(text):
    return xml.fromstring(re.search("<svg.*?</svg>", text)[0])


def test_notebooks_show_scenes_and_solutions(room):
    lines = svg(room._repr_html_()).findall(".//{*}line")
    assert len(lines) == 7
    s = room.solve(error=1e-4)
    text = s._repr_html_()
    colours = {line.get("stroke") for line in svg(text).findall(".//{*}line")}
    assert len(colours) > 10 and {"#261854", "#fce678"} <= colours
    assert f"{s.B[4, 0]:.6g}" in text and "B, averages" in text
    assert "B, averages" not in room.solve(epsilon=.5)._repr_html_()


def test_names_are_no_markup():
    scene = hr2d.Scene()
    scene.add([(0, 0), (1, 0)], name="<script>&")
    scene.add([(1, 1), (0, 1)], emission=1)
    text = scene._repr_html_() + scene.solve()._repr_html_()
    assert "<script>" not in text and "&lt;script&gt;&amp;" in text
    assert svg(text).find(".//{*}title").text == "<script>&"


def test_empty_scene():
    assert "0 patches" in hr2d.Scene()._repr_html_()


def test_the_readme_runs(tmp_path, monkeypatch):
    for module in ("matplotlib", "pandas", "xarray"):
        pytest.importorskip(module)
    monkeypatch.chdir(tmp_path)
    text = (Path(__file__).parent.parent / "README.md").read_text(encoding="utf-8")
    blocks, names = re.findall(r"```python\n(.*?)```", text, re.S), {}
    assert len(blocks) == 6
    for block in blocks:
        exec(compile(block, "README.md", "exec"), names)
    assert names["F"].shape == (7, 7) and names["s"].B.shape == (7, 1)
