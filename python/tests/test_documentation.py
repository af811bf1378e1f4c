# SPDX-License-Identifier: GPL-3.0-or-later
"""Examples in docstrings do what they show, and everything public has a docstring and types."""
import doctest
import inspect
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import hr2d


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
    for name in hr2d.__all__:
        value = getattr(hr2d, name)
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
