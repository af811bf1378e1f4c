# SPDX-License-Identifier: GPL-3.0-or-later
"""setuptools as pip calls it, after a look at what is missing.

With --no-build-isolation pip takes what is installed, and says nothing that helps if it is not.
"""
from importlib.util import find_spec

missing = [name for name in ("setuptools", "cffi") if find_spec(name) is None]
# From version 70.1 on setuptools makes wheels itself.
if find_spec("wheel") is None and ("setuptools" in missing
                                   or find_spec("setuptools.command.bdist_wheel") is None):
    missing.append("wheel")
if missing:
    raise SystemExit(f"hr2d is built with what is not installed here: {', '.join(missing)}; install "
                     f"with pip install {' '.join(missing)}, or on Debian with "
                     f"apt install {' '.join('python3-' + name for name in missing)}")

from setuptools.build_meta import *  # noqa: E402, F401, F403
