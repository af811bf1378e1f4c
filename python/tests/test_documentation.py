# SPDX-License-Identifier: GPL-3.0-or-later
"""Examples in docstrings do what they show, and everything public has a docstring and types."""
import doctest
import inspect
import re
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import numpy as np
import pytest

import hr2d
import hr2d.convert
import hr2d.sun


def square():
    """A closed room: a floor that shines, and three walls."""
    scene = hr2d.Scene()
    scene.add([(0, 0), (1, 0)], emission=1, reflectance=.5, name="floor")
    scene.add([(1, 0), (1, 1), (0, 1), (0, 0)], reflectance=.5, name="walls")
    return scene


def modules():
    names = [name for name in sys.modules if name.startswith("hr2d.") and name != "hr2d._hr2d"]
    return [sys.modules[name] for name in sorted(names)]


def test_examples():
    tried = failed = 0
    finder, runner = doctest.DocTestFinder(), doctest.DocTestRunner(optionflags=doctest.ELLIPSIS)
    for module in modules():
        if module is hr2d.convert and find_spec("svgelements") is None:
            continue
        for test in finder.find(module, extraglobs={"square": square, "np": np, "hr2d": hr2d}):
            result = runner.run(test)
            tried, failed = tried + result.attempted, failed + result.failed
    assert failed == 0 and tried >= 20
    wrong = doctest.DocTestParser().get_doctest(">>> 1 + 1\n3\n", {}, "wrong", None, 0)
    assert doctest.DocTestRunner(verbose=False).run(wrong, out=lambda text: None).failed == 1


def members(value):
    """The functions and properties of a class of the package."""
    for name, item in vars(value).items():
        item = getattr(item, "func", getattr(item, "fget", getattr(item, "__func__", item)))
        if not name.startswith("_") and inspect.isfunction(item):
            yield f"{value.__name__}.{name}", item


def test_all_is_documented():
    lacking = []
    for name, value in [(name, getattr(module, name)) for module in (hr2d, hr2d.convert, hr2d.sun)
                        for name in module.__all__]:
        if isinstance(value, int):
            continue
        items = [(name, value)]
        if inspect.isclass(value) and not issubclass(value, Exception):
            items += list(members(value))
        lacking += [name for name, item in items if not inspect.getdoc(item)]
    assert not lacking


def mypy(cache, file):
    return subprocess.run([sys.executable, "-m", "mypy", "--strict", "--cache-dir", str(cache),
                           str(file)], capture_output=True, text=True)


def test_types(tmp_path):
    pytest.importorskip("mypy")
    package, example = Path(hr2d.__file__).parent, Path(__file__).parent / "typed_example.py"
    found = mypy(tmp_path, package)
    assert found.returncode == 0, found.stdout
    found = mypy(tmp_path, example)
    assert found.returncode == 0, found.stdout
    wrong = tmp_path / "wrong.py"
    wrong.write_text(example.read_text().replace("error=1e-6", 'error="1e-6"'))
    assert 'has incompatible type "str"' in mypy(tmp_path, wrong).stdout


INSTEAD = """
add() and add_file() pass all through the reader of scene files
hr2d_gas_init hr2d_scene_add hr2d_scene_add_gas hr2d_scene_add_thermal hr2d_scene_read hr2d_scene_set_sky hr2d_scene_set_sun hr2d_patch_init
hr2d_scene_set_continuous_sky hr2d_sky_cie hr2d_sky_perez hr2d_sky_clearness hr2d_sky_radiance hr2d_sky_init
hr2d_thermal_init
arrays of patches, elements and links
hr2d_scene_segment hr2d_scene_length hr2d_element_level hr2d_element_parent hr2d_hierarchy_leaf
hr2d_hierarchy_originals hr2d_hierarchy_scene hr2d_linkset_get hr2d_linkset_size hr2d_linkset_policy
B, H, net_flux, at() and account
hr2d_solution_error hr2d_solution_gather_net_flux hr2d_solution_work hr2d_solution_element_irradiance
hr2d_scene_temperature
exchange_area(), exchange_areas(), point_factors() and sunlit_parts()
hr2d_exchange_area hr2d_exchange_area_past hr2d_exchange_rows_visit hr2d_beams_visit hr2d_kernel hr2d_orientation
hr2d_scene_sunlight_over
refine() and study()
hr2d_refine_count hr2d_refine_visit
names of oracles and policies
hr2d_oracle_bf hr2d_oracle_bounds hr2d_oracle_l1 hr2d_oracle_l1_grid hr2d_oracle_size hr2d_oracle_size2
hr2d_policy_modified hr2d_policy_original
loops in C
hr2d_scene_sky hr2d_scene_sunlight_at hr2d_solution_element
pickle
hr2d_state_read_scene hr2d_state_write_scene
structs that are set to 0
hr2d_field_options_init hr2d_lint_options_init hr2d_matrix_options_init
for solvers and distributions that are written in C
hr2d_blocks hr2d_leaf_sums hr2d_hierarchy_pull hr2d_hierarchy_push hr2d_linkset_own_tests hr2d_clusters_bytes
hr2d_clusters_create hr2d_clusters_destroy hr2d_clusters_gather hr2d_clusters_links hr2d_clusters_options_init
"""
"""What takes the place of functions of C, and the functions."""


def test_no_function_of_c_is_missed():
    from hr2d._hr2d import lib

    functions = {name for name in dir(lib) if name.startswith("hr2d_")}
    package = Path(hr2d.__file__).parent
    text = "".join(path.read_text(encoding="utf-8") for path in package.glob("*.py"))
    used = set(re.findall(r"\bhr2d_\w+", text))
    instead = set(re.findall(r"\bhr2d_\w+", INSTEAD))
    lacking, wrong = functions - used - instead, instead - functions | instead & used
    assert not lacking, f"give them to Python, or say what takes their place: {sorted(lacking)}"
    assert not wrong, f"these are used, or no functions: {sorted(wrong)}"
