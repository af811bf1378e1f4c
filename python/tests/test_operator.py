# SPDX-License-Identifier: GPL-3.0-or-later
import numpy as np
import pytest

import hr2d


def test_the_light_of_the_scene_is_that_of_solve(room):
    op = room.operator(error=1e-6)
    s, is_ = op.solve(), room.solve(error=1e-6)
    assert np.allclose(s.B, is_.B, rtol=4e-6) and s.account.reached
    assert op.account.average.bound > 0


def test_other_light_is_that_of_a_scene_with_it(plates):
    op = plates.operator(error=1e-8)
    s = op.solve(emission=[0, 2], reflectance=[.2, .7])
    other = hr2d.Scene()
    other.add([(0, 0), (1, 0)], reflectance=.2)
    other.add([(1, 1), (0, 1)], emission=2, reflectance=.7)
    is_ = other.solve(error=1e-10)
    assert np.allclose(s.B, is_.B, rtol=s.account.average.bound + 1e-10)
    assert not np.allclose(s.B, op.solve().B, rtol=.1)
    # A solution keeps its light: B at a point is E + ρH with its own values.
    at = s.at(1, .25)
    assert np.allclose(at.B, 2 + .7 * at.H)


def test_many_lights_at_once_are_each_of_them_alone(room):
    op = room.operator(error=1e-4)
    r = np.random.default_rng(5)
    emission = r.random((5, len(room), room.bands))
    background = r.random((5, room.bands))
    many = op.solve(emission=emission, background=background, account=False)
    assert many.B.shape == many.H.shape == emission.shape
    for k in range(5):
        one = op.solve(emission=emission[k], background=background[k], account=False)
        assert np.allclose(many.B[k], one.B, rtol=1e-4) and np.allclose(many.H[k], one.H, rtol=1e-4)
    assert not np.isfinite(many.account.average.bound)
    # An array without lights is repeated.
    same = op.solve(emission=emission, background=background[0], account=False)
    assert np.allclose(same.B[0], many.B[0], rtol=1e-4)
    assert not np.allclose(same.B[1], many.B[1], rtol=1e-2)


def test_responses_make_solutions(plates):
    op = plates.operator(error=1e-10)
    response = op.response()[:, :, 0]
    emission = np.array([.3, .8])
    assert np.allclose(response @ emission, op.solve(emission=emission).B[:, 0], rtol=1e-10)
    # Two plates: (I − ρF)⁻¹ of means is near, but not equal to that of the equation.
    f = plates.factors()
    assert np.allclose(response, np.linalg.inv(np.eye(2) - .5 * f), rtol=.02)


def test_gradients_are_limits(plates):
    op = plates.operator(error=1e-10)
    emission, rho = np.array([1., .5]), np.array([.4, .6])

    def J(emission, rho):
        s = op.solve(emission=emission, reflectance=rho, account=False)
        return s.B[1, 0] - 2 * s.H[0, 0]

    s = op.solve(emission=emission, reflectance=rho)
    g = op.gradient(s, B=[0, 1], H=[-2, 0])
    for k in range(2):
        step = np.eye(2)[k] * 1e-4
        assert np.isclose(g.emission[k, 0], (J(emission + step, rho) - J(emission - step, rho)) / 2e-4,
                          atol=1e-8)
        assert np.isclose(g.reflectance[k, 0],
                          (J(emission, rho + step) - J(emission, rho - step)) / 2e-4, atol=1e-7)
    assert np.isnan(g.temperature).all()


def test_a_furnace_heats_up():
    furnace = hr2d.Scene()
    furnace.add([(0, 0), (1, 0)], temperature=300, emissivity=.8)
    furnace.add([(1, 0), (1, 1), (0, 1), (0, 0)], temperature=1000, emissivity=.9)
    op = furnace.operator(error=1e-6)
    kelvin = np.array([300., 1000, 1000, 1000])
    for _ in range(400):
        s = op.solve(temperature=kelvin, account=False)
        kelvin[0] -= s.net_flux[0, 0] / 2000  # a load of 2000 J/(m² K), steps of a second
    assert abs(kelvin[0] - 1000) < 5
    assert s.temperatures.kelvin[0] == pytest.approx(kelvin[0], abs=1)


def test_what_is_not_valid_is_told(plates):
    op = plates.operator(error=1e-2)
    with pytest.raises(hr2d.InvalidArgument, match="emission of floor|emission of patch 0"):
        op.solve(emission=[-1, 0])
    with pytest.raises(ValueError, match="reflectance ends with"):
        op.solve(reflectance=[.1, .2, .3])
    with pytest.raises(ValueError, match="numbers of lights differ"):
        op.solve(emission=np.ones((2, 2, 1)), reflectance=np.full((3, 2, 1), .5))
    with pytest.raises(hr2d.InvalidArgument, match="no sun"):
        op.solve(sun=[1])
