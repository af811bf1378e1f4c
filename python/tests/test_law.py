# SPDX-License-Identifier: GPL-3.0-or-later
"""The law of N and L, beside its closed form and beside counts."""
import numpy as np
import pytest

import hr2d


def test_the_law_of_parallel_patches_has_a_closed_form(plates):
    law = plates.study_law(policy="modified")
    (links,), (elements, roots) = law.links, law.elements
    assert links.power == 2 and elements.power == 1 and law.period == 2
    assert links.factor == pytest.approx(3 / np.log(2) * (np.pi / 4 - np.log(2) / 2), rel=1e-9)
    assert elements.factor == pytest.approx(4 / np.log(2), rel=1e-9)
    assert roots == (-2, 0, 0)
    assert 0 < links.error < 1e-6


def test_counts_follow_the_law():
    scene = hr2d.Scene()
    scene.add([(0, 0), (1, 0)], emission=1, reflectance=.5)
    scene.add([(1.1, .8), (.1, 1.1)], reflectance=.5)
    law = scene.study_law()
    epsilon = .02 * 2 ** -(np.arange(16) / 16)
    study = scene.study(epsilon)
    assert study.law == law
    mean = np.mean(law.N(epsilon) * epsilon)
    assert np.mean(study.N * epsilon) == pytest.approx(mean, rel=1e-2)
    assert np.mean(study.N * epsilon) != pytest.approx(1.03 * mean, rel=1e-2)
    mean = np.mean(law.L(epsilon) * epsilon ** 2)
    assert np.mean(study.L * epsilon ** 2) == pytest.approx(mean, rel=1e-2)
    # Another policy has another law.
    other = scene.study_law(policy="modified", oracle="size")
    assert other.L(.01) / law.L(.01) > 1.03
    # The square of the oracle changes nothing but the meaning of ε.
    assert scene.study_law(oracle="size2").L(1e-4) == pytest.approx(law.L(1e-2), rel=1e-6)


def test_what_has_no_law_is_told(room):
    with pytest.raises(hr2d.Unsupported, match="shell/1.*touch"):
        room.study_law()
    assert room.study_law(oracle="l1").L(1e-4) > 0
    with pytest.raises(hr2d.Unsupported, match="bf"):
        room.study_law(oracle="bf")
    with pytest.raises(ValueError, match="no policy"):
        room.study_law(policy="mine")


def test_it_can_be_stopped(room):
    with pytest.raises(hr2d.Stopped):
        room.study_law(oracle="l1", progress=lambda now: False)
