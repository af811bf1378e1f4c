# SPDX-License-Identifier: GPL-3.0-or-later
"""Predictions, enclosures, grids, factors of points, states, and other forms of the same data."""
import copy
import json
import math
import pickle
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context

import numpy as np
import pytest

import hr2d
from conftest import make_plates, make_room


def make_hot():
    scene = hr2d.Scene(wavelengths=4, background=[1, 2], sun={"irradiance": 300, "bearing": 20},
                       sky=[(-90, 0, 80), (0, 90, [120, 90])])
    scene.add([(0, 0), (4, 0)], temperature=300, emissivity=[[300, .5], [900, .7]], name="floor")
    scene.add([(4, 0), (4, 1.5), (3, 2)], temperature=350, emissivity=.8, sides="both", name="wall")
    return scene


def make_insulated():
    scene = hr2d.Scene(background_temperature=280)
    scene.add([(0, 0), (4, 0)], flux=100, emissivity=[[300, .5], [900, .7]], name="floor")
    scene.add([(4, 1), (0, 1)], temperature=250, emissivity=.5, name="lid")
    return scene


def make_row():
    scene = hr2d.Scene(background=1)
    scene.set_period(2, 0)
    scene.add([(0, 0), (2, 0)], reflectance=.3, emission=1, name="ground")
    scene.add([(.5, .5), (1.2, 1)], reflectance=.2, sides="both", name="panel")
    return scene


def make_mirrored():
    scene = hr2d.Scene(background=1)
    scene.add([(0, 0), (2, 0), (2, 1)], reflectance=.3, emission=1, name="a")
    scene.add_mirror((0, 0), (0, 1))
    return scene


MAKERS = [make_room, make_plates, make_hot, make_insulated, make_row, make_mirrored]
makers = pytest.mark.parametrize("make", MAKERS)


# Answers

def test_predictions_are_of_the_solve():
    room = make_room()
    told, s = room.predict(error=1e-4), room.solve(error=1e-4, no_error=True)
    assert told.order == s.account.order and told.elements == s.account.elements
    assert 0 < told.least_seconds <= told.seconds <= told.most_seconds
    assert room.predict(error=1e-9).elements > told.elements
    with pytest.raises(hr2d.LimitReached):
        room.predict(error=1e-9, max_elements=10)


def test_without_an_error_the_values_are_there_and_errors_are_not():
    room = make_room()
    s = room.solve(error=1e-4, no_error=True)
    assert math.isinf(s.account.average.bound)
    assert np.allclose(s.B, room.solve(error=1e-8).B, rtol=1e-3)
    assert math.isfinite(room.solve(error=1e-4).account.average.bound)
    with pytest.raises(TypeError, match="epsilon does not go with no_error"):
        room.solve(epsilon=.1, no_error=True)


def test_enclosures_hold_the_solution():
    plates = make_plates()
    ends, s = plates.enclose(1e-2), plates.solve(error=1e-9)
    assert ends.gap <= 1e-2 and ends.links > 0 and ends.reason == ""
    for low, value, high in [(ends.lower, s.B, ends.upper), (ends.lower_H, s.H, ends.upper_H)]:
        assert (low <= value).all() and (value <= high).all() and (high > low).any()
    error, of_h = ends.error(s)
    assert 0 < error < 3e-2 and 0 < of_h < 3e-2
    brighter = make_room().solve()
    with pytest.raises(hr2d.InvalidArgument):
        ends.error(brighter)
    with pytest.warns(hr2d.AccuracyWarning):
        assert plates.enclose(1e-9, max_links=1000).gap > 1e-9
    with pytest.raises(ValueError):
        plates.enclose(-1)


def test_grids_are_the_field_and_within_the_tolerance():
    room = make_room()
    s = room.solve(error=1e-4)
    exact = s.field_on_grid((0, 0, 5, 2.8), (29, 51))
    points = s.field(np.meshgrid(exact.x, exact.y))
    for name in ("mean", "flux", "sky", "place"):
        one, other = getattr(exact, name), getattr(points, name)
        assert np.allclose(one, other, rtol=1e-14, atol=1e-15, equal_nan=True), name
    assert exact.interpolated == 0 and exact.mean.shape == (29, 51, 1)
    about = s.field_on_grid((0, 0, 5, 2.8), (290, 510), tolerance=.02)
    assert about.interpolated > 0
    some = s.field(np.meshgrid(about.x[::17], about.y[::13]))
    span = np.nanmax(some.mean) - np.nanmin(some.mean)
    off = np.nanmax(abs(about.mean[::13, ::17] - some.mean))
    assert 0 < off <= .02 * span
    assert s.field_on_grid(shape=(2, 2)).x.tolist() == [0, 5]
    assert np.isfinite(s.field_on_grid((1, 1, 2, 2), (2, 2), errors=True).error).all()
    with pytest.raises(hr2d.InvalidArgument):
        s.field_on_grid(tolerance=2)


def test_factors_of_points_sum_to_one_and_give_the_light():
    room = make_room()
    x = np.array([[1, 2.2], [4, 4.5]])
    see = room.point_factors((x, .7 + 0 * x), (0, 1))
    assert see.share.shape == see.factor.shape == (2, 2, len(room)) and see.sky.shape == (2, 2)
    assert np.allclose(see.share.sum(axis=-1) + see.sky + see.back, 1, atol=1e-14)
    assert np.allclose(see.factor.sum(axis=-1) + see.sky_factor + see.back_factor, 1, atol=1e-14)
    black = hr2d.Scene(background=1)
    for k, ends in enumerate(room.segments):
        black.add(ends, emission=1 + k)
    s, see = black.solve(), black.point_factors((x, 1 + 0 * x))
    field = s.field((x, 1 + 0 * x))
    assert np.allclose(see.share @ s.B[:, 0] + see.sky, field.mean[..., 0], rtol=1e-12)
    assert see.factor is None
    with pytest.raises(hr2d.InvalidArgument):
        room.point_factors((1, 1), (0, 0))


def test_the_law_of_stefan():
    assert hr2d.black_body(300) == pytest.approx(5.670374419e-8 * 300 ** 4, rel=1e-9)
    assert hr2d.black_body(300, 0, 4) + hr2d.black_body(300, 4) == pytest.approx(hr2d.black_body(300))


def test_temperatures_at_points():
    scene = make_insulated()
    s = scene.solve(error=1e-6)
    t = np.linspace(.1, .9, 5).reshape(1, 5)
    kelvin = s.temperature_at("floor", t)
    assert kelvin.shape == (1, 5) and abs(kelvin.mean() - s.temperatures.kelvin[0]) < 20
    assert np.allclose(s.temperature_at("lid", t), 250)


# Stages

def test_a_state_goes_on_with_the_same_bits():
    room = make_room()
    coarse = room.solve(epsilon=.5)
    for start in (coarse, coarse.state()):
        fine = room.solve(epsilon=.1, start=start)
        direct = room.solve(epsilon=.1)
        assert len(fine.elements) == len(direct.elements)
        assert np.allclose(fine.B, direct.B, rtol=1e-9)
    assert fine.state() == room.solve(epsilon=.1, start=coarse).state()
    with pytest.raises(hr2d.FormatError):
        room.solve(epsilon=.1, start=coarse.state()[:-1])
    with pytest.raises(hr2d.InvalidArgument):
        make_plates().solve(epsilon=.1, start=coarse)
    with pytest.raises(hr2d.Unsupported):
        room.solve(error=1e-3).state()


def test_links_of_a_solution():
    room = make_room()
    s, links = room.solve(epsilon=.1), room.refine(epsilon=.1)
    assert np.array_equal(s.links.pairs, links.pairs) and s.links.N == len(s.elements)
    assert s.links.validate() and links.bytes >= 16 * links.L
    assert s.residual < 1e-9
    of_target = room.solve(error=1e-3).links
    del s
    assert of_target.L == len(of_target.pairs) > 0


# Copies

def same_scene(one, other):
    return (one.names == other.names and np.array_equal(one.segments, other.segments) and
            np.array_equal(one.emission, other.emission, equal_nan=True) and
            np.array_equal(one.reflectance, other.reflectance, equal_nan=True) and
            one.images == other.images and np.array_equal(one.background, other.background))


def test_panes_shields_and_gas_are_written(tmp_path):
    box = [(0, 0), (2, 0), (2, 1), (0, 1), (0, 0)]
    scenes = [hr2d.Scene() for _ in range(4)]
    scenes[0].add(box, emission=.2, reflectance=.5)
    scenes[0].add([(1, 0), (1, 1)], transmittance=.5, reflectance=.2, sides="both",
                  back={"reflectance": .1, "emission": .3}, name="opal")
    scenes[1].add(box, temperature=400, emissivity=.7)
    scenes[1].add([(1, 0), (1, 1)], transmittance=.3, temperature=300, emissivity=.6, sides="both")
    scenes[2].add(box[:3], temperature=900, emissivity=.7)
    scenes[2].add(box[2:], temperature=400, emissivity=.7)
    scenes[2].add([(1, 0), (1, 1)], shield=True, emissivity=.2, sides="both",
                  back={"emissivity": .4})
    scenes[3].add(box, temperature=400, emissivity=.7)
    scenes[3].set_medium(.4, temperature=1200)
    for scene in scenes:
        scene.write(tmp_path / "copy.geojson")
        same = hr2d.read(tmp_path / "copy.geojson")
        assert same.names == scene.names and (same.other_side == scene.other_side).all()
        B = scene.solve(error=1e-6).B
        assert same.solve(error=1e-6).B == pytest.approx(B, rel=1e-12)


@makers
def test_scenes_are_pickled_and_copied(make):
    scene = make()
    for other in (pickle.loads(pickle.dumps(scene)), copy.copy(scene), copy.deepcopy(scene)):
        assert same_scene(scene, other)
        assert np.array_equal(scene.solve(error=1e-4).B, other.solve(error=1e-4).B)


def test_a_copy_is_another_scene():
    scene = make_plates()
    other = copy.copy(scene)
    other.add([(0, .5), (1, .5)], name="more")
    assert len(other) == 3 and len(scene) == 2
    other.commit()
    with pytest.raises(hr2d.StateError):
        pickle.loads(pickle.dumps(other)).add([(2, 2), (3, 3)])
    crossed = hr2d.Scene()
    crossed.add([(0, 0), (2, 2)], name="a")
    crossed.add([(0, 2), (2, 0)], name="b")
    crossed.split_crossings()
    crossed.force("occlusion")
    again = pickle.loads(pickle.dumps(crossed))
    assert again.names == crossed.names and "occlusion" in again.effects


@makers
@pytest.mark.parametrize("how", [{"error": 1e-4}, {"epsilon": .2}, {"epsilon": .3, "order": 3}])
def test_solutions_are_pickled(make, how):
    scene = make()
    s = scene.solve(points="error" in how, **how)
    other = pickle.loads(pickle.dumps(s))
    for name in ("B", "H", "net_flux", "power", "element_B", "account", "residual"):
        assert np.array_equal(getattr(s, name), getattr(other, name)), name
    assert np.array_equal(s.elements["child"], other.elements["child"])
    t = np.linspace(.05, .95, 7)
    for gather in (True, False):
        ours, theirs = s.at(0, t, gather=gather), other.at(0, t, gather=gather)
        assert np.allclose(ours.B, theirs.B, rtol=1e-10)
    points = np.array([[1.1, 1.6], [.7, .8]])
    assert np.allclose(s.field(points).mean, other.field(points).mean, rtol=1e-10, equal_nan=True)
    if scene._has_heat():
        assert np.array_equal(s.temperatures.kelvin, other.temperatures.kelvin, equal_nan=True)
    again = pickle.loads(pickle.dumps(other))
    assert np.array_equal(again.B, s.B) and copy.copy(s) is s
    with pytest.raises(hr2d.Unsupported):
        other.state()


def test_a_solution_of_an_operator_is_not_pickled():
    op = make_plates().operator(error=1e-4)
    with pytest.raises(hr2d.Unsupported):
        pickle.dumps(op.solve(emission=[1, 2]))


def solve_there(scene, reflectance):
    scene = copy.copy(scene)
    scene.add([(2, 0), (2, 1)], reflectance=reflectance, name="side")
    return scene.solve(error=1e-4)


def test_processes():
    """Each has a scene and gives a solution."""
    scene, values = make_plates(), [.1, .5, .9]
    with ProcessPoolExecutor(2, mp_context=get_context("spawn")) as pool:
        found = list(pool.map(solve_there, [scene] * 3, values))
    for s, value in zip(found, values):
        assert np.array_equal(s.B, solve_there(scene, value).B)
        assert s.at("side", [.5]).B.shape == (1, 1)


def test_joblib():
    joblib = pytest.importorskip("joblib")
    scene, values = make_plates(), [.1, .9]
    found = joblib.Parallel(n_jobs=2)(joblib.delayed(solve_there)(scene, v) for v in values)
    assert [s.B[0, 0] for s in found] == [solve_there(scene, v).B[0, 0] for v in values]


# Other forms

@makers
def test_geojson_is_the_scene(make, tmp_path):
    scene = make()
    path = tmp_path / "scene.geojson"
    scene.write(path)
    other = hr2d.read(path)
    assert same_scene(scene, other)
    assert np.array_equal(scene.solve(error=1e-4).B, other.solve(error=1e-4).B)
    collection = json.loads(json.dumps(scene.to_geojson()))
    assert json.loads(path.read_text()) == collection
    assert len(collection["features"]) == len(scene) + len(scene.mirrors)
    third = hr2d.Scene()
    third.add_text(json.dumps(collection))
    assert same_scene(scene, third)


def test_geojson_is_what_the_schema_says():
    jsonschema = pytest.importorskip("jsonschema")
    import os
    folder = os.environ.get("HR2D_SRCDIR")
    if not folder:
        pytest.skip("HR2D_SRCDIR names no sources")
    with open(os.path.join(folder, "schemas/scene.json"), encoding="utf-8") as stream:
        validator = jsonschema.Draft202012Validator(json.load(stream))
    for make in MAKERS:
        validator.validate(make().to_geojson())
    wrong = make_room().to_geojson()
    wrong["features"][0]["properties"]["reflectance"] = 2
    assert not validator.is_valid(wrong)


def test_data_frames():
    pandas = pytest.importorskip("pandas")
    scene = make_hot()
    s = scene.solve(error=1e-4)
    table = s.to_dataframe()
    assert isinstance(table, pandas.DataFrame) and len(table) == len(scene) * scene.bands
    one = table[(table.name == "floor") & (table.band == 1)].iloc[0]
    assert one.B == s.B[0, 1] and one.H == s.H[0, 1] and one.length == 4
    assert one.temperature == s.temperatures.kelvin[0] and one.heat == s.temperatures.heat[0]
    assert "temperature" not in make_room().solve().to_dataframe()
    study = make_plates().study([1, .5, .2])
    assert study.to_dataframe().L.tolist() == study.L.tolist()


def test_npz(tmp_path):
    s = make_hot().solve(epsilon=.3)
    s.write_npz(tmp_path / "s.npz")
    with np.load(tmp_path / "s.npz") as data:
        assert np.array_equal(data["B"], s.B) and data["names"].tolist() == s.scene.names
        assert np.array_equal(data["element_B"], s.element_B)
        assert np.array_equal(data["element_patch"], s.elements["patch"])
        assert not np.array_equal(data["B"], data["H"])


def test_xarray():
    pytest.importorskip("xarray")
    scene = make_hot()
    s = scene.solve(error=1e-4)
    data = s.to_xarray()
    assert data.B.dims == ("patch", "band") and np.array_equal(data.B.values, s.B)
    assert data.temperature.values[0] == s.temperatures.kelvin[0]
    assert list(data.name.values) == scene.names
    grid = s.field_on_grid((1, .5, 2, 1), (3, 4))
    field = grid.to_xarray()
    assert field.mean("band") is not None and dict(field.sizes)["y"] == 3
    assert float(field["mean"].sel(x=2, y=.5, band=1)) == grid.mean[0, 3, 1]
