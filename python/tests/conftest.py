# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes that several tests use."""
import os

os.environ.setdefault("MPLBACKEND", "Agg")

import numpy as np
import pytest

import hr2d


def make_room():
    """The room of the README."""
    room = hr2d.Scene(background=1.0)
    room.add([(0, 0), (5, 0), (5, 2.8), (0, 2.8), (0, 2.2)], reflectance=.6, name="shell")
    room.add([(0, .9), (0, 0)], reflectance=.6, name="parapet")
    room.add([(1.5, .75), (3, .75)], reflectance=.5, sides="both", name="table")
    return room


def make_plates(reflectance=.5):
    """A lit floor and a ceiling, both of length 1, at a distance of 1."""
    scene = hr2d.Scene()
    scene.add([(0, 0), (1, 0)], emission=1, reflectance=reflectance, name="floor")
    scene.add([(1, 1), (0, 1)], reflectance=reflectance, name="ceiling")
    return scene


@pytest.fixture
def room():
    return make_room()


@pytest.fixture
def plates():
    return make_plates()


class Plates:
    """B and H of the plates by Nyström's method: G = 1/(2r³) with r² = 1 + (x − y)²."""

    def __init__(self, rho=.5, points=40):
        x, w = np.polynomial.legendre.leggauss(points)
        self.x, self.w = (x + 1) / 2, w / 2
        K = self.kernel(self.x)
        one = np.eye(points)
        equation = np.block([[one, -rho * K], [-rho * K, one]])
        right = np.concatenate([np.ones(points), np.zeros(points)])
        self.floor, self.ceiling = np.split(np.linalg.solve(equation, right), 2)

    def kernel(self, at):
        return self.w / (2 * (1 + (np.asarray(at)[:, None] - self.x) ** 2) ** 1.5)

    def averages(self):
        return np.array([self.w @ self.floor, self.w @ self.ceiling])

    def ceiling_irradiance(self, at):
        """H at abscissae of the ceiling."""
        return self.kernel(at) @ self.floor


@pytest.fixture(scope="session")
def exact():
    return Plates()
