# SPDX-License-Identifier: GPL-3.0-or-later
import numpy as np
import pytest

import hr2d


def make_street(**kind):
    """A black street, 4 wide between walls of 3, with a roof on the right."""
    scene = hr2d.Scene(background=1, **kind)
    scene.add([(0, 0), (4, 0)], name="street")
    scene.add([(4, 0), (4, 3), (6, 3), (6, 0)], name="house")
    return scene


def test_a_period_goes_on_for_ever():
    scene = make_street()
    scene.set_period(6, 0)
    assert scene.period == (6, 0)
    s = scene.solve(error=1e-9)
    assert s.H[:, 0] == pytest.approx([.5, 1 / 3, 1, 1 / 3], abs=1e-9)  # crossed strings
    assert scene.images > 2 and scene.cut_off == 0
    # Alone, the wall that looks to the right sees nothing but the background.
    alone = make_street()
    assert alone.period == (0, 0) and alone.images == 1
    assert alone.solve(error=1e-9).H[3, 0] == pytest.approx(1)


def test_a_mirror_has_the_other_half():
    half = hr2d.Scene(background=1)
    half.add([(0, 0), (2, 0)])
    half.add([(2, 0), (2, 3)])
    half.add_mirror((0, 0), (0, 1))
    assert half.images == 2
    assert half.solve(error=1e-9).H[:, 0] == pytest.approx([.5, 1 / 3], abs=1e-9)
    shape = hr2d.Scene(background=1)
    shape.add([(0, 0), (2, 0)])
    shape.add([(2, 0), (2, 3)])
    assert len(shape.add([(0, 0), (0, 1)], sides="mirror")) == 0
    assert np.array_equal(shape.solve(error=1e-9).H, half.solve(error=1e-9).H)


def test_what_is_behind_a_mirror_is_refused():
    scene = make_street()
    scene.add_mirror((1, 0), (1, 1))
    with pytest.raises(hr2d.SceneError, match="mirror"):
        scene.commit()
