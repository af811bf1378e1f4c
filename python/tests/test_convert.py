# SPDX-License-Identifier: GPL-3.0-or-later
"""Drawings and meshes as scenes.  The files in data/ are written by hand: all are a room of 4 by 3."""
import importlib.metadata
import json
import math
import os
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import hr2d
import hr2d.convert

DATA = Path(__file__).parent / "data"
MODULES = {"dxf": "ezdxf", "svg": "svgelements", "msh": "meshio", "vtk": "meshio", "vtu": "meshio",
           "vtp": "vtkmodules"}
WALLS = ("floor", "east", "ceiling", "west")
CORNERS = [(0, 0), (4, 0), (4, 3), (0, 3)]
MATERIALS = {"floor": {"emission": 1}, "east": {"reflectance": .2}, "ceiling": {"reflectance": .8},
             "west": {"emission": .1, "reflectance": 0}}


def read(path, **options):
    """What a file becomes, and what is said about it."""
    pytest.importorskip(MODULES[str(path).rpartition(".")[2]],
                        reason=f"{path}: its module is not installed")
    said = []
    return hr2d.convert.read(path, report=said.append, **options), said


def parts(found):
    """A list of (name, points) of all lines and rings."""
    result = []
    for feature in found["features"]:
        shape, name = feature["geometry"], feature["properties"]["name"]
        lines = {"LineString": lambda c: [c], "MultiLineString": lambda c: c,
                 "Polygon": lambda c: c, "MultiPolygon": lambda c: [r for p in c for r in p],
                 }[shape["type"]](shape["coordinates"])
        result += [(name, np.array(line)) for line in lines]
    return result


def shoelace(points):
    x, y = np.asarray(points).T
    return float(np.sum(x[:-1] * y[1:] - x[1:] * y[:-1])) / 2


def length(points):
    return float(np.hypot(*np.diff(points, axis=0).T).sum())


def distance(point, line):
    """From a point to a polygonal line."""
    a, d = line[:-1], np.diff(line, axis=0)
    t = np.clip(np.sum((point - a) * d, axis=1) / np.sum(d * d, axis=1), 0, 1)
    return float(np.hypot(*(a + t[:, None] * d - point).T).min())


def farthest(curve, line):
    return max(distance(point, line) for point in curve)


def room():
    """The room without any file."""
    scene = hr2d.Scene()
    for k, name in enumerate(WALLS):
        scene.add([CORNERS[k], CORNERS[(k + 1) % 4]], name=name,
                  **{"reflectance": .5, **MATERIALS[name]})
    return scene


def solved(scene):
    return scene.solve(error=1e-8)


# ---- the same room from each kind of file

@pytest.mark.parametrize("name,options", [
    ("room.dxf", {"scale": .001}), ("room.svg", {"scale": .01}), ("room.msh", {"join": True}),
    ("room-4.1.msh", {"join": True}),
    ("room.vtk", {})])
def test_the_room_has_the_same_light(name, options):
    materials = MATERIALS
    if name == "room.vtk":
        materials = {f"wall {k + 1}": MATERIALS[wall] for k, wall in enumerate(WALLS)}
    found, _ = read(DATA / name, properties={"reflectance": .5}, materials=materials, **options)
    assert [tuple(f["properties"]["name"] for f in found["features"])] == [tuple(materials)]
    scene = hr2d.Scene()
    scene.add(found)
    expected = solved(room())
    assert np.array_equal(scene.segments, room().segments)
    assert np.array_equal(solved(scene).B, expected.B)

    # Fronts that look away from the room see no light of it.
    found, _ = read(DATA / name, properties={"reflectance": .5}, materials=materials, faces="out",
                    **options)
    outside = hr2d.Scene()
    outside.add(found)
    assert not np.allclose(solved(outside).B, expected.B, rtol=.01)


def test_rooms_of_cells_and_of_polygonal_data():
    found, said = read(DATA / "room.vtu")
    (name, ring), = parts(found)
    assert name == "boundary" and said == []
    assert ring.tolist() == [[0, 0], [2, 0], [4, 0], [4, 3], [2, 3], [0, 3], [0, 0]]
    found, _ = read(DATA / "room.vtu", join=True)
    assert parts(found)[0][1].tolist() == [list(c) for c in CORNERS + CORNERS[:1]]
    assert found["features"][0]["properties"] == {"name": "boundary", "faces": "in"}

    found, said = read(DATA / "room.vtp")
    assert [name for name, _ in parts(found)] == ["wall 1", "wall 2"]
    assert parts(found)[1][1].tolist() == [[4, 0], [4, 3], [0, 3], [0, 0]]
    assert said == ["turned: line of a ring (3)"]


def test_what_is_said_about_a_room():
    found, said = read(DATA / "room.dxf", scale=.001)
    assert said == ["skipped: TEXT (1)", "turned: line of a ring (2)"]
    assert [length(line) for _, line in parts(found)] == [4, 3, 4, 3]
    _, said = read(DATA / "room.svg")
    assert said == ["skipped: text (1)", "turned: line of a ring (1)"]
    _, said = read(DATA / "room.msh")
    assert said == []
    with pytest.warns(hr2d.convert.ConvertWarning, match="turned"):
        pytest.importorskip("ezdxf")
        hr2d.convert.read(DATA / "room.dxf")


# ---- DXF

def dxf(path, draw):
    ezdxf = pytest.importorskip("ezdxf")
    drawing = ezdxf.new("R2010")
    drawing.header["$INSUNITS"] = 0
    draw(drawing, drawing.modelspace())
    drawing.saveas(path)
    return path


def on(layer):
    return {"dxfattribs": {"layer": layer}}


def test_arcs_of_dxf_are_within_the_tolerance(tmp_path):
    def draw(drawing, space):
        space.add_arc((1, 2), 3, 30, 300, **on("arc"))
        space.add_circle((20, 0), 2, **on("circle"))
        space.add_lwpolyline([(40, 0, 0), (42, 0, 1), (42, 2, -.3)], format="xyb", close=True,
                             **on("bulges"))
        space.add_ellipse((60, 0), (3, 1), .4, 1, 5, **on("ellipse"))
        space.add_spline([(80, 0), (81, 2), (83, -1), (84, 1)], **on("spline"))

    tolerance = .01
    path = dxf(tmp_path / "arcs.dxf", draw)
    found, said = read(path, tolerance=tolerance)
    lines = dict(parts(found))
    t = np.linspace(0, 1, 500)[:, None]
    turn = np.radians(30 + 270 * t)
    arc = (1, 2) + 3 * np.hstack([np.cos(turn), np.sin(turn)])
    assert .5 * tolerance < farthest(arc, lines["arc"]) <= tolerance * (1 + 1e-9)
    assert lines["arc"][[0, -1]] == pytest.approx(arc[[0, -1]], abs=1e-14)
    most = 4 * math.asin(math.sqrt(tolerance / 3 / 2))
    assert len(lines["arc"]) - 1 == math.ceil(math.radians(270) / most)
    assert farthest(arc, lines["arc"][::2]) > tolerance

    n = len(lines["circle"]) - 1
    assert n == math.ceil(2 * math.pi / (4 * math.asin(math.sqrt(tolerance / 2 / 2))))
    assert shoelace(lines["circle"]) == pytest.approx(n / 2 * 4 * math.sin(2 * math.pi / n), rel=1e-12)
    assert np.hypot(*(lines["circle"] - (20, 0)).T) == pytest.approx(2, rel=1e-14)

    # A half circle to the right of its chord; an arc of the bulge -0.3 back to the start.
    half = (42, 1) + np.hstack([np.sin(np.pi * t), -np.cos(np.pi * t)])
    assert .3 * tolerance < farthest(half, lines["bulges"]) <= tolerance
    for point in ([40, 0], [42, 0], [42, 2]):
        assert point in lines["bulges"].tolist()
    middle = np.array([41, 1]) + .3 * math.sqrt(2) * np.array([1, -1]) / math.sqrt(2)
    assert distance(middle, lines["bulges"]) <= tolerance

    u = 1 + 4 * t
    ellipse = (60, 0) + np.array([3, 1]) * np.cos(u) + .4 * np.array([-1, 3]) * np.sin(u)
    assert .3 * tolerance < farthest(ellipse, lines["ellipse"]) <= tolerance

    ezdxf = pytest.importorskip("ezdxf")
    spline = next(e for e in ezdxf.readfile(path).modelspace() if e.dxftype() == "SPLINE")
    curve = np.array([tuple(p)[:2] for p in spline.construction_tool().approximate(500)])
    assert farthest(curve, lines["spline"]) <= tolerance
    assert said == ["front on the left, as drawn: line that is no part of a ring (3)"]


def test_the_default_tolerance_has_no_unit(tmp_path):
    for radius in (1e-3, 1, 1e6):
        path = dxf(tmp_path / "circle.dxf", lambda d, space: space.add_circle((0, 0), radius))
        assert len(parts(read(path)[0])[0][1]) == 33
    path = dxf(tmp_path / "circle.dxf", lambda d, space: space.add_circle((0, 0), 1))
    with pytest.raises(hr2d.SceneError, match="in units of the drawing"):
        read(path, tolerance=1e-14)
    assert len(parts(read(path, tolerance=10)[0])[0][1]) == 4


def test_blocks_are_taken_apart(tmp_path):
    def draw(drawing, space):
        block = drawing.blocks.new("WINDOW")
        block.add_line((0, 0), (1, 0), **on("0"))
        block.add_line((0, 1), (1, 1), **on("glass"))
        block.add_text("W")
        outer = drawing.blocks.new("PAIR")
        outer.add_blockref("WINDOW", (0, 0), **on("0"))
        outer.add_blockref("PAIR", (0, 0))
        space.add_blockref("NONE", (0, 0))
        space.add_blockref("PAIR", (10, 20), dxfattribs={
            "layer": "south", "rotation": 90, "xscale": 3, "yscale": 2})

    found, said = read(dxf(tmp_path / "blocks.dxf", draw))
    lines = dict(parts(found))
    assert sorted(lines) == ["glass", "south"]
    assert lines["south"] == pytest.approx(np.array([(10, 20), (10, 23)]), abs=1e-12)
    assert lines["glass"] == pytest.approx(np.array([(8, 20), (8, 23)]), abs=1e-12)
    assert said[0] == ("skipped: INSERT without its block (1), TEXT (1), "
                       "INSERT of a block in itself (1)")


def test_what_is_no_line_in_the_plane_is_counted(tmp_path):
    def draw(drawing, space):
        space.add_line((0, 0, 7), (1, 0, 7), **on("flat"))
        space.add_line((0, 0, 0), (1, 0, 5))
        space.add_circle((0, 0), 1, dxfattribs={"extrusion": (1, 0, 0)})
        space.add_text("x")
        space.add_text("y")
        space.add_3dface([(0, 0), (1, 0), (1, 1)])
        space.add_line((3, 3), (3, 3))
        space.add_lwpolyline([(5, 0), (5, 0), (6, 0), (6, 0)], **on("twice"))
        drawing.layers.add("away").off()
        space.add_line((0, 2), (1, 2), **on("away"))
        drawing.layout("Layout1").add_line((0, 0), (1, 1))

    found, said = read(dxf(tmp_path / "space.dxf", draw))
    assert [(name, line.tolist()) for name, line in parts(found)] == [
        ("flat", [[0, 0], [1, 0]]), ("twice", [[5, 0], [6, 0]])]
    assert said == ["skipped: LINE out of the plane (1), CIRCLE out of the plane (1), TEXT (2), "
                    "3DFACE (1), LINE that is not shown (1), entity of paper space (1)",
                    "dropped: line without length (1), repeated point (2)",
                    "front on the left, as drawn: line that is no part of a ring (2)"]


def test_old_polylines(tmp_path):
    """POLYLINE with bulges; the frame of a spline, flag 16, is no part of it; a grid of blocks."""
    def draw(drawing, space):
        line = space.add_polyline2d([(20, 20, 1), (22, 20, 1)], format="xyb", close=True, **on("round"))
        assert line.dxftype() == "POLYLINE"
        fitted = space.add_polyline2d([(0, 0), (9, 9), (1, 1)], **on("fitted"))
        fitted.vertices[1].dxf.flags |= 16
        space.add_polyline3d([(5, 5, 1), (6, 6, 1), (5, 6, 1)], **on("space")).close()
        space.add_polyline3d([(5, 5, 1), (6, 6, 2)])
        drawing.blocks.new("TILE").add_line((0, 0), (.5, 0))
        space.add_blockref("TILE", (0, 30), dxfattribs={
            "layer": "tiles", "column_count": 3, "column_spacing": 2})

    found, said = read(dxf(tmp_path / "old.dxf", draw))
    lines = {}
    for name, line in parts(found):
        lines.setdefault(name, []).append(line)
    assert sorted(lines) == ["fitted", "round", "space", "tiles"]
    assert lines["fitted"][0].tolist() == [[0, 0], [1, 1]]
    assert np.hypot(*(lines["round"][0] - (21, 20)).T) == pytest.approx(1) and len(lines["round"][0]) == 33
    assert [abs(shoelace(line)) for line in lines["space"]] == [.5]
    assert [line.tolist() for line in lines["tiles"]] == [[[x, 30], [x + .5, 30]] for x in (0, 2, 4)]
    assert said[0] == "skipped: POLYLINE out of the plane (1)"


def test_seen_from_behind(tmp_path):
    """An entity whose extrusion is −z is a mirror image."""
    def draw(drawing, space):
        space.add_arc((1, 0), 1, 0, 90, dxfattribs={"extrusion": (0, 0, -1)})

    (_, line), = parts(read(dxf(tmp_path / "behind.dxf", draw))[0])
    assert line[[0, -1]] == pytest.approx(np.array([(-2, 0), (-1, 1)]), abs=1e-14)


def test_units_and_names(tmp_path):
    def draw(drawing, space):
        drawing.header["$INSUNITS"] = 4
        space.add_line((0, 0), (1000, 0), **on("a"))
        space.add_line((0, 1000), (1000, 1000), **on("b"))

    path = dxf(tmp_path / "units.dxf", draw)
    assert read(path)[1][0] == "the unit of the drawing is mm: a scale of 0.001 makes metres"
    found, said = read(path, scale=.001, only=["a"], materials={"b": {"emission": 1}})
    assert [name for name, _ in parts(found)] == ["a"] and parts(found)[0][1].tolist() == [[0, 0], [1, 0]]
    assert said[0] == "left out: b (1)" and said[-1] == "material of 'b': nothing has this name"
    with pytest.raises(hr2d.SceneError, match="nothing is called 'c'; there is a, b"):
        read(path, only=["c"])


# ---- fronts

def test_rings_in_rings(tmp_path):
    """A room with a column, in which there is a shaft: fronts look into the room and the shaft."""
    def draw(drawing, space):
        for k, layer in enumerate(("room", "column", "shaft")):
            ring = [(k, k), (10 - k, k), (10 - k, 10 - k), (k, 10 - k)]
            space.add_lwpolyline(ring[::-1 if k == 1 else 1], close=True, **on(layer))

    path = dxf(tmp_path / "rings.dxf", draw)
    faces = {f["properties"]["name"]: f["properties"]["faces"] for f in read(path)[0]["features"]}
    assert faces == {"room": "in", "column": "out", "shaft": "in"}
    scene = hr2d.Scene()
    scene.add(read(path)[0])
    assert scene.factors().sum(axis=1) == pytest.approx(1)
    faces = {f["properties"]["name"]: f["properties"]["faces"]
             for f in read(path, faces="out")[0]["features"]}
    assert faces == {"room": "out", "column": "in", "shaft": "out"}
    both = read(path, sides="both")[0]["features"][0]
    assert both["properties"] == {"name": "room", "sides": "both"}


def test_one_name_for_rings_of_both_directions(tmp_path):
    def draw(drawing, space):
        space.add_lwpolyline([(0, 0), (4, 0), (4, 4), (0, 4)], close=True, **on("wall"))
        space.add_lwpolyline([(1, 1), (2, 1), (2, 2), (1, 2)], close=True, **on("wall"))

    found, _ = read(dxf(tmp_path / "wall.dxf", draw))
    (_, outer), (_, inner) = parts(found)
    assert found["features"][0]["geometry"]["type"] == "MultiLineString"
    assert shoelace(outer) == 16 and shoelace(inner) == -1
    scene = hr2d.Scene()
    scene.add(found)
    assert list(scene.names) == [f"wall/{k}" for k in range(1, 9)]
    assert scene.factors().sum(axis=1) == pytest.approx(1)


def test_lines_in_no_ring_have_the_front_that_is_drawn(tmp_path):
    def draw(drawing, space):
        space.add_line((0, 0), (1, 0), **on("a"))
        space.add_line((2, 0), (1, 0), **on("a"))
        space.add_line((1, 0), (1, 1), **on("a"))

    path = dxf(tmp_path / "lines.dxf", draw)
    found, said = read(path)
    assert [line.tolist() for _, line in parts(found)] == [
        [[0, 0], [1, 0]], [[2, 0], [1, 0]], [[1, 0], [1, 1]]]
    assert said == ["front on the left, as drawn: line that is no part of a ring (3)"]
    found, said = read(path, front="right")
    assert [line.tolist() for _, line in parts(found)] == [
        [[1, 0], [0, 0]], [[1, 0], [2, 0]], [[1, 1], [1, 0]]]


def test_ends_within_roundings_meet(tmp_path):
    def draw(drawing, space):
        space.add_line((-1, 0), (1, 0), **on("floor"))
        space.add_arc((0, 0), 1, 0, 180, **on("vault"))
        space.add_line((5, 0), (5, 1), **on("near"))
        space.add_line((5, 1.001), (5, 2), **on("near"))

    found, said = read(dxf(tmp_path / "vault.dxf", draw))
    lines = parts(found)
    assert lines[1][1][[0, -1]].tolist() == [[1, 0], [-1, 0]]
    assert said[0] == "moved: end that is within roundings of another one (1)"
    assert len(lines) == 4  # a gap of a thousandth stays one


# ---- SVG

def svg(path, body, root='viewBox="0 0 10 10"'):
    path.write_text(f'<svg xmlns="http://www.w3.org/2000/svg" xmlns:i="http://www.inkscape.org/'
                    f'namespaces/inkscape" {root}>{body}</svg>', encoding="utf-8")
    return path


def test_curves_of_svg_are_within_the_tolerance(tmp_path):
    path = svg(tmp_path / "curves.svg",
               '<path id="cubic" d="M0 0C1 4 5 4 6 0"/><path id="quadratic" d="M0 0q2 4 4 0"/>'
               '<ellipse id="turned" cx="3" cy="1" rx="2" ry="1" '
               'transform="translate(2 3) rotate(30) scale(1 .5)"/>'
               '<circle id="circle" cx="5" cy="5" r="2"/>')
    tolerance = .004
    lines = dict(parts(read(path, tolerance=tolerance)[0]))
    t = np.linspace(0, 1, 400)[:, None]
    down = np.array([1, -1])

    def bezier(corners):
        n = len(corners) - 1
        sums = sum(math.comb(n, k) * t ** k * (1 - t) ** (n - k) * np.array(p, float)
                   for k, p in enumerate(corners))
        return sums * down + (0, 10)

    cubic, quadratic = bezier([(0, 0), (1, 4), (5, 4), (6, 0)]), bezier([(0, 0), (2, 4), (4, 0)])
    assert .3 * tolerance < farthest(cubic, lines["cubic"]) <= tolerance
    assert .3 * tolerance < farthest(quadratic, lines["quadratic"]) <= tolerance
    assert farthest(quadratic, lines["quadratic"][::2]) > tolerance  # it would be noticed

    u = 2 * np.pi * t
    x, y = 3 + 2 * np.cos(u), .5 * (1 + np.sin(u))
    c, s = math.cos(math.radians(30)), math.sin(math.radians(30))
    turned = np.hstack([2 + c * x - s * y, 10 - (3 + s * x + c * y)])
    assert .3 * tolerance < farthest(turned, lines["turned"]) <= tolerance * (1 + 1e-6)
    assert np.hypot(*(lines["circle"] - (5, 5)).T) == pytest.approx(2, rel=1e-12)
    n = len(lines["circle"]) - 1
    assert shoelace(lines["circle"]) == pytest.approx(n / 2 * 4 * math.sin(2 * math.pi / n), rel=1e-9)


def test_shapes_names_and_transforms_of_svg(tmp_path):
    path = svg(tmp_path / "shapes.svg", '''
      <style>.gone { display: none }</style>
      <defs><rect id="box" width="1" height="1"/><rect id="unused" width="9" height="9"/></defs>
      <g id="g1" i:label="walls" transform="translate(1 2)">
        <rect x="1" y="1" width="2" height="3"/>
        <polygon class="wall" points="5,5 6,5 6,6"/>
        <path id="two" d="M0 0h1v1zm3 0h1v1z"/>
        <path id="straight" d="M0 5L1 5Z"/>
      </g>
      <use href="#box" x="7"/><use href="#later"/>
      <line class="gone" x1="0" y1="0" x2="1" y2="1"/>
      <line visibility="hidden" x1="0" y1="0" x2="1" y2="1"/>
      <clipPath id="clip"><rect width="8" height="8"/></clipPath>
      <symbol id="s"><rect width="8" height="8"/></symbol><image href="x.png"/>''')
    found, said = read(path)
    lines = parts(found)
    assert [name for name, _ in lines] == ["walls", "wall", "two", "two", "straight", "box"]
    assert lines[0][1].min(axis=0).tolist() == [2, 4] and lines[0][1].max(axis=0).tolist() == [4, 7]
    assert abs(shoelace(lines[0][1])) == 6 and abs(shoelace(lines[1][1])) == .5
    assert lines[2][1].mean(axis=0)[0] < 2.5 and lines[3][1].min(axis=0).tolist() == [4, 7]
    assert lines[4][1].tolist() == [[1, 3], [2, 3]]
    assert lines[5][1].min(axis=0).tolist() == [7, 9]
    assert said[0] == ("skipped: use of what is not above it (1), symbol (1), image (1), "
                       "line that is not shown (1), rect of definitions (1), line not shown or without size (1)")
    assert said[1] == "dropped: way back of a ring of two points (1)"
    names = [name for name, _ in parts(read(path, names="group")[0])]
    assert names == ["walls", "walls", "walls", "walls", "walls", "box"]


def test_user_units_of_svg(tmp_path):
    """Sizes of the page are no part of coordinates; y is 0 at its lower edge."""
    line = '<line id="a" x1="1" y1="1" x2="5" y2="1"/>'
    for root, y in (('viewBox="0 0 10 10" width="210mm" height="297mm"', 9),
                    ('viewBox="-5 -5 10 10"', 4), ('width="20" height="8"', 7), ('', -1)):
        (_, points), = parts(read(svg(tmp_path / "units.svg", line, root))[0])
        assert points.tolist() == [[1, y], [5, y]]


def test_wrong_svg_is_refused(tmp_path):
    for body, message in (('<path id="p" d="M0 0 L 1 x"/>', "path p: no path data"),
                          ('<path id="p" d="M0 0 L 1"/>', "path p: L of a path has 1 numbers"),
                          ('<path id="p" d="M0 0 L nan 1"/>', "path p: no path data"),
                          ('<path id="p" d="M0 0 L 1e999 1"/>', "path p: point 2: .* not finite"),
                          ('<rect id="r" width="nan" height="1"/>', "rect r: width is no finite"),
                          ('<polygon id="q" points="0,0 1,0 1"/>', "polygon q: points are no pairs"),
                          ('<g id="a"><path d="M0 0h1"/><use href="#a"/></g>', "use of a: it is in"),
                          ("<g>" * 2000 + "</g>" * 2000, "nested too deep"),
                          ('<line id="l0" x2="1"/>' + "".join(
                              f'<g id="l{k + 1}">' + f'<use href="#l{k}"/>' * 9 + "</g>"
                              for k in range(9)), "use of l7: it has 4782969 shapes"),
                          ("<path", "no XML")):
        with pytest.raises((hr2d.FormatError, hr2d.SceneError), match=message):
            read(svg(tmp_path / "wrong.svg", body))
    with pytest.raises(hr2d.SceneError, match="the scene would be empty"):
        read(svg(tmp_path / "empty.svg", "<text>x</text>"))


# ---- meshes

def ring_of_cells():
    """[0, 3]² without its middle, of triangles and quads; the names of meshio's arguments."""
    points = np.array([(x, y, 0) for y in range(4) for x in range(4)], dtype=float)
    quads = [(k, k + 1, k + 5, k + 4) for k in (0, 1, 2, 4, 6, 8, 9, 10)]
    triangles = [(a, b, c) for a, b, c, d in quads[:4]] + [(a, d, c) for a, b, c, d in quads[:4]]
    return points, [("triangle", np.array(triangles)), ("quad", np.array(quads[4:]))]


@pytest.mark.parametrize("end,kind", [("msh", "gmsh22"), ("vtk", "vtk"),
                                      ("vtk", "vtk42"), ("vtu", "vtu")])
def test_the_boundary_of_cells(tmp_path, end, kind):
    meshio = pytest.importorskip("meshio")
    path = tmp_path / f"ring.{end}"
    meshio.write(path, meshio.Mesh(*ring_of_cells()), file_format=kind)
    found, said = read(path)
    rings = sorted((shoelace(line), length(line)) for _, line in parts(found))
    assert rings == [(-1, 4), (9, 12)] and said == []
    assert sorted(len(line) - 1 for _, line in parts(read(path, join=True)[0])) == [4, 4]

    # As a solid, its cavity is what is lit: all that leaves there arrives there.
    scene = hr2d.Scene()
    scene.add(read(path, faces="out")[0])
    rows = scene.factors().sum(axis=1)
    cavity = np.abs(scene.segments - 1.5).max(axis=(1, 2)) < 1
    assert cavity.sum() == 4 and rows[cavity] == pytest.approx(1) and np.all(rows[~cavity] == 0)


def test_regions_and_lines_inside(tmp_path):
    """Two cells of two regions: the line between them is no boundary."""
    meshio = pytest.importorskip("meshio")
    points = np.array([(0, 0, 0), (1, 0, 0), (2, 0, 0), (2, 1, 0), (1, 1, 0), (0, 1, 0)], float)
    quads = np.array([(0, 1, 4, 5), (2, 1, 4, 3)])  # one clockwise
    path = tmp_path / "two.msh"
    tags = {key: [np.array([7, 8])] for key in ("gmsh:physical", "gmsh:geometrical")}
    meshio.write(path, meshio.Mesh(points, [("quad", quads)], cell_data=tags,
                                   field_data={"air": np.array([7, 2])}), file_format="gmsh22")
    lines = dict(parts(read(path)[0]))
    assert {name: length(line) for name, line in lines.items()} == {"air": 3, "physical 8": 3}
    both = lines["air"].tolist() + lines["physical 8"].tolist()
    assert [1, 0] in both and shoelace([p for p in both + both[:1]]) == 2

    tags = {key: [np.array([7, 8]), np.array([5, 6])] for key in tags}
    cells = [("quad", quads), ("line", np.array([(4, 1), (3, 2)]))]
    meshio.write(path, meshio.Mesh(points, cells, cell_data=tags), file_format="gmsh22")
    found, said = read(path)
    lines = dict(parts(found))
    assert lines["physical 5"].tolist() == [[1, 1], [1, 0]]  # as drawn
    assert lines["physical 6"].tolist() == [[2, 0], [2, 1]]  # the cell on its left
    assert said == ["skipped: edge of the boundary that is no line of the mesh (5)",
                    "front on the left, as drawn: line that is no part of a ring (1)"]


def test_curved_cells_run_through_their_nodes(tmp_path):
    meshio = pytest.importorskip("meshio")
    points = [(0, 0, 0), (2, 0, 0), (0, 2, 0), (1, -.5, 0), (1.2, 1.2, 0), (-.5, 1, 0)]
    path = tmp_path / "curved.vtu"
    meshio.write(path, meshio.Mesh(np.array(points), [("triangle6", [range(6)])]))
    (_, ring), = parts(read(path)[0])
    assert ring.tolist() == [list(points[k][:2]) for k in (0, 3, 1, 4, 2, 5, 0)]
    meshio.write(path, meshio.Mesh(np.array(points), [("line3", [(0, 1, 3)]), ("vertex", [[2]])]))
    found, said = read(path)
    assert parts(found)[0][1].tolist() == [[0, 0], [1, -.5], [2, 0]] and said[0] == "skipped: vertex (1)"


def test_tags_of_cells(tmp_path):
    meshio = pytest.importorskip("meshio")
    path = tmp_path / "tags.vtu"
    data = {"a": [np.array([1, 2])], "b": [np.array([3, 3])], "v": [np.zeros((2, 3))]}
    meshio.write(path, meshio.Mesh(np.eye(3) * [1, 1, 0], [("line", [(0, 1), (1, 2)])],
                                   cell_data=data))
    assert [name for name, _ in parts(read(path)[0])] == ["line"]  # of two none is the only one
    assert [name for name, _ in parts(read(path, tags="a")[0])] == ["a 1", "a 2"]
    assert [name for name, _ in parts(read(path, tags="b")[0])] == ["b 3"]
    for tags, message in (("c", "no tags 'c' of cells, but a, b, v"), ("v", "several numbers")):
        with pytest.raises(hr2d.FormatError, match=message):
            read(path, tags=tags)


# ---- what is refused

def test_coordinates_that_are_not_finite(tmp_path):
    for name, old, new, place in (
            ("room.dxf", "4000.0", "nan", r"LINE #\w+ of layer floor: point 2"),
            ("room.dxf", "4000.0", "1e999", r"LINE #\w+ of layer floor: point 2"),
            ("room.vtk", "4 3 0", "4 nan 0", "point 3 of the mesh"),
            ("room.msh", "3 4 3 0", "3 4 inf 0", "point 3 of the mesh"),
            ("room.vtp", "4 3 0", "4 nan 0", "point 3 of the mesh")):
        text = (DATA / name).read_text(encoding="utf-8")
        (tmp_path / name).write_text(text.replace(old, new, 1), encoding="utf-8")
        with pytest.raises(hr2d.SceneError, match=place + ": a coordinate is not finite"):
            read(tmp_path / name)


def test_what_is_no_such_file(tmp_path):
    for end in MODULES:
        wrong = tmp_path / f"wrong.{end}"
        wrong.write_text("nothing of this kind\n", encoding="utf-8")
        with pytest.raises(hr2d.FormatError):
            read(wrong)
        with pytest.raises(OSError):
            read(tmp_path / f"none.{end}")
    for name, old, new, message in (
            ("room.vtu", " 0 1 4 5 ", " 0 1 4 55 ", "a point that is not there"),
            ("room.dxf", "  0\nTEXT", "  0\nTEXAS", None),
            ("room.svg", "UTF-8", "UTF-88", "no XML: unknown encoding"),
            ("room.svg", "2000/svg", "2000/svgs", "svgelements")):
        text = (DATA / name).read_text(encoding="utf-8")
        (tmp_path / name).write_text(text.replace(old, new), encoding="utf-8")
        if message is None:
            assert read(tmp_path / name)[1][0] == "skipped: TEXAS (1)"
        else:
            with pytest.raises(hr2d.FormatError, match=message):
                read(tmp_path / name)
    with pytest.raises(hr2d.FormatError, match="the name ends with none of .dxf, .svg"):
        hr2d.convert.read("room.txt")
    path = tmp_path / "empty.dxf"
    path.write_text("  0\nSECTION\n  2\nENTITIES\n  0\nENDSEC\n  0\nEOF\n", encoding="utf-8")
    with pytest.raises(hr2d.SceneError, match="the scene would be empty"):
        read(path)


def test_wrong_arguments():
    for options in ({"faces": "up"}, {"front": "top"}, {"sides": "none"}, {"names": "colour"},
                    {"format": "step"}, {"scale": 0}, {"scale": math.inf}, {"tolerance": -1},
                    {"tolerance": math.nan}):
        with pytest.raises(ValueError, match=list(options)[0]):
            hr2d.convert.read("room.dxf", **options)


@pytest.mark.parametrize("name,module,package", [
    ("room.dxf", "ezdxf", "python3-ezdxf"), ("room.svg", "svgelements", "python3-svgelements"),
    ("room.msh", "meshio", "python3-meshio"), ("room.vtk", "meshio", "python3-meshio"),
    ("room.vtp", "vtkmodules.vtkIOXML", "python3-vtk9")])
def test_a_missing_module_has_a_name(monkeypatch, name, module, package):
    monkeypatch.setitem(sys.modules, module, None)
    with pytest.raises(ModuleNotFoundError, match=f"{module}: apt install {package}, or pip install"):
        hr2d.convert.read(DATA / name)


# ---- properties and the command

def test_properties_of_a_name_go_before():
    general = {"reflectance": .5, "emission": [1, 2]}
    found, _ = read(DATA / "room.msh", properties=general, materials={
        "floor": {"temperature": 300, "emissivity": .9}, "east": {"emission": 0},
        "west": {"sides": "both"}})
    properties = {f["properties"].pop("name"): f["properties"] for f in found["features"]}
    assert properties == {"floor": {"temperature": 300, "emissivity": .9},
                          "east": {"reflectance": .5, "emission": 0}, "ceiling": general,
                          "west": {**general, "sides": "both"}}


def command(*arguments):
    return subprocess.run([sys.executable, "-m", "hr2d.convert", *map(str, arguments)],
                          capture_output=True, text=True)


def test_the_command(tmp_path):
    pytest.importorskip("svgelements")
    materials, out = tmp_path / "materials.json", tmp_path / "room.geojson"
    materials.write_text(json.dumps(MATERIALS))
    options = ["--scale", ".01", "--reflectance", ".5", "--materials", materials]
    done = command(DATA / "room.svg", *options, "-o", out)
    assert (done.returncode, done.stdout) == (0, "")
    assert done.stderr == (f"hr2d-convert: {DATA}/room.svg: skipped: text (1)\n"
                           f"hr2d-convert: {DATA}/room.svg: turned: line of a ring (1)\n")
    assert np.array_equal(solved(hr2d.read(out)).B, solved(room()).B)
    assert command(DATA / "room.svg", *options).stdout == out.read_text(encoding="utf-8")
    found = json.loads(command(DATA / "room.svg", "--outside", "--emission", "1,2,3", "--join",
                               "--only", "east").stdout)
    assert found["features"][0]["properties"]["emission"] == [1, 2, 3]


def test_the_command_refuses(tmp_path):
    pytest.importorskip("svgelements")
    source, wrong = tmp_path / "room.svg", tmp_path / "wrong.json"
    source.write_bytes((DATA / "room.svg").read_bytes())
    wrong.write_text("[1]")
    for arguments, status, message in (
            ((source, "-o", source), 1, "the output is the input"),
            ((source, "--reflectance", "2"), 1, "reflectance: must be between 0 and 1"),
            ((source, "--materials", wrong), 1, "no object from names to objects"),
            ((tmp_path / "none.svg",), 1, "none.svg: No such file or directory"),
            ((source, "--reflectance", "nan"), 2, "'nan' is not finite"),
            ((source, "--tolerance", "0"), 2, "no number above 0"),
            ((source, "--inside", "--outside"), 2, "not allowed with"), ((), 2, "required: FILE")):
        done = command(*arguments)
        assert (done.returncode, done.stdout) == (status, "") and message in done.stderr, done.stderr
    assert source.read_bytes() == (DATA / "room.svg").read_bytes()


def test_the_manual_page_has_all_options():
    page = Path(os.environ.get("HR2D_SRCDIR", Path(__file__).parents[2])) / "python/hr2d-convert.1"
    if not page.exists():
        pytest.skip("there is no manual page here")
    shown = set(re.findall(r"--[a-z]+", command("--help").stdout))
    told = set(re.findall(r"--[a-z]+", page.read_text(encoding="utf-8").replace("\\-", "-")))
    assert shown - told == set() and told - shown == {"--snap", "--target"}
    assert len(shown) == 21


def test_the_command_has_a_name():
    scripts = importlib.metadata.entry_points()
    scripts = (scripts.select(group="console_scripts") if hasattr(scripts, "select")
               else scripts.get("console_scripts", []))
    found = [script for script in scripts if script.name == "hr2d-convert"]
    if not found:
        pytest.skip("the package is not installed")
    assert found[0].load() is hr2d.convert.main
