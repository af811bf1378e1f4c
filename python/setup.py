# SPDX-License-Identifier: GPL-3.0-or-later
"""The version is that of the library that pkg-config finds; see hr2d_build.py."""
import sys
from pathlib import Path

from setuptools import setup

sys.path.insert(0, str(Path(__file__).parent))
from hr2d_build import pkg_config  # noqa: E402

# The extension keeps to Python's stable interface, as cffi makes it: one wheel for 3.9 and later.
setup(version=pkg_config("--modversion")[0], cffi_modules=["hr2d_build.py:ffi"],
      options={"bdist_wheel": {"py_limited_api": "cp39"}})
