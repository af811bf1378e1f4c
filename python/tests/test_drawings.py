# SPDX-License-Identifier: GPL-3.0-or-later
import pytest

import hr2d


def make_loose_room():
    scene = hr2d.Scene()
    scene.add([(0, 0), (2, 0)], emission=1, name="floor")
    scene.add([(2, .001), (2, 1), (0, 1), (0, 0)], reflectance=.5, name="shell")
    return scene


def test_warnings_have_a_place():
    found = make_loose_room().warnings()
    assert [w.code for w in found] == ["loose-end"]
    assert found[0].patches == (0, 1) and found[0].at == (2, 0)
    assert found[0].gap == pytest.approx(.001) and "snap" in found[0].text


def test_snap_closes_the_room():
    scene = make_loose_room()
    report = scene.snap(.002)
    assert report.ends == 1 and report.farthest == pytest.approx(.001)
    assert scene.warnings() == []
    assert scene.segments[1][0].tolist() == [2, 0]
    assert scene.factors().sum(axis=1) == pytest.approx(1)
    with pytest.raises(hr2d.InvalidArgument):
        make_loose_room().snap(0)


def test_what_cannot_be_committed_has_warnings():
    scene = hr2d.Scene()
    scene.add([(0, 0), (1, 1)], emission=1)
    scene.add([(0, 1), (1, 0)])
    assert isinstance(scene.warnings(), list)
    with pytest.raises(hr2d.SceneError, match="cross"):
        scene.commit()
