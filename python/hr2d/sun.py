# SPDX-License-Identifier: GPL-3.0-or-later
"""Where the sun stands at a time, and where that is in a section.

    import hr2d, hr2d.sun
    stands = hr2d.sun.position(times, latitude=50.1, longitude=8.7)
    seen = hr2d.sun.section(stands, right=180)  # +x of the section points to the south
    rows.set_sun(seen.part * dni, bearing=seen.bearing)

The sun is that of J. Meeus, Astronomical Algorithms, ch. 25 (geometric longitude, aberration, the
largest term of nutation), with the nine largest terms that planets and the moon make of its
longitude (P. Bretagnon and G. Francou, VSOP87, as in the tables of I. Reda and A. Andreas, Solar
Energy 76(5), 2004, 577-589), and its parallax.  From 1900 to 2100 its direction is within
0.004 degrees of that of Reda and Andreas, who state 0.0003; UTC is up to 0.9 s from UT1, 0.004
degrees more.  So positions are within 0.01 degrees, without refraction.  The sun is 0.53 wide.
"""
from __future__ import annotations

import datetime
from typing import Any, NamedTuple

import numpy as np

from ._arrays import Array

__all__ = ["Position", "Section", "position", "section"]

_NOON_OF_2000 = np.datetime64("2000-01-01T12:00:00", "us")
_TT_OF_UTC = 65 / 86400
"""Days from UTC to terrestrial time: within 35 s from 1900 to 2100 but for .0015 degrees."""

_PERTURBATIONS = np.array([  # 1e-8 rad, phase in rad, rad in a thousand years
    (3497, 2.7441, 5753.3849), (3418, 2.8289, 3.5231), (3136, 3.6277, 77713.7715),
    (2676, 4.4181, 7860.4194), (2343, 6.1352, 3930.2097), (1324, .7425, 11506.7698),
    (1273, 2.0371, 529.691), (1199, 1.1096, 1577.3435), (990, 5.233, 5884.927)])


class Position(NamedTuple):
    """Where the sun stands, in degrees, each of the shape of the times."""

    azimuth: Array
    """Clockwise from the north, in [0, 360)."""
    elevation: Array
    """Above the horizon; negative below it."""


class Section(NamedTuple):
    """The sun of a section, each of the shape of its azimuth."""

    bearing: Array
    """Degrees clockwise from +y, as Scene.set_sun() takes it; 0 where the sun has set."""
    profile: Array
    """The profile angle, the elevation of the sun in the section: 90 - |bearing| degrees."""
    part: Array
    """What the section has of the direct normal irradiance, in [0, 1]; 0 where the sun has set."""


def _in_utc(time: Any) -> np.datetime64:
    if isinstance(time, np.datetime64):
        return np.datetime64(time, "us")
    if not isinstance(time, datetime.datetime):
        raise TypeError(f"{time!r} is no time: times are datetime.datetime with a zone, or "
                        "numpy.datetime64 in UTC")
    if time.utcoffset() is None:
        raise ValueError(f"{time} has no zone: write tzinfo=datetime.timezone.utc, or "
                         "tz_localize() of pandas")
    return np.datetime64(time.astimezone(datetime.timezone.utc).replace(tzinfo=None), "us")


def _days(times: Any) -> Array:
    """Days since noon of 2000-01-01, in UTC."""
    given = np.asarray(times)
    if given.dtype.kind == "M" and hasattr(times, "to_pydatetime"):
        given = np.asarray(times.to_pydatetime(), dtype=object)  # pandas, without a zone
    if given.dtype.kind != "M":
        given = np.array([_in_utc(time) for time in given.ravel()],
                         "datetime64[us]").reshape(given.shape)
    if np.any(np.isnat(given)):
        raise ValueError("a time is missing: it is NaT")
    return np.asarray((given.astype("datetime64[us]") - _NOON_OF_2000) / np.timedelta64(1, "D"))


def _equatorial(days: Array) -> Any:
    """Right ascension and declination, and sidereal time at Greenwich: radians, apparent."""
    t = (days + _TT_OF_UTC) / 36525
    anomaly = np.radians(357.52911 + t * (35999.05029 - .0001537 * t))
    centre = ((1.914602 - t * (.004817 + .000014 * t)) * np.sin(anomaly) +
              (.019993 - .000101 * t) * np.sin(2 * anomaly) + .000289 * np.sin(3 * anomaly))
    node = np.radians(125.04 - 1934.136 * t)
    nutation = -.00478 * np.sin(node)
    size, phase, rate = _PERTURBATIONS.T
    pulled = np.degrees(1e-8 * np.cos(phase + t[..., np.newaxis] / 10 * rate) @ size)
    longitude = np.radians(280.46646 + t * (36000.76983 + .0003032 * t) + centre + pulled +
                           nutation - .00569)
    tilt = np.radians(23.439291 - .0130042 * t + .00256 * np.cos(node))
    ascension = np.arctan2(np.cos(tilt) * np.sin(longitude), np.cos(longitude))
    declination = np.arcsin(np.sin(tilt) * np.sin(longitude))
    sidereal = (280.46061837 + 360.98564736629 * days + .000387933 * t * t +
                nutation * np.cos(tilt))
    return ascension, declination, np.radians(sidereal)


def _refraction(elevation: Array, pressure: float, temperature: float) -> Array:
    """Degrees by which air lifts the sun (Saemundsson, Sky and Telescope 72, 1986, 70); below
    where the limb rises it goes to 0, as nobody sees it there."""
    e = np.maximum(elevation, -1.)
    lift = (pressure / 1010 * 283 / (273 + temperature) * 1.02 /
            (60 * np.tan(np.radians(e + 10.3 / (e + 5.11)))))
    return np.where(elevation < -1, lift * np.maximum(2 + elevation, 0), lift)


def position(times: Any, latitude: Any, longitude: Any, *, pressure: float = 0,
             temperature: float = 10) -> Position:
    """Where the sun stands at times, from a place at a latitude (north is positive) and a
    longitude (east is positive) in degrees, within 0.01 degrees.

    Times are datetime.datetime with a zone, numpy.datetime64 in UTC, or arrays of them, also an
    index of pandas.  With a pressure in hPa, as 1010 at the sea, refraction lifts the sun, for air
    of a temperature in degrees Celsius: 0.02 degrees at 45 degrees, 0.5 at the horizon, where air
    varies by 0.1.

    >>> import datetime, hr2d.sun
    >>> noon = datetime.datetime(2003, 10, 17, 19, 30, 30, tzinfo=datetime.timezone.utc)
    >>> denver = hr2d.sun.position(noon, 39.742476, -105.1786)
    >>> round(float(denver.azimuth), 2), round(float(denver.elevation), 2)
    (194.34, 39.87)
    """
    days, phi = _days(times), np.radians(np.asarray(latitude, np.float64))
    if not np.all(np.abs(phi) <= np.pi / 2):
        raise ValueError("a latitude is from -90 to 90 degrees")
    ascension, declination, sidereal = _equatorial(days)
    hour = sidereal + np.radians(np.asarray(longitude, np.float64)) - ascension
    up = (np.sin(declination) * np.sin(phi) + np.cos(declination) * np.cos(phi) * np.cos(hour))
    east = -np.cos(declination) * np.sin(hour)
    north = (np.sin(declination) * np.cos(phi) - np.cos(declination) * np.sin(phi) * np.cos(hour))
    level = np.hypot(east, north)
    elevation = np.degrees(np.arctan2(up, level)) - 8.794 / 3600 * level
    if pressure:
        elevation = elevation + _refraction(elevation, pressure, temperature)
    return Position(np.degrees(np.arctan2(east, north)) % 360, elevation)


def section(stands: Any, right: float) -> Section:
    """The sun of a section whose +x points to an azimuth, `right`, in degrees clockwise from the
    north, and whose +y points up: rows from east to west, seen towards the east, have 180.

    `stands` is a Position, or an azimuth and an elevation in degrees.  The component along the
    rows changes no irradiance in the section: that of a surface is DNI times `part` times the
    cosine in the section.

    >>> import hr2d.sun
    >>> seen = hr2d.sun.section((180, 30), right=180)
    >>> round(float(seen.bearing), 9), round(float(seen.part), 9)
    (60.0, 1.0)
    """
    azimuth, elevation = (np.radians(np.asarray(angle, np.float64)) for angle in stands)
    across = np.cos(elevation) * np.cos(azimuth - np.radians(right))
    up = np.sin(elevation)
    shines = up > 0
    bearing = np.where(shines, np.degrees(np.arctan2(across, up)), 0.)
    return Section(bearing, np.where(shines, 90 - np.abs(bearing), 0.),
                   np.where(shines, np.hypot(across, up), 0.))
