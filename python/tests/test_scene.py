# SPDX-License-Identifier: GPL-3.0-or-later
import json

import numpy as np
import pytest

import hr2d
from conftest import make_plates


def test_patches_are_those_that_were_added(room):
    assert room.names == ["shell/1", "shell/2", "shell/3", "shell/4", "parapet", "table",
                          "table (back)"]
    assert room.segments[3].tolist() == [[0, 2.8], [0, 2.2]]
    assert room.segments[6].tolist() == room.segments[5][::-1].tolist()
    along = room.segments[:, 1] - room.segments[:, 0]
    assert np.array_equal(room.lengths, np.hypot(*along.T))
    assert room.reflectance[:, 0].tolist() == [.6] * 5 + [.5] * 2
    assert room.background.tolist() == [1] and room.bands == 1
    assert room.index("parapet") == 4 and room.index(2) == 2 and len(room) == 7
    assert "table" in room.effects["two-sided"] and "bands" not in room.effects


def test_add_returns_indices():
    scene = hr2d.Scene()
    assert scene.add([(0, 0), (1, 0), (1, 1)]) == range(0, 2)
    assert scene.add([(5, 5), (6, 5)], sides="both") == range(2, 4)


def test_bands_are_arrays():
    scene = hr2d.Scene(background=np.array([.1, .2]))
    scene.add(np.array([[0, 0], [1, 0]], dtype=np.float32), emission=np.array([1, 2]),
              reflectance=(.5, .25))
    assert scene.bands == 2 and scene.emission.tolist() == [[1, 2]]
    assert scene.background.tolist() == [.1, .2]


def test_numbers_keep_all_digits():
    scene, third = hr2d.Scene(), 1 / 3
    scene.add([(third, 0), (1e-300, 7 * third)])
    assert scene.segments[0].tolist() == [[third, 0], [1e-300, 7 * third]]


def test_geojson_and_shapely():
    square = {"type": "Polygon", "coordinates": [[(0, 0), (4, 0), (4, 3), (0, 3), (0, 0)]]}

    class Shape:
        """As an object of shapely."""

        __geo_interface__ = square

    class Ring:
        __geo_interface__ = {"type": "LinearRing", "coordinates": square["coordinates"][0]}

    feature = {"type": "Feature", "properties": {"reflectance": .3, "name": "box"},
               "geometry": square}
    collection = {"type": "FeatureCollection", "features": [feature]}
    parsed, ends = hr2d.Scene(), []
    parsed.add_text(json.dumps(collection))
    for shape in (square, Shape(), Ring(), feature, collection, parsed):
        scene = shape if shape is parsed else hr2d.Scene()
        if scene is not parsed:
            scene.add(shape)
        ends.append(scene.segments.tolist())
    assert all(end == ends[0] for end in ends) and len(ends[0]) == 4
    assert parsed.reflectance[:, 0].tolist() == [.3] * 4
    outside = hr2d.Scene()
    outside.add(feature, faces="out", reflectance=.9)
    assert outside.segments[0].tolist() != ends[0][0] and outside.names[0] == "box/1"
    assert outside.reflectance[:, 0].tolist() == [.9] * 4


def test_view_factors_are_those_of_crossed_strings():
    """Unit plates at a distance of 1: crossed minus uncrossed strings, √2 − 1."""
    F = make_plates().factors()
    assert F == pytest.approx(np.array([[0, 1], [1, 0]]) * (2 ** .5 - 1), rel=4e-15)
    assert hr2d.exchange_area([(0, 0), (1, 0)], [(1, 1), (0, 1)]) == F[0, 1]
    screen = [(-5, .5), (.5, .5)]
    # One of the crossed strings, and the left one of the others, bend around the end (½, ½).
    past = hr2d.exchange_area([(0, 0), (1, 0)], [(1, 1), (0, 1)], [screen])
    crossed, uncrossed = 2 * 2 ** .5, 1 + 2 * .5 ** .5
    assert past == pytest.approx((crossed - uncrossed) / 2, rel=1e-14)


def test_rows_of_a_closed_room_sum_to_one():
    scene = hr2d.Scene()
    scene.add({"type": "Polygon", "coordinates": [[(0, 0), (4, 0), (4, 3), (1, 5), (0, 0)]]})
    F = scene.factors()
    assert F.sum(axis=1) == pytest.approx(np.ones(4), abs=1e-13)
    A = scene.exchange_areas()
    assert np.array_equal(A, A.T) and np.array_equal(F, A / scene.lengths[:, None])


def test_sparse_factors_are_the_dense_ones_and_no_copy(room):
    pytest.importorskip("scipy")
    areas = room.exchange_areas(sparse=True)
    assert np.array_equal(areas.toarray(), room.exchange_areas())
    assert not areas.data.flags.owndata and not areas.data.flags.writeable
    F = room.factors(sparse=True, threads=2)
    assert np.array_equal(F.toarray(), room.factors()) and F.nnz < 49
    rows = areas.data
    del areas
    assert rows.sum() == pytest.approx(room.exchange_areas().sum())


def test_crossings_are_cut():
    scene = hr2d.Scene()
    scene.add([(0, 0), (1, 1)], name="x")
    scene.add([(0, 1), (1, 0)], name="y")
    with pytest.raises(hr2d.SceneError, match='"x".*"y"|cross'):
        scene.factors()
    assert scene.split_crossings() == 1 and len(scene) == 4
    assert scene.factors().shape == (4, 4)


@pytest.mark.parametrize("kind, message, make", [
    (hr2d.SceneError, "no length", lambda: hr2d.Scene().add([(0, 0), (0, 0)])),
    (hr2d.SceneError, 'lamp.*reflectance.*not 2',
     lambda: hr2d.Scene().add([(0, 0), (1, 0)], reflectance=2, name="lamp")),
    (hr2d.SceneError, "lamp: .*not finite",
     lambda: hr2d.Scene().add([(0, 0), (np.nan, 0)], name="lamp")),
    (hr2d.SceneError, "no patches", lambda: hr2d.Scene().solve()),
    (hr2d.FormatError, "line 1", lambda: hr2d.Scene().add_text("{")),
    (hr2d.FileError, "no-such-file: cannot open", lambda: hr2d.read("no-such-file")),
    (OSError, "no-such-file", lambda: hr2d.read("no-such-file")),
    (ValueError, "two points", lambda: hr2d.Scene().add([1, 2, 3])),
    (hr2d.SceneError, "background", lambda: hr2d.Scene(background=-1)),
])
def test_failures_are_exceptions_with_the_message(kind, message, make):
    with pytest.raises(kind, match=message) as caught:
        make()
    assert isinstance(caught.value, (hr2d.Error, ValueError))


def test_a_failed_add_leaves_the_scene_as_it_was(room):
    with pytest.raises(hr2d.SceneError):
        room.add([(0, 5), (1, 5), (1, 5)])
    assert len(room) == 7
    room.commit()
    with pytest.raises(hr2d.StateError, match="committed"):
        room.add([(9, 9), (9, 8)])


def test_indices_and_names_are_checked(room):
    s = room.solve()
    for wrong, kind in ((7, IndexError), (-1, IndexError), ("tabel", KeyError)):
        with pytest.raises(kind):
            s.at(wrong, .5)
    with pytest.raises(ValueError):
        s.at(0, 1.5)
    with pytest.raises(ValueError):
        s.at(0, np.nan)


def test_readers_wait_for_a_change_in_another_thread():
    import sys
    import threading
    scene, interval = hr2d.Scene(), sys.getswitchinterval()
    line = np.array([[i, i * i % 7 + .5 * i] for i in range(3000)], dtype=float)
    scene.add(line)

    def change():
        for k in range(40):
            scene.add(line + [0, 10 * k + 5.])

    sys.setswitchinterval(1e-6)
    try:
        changer = threading.Thread(target=change)
        changer.start()
        while changer.is_alive():
            segments, lengths, names = scene.segments, scene.lengths, scene.names
            assert np.isfinite(segments).all() and (lengths > 0).all()
            assert len(segments) % 2999 == 0 and None not in names
        changer.join()
    finally:
        sys.setswitchinterval(interval)
    assert len(scene) == 41 * 2999
