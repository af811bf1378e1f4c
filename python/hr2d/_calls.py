# SPDX-License-Identifier: GPL-3.0-or-later
"""Calls of the library, and the callbacks that run during one.

cffi releases Python's lock during a call.  An exception in a callback, also the one of Ctrl-C,
cannot pass through C: it is kept, the call is stopped, and then the exception is raised.  All
callbacks run in the thread of their call, so that a list for each thread suffices.
"""
from __future__ import annotations

import os
import threading
from typing import Any, Callable, List, Optional

from ._errors import error_of
from ._hr2d import ffi, lib


class Progress:
    """How far a call is, as a progress function receives it."""

    def __init__(self, raw: Any):
        self.phase: str = ffi.string(raw.phase).decode()
        self.fraction: float = raw.fraction
        self.elements: int = raw.elements
        self.links: int = raw.links
        self.residual: float = raw.residual

    def __repr__(self) -> str:
        return (f"<{self.phase} {self.fraction:.0%}, {self.elements} elements, "
                f"{self.links} links>")


ProgressFunction = Callable[[Progress], Any]


class _Calls(threading.local):
    def __init__(self) -> None:
        self.running: List[Call] = []


_calls = _Calls()


class Call:
    """One call: `with Call() as call: call.check(lib.hr2d_…(…))`."""

    def __init__(self, progress: Optional[ProgressFunction] = None):
        self.progress = progress
        self.error: Optional[BaseException] = None

    def __enter__(self) -> "Call":
        _calls.running.append(self)
        return self

    def __exit__(self, *exception: Any) -> None:
        _calls.running.remove(self)

    def check(self, status: int, message: Callable[[], Any] = lambda: ffi.NULL,
              place: Any = "") -> None:
        """Raises what a callback raised, or the error that the call returned."""
        if status == lib.HR2D_OK and self.error is None:
            return
        if self.error is not None:
            raise self.error
        raw = message()
        error = error_of(status, ffi.string(raw).decode() if raw else "")
        error.args = (f"{os.fsdecode(place)}: {error}",) if place else error.args
        raise error

    def check_made(self, status: int, made: Any, message: Callable[[], Any]) -> None:
        """As check(), but an accuracy that was not reached is no error if there is a result."""
        if status != lib.HR2D_EACCURACY or not made or self.error:
            self.check(status, message)


def keep_exception(kind: Any, error: BaseException, trace: Any) -> None:
    """cffi's onerror: an exception of a callback waits for the end of the call."""
    if _calls.running and _calls.running[-1].error is None:
        _calls.running[-1].error = error


@ffi.def_extern(error=lib.HR2D_STOPPED, onerror=keep_exception)
def hr2dpy_progress(ctx: Any, raw: Any) -> int:
    # Python runs the handlers of signals here.
    if _calls.running:
        call = _calls.running[-1]
        if call.error is not None:
            return lib.HR2D_STOPPED
        if call.progress is not None and call.progress(Progress(raw)) is False:
            return lib.HR2D_STOPPED
    return lib.HR2D_OK


POLL = ffi.addressof(lib, "hr2dpy_poll")


def constant(name: str) -> float:
    """The value of a macro of the headers."""
    value = ffi.new("double *")
    with Call() as call:
        call.check(lib.hr2d_constant(name.encode(), value))
    return float(value[0])


ALL_THREADS = int(constant("HR2D_ALL_THREADS"))


def thread_count(threads: Any) -> int:
    """The C form of the argument `threads`: a number, or "all"."""
    if threads == "all":
        return ALL_THREADS
    count = int(threads)
    if count != threads or not 1 <= count < ALL_THREADS:
        raise ValueError(f'threads is a number from 1 on or "all", not {threads!r}')
    return count


def owned(pointer: Any, destroy: Callable[[Any], None], *needs: Any) -> Any:
    """A pointer that is destroyed with its last user, and before all objects that it needs."""

    def release(raw: Any, destroy: Any = destroy, needs: Any = needs) -> None:
        destroy(raw)

    return ffi.gc(pointer, release)
