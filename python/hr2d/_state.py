# SPDX-License-Identifier: GPL-3.0-or-later
"""Solutions as bytes: stages of a refinement, and what pickle keeps."""
from __future__ import annotations

from typing import Any, Dict

import numpy as np

from ._arrays import Array, doubles, view
from ._calls import Call, keep_exception, owned
from ._hr2d import ffi, lib


@ffi.def_extern(error=lib.HR2D_ECALLBACK, onerror=keep_exception)
def hr2dpy_write(ctx: Any, data: Any, size: int) -> int:
    ffi.from_handle(ctx).extend(ffi.buffer(data, size))
    return lib.HR2D_OK


@ffi.def_extern(error=lib.HR2D_ECALLBACK, onerror=keep_exception)
def hr2dpy_read(ctx: Any, data: Any, size: int) -> int:
    reader = ffi.from_handle(ctx)
    some = reader[0][reader[1]:reader[1] + size]
    if len(some) < size:
        return lib.HR2D_ESYNTAX
    ffi.buffer(data, size)[:] = some
    reader[1] += size
    return lib.HR2D_OK


def write_state(solution: Any) -> bytes:
    """The bytes of hr2d_state_write()."""
    data = bytearray()
    handle = ffi.new_handle(data)
    with Call() as call:
        call.check(lib.hr2d_state_write(solution, lib.hr2dpy_write, handle))
    return bytes(data)


def read_state(links: Any, data: bytes, call: Call) -> Any:
    """Fills an empty set of links; returns the solution."""
    pointer, handle = ffi.new("hr2d_solution **"), ffi.new_handle([data, 0])
    call.check(lib.hr2d_state_read(links, lib.hr2dpy_read, handle, pointer),
               lambda: lib.hr2d_linkset_message(links))
    return owned(pointer[0], lib.hr2d_solution_destroy, links)


# What a solution of a target is made of is larger than its result: links between clusters, blocks.
# pickle keeps its elements with their coefficients, from which values at points and fields follow,
# and the averages as arrays.

def keep_elements(solution: Any) -> Dict[str, Any]:
    """The elements with their coefficients, and the order."""
    raw = solution._raw
    tree = lib.hr2d_linkset_hierarchy(lib.hr2d_solution_links(raw))
    field = view(lib.hr2d_solution_field(raw), np.float64, lib.hr2d_solution_field_size(raw), raw)
    return {"elements": solution.elements.copy(), "field": field.copy(),
            "order": lib.hr2d_hierarchy_order(tree)}


def _divide(tree: Any, elements: Array, call: Call) -> None:
    """Divides elements in the order of their children, which then have their former numbers."""
    parents = np.flatnonzero(elements["child"])
    for parent in parents[np.argsort(elements["child"][parents])]:
        e, left = elements[parent], elements[elements["child"][parent]]
        t = left["length"] / e["length"]
        call.check(lib.hr2d_hierarchy_divide(tree, int(parent), t, ffi.NULL))


def adopt(scene: Any, kept: Dict[str, Any]) -> Any:
    """A solution with these coefficients on links between whole patches."""
    hierarchy, links = ffi.new("hr2d_hierarchy **"), ffi.new("hr2d_linkset **")
    pointer = ffi.new("hr2d_solution **")
    with Call() as call:
        call.check(lib.hr2d_hierarchy_create(scene._raw, hierarchy))
        tree = owned(hierarchy[0], lib.hr2d_hierarchy_destroy, scene._raw)
        call.check(lib.hr2d_hierarchy_set_order(tree, kept["order"]))
        _divide(tree, kept["elements"], call)
        call.check(lib.hr2d_linkset_create(tree, ffi.NULL, ffi.NULL, ffi.NULL, ffi.NULL, links))
        pairs = owned(links[0], lib.hr2d_linkset_destroy, tree)
        options = ffi.new("hr2d_refine_options *")
        lib.hr2d_refine_options_init(options, ffi.sizeof("hr2d_refine_options"))
        options.epsilon = 1e300
        call.check(lib.hr2d_refine(pairs, options), lambda: lib.hr2d_linkset_message(pairs))
        call.check(lib.hr2d_solution_adopt(pairs, ffi.NULL, doubles(kept["field"]), pointer),
                   lambda: lib.hr2d_linkset_message(pairs))
    return owned(pointer[0], lib.hr2d_solution_destroy, pairs)
