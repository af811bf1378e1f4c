# SPDX-License-Identifier: GPL-3.0-or-later
import sys

import numpy as np
import pytest

import hr2d

pytest.importorskip("matplotlib")
Image = pytest.importorskip("PIL.Image")


def lit(bearing, irradiance=1.0):
    """A wall on the ground, and a sun."""
    scene = hr2d.Scene(background=.1, sun={"bearing": bearing, "irradiance": irradiance})
    scene.add([(-2, 0), (2, 0)], reflectance=.5, name="ground")
    scene.add([(0, .2), (0, 1)], reflectance=.3, sides="both", name="wall")
    return scene.solve(error=1e-2)


def frames(path):
    film = Image.open(path)
    pictures = []
    for k in range(film.n_frames):
        film.seek(k)
        pictures.append(np.asarray(film.convert("RGB"), dtype=int))
    return film, pictures


def test_a_sun_that_crosses(tmp_path):
    path = tmp_path / "sun.png"
    hr2d.film(path, (lit(b) for b in (-60, 0, 60)), titles=["a", "b", "c"], fps=4, filled=40,
              size=(4, 3), dpi=50)
    film, pictures = frames(path)
    assert film.format == "PNG" and film.size == (200, 150) and len(pictures) == 3
    assert film.info["duration"] == 250 and film.info["loop"] == 0
    differ = [np.abs(pictures[j] - pictures[k]).max() for j, k in ((0, 1), (1, 2), (0, 2))]
    assert min(differ) > 50, differ
    assert [p.name for p in tmp_path.iterdir()] == ["sun.png"]


def colour_bar(picture):
    """The columns on the right, where the colours and their numbers are."""
    return picture[:, int(.86 * picture.shape[1]):]


def test_all_pictures_have_the_same_colours_and_part_of_the_plane(tmp_path):
    path = tmp_path / "sun.gif"
    solutions = [lit(10, 1), lit(10, 2)]
    hr2d.film(path, solutions, filled=30, size=(4, 3), dpi=60)
    _, (dim, bright) = frames(path)
    assert np.abs(colour_bar(dim) - colour_bar(bright)).max() < 30
    assert bright.sum() > dim.sum() + 1e5
    hr2d.film(path, solutions, filled=30, size=(4, 3), dpi=60, limits=(0, 20))
    assert frames(path)[1][1].sum() < dim.sum()
    light = [hr2d._draw.look(s, hr2d._draw.view_of(s.scene, None), 0, 9, 20, None)
             for s in solutions]
    low, high = hr2d._film._limits(light)
    assert (low, high) == (light[0].range[0], light[1].range[1]) and low < light[1].range[0]


def wall_at(x):
    scene = hr2d.Scene(background=1)
    scene.add([(0, 0), (4, 0)], reflectance=.5)
    scene.add([(x, .5), (x, 1.5)], reflectance=.5, sides="both")
    return scene.solve(error=1e-2)


def test_a_wall_that_moves_stays_in_view():
    view = hr2d._film._view([wall_at(-1), wall_at(6)], None)
    assert view.low[0] < -1 and view.high[0] > 6 and view.low[1] < 0 < 1.5 < view.high[1]
    box = hr2d._film._view([wall_at(-1), wall_at(6)], (0, 0, 1, 1))
    assert (*box.low, *box.high) == (0, 0, 1, 1)


def test_a_furnace_that_heats_up_shows_temperatures(tmp_path):
    furnace = hr2d.Scene()
    furnace.add([(0, 0), (2, 0), (2, 1), (0, 1), (0, 0)], temperature=500, emissivity=.8)
    operator = furnace.operator(error=1e-4)
    kelvin = [500, 900]
    solutions = [operator.solve(temperature=[t] * 4) for t in kelvin]
    shown = [hr2d.radiation_temperature(s.B) for s in solutions]
    # In equilibrium all radiosity is that of a black body.
    for t, found in zip(kelvin, shown):
        assert found == pytest.approx(t, rel=1e-6)
    assert float(hr2d.radiation_temperature(hr2d.black_body(300))) == pytest.approx(300)
    assert hr2d.radiation_temperature(-1) == 0
    hr2d.film(tmp_path / "furnace.webp", solutions, show=hr2d.radiation_temperature, label="T, K",
              filled=20, size=(4, 3), dpi=50)
    assert len(frames(tmp_path / "furnace.webp")[1]) == 2
    light = hr2d._draw.look(solutions[1], hr2d._draw.view_of(furnace, None), 0, 9, 20,
                            hr2d.radiation_temperature)
    assert light.between == pytest.approx(900, rel=1e-3)


def test_what_cannot_be_a_film(tmp_path, monkeypatch):
    s = wall_at(1)
    with pytest.raises(ValueError, match="one of .apng"):
        hr2d.film(tmp_path / "film.txt", [s])
    with pytest.raises(ValueError, match="one solution or more"):
        hr2d.film(tmp_path / "film.png", [])
    with pytest.raises(ValueError, match="1 titles for 2 solutions"):
        hr2d.film(tmp_path / "film.png", [s, s], titles=["one"])
    monkeypatch.setitem(__import__("matplotlib").rcParams, "animation.ffmpeg_path", "no-such")
    with pytest.raises(RuntimeError, match="ffmpeg"):
        hr2d.film(tmp_path / "film.mp4", [s])

    def broken():
        yield s
        raise KeyError("half")

    with pytest.raises(KeyError):
        hr2d.film(tmp_path / "film.png", broken())
    assert not list(tmp_path.iterdir())


def test_a_movie_is_made_by_ffmpeg(tmp_path, monkeypatch):
    """What the program gets, by one that keeps it."""
    program = tmp_path / "ffmpeg"
    program.write_text(f"#!{sys.executable}\nimport sys\n"
                       "if '-version' in sys.argv: sys.exit(0)\n"
                       "data = sys.stdin.buffer.read()\n"
                       "open(sys.argv[-1], 'wb').write(b'%d ' % len(data) + b' '.join(\n"
                       "    a.encode() for a in sys.argv))\n")
    program.chmod(0o755)
    monkeypatch.setitem(__import__("matplotlib").rcParams, "animation.ffmpeg_path", str(program))
    path = tmp_path / "film.mp4"
    hr2d.film(path, [wall_at(1), wall_at(2)], fps=12, filled=0, size=(4, 3), dpi=50)
    size, *words = path.read_text().split()
    assert int(size) == 2 * 200 * 150 * 4
    assert "12" in words, words
