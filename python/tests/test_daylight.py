# SPDX-License-Identifier: GPL-3.0-or-later
import numpy as np
import pytest

import hr2d


def make_ground(**kind):
    """A black ground, and a black plate above it."""
    scene = hr2d.Scene(**kind)
    scene.add([(0, 0), (10, 0)], name="ground")
    scene.add([(4, 1), (6, 1)], sides="both", name="plate")
    return scene


def test_a_sun_throws_a_shadow():
    scene = make_ground()
    scene.set_sun(800, bearing=45)  # right of the zenith: the shadow falls to the left
    half = 800 * np.sqrt(.5)
    assert scene.sunlit_parts("ground") == pytest.approx(np.array([[0, .3], [.5, 1]]))
    assert scene.sunlight[:, 0] == pytest.approx([.8 * half, half, 0])
    at = scene.sunlight_at("ground", [[.1, .4], [.45, .9]])
    assert at[..., 0] == pytest.approx(np.array([[half, 0], [0, half]]))
    s = scene.solve(error=1e-9)
    assert s.H[:, 0] == pytest.approx([.8 * half, half, 0])
    with pytest.raises(ValueError, match="fraction"):
        scene.sunlight_at("ground", 1.5)
    with pytest.raises(IndexError):
        scene.sunlit_parts("ground", 1)


def test_suns_are_bands():
    scene = make_ground()
    scene.set_sun([1, 2], direction=[[0, -1], [1, -1]])
    assert scene.bands == 2
    assert scene.sun.direction.tolist() == [[0, -1], [1, -1]]
    assert scene.sun.irradiance.tolist() == [1, 2]
    assert scene.sunlight[1] == pytest.approx([1, 2 * np.sqrt(.5)])
    assert make_ground().sun.irradiance.tolist() == [0]
    one = make_ground(sun={"irradiance": 1, "direction": (0, -1)})
    assert one.sunlight[:, 0] == pytest.approx([.8, 1, 0])


def test_a_sky_has_pieces():
    scene = make_ground(background=.5, sky=[(-90, 0, 2), (0, 30, [3])])
    assert scene.sky([-45, 10, 40])[:, 0].tolist() == [2, 3, .5]
    # From the front of the plate: half of L and of sines.
    H = scene.solve(error=1e-9).H[1, 0]
    assert H == pytest.approx((2 * 1 + 3 * .5 + .5 * .5) / 2)
    dome = make_ground(sky=[(-90, 90, 1)]).solve(error=1e-9).H
    light = make_ground(background=1).solve(error=1e-9).H
    assert dome[:2] == pytest.approx(light[:2])
    assert dome[2] == 0 < light[2]  # the ground ends, and there is a background below


def test_what_is_no_day_is_said():
    with pytest.raises(hr2d.SceneError, match="bearing"):
        hr2d.Scene().set_sun(1)
    with pytest.raises(hr2d.SceneError, match="overlap"):
        hr2d.Scene().set_sky([(0, 20, 1), (10, 30, 1)])
    with pytest.raises(hr2d.SceneError, match="not finite"):
        hr2d.Scene().set_sun(np.nan, bearing=0)


def test_a_black_background_has_a_temperature():
    scene = make_ground(background_temperature=300)
    assert scene.background == pytest.approx([5.670374419e-8 * 300 ** 4])
