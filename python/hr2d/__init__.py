# SPDX-License-Identifier: GPL-3.0-or-later
"""Hierarchical radiosity in the plane.

    import numpy as np, hr2d
    room = hr2d.Scene(background=1.0)
    room.add([(0, 0), (5, 0), (5, 2.8), (0, 2.8), (0, 2.2)], reflectance=.6, name="shell")
    room.add([(0, .9), (0, 0)], reflectance=.6, name="parapet")
    s = room.solve(error=1e-6)
    s.B, s.H, s.net_flux, s.account
    s.at("shell/1", np.linspace(0, 1, 101))
    s.field(np.mgrid[0:5:200j, 0:2.8:100j])

The library's manual, with equations and bounds of errors, are its headers, hr2d/hr2d.h.
"""
try:
    from ._hr2d import ffi as _ffi
    from ._hr2d import lib as _lib
except ImportError as error:
    if "libhr2d" not in str(error):
        raise
    raise ImportError(f"{error}: run ldconfig if it is installed, or set LD_LIBRARY_PATH to its "
                      "folder; a wheel made by `make wheel` needs no libhr2d") from None
from ._calls import Progress
from ._enclosure import Enclosure
from ._errors import (AccuracyError, AccuracyWarning, CallbackError, Error, FileError,
                      FormatError, InvalidArgument, LimitReached, NoSolution, NotConverged,
                      OutOfMemory, RangeError, SceneError, StateError, Stopped, Unsupported)
from ._film import film, radiation_temperature
from ._law import Law, Term
from ._links import Fit, Links, Study
from ._operator import Gradient, Lights, Operator
from ._scene import Scene, SceneWarning, Snap, Sun, black_body, exchange_area, read
from ._points import PointFactors
from ._solution import Account, Bounded, Field, Gas, Grid, Points, Power, Solution, Temperatures
from ._solve import Prediction
from ._strategy import SPLIT_BOTH, SPLIT_FIRST, SPLIT_SECOND, Batch, Oracle, Policy

__version__: str = _ffi.string(_lib.hr2d_version()).decode()

__all__ = [
    "Account", "AccuracyError", "AccuracyWarning", "Batch", "Bounded", "CallbackError",
    "Enclosure", "Error", "Field", "FileError", "Fit", "FormatError", "Gas", "Gradient", "Grid",
    "InvalidArgument", "Law", "Lights", "LimitReached", "Links", "NoSolution", "NotConverged",
    "Operator", "Oracle", "OutOfMemory", "PointFactors", "Points", "Policy", "Power",
    "Prediction", "Progress", "RangeError", "SPLIT_BOTH", "SPLIT_FIRST", "SPLIT_SECOND",
    "Scene", "SceneError", "SceneWarning", "Snap", "Solution", "StateError", "Stopped", "Study",
    "Sun", "Temperatures", "Term", "Unsupported", "black_body", "exchange_area",
    "film", "radiation_temperature", "read",
]
