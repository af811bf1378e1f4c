# SPDX-License-Identifier: GPL-3.0-or-later
import math

import numpy as np
import pytest

import hr2d


def size(batch):
    return np.maximum(batch.first["length"], batch.second["length"]) / batch.distance


def covered(links, scene):
    """The part of the rectangle of two patches that the tiles of links cover."""
    return links.lengths.prod(axis=1).sum() / scene.lengths.prod()


def test_links_are_tiles_of_the_rectangle(plates):
    links = plates.refine(epsilon=.1, policy="modified")
    assert len(links) == links.L == len(links.pairs) and not links.directed
    assert links.N == len(links.elements) and links.epsilon == .1
    assert covered(links, plates) == pytest.approx(1, abs=1e-14)
    assert (links.lengths == np.ldexp(1.0, -links.levels)).all()
    # A point of the rectangle is in one tile.
    at = np.array([.3, .81])[links.patches]
    hit = ((links.intervals[..., 0] <= at) & (at < links.intervals[..., 1])).all(axis=1)
    assert hit.sum() == 1
    fewer = hr2d.Links.__new__(hr2d.Links)
    fewer.__dict__.update(links.__dict__, _links=links._links[1:])
    for name in ("patches", "lengths", "levels", "intervals", "kernel"):
        fewer.__dict__.pop(name, None)
    assert covered(fewer, plates) < 1 - 1e-6  # a tile that is missing would be seen


def test_the_kernel_is_that_of_the_middle(plates):
    links = plates.refine(epsilon=.05)
    middle = links.intervals.mean(axis=2)
    # The ceiling runs back: x of its fraction t is 1 - t.
    x = np.where(links.patches == 0, middle, 1 - middle)
    r = np.hypot(1, x[:, 0] - x[:, 1])
    assert links.kernel == pytest.approx(1 / (2 * r ** 3), rel=2e-3)
    assert links.exchange_areas.sum() == pytest.approx(math.sqrt(2) - 1, rel=1e-14)


def test_the_matrix_has_both_directions(plates):
    pytest.importorskip("scipy")
    links = plates.refine(epsilon=.2)
    matrix = links.matrix()
    assert matrix.shape == (links.N, links.N) and matrix.nnz == 2 * links.L
    assert abs(matrix - matrix.T).max() == 0
    one_way = plates.refine(epsilon=.2, ordered=True)
    assert one_way.directed and one_way.L == 2 * links.L
    assert abs(one_way.matrix() - matrix).max() < 1e-15
    assert abs(one_way.matrix() - 2 * matrix).max() > 1e-3


def test_study_counts_what_refine_makes(plates):
    epsilon = np.geomspace(1 / 16, 1 / 1024, 7)
    study = plates.study(epsilon)
    assert (study.epsilon == epsilon).all() and len(study) == 7
    for k in (0, 3, 6):
        links = plates.refine(epsilon=epsilon[k])
        assert (study.N[k], study.L[k]) == (links.N, links.L)
    assert (study.leaves == (study.N + 2) // 2).all()
    assert (study.oracle_calls >= study.L).all() and (study.seconds >= 0).all()
    fit = study.fit
    wanted = np.polyfit(study.N.astype(float), study.L.astype(float), 2)[::-1]
    assert (fit.a, fit.b, fit.c) == pytest.approx(wanted, rel=1e-6)
    assert fit(study.N) == pytest.approx(wanted @ study.N[None, :] ** np.arange(3)[:, None])
    assert 1.8 < fit.slope < 2.2 and .9 < fit.r2 <= 1


def test_study_asks_oracles_and_policies_in_python(plates):
    epsilon = [.5, .25, .125]
    own, built_in = plates.study(epsilon, oracle=size), plates.study(epsilon, oracle="size")
    assert (own.L == built_in.L).all() and (own.N == built_in.N).all()
    assert (plates.study(epsilon, oracle=size, policy="modified").L >= own.L).all()
    assert (plates.study(epsilon, oracle="l1").L != own.L).any()

    def fails(batch):
        raise KeyError("mine")

    with pytest.raises(KeyError, match="mine"):
        plates.study(epsilon, oracle=fails)
    with pytest.raises(KeyError, match="mine"):
        plates.refine(oracle=fails)


def test_wrong_arguments_and_limits(plates):
    with pytest.raises(ValueError, match="sequence"):
        plates.study(.5)
    with pytest.raises(hr2d.InvalidArgument):
        plates.study([.5, -1])
    with pytest.raises(hr2d.InvalidArgument):
        plates.study([.5, .5, .5]).fit  # one N only
    with pytest.raises(hr2d.LimitReached):
        plates.study([.5, .01], max_links=100)
    with pytest.raises(hr2d.LimitReached):
        plates.refine(epsilon=.01, max_links=100)
    with pytest.raises(hr2d.Stopped):
        plates.study([1e-3, 1e-4], progress=lambda progress: False)
    assert len(plates.study([])) == 0
    assert len(plates.refine(epsilon=0, max_level=0)) == 1


def test_shadows_have_no_links():
    scene = hr2d.Scene()
    scene.add([(0, 0), (1, 0)], emission=1, name="floor")
    scene.add([(1, 1), (0, 1)], name="ceiling")
    scene.add([(.25, .5), (.75, .5)], sides="both", name="blocker")
    links = scene.refine(epsilon=.05)
    facing = (np.sort(links.patches, axis=1) == [0, 1]).all(axis=1)
    tiles = links.lengths[facing].prod(axis=1).sum()
    # Lines cross y = .5 at the mean of their ends; beside the blocker a quarter of them does.
    assert .25 <= tiles < .27
    middle = links.intervals[facing].mean(axis=2)
    assert not (np.abs(middle - .5) < .1).all(axis=1).any()
