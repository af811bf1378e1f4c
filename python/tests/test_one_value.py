# SPDX-License-Identifier: GPL-3.0-or-later
"""One value, and all ways in which it can be asked for, beside closed forms; the program, where
the tests have it, says the same."""
import json
import os
import subprocess

import numpy as np
import pytest

import hr2d

PROGRAM = os.environ.get("HR2D_PROGRAM")


def line(name, points, **properties):
    return {"type": "Feature", "properties": {"name": name, **properties},
            "geometry": {"type": "LineString", "coordinates": points}}


def collection(features, **members):
    return json.dumps({"type": "FeatureCollection", "hr2d": members, "features": features})


def solved(text, error):
    scene = hr2d.Scene()
    scene.add_text(text)
    return scene.commit().solve(error=error)


def program(text, error, place, tmp_path):
    (tmp_path / "scene").write_text(text)
    subprocess.run([PROGRAM, "solve", tmp_path / "scene", "--target-error", repr(error), "--at",
                    place, "--json", tmp_path / "json", "--quiet"], check=True)
    return json.loads((tmp_path / "json").read_text())


def check_program(text, error, place, s, tmp_path):
    if not PROGRAM:
        return
    patch, t = place.split(":")
    said, points = program(text, error, place, tmp_path), s.at(patch, float(t))
    assert said["at"][0]["value"] == points.B.tolist()
    assert said["at"][0]["irradiance"] == points.H.tolist()
    assert [p["average"] for p in said["patches"]] == s.B.tolist()
    assert [p["irradiance"] for p in said["patches"]] == s.H.tolist()


@pytest.mark.parametrize("tilt, length, height, pitch", [
    (30, 2, 2, 5), (15, 1.7, .5, 3), (60, 1, .1, 1.2), (85, 2, .5, 9)])
def test_panels_in_a_period(tilt, length, height, pitch, tmp_path):
    # A point of a panel sees the sky above the top of the row before, at the angle ψ above the
    # horizon: H = ½(1 + cos(tilt + ψ)).
    u = length * np.exp(1j * np.radians(tilt))
    text = collection([line("panel", [[0, height], [u.real, height + u.imag]], sides="both"),
                       line("ground", [[0, 0], [pitch, 0]])], period=[pitch, 0], background=1)
    t = np.array([.05, .15, .5, .9])
    psi = np.arctan2((1 - t) * u.imag, pitch - (1 - t) * u.real)
    right = (1 + np.cos(np.radians(tilt) + psi)) / 2
    s = solved(text, 1e-4)
    assert s.at("panel", t).H[:, 0] == pytest.approx(right, abs=1e-11)
    # Black as the panel is, the light that passes the points close above it is its H.
    n = np.array([-u.imag, u.real]) / length
    places = np.outer([u.real, u.imag], t) + [[0], [height]] + 1e-12 * n[:, None]
    assert s.field(places).flux[:, 0] @ n == pytest.approx(right, abs=1e-9)
    check_program(text, 1e-4, "panel:0.15", s, tmp_path)


def test_a_lamp_in_endless_plates(tmp_path):
    # 0.3673092 is the sum of the Fourier series.
    text = collection([line("lamp", [[0, 0], [.5, 0]], emission=1, reflectance=.5),
                       line("floor", [[.5, 0], [1, 0]], reflectance=.5),
                       line("ceiling", [[1, .5], [0, .5]], reflectance=.5)], period=[1, 0])
    s = solved(text, 1e-4)
    assert s.at("ceiling", .75).B == pytest.approx(.3673092, abs=1e-6)
    check_program(text, 1e-4, "ceiling:0.75", s, tmp_path)


def test_mirrors_beside_a_plate(tmp_path):
    # A plate above black ground between mirrors is a row of plates, each 2 long in 5: the ground
    # sees the sky but the plates.
    mirrors = [{"type": "Feature", "properties": {"sides": "mirror"}, "geometry": {
        "type": "LineString", "coordinates": [[x, 0], [x, 1.5]]}} for x in (0, 2.5)]
    text = collection([line("ground", [[0, 0], [2.5, 0]]),
                       line("plate", [[0, 1.5], [1, 1.5]], sides="both"), *mirrors],
                      background=1)
    x, k = np.array([.5, 1.25, 2]), np.arange(-20000, 20001)[:, None]
    sine = lambda end: (end - x) / np.hypot(end - x, 1.5)
    right = 1 - (sine(5 * k + 1) - sine(5 * k - 1)).sum(0) / 2
    s = solved(text, 1e-6)
    assert s.at("ground", x / 2.5).H[:, 0] == pytest.approx(right, abs=2e-8)
    check_program(text, 1e-6, "ground:0.5", s, tmp_path)
