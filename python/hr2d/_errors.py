# SPDX-License-Identifier: GPL-3.0-or-later
"""Each failure of the library is an exception with the library's message."""
from __future__ import annotations

from typing import Dict, Type

from ._hr2d import ffi, lib


class Error(Exception):
    """A call of the library failed.  The text is the library's message."""

    status: int = -1
    """The hr2d_status of the call."""


class Stopped(Error):
    """A callback ended the call by returning False."""


class OutOfMemory(Error, MemoryError):
    """An allocation failed."""


class InvalidArgument(Error, ValueError):
    """An argument or an option is not valid."""


class StateError(Error):
    """An object is not in the state that a call needs."""


class RangeError(Error, ArithmeticError):
    """Doubles cannot represent a value."""


class FileError(Error, OSError):
    """A file could not be read."""


class FormatError(Error, ValueError):
    """A file does not have the expected format."""


class SceneError(Error, ValueError):
    """The scene is not valid."""


class Unsupported(Error, NotImplementedError):
    """This version does not support an effect."""


class CallbackError(Error):
    """An oracle or a policy gave an invalid value."""


class LimitReached(Error):
    """A limit of elements, links or bytes does not suffice."""


class NoSolution(Error, ArithmeticError):
    """The radiosity equation of this scene has no solution."""


class NotConverged(Error, ArithmeticError):
    """The iteration ended before it reached its tolerance."""


class AccuracyError(Error):
    """The target was not reached, and there is no solution at all."""


class AccuracyWarning(UserWarning):
    """The target was not reached; the best solution is returned with its errors."""


_CLASSES: Dict[int, Type[Error]] = {
    lib.HR2D_STOPPED: Stopped,
    lib.HR2D_ENOMEM: OutOfMemory,
    lib.HR2D_EINVAL: InvalidArgument,
    lib.HR2D_ESTATE: StateError,
    lib.HR2D_ERANGE: RangeError,
    lib.HR2D_EIO: FileError,
    lib.HR2D_ESYNTAX: FormatError,
    lib.HR2D_ESCENE: SceneError,
    lib.HR2D_EUNSUPPORTED: Unsupported,
    lib.HR2D_ECALLBACK: CallbackError,
    lib.HR2D_EMAX_ELEMENTS: LimitReached,
    lib.HR2D_EMAX_LINKS: LimitReached,
    lib.HR2D_EMAX_BYTES: LimitReached,
    lib.HR2D_ENO_SOLUTION: NoSolution,
    lib.HR2D_ENOT_CONVERGED: NotConverged,
    lib.HR2D_EACCURACY: AccuracyError,
}


def error_of(status: int, message: str = "") -> Error:
    """The exception of a status, with the general phrase where the call has no message."""
    text = message or ffi.string(lib.hr2d_strerror(status)).decode()
    error = _CLASSES.get(status, Error)(text)
    error.status = int(status)
    return error
