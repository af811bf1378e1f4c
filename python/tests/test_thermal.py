# SPDX-License-Identifier: GPL-3.0-or-later
import json

import numpy as np
import pytest

import hr2d

SIGMA = 5.670374419e-8


def make_muffle(load, **kind):
    """A heater on the left, a load on the right, insulated walls between them."""
    scene = hr2d.Scene(**kind)
    scene.add([(0, 1), (0, 0)], temperature=1200, name="heater")
    scene.add([(0, 0), (2, 0)], flux=0, emissivity=.4, name="floor")
    scene.add([(2, 0), (2, 1)], name="load", **load)
    scene.add([(2, 1), (0, 1)], flux=0, emissivity=.7, name="ceiling")
    return scene


def test_between_two_plates_is_the_mean_of_the_fourth_powers():
    t = make_muffle({"temperature": 600}).solve(error=1e-9).temperatures
    middle = ((1200. ** 4 + 600. ** 4) / 2) ** .25
    assert t.kelvin == pytest.approx([1200, middle, 600, middle], rel=1e-9)
    assert (np.abs(t.kelvin - [1200, middle, 600, middle]) <= t.bound + 1e-11).all()
    assert t.state == ("given", "found", "given", "found")
    assert t.heat[0] == pytest.approx(-t.heat[2]) and t.heat[1] == t.heat[3] == 0
    assert t.heat[0] > t.heat_bound[0] > 0


def test_one_source_heats_all():
    t = make_muffle({"flux": 0}).solve().temperatures
    assert t.kelvin == pytest.approx(np.full(4, 1200), rel=1e-12)
    links = make_muffle({"flux": 0}).solve(epsilon=.1).temperatures
    assert links.kelvin == pytest.approx(t.kelvin) and np.isnan(links.bound[1])


def test_a_heater_gives_its_heat():
    muffle = make_muffle({"temperature": 600})
    heated = hr2d.Scene()
    for k, properties in enumerate([{"heat": 5000, "emissivity": .5}, {"flux": 0, "emissivity": .4},
                                    {"temperature": 600}, {"flux": 0, "emissivity": .7}]):
        heated.add(muffle.segments[k], **properties)
    t = heated.solve(error=1e-9).temperatures
    assert t.heat == pytest.approx([5000, 0, -5000, 0], abs=1e-3)
    # A rod of four sides shares it by their lengths: what reaches the walls is the same.
    rod = hr2d.Scene(background=0)
    rod.add([(0, 0), (0, 1), (2, 1), (2, 0), (0, 0)], heat=300, name="rod")
    s = rod.solve()
    assert s.temperatures.heat == pytest.approx([50, 100, 50, 100])
    assert s.net_power[:, 0] == pytest.approx([50, 100, 50, 100])
    foil = hr2d.Scene(background=0)
    foil.add([(0, 0), (0, 4)], heat=300, sides="both", emissivity=.5)
    assert foil.solve().temperatures.heat == pytest.approx([150, 150])
    with pytest.raises(hr2d.SceneError, match="heat cannot both be given"):
        hr2d.Scene().add([(0, 0), (1, 0)], flux=1, heat=1)
    with pytest.raises(hr2d.SceneError, match="of its own"):
        hr2d.Scene().add([(0, 0), (1, 0)], heat=1, sides="both", back={"emissivity": .1})


def test_what_cannot_be_is_said():
    with pytest.raises(hr2d.Error, match="negative radiosity"):
        make_muffle({"flux": -1e6}).solve()
    with pytest.raises(hr2d.SceneError, match="cannot both be given"):
        hr2d.Scene().add([(0, 0), (1, 0)], temperature=1, flux=1)


def test_points_of_a_found_temperature_have_its_light():
    scene = hr2d.Scene(wavelengths=[3, 8])
    corners = [(0, 0), (3, 0), (0, 3), (0, 0)]
    for k, kind in enumerate([{"temperature": 1200}, {"temperature": 600}, {"flux": 0}]):
        scene.add(corners[k:k + 2], emissivity=[.2, .5, .9], **kind)
    for s in (scene.solve(error=1e-6), scene.solve(epsilon=.05)):
        points = s.at(2, [.2, .5])
        kelvin = s.temperatures.kelvin[2]
        assert 600 < kelvin < 1200
        # B = ε f σT⁴ + (1 − ε) H, where f sums to 1 over the bands.
        black = (points.B - (1 - np.array([.2, .5, .9])) * points.H) / [.2, .5, .9]
        assert black.sum(axis=-1) == pytest.approx(np.full(2, SIGMA * kelvin ** 4), rel=1e-9)


def test_wavelengths_make_bands():
    scene = hr2d.Scene(wavelengths=[3, 8])
    scene.add([(0, 0), (1, 0), (0, 1), (0, 0)], temperature=900, emissivity=[.2, .5, .9])
    assert scene.bands == 3
    s = scene.solve()
    assert s.H.sum(axis=1) == pytest.approx(np.full(3, SIGMA * 900. ** 4))
    assert s.temperatures.heat == pytest.approx(np.zeros(3), abs=1e-8)


def make_rooms(**pane):
    """Two rooms of 1200 K and 300 K, with something between them."""
    scene = hr2d.Scene()
    scene.add([(1, 1), (0, 1), (0, 0), (1, 0)], temperature=1200, emissivity=.6, name="hot")
    scene.add([(1, 0), (2, 0), (2, 1), (1, 1)], temperature=300, emissivity=.6, name="cold")
    scene.add([(1, 0), (1, 1)], sides="both", name="sheet", **pane)
    return scene


def test_a_shield_passes_its_heat_on():
    scene = make_rooms(shield=True, emissivity=.3, back={"emissivity": .8})
    s = scene.solve(error=1e-9)
    t = s.temperatures
    tau = .3 * .8 / 1.1
    assert scene.transmittance[6:, 0] == pytest.approx([tau, tau], rel=1e-15)
    assert list(scene.other_side) == [0, 1, 2, 3, 4, 5, 7, 6]
    assert t.kelvin[6] == t.kelvin[7] and 300 < t.kelvin[6] < 1200
    assert t.heat[6] == pytest.approx(-t.heat[7], rel=1e-9) and t.heat[7] > 0


def test_a_pane_passes_light_on():
    opaque = make_rooms(temperature=300, emissivity=.5).solve(error=1e-8).temperatures
    scene = make_rooms(temperature=300, emissivity=.5, transmittance=.3)
    pane = scene.solve(error=1e-8).temperatures
    assert scene.reflectance[6, 0] == pytest.approx(.2)
    at = scene.solve(error=1e-8).at("sheet", [.3, .5])
    assert at.B.T == pytest.approx(scene.emission[6] + .2 * at.H.T + .3 * scene.solve(
        error=1e-8).at("sheet (back)", [.7, .5]).H.T, rel=1e-12)
    assert pane.heat[3:6].sum() < opaque.heat[3:6].sum() - 100
    with pytest.raises(hr2d.SceneError, match="above 1"):
        make_rooms(temperature=300, emissivity=.8, transmittance=.3)


@pytest.mark.parametrize("section, wall", [("long", .3622774630782), ("flat", None)])
def test_gas_in_a_grey_square(section, wall):
    """B − H of the walls of a cold square with ρ = .5 around gas with E_g = 1 and κ = 1."""
    scene = hr2d.Scene()
    scene.add([(0, 0), (1, 0), (1, 1), (0, 1), (0, 0)], reflectance=.5)
    scene.set_medium(1, emission=1, section=section)
    s = scene.solve(error=1e-10)
    assert scene.absorption == [1] and s.gas.emission == [1]
    if wall:
        assert (s.H - s.B)[:, 0] == pytest.approx(wall, rel=1e-9)
    assert s.gas.heat == pytest.approx((s.H - s.B).sum(), rel=1e-9)


def test_adiabatic_gas_finds_its_temperature():
    """Between walls of 1 and 0, two white: its value is published with 13 digits."""
    scene = hr2d.Scene()
    scene.add([(0, 0), (1, 0)], emission=1)
    scene.add([(1, 0), (1, 1)], reflectance=1)
    scene.add([(1, 1), (0, 1)])
    scene.add([(0, 1), (0, 0)], reflectance=1)
    scene.set_medium(1, flux=0)
    s = scene.solve(error=1e-9)
    assert s.B[0] - s.H[0] == pytest.approx(.5356749890498, rel=1e-8)
    assert s.gas.emission == pytest.approx(.5, rel=1e-9)
    assert s.gas.heat == pytest.approx(0, abs=1e-12)


def test_without_gas_there_is_none():
    scene = hr2d.Scene()
    scene.add([(0, 0), (1, 0)], emission=1)
    assert scene.solve().gas is None and (scene.absorption == 0).all()


def test_gases_have_borders():
    """A border within one gas changes nothing; a hotter flame gives more than it gets."""
    one, parted = hr2d.Scene(), hr2d.Scene()
    for scene in (one, parted):
        scene.add([(0, 0), (1, 0), (1, 1), (0, 1), (0, 0)], reflectance=.5)
        scene.set_medium(1, emission=1)
    parted.add_medium([(.2, .3), (.7, .1), (.8, .8)], 1, emission=1)
    assert parted.absorptions.tolist() == [[1], [1]] and len(parted) == 4
    b, c = (scene.solve(error=1e-9) for scene in (one, parted))
    assert c.B == pytest.approx(b.B, rel=1e-9)
    assert sum(gas.heat[0] for gas in c.gases) == pytest.approx(b.gas.heat[0], rel=1e-9)
    hot = hr2d.Scene()
    hot.add_text(json.dumps(parted.to_geojson()))
    assert hot.solve(error=1e-9).B == pytest.approx(b.B, rel=1e-9)
    hot = hr2d.Scene()
    hot.add_text(json.dumps(parted.to_geojson()))
    hot.add_medium([(.4, .4), (.6, .4), (.5, .6)], 5, emission=4, section="long")
    s = hot.solve(error=1e-6)
    assert s.gases[2].heat > 0 and (s.B > b.B).all()
    with pytest.raises(hr2d.Error, match="fewer than three|needs 4 positions"):
        hr2d.Scene().add_medium([(0, 0), (1, 0)], 1)
