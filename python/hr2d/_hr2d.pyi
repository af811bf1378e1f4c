# SPDX-License-Identifier: GPL-3.0-or-later
# What cffi makes of the headers.
from typing import Any, Callable, TypeVar

_F = TypeVar("_F", bound=Callable[..., Any])

class _FFI:
    def def_extern(self, *, error: Any, onerror: Any) -> Callable[[_F], _F]: ...
    def __getattr__(self, name: str) -> Any: ...

class _Lib:
    HR2D_OK: int
    HR2D_STOPPED: int
    HR2D_ESYNTAX: int
    def __getattr__(self, name: str) -> Any: ...

ffi: _FFI
lib: _Lib
