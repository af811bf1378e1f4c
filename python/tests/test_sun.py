# SPDX-License-Identifier: GPL-3.0-or-later
import datetime

import numpy as np
import pytest

import hr2d
import hr2d.sun

UTC = datetime.timezone.utc

# By the algorithm of Reda and Andreas, in the implementation of pvlib 0.13: time, latitude,
# longitude; azimuth, elevation without and with refraction at 1010 hPa and 10 degrees Celsius.
TABLE = [
    ("1959-06-10T04:34:30", 50.2, 71.05, 116.1679, 48.6233, 48.6382),
    ("2028-02-04T08:59:36", 66.59, 94.01, 223.1575, 0.5518, 0.9624),
    ("2022-02-16T18:16:31", -6.95, -46.51, 259.6714, 46.2309, 46.2470),
    ("2029-12-05T06:27:40", 20.14, 116.19, 220.9884, 35.1553, 35.1792),
    ("2005-03-24T22:36:40", 7.64, -157.03, 185.9084, 84.0709, 84.0726),
    ("1994-10-30T02:02:56", 18.43, 92.91, 118.1885, 29.2920, 29.3219),
    ("2020-12-20T07:18:52", 55.04, 100.22, 208.0098, 7.2966, 7.4157),
    ("1985-03-13T01:02:06", -4.66, -164.23, 272.2076, 61.1338, 61.1431),
    ("2005-09-07T07:30:31", 34.27, 168.3, 281.4372, -5.9705, -5.9705),
    ("1965-04-29T22:13:48", -18.14, -10.96, 269.8649, -54.5543, -54.5543),
    ("2030-02-17T10:06:44", -3.4, -98.31, 107.9999, -38.1126, -38.1126),
    ("1969-09-02T11:34:14", -8.8, 119.76, 274.7479, -24.1922, -24.1922),
    ("2013-04-25T00:19:54", 46.52, 109.72, 99.2784, 26.7813, 26.8146),
    ("2020-05-21T10:18:38", -29.63, 65.7, 316.4905, 26.2066, 26.2406),
]


def unit(azimuth, elevation):
    a, e = np.radians(azimuth), np.radians(elevation)
    return np.stack([np.cos(e) * np.sin(a), np.cos(e) * np.cos(a), np.sin(e)], axis=-1)


def degrees_between(one, other):
    return np.degrees(2 * np.arcsin(np.linalg.norm(one - other, axis=-1) / 2))


def test_the_example_of_the_solar_position_algorithm():
    # Reda and Andreas, table A5.1: Golden, Colorado, 820 mbar, 11 degrees Celsius.
    zone = datetime.timezone(datetime.timedelta(hours=-7))
    time = datetime.datetime(2003, 10, 17, 12, 30, 30, tzinfo=zone)
    stands = hr2d.sun.position(time, 39.742476, -105.1786, pressure=820, temperature=11)
    assert abs(stands.azimuth - 194.34024) < .01
    assert abs(90 - stands.elevation - 50.11162) < .01
    assert abs(hr2d.sun.position(time, 39.742476, -105.1786).elevation - 39.872046) < .01


def test_positions_are_within_a_hundredth_of_a_degree():
    times = np.array([row[0] for row in TABLE], "datetime64[s]")
    latitude, longitude, azimuth, bare, lifted = (np.array([row[k] for row in TABLE])
                                                 for k in range(1, 6))
    found = hr2d.sun.position(times, latitude, longitude)
    assert degrees_between(unit(*found), unit(azimuth, bare)).max() < .006
    air = hr2d.sun.position(times, latitude, longitude, pressure=1010)
    assert np.abs(air.elevation - lifted).max() < .01
    # Half a minute of time is seen, and so are degrees to the west.
    late = hr2d.sun.position(times + np.timedelta64(30, "s"), latitude, longitude)
    assert degrees_between(unit(*late), unit(azimuth, bare)).min() > .05
    assert degrees_between(unit(*hr2d.sun.position(times, latitude, -longitude)),
                           unit(azimuth, bare)).max() > 10


def test_times():
    noon = datetime.datetime(2024, 6, 20, 12, tzinfo=UTC)
    one = hr2d.sun.position(noon, 50, 8)
    assert np.shape(one.azimuth) == ()
    same = hr2d.sun.position([[noon], [noon]], 50, 8)
    assert same.azimuth.shape == (2, 1) and np.all(same.azimuth == one.azimuth)
    assert hr2d.sun.position(np.datetime64("2024-06-20T12"), 50, 8) == one
    assert hr2d.sun.position(noon, [40, 50], 8).elevation[1] == one.elevation
    pandas = pytest.importorskip("pandas")
    local = pandas.DatetimeIndex(["2024-06-20 14:00"], tz="Europe/Berlin")
    assert hr2d.sun.position(local, 50, 8).azimuth.tolist() == [one.azimuth]
    with pytest.raises(ValueError, match="zone"):
        hr2d.sun.position(pandas.DatetimeIndex(["2024-06-20 14:00"]), 50, 8)


def test_what_is_no_time():
    with pytest.raises(ValueError, match="zone"):
        hr2d.sun.position(datetime.datetime(2024, 6, 20, 12), 50, 8)
    with pytest.raises(ValueError, match="NaT"):
        hr2d.sun.position(np.datetime64("NaT"), 50, 8)
    with pytest.raises(TypeError, match="no time"):
        hr2d.sun.position("noon", 50, 8)
    with pytest.raises(ValueError, match="latitude"):
        hr2d.sun.position(np.datetime64("2024-06-20T12"), 91, 8)


def test_a_section_has_the_cosine_of_space():
    rng = np.random.default_rng(7)
    azimuth, elevation = rng.uniform(0, 360, 50), rng.uniform(1, 89, 50)
    for right in (180, 35):
        seen = hr2d.sun.section((azimuth, elevation), right)
        assert np.allclose(seen.profile, 90 - np.abs(seen.bearing))
        for tilt in (0, 30, -90):
            # The normal of a plane that is tilted towards +x.
            x, y = np.sin(np.radians(tilt)), np.cos(np.radians(tilt))
            normal = unit(right, 0) * x + np.array([0, 0, 1]) * y
            bearing = np.radians(seen.bearing)
            cosine = seen.part * (np.sin(bearing) * x + np.cos(bearing) * y)
            assert np.allclose(cosine, unit(azimuth, elevation) @ normal, atol=1e-14)


def test_the_profile_angle_is_that_of_textbooks():
    # Duffie and Beckman, example 1.9.1: tan(profile) = tan(elevation) / cos(azimuth - facing).
    seen = hr2d.sun.section((200, 28), right=205)
    assert np.tan(np.radians(seen.profile)) == pytest.approx(
        np.tan(np.radians(28)) / np.cos(np.radians(5)))


def test_a_scene_takes_it():
    times = np.datetime64("2024-03-20T00", "h") + np.arange(24)
    seen = hr2d.sun.section(hr2d.sun.position(times, 50, 8), right=180)
    scene = hr2d.Scene()
    scene.add([(0, 0), (10, 0)], name="ground")
    scene.add([(20, 0), (19, 1)], name="panel")  # its front looks to the north, away from +x
    scene.set_sun(800 * seen.part, bearing=seen.bearing)
    stands = hr2d.sun.position(times, 50, 8)
    above = np.maximum(unit(*stands)[:, 2], 0)
    assert np.allclose(scene.sunlight[0], 800 * above)
    assert (seen.part == 0).sum() >= 11 and (above > 0).sum() >= 11
