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

    walls = room.plot(ax=pyplot.figure().gca()).collections[0]
    front, back = walls.get_segments()[5:]
    assert front[0][1] == back[0][1] == .75
    # Shifted by two points of the page, not by a part of the scene.
    shift = walls.get_offset_transform().transform(walls.get_offsets())[5:]
    assert shift == pytest.approx(np.array([[0, 2], [0, -2]]) * walls.figure.dpi / 72)


def limits(axes):
    return *axes.get_xlim(), *axes.get_ylim()


def test_a_box_is_a_part_of_the_plane(room):
    pyplot = pytest.importorskip("matplotlib.pyplot")
    s = room.solve(error=1e-2)
    axes = room.plot(s, ax=pyplot.figure().gca(), filled=20, labels=True, box=(2, .5, 1, 0))
    assert limits(axes) == (1, 2, 0, .5)
    image = axes.images[0]
    assert tuple(image.get_extent()) == (1, 2, 0, .5)
    x, y = np.meshgrid(1 + (np.arange(20) + .5) / 20, (np.arange(10) + .5) / 20)
    assert np.asarray(image.get_array()) == pytest.approx(s.field((x, y)).mean[..., 0], nan_ok=True)
    whole = room.plot(s, ax=pyplot.figure().gca(), filled=0, labels=True)
    assert 0 < len(axes.texts) < len(whole.texts)
    with pytest.raises(ValueError):
        room.plot(s, ax=pyplot.figure().gca(), box=(0, 0, 1))


def ground(length):
    scene = hr2d.Scene(background=1)
    scene.add([(-length / 2, 0), (length / 2, 0)], reflectance=.3, name="ground")
    scene.add([(0, 1), (0, 3)], reflectance=.5, sides="both", name="mast")
    scene.add([(4, 1), (4, 2)], reflectance=.5, name="post")
    return scene


def test_long_ground_goes_on_beyond_the_picture():
    pyplot = pytest.importorskip("matplotlib.pyplot")
    scene = ground(2000)
    axes = scene.plot(scene.solve(error=1e-2), ax=pyplot.figure().gca(), filled=10)
    # The extent of the rest is 4: 10 % of it along the ground, and 6 % around all.
    assert limits(axes) == pytest.approx((-.64, 4.64, -.24, 3.24))
    assert axes.texts[0].get_text() == ("1 patch goes on beyond the picture: the scene is from "
                                        "(-1000, 0) to (1000, 3)")
    far = ground(2000)
    far.add([(1000, -20), (-1000, -20)], reflectance=.3)
    far.add([(500, 2), (2500, 2)], reflectance=.3)
    assert limits(far.plot(ax=pyplot.figure().gca())) == limits(axes)
    # Nor are the walls of a room ground because a piece of them is short.
    room = hr2d.Scene()
    room.add([(0, 0), (5, 0), (5, 3), (0, 3), (0, .1)], reflectance=.5)
    room.add([(0, .1), (0, 0)], reflectance=.5)
    assert not room.plot(ax=pyplot.figure().gca()).texts
    axes = ground(20).plot(ax=pyplot.figure().gca())
    assert limits(axes)[0] < -10 and not axes.texts
    # Notebooks show the same part.
    height = float(svg(scene._repr_html_()).get("height"))
    assert 150 < height < 360, height


def test_what_is_around_a_cell_is_pale():
    pyplot = pytest.importorskip("matplotlib.pyplot")
    scene = hr2d.Scene(background=1)
    scene.add([(0, 0), (3, 0)], reflectance=.3)
    scene.add([(1, 1), (2, 1)], reflectance=.3, sides="both")
    scene.set_period(3, 0)
    alone = scene.plot(ax=pyplot.figure().gca())
    assert len(alone.collections) == 1  # not yet committed
    axes = scene.plot(scene.solve(error=1e-2), ax=pyplot.figure().gca(), filled=10)
    walls, pale = axes.collections[:2]
    segments = np.array(pale.get_segments())
    assert len(segments) == 3 * (scene.images - 1)
    assert segments[:3] == pytest.approx(scene.image(1))
    assert {abs(x) % 3 for x in np.round(segments[:, 0, 0], 9)} <= {0, 1, 2}
    assert limits(axes) == pytest.approx((-.48, 3.48, -.18, 1.18))
    with pytest.raises(IndexError):
        scene.image(scene.images)
    half = hr2d.Scene(background=1)
    half.add([(0, 0), (2, 0)], reflectance=.3)
    half.add_mirror((0, 0), (0, 1))
    axes = half.plot(half.solve(error=1e-2), ax=pyplot.figure().gca(), filled=0)
    assert np.array(axes.collections[1].get_segments()) == pytest.approx(half.image(1))
    assert axes.lines[0].get_linestyle() == "-."


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
