# SPDX-License-Identifier: GPL-3.0-or-later
"""The two ways to a solution: to a target error, and by links of an oracle."""
from __future__ import annotations

import math
import warnings
from typing import Any, Dict, List, NamedTuple, Optional, Tuple

from ._calls import Call, ProgressFunction, constant, owned
from ._errors import AccuracyWarning, error_of
from ._hr2d import ffi, lib
from ._solution import Account, Solution
from ._state import read_state
from ._strategy import oracle_table, policy_table

MOST_ROUNDS = 20  # of links by the light of the last round


class Prediction(NamedTuple):
    """The predicted cost of a solve to a target."""

    order: int
    elements: int
    leaves: int
    links: int
    bytes: int
    """Memory of elements, links and blocks at most."""
    seconds: float
    """Wall time, the account of the error included."""
    least_seconds: float
    """The range of that time begins here."""
    most_seconds: float
    """And ends here."""


NORMS = {"average": lib.HR2D_NORM_AVERAGE, "sup": lib.HR2D_NORM_SUP}


def _positive(name: str, value: float) -> float:
    if not (value > 0 and math.isfinite(value)):
        raise ValueError(f"{name} is a number above 0, not {value}")
    return value


def _error(error: Optional[float], seconds: Optional[float]) -> float:
    """In C 0 stands for the default, and a named constant for the smallest error."""
    if error is None and seconds is None:
        return 0
    if error is None or error == 0:
        return constant("HR2D_SMALLEST_ERROR")
    return _positive("error", error)


def make_target(target: Dict[str, Any], limits: Dict[str, int], points: bool,
                keep: List[Any]) -> Any:
    """The struct of a target; `keep` has what it points to."""
    norm = target["norm"] or "average"
    if norm not in NORMS:
        raise ValueError(f'norm is "average" or "sup", not {norm!r}')
    raw = ffi.new("hr2d_target *")
    lib.hr2d_target_init(raw, ffi.sizeof("hr2d_target"))
    raw.error = _error(target["error"], target["seconds"])
    raw.norm = NORMS[norm]
    raw.points = bool(points)
    raw.no_error = bool(target["no_error"])
    if target["seconds"] is not None:
        raw.seconds = _positive("seconds", target["seconds"])
    if target["floor"] is not None:
        raw.floor = _positive("floor", target["floor"])
    if target["important"]:
        keep.append(ffi.new("size_t[]", target["important"]))
        raw.important, raw.important_count = keep[-1], len(target["important"])
    for name, value in limits.items():
        setattr(raw, name, value)
    return raw


def to_target(scene: Any, target: Dict[str, Any], limits: Dict[str, int], points: bool,
              progress: Optional[ProgressFunction]) -> Solution:
    keep: List[Any] = []
    raw = make_target(target, limits, points, keep)
    pointer, account = ffi.new("hr2d_solution **"), ffi.new("hr2d_account *")
    with Call(progress) as call:
        status = lib.hr2d_solve_to(scene._raw, raw, pointer, account)
        reached = status == lib.HR2D_OK
        if pointer[0]:
            solution = Solution(
                scene, owned(pointer[0], lib.hr2d_solution_destroy, scene._raw),
                Account._of(account, reached), (raw, account, keep))
        call.check_made(status, pointer[0], lambda: account.reason)
    if not reached:
        warnings.warn(solution.account.reason, AccuracyWarning, stacklevel=3)
    return solution


def predict(scene: Any, target: Dict[str, Any], limits: Dict[str, int], points: bool,
            progress: Optional[ProgressFunction]) -> Prediction:
    keep: List[Any] = []
    raw, found = make_target(target, limits, points, keep), ffi.new("hr2d_prediction *")
    with Call(progress) as call:
        call.check(lib.hr2d_predict(scene._raw, raw, found))
    return Prediction(*(getattr(found, name) for name in Prediction._fields))


def refine_options(paper: Dict[str, Any], limits: Dict[str, int]) -> Any:
    """In C 0 stands for a default, and named constants for the number 0."""
    raw = ffi.new("hr2d_refine_options *")
    lib.hr2d_refine_options_init(raw, ffi.sizeof("hr2d_refine_options"))
    if paper["epsilon"] is not None:
        raw.epsilon = (paper["epsilon"] if paper["epsilon"] != 0
                       else constant("HR2D_EPSILON_ZERO"))
    if paper["max_level"] is not None:
        raw.max_level = paper["max_level"] or int(constant("HR2D_NO_SUBDIVISION"))
    for name, value in limits.items():
        setattr(raw, name, value)
    return raw


def _solve_options(paper: Dict[str, Any], limits: Dict[str, int]) -> Any:
    raw = ffi.new("hr2d_solve_options *")
    lib.hr2d_solve_options_init(raw, ffi.sizeof("hr2d_solve_options"))
    raw.threads = limits["threads"]
    if paper["closure"] is not None:
        raw.closure = lib.HR2D_CLOSURE_ON if paper["closure"] else lib.HR2D_CLOSURE_OFF
    return raw


def empty_links(scene: Any, paper: Dict[str, Any], call: Call) -> Any:
    """A set without links, with the oracle, the policy and the order of its elements."""
    hierarchy, links = ffi.new("hr2d_hierarchy **"), ffi.new("hr2d_linkset **")
    call.check(lib.hr2d_hierarchy_create(scene._raw, hierarchy))
    tree = owned(hierarchy[0], lib.hr2d_hierarchy_destroy, scene._raw)
    order = paper.get("order")
    if order is not None and lib.hr2d_hierarchy_set_order(tree, order):
        highest = int(constant("HR2D_MAX_ORDER"))
        raise error_of(lib.HR2D_EINVAL, f"order is a number from 1 to {highest}")
    oracle, oracle_ctx, oracle_keep = oracle_table(paper["oracle"])
    policy, policy_ctx, policy_keep = policy_table(paper["policy"])
    call.check(lib.hr2d_linkset_create(tree, oracle, oracle_ctx, policy, policy_ctx, links))
    return owned(links[0], lib.hr2d_linkset_destroy, tree, oracle_keep, policy_keep)


def _needs_brightness(pairs: Any) -> bool:
    return bool(lib.hr2d_linkset_oracle(pairs).flags & lib.HR2D_ORACLE_NEEDS_BRIGHTNESS)


def _size(pairs: Any) -> Tuple[int, int]:
    counts = lib.hr2d_linkset_counts(pairs)
    return counts.elements, counts.links


def by_links(scene: Any, paper: Dict[str, Any], limits: Dict[str, int], points: bool,
             progress: Optional[ProgressFunction]) -> Solution:
    pointer = ffi.new("hr2d_solution **")
    with Call(progress) as call:
        pairs = empty_links(scene, paper, call)

        def message() -> Any:
            return lib.hr2d_linkset_message(pairs)

        refine, solve = refine_options(paper, limits), _solve_options(paper, limits)
        solution = ffi.NULL
        if paper["start"] is not None:
            start = paper["start"]
            state = start.state() if isinstance(start, Solution) else start
            solution = read_state(pairs, state, call)
        for _ in range(MOST_ROUNDS if _needs_brightness(pairs) else 1):
            before = _size(pairs)
            refine.brightness = solve.start = solution
            call.check(lib.hr2d_refine(pairs, refine), message)
            call.check(lib.hr2d_solve(pairs, solve, pointer), message)
            solution = owned(pointer[0], lib.hr2d_solution_destroy, pairs)
            if _size(pairs) == before:
                break
    return Solution(scene, solution, None, points=points)
