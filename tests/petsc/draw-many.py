# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws scenes in a folder whose links are shared out: turned squares and fibres of 16 sides,
each in a cell of its own, two plates, squares, fibres and walls in a room of four walls; with
the epsilon for each."""
import json
import math
import random
import sys


def lines(points, first):
    """The sides of a polygon with fronts outside, of which each sixteenth shines."""
    points = points[::-1]
    return [{"type": "Feature",
             "properties": {"emission": int((first + k) % 16 == 0), "reflectance": 0.5},
             "geometry": {"type": "LineString",
                          "coordinates": [points[k], points[(k + 1) % len(points)]]}}
            for k in range(len(points))]


def polygons(count, corners):
    drawn = []
    source = random.Random(7)
    side = math.ceil(math.sqrt(count))
    for k in range(count):
        radius, turn = 0.1 + 0.2 * source.random(), 7 * source.random()
        x = k % side + radius + (1 - 2 * radius) * source.random()
        y = k // side + radius + (1 - 2 * radius) * source.random()
        drawn += lines([[x + radius * math.cos(turn + 2 * math.pi * c / corners),
                         y + radius * math.sin(turn + 2 * math.pi * c / corners)]
                        for c in range(corners)], len(drawn))
    return drawn


def room(low, high):
    """Four walls that are seen from the inside."""
    corners = [[low, low], [high, low], [high, high], [low, high]]
    return sum((lines([b, a], 1)[:1] for a, b in zip(corners, corners[1:] + corners[:1])), [])


def feature(a, b, **properties):
    return {"type": "Feature", "properties": {"reflectance": 0.5, **properties},
            "geometry": {"type": "LineString", "coordinates": [a, b]}}


def walls(count):
    """Two-sided walls, each anywhere in a cell of its own, in a room of one bright wall."""
    source = random.Random(11)
    side = math.ceil(math.sqrt(count))
    corners = [[0, 0], [1, 0], [1, 1], [0, 1]]
    drawn = [feature(a, b, emission=int(a == [0, 0]))
             for a, b in zip(corners, corners[1:] + corners[:1])]
    for k in range(count):
        at = [(k % side + 0.05 + 0.9 * source.random()) / side if c % 2 == 0 else
              (k // side + 0.05 + 0.9 * source.random()) / side for c in range(4)]
        drawn.append(feature(at[:2], at[2:], sides="both"))
    return drawn


plates = [{"type": "Feature", "properties": {"emission": int(y == 0), "reflectance": 0.5},
           "geometry": {"type": "LineString", "coordinates": [[int(y > 0), y], [int(y == 0), y]]}}
          for y in (0, 0.1)]
for name, features, epsilon in (("squares", polygons(256, 4), 0.5),
                                ("fibres", polygons(100, 16), 0.5), ("plates", plates, 0.01),
                                ("room", room(-1, 17) + polygons(256, 4), 0.5),
                                ("bed", room(-1, 11) + polygons(100, 16), 0.5),
                                ("walls", walls(200), 0.3)):
    with open(f"{sys.argv[1]}/{name}.geojson", "w", encoding="utf-8") as file:
        json.dump({"type": "FeatureCollection", "features": features}, file)
    with open(f"{sys.argv[1]}/{name}.eps", "w", encoding="utf-8") as file:
        print(epsilon, file=file)
