# SPDX-License-Identifier: GPL-3.0-or-later
"""The paper's experiment: the links of a refinement, and L against N for falling ε."""
from __future__ import annotations

from functools import cached_property
from importlib import import_module
from typing import Any, Dict, List, NamedTuple, Optional, Sequence, Union

import numpy as np

from ._arrays import ELEMENT, Array, doubles, frozen, view
from ._calls import Call, ProgressFunction
from ._hr2d import ffi, lib
from ._law import Law, find_law
from ._strategy import OracleLike, PolicyLike
from ._solve import empty_links, refine_options


def _layout(struct: str, members: Dict[str, Any]) -> np.dtype[Any]:
    """A structured type of numpy for members of a struct in C, by their paths."""
    return np.dtype({
        "names": list(members),
        "formats": [kind for kind, _ in members.values()],
        "offsets": [ffi.offsetof(struct, *path) for _, path in members.values()],
        "itemsize": ffi.sizeof(struct),
    })


_LINK = _layout("hr2d_link", {
    "elements": ((np.uint32, 2), ("pair",)),
    "exchange_area": (np.float64, ("exchange_area",)),
})

_ROW = _layout("hr2d_study_row", {
    "epsilon": (np.float64, ("epsilon",)),
    "N": (np.uint64, ("counts", "elements")),
    "L": (np.uint64, ("counts", "links")),
    "leaves": (np.uint64, ("counts", "leaves")),
    "limited": (np.uint64, ("counts", "limited_links")),
    "oracle_calls": (np.uint64, ("counts", "oracle_calls")),
    "seconds": (np.float64, ("seconds",)),
})


class Links:
    """The links of a refinement; arrays have an item per link, and 2 in it for its elements.

    If links are `directed`, light goes from the second element to the first, otherwise both
    ways.
    """

    def __init__(self, scene: Any, raw: Any):
        self.scene = scene
        self._raw = raw
        self._tree = lib.hr2d_linkset_hierarchy(raw)
        counts = lib.hr2d_linkset_counts(raw)
        self.N: int = counts.elements
        """Elements: all nodes of all trees."""
        self.L: int = counts.links
        """Links."""
        self.limited: int = counts.limited_links
        """Links that only a limit of the level accepted."""
        self.epsilon: float = lib.hr2d_linkset_epsilon(raw)
        self.directed = bool(lib.hr2d_linkset_directed(raw))

    def __len__(self) -> int:
        return self.L

    def __repr__(self) -> str:
        return f"<hr2d.Links: {self.N} elements, {self.L} links>"

    @cached_property
    def elements(self) -> Array:
        """All elements, as Solution.elements."""
        return view(lib.hr2d_hierarchy_elements(self._tree), ELEMENT, self.N, self._raw)

    @property
    def bytes(self) -> int:
        """The memory of the links."""
        return int(lib.hr2d_linkset_bytes(self._raw))

    def validate(self) -> bool:
        """Whether every transport is accounted for exactly once (paper, section 2); True, or
        InvalidArgument says where it is not.  Of a solution to a target with many patches links
        between clusters are lacking."""
        with Call() as call:
            call.check(lib.hr2d_linkset_validate(self._raw),
                       lambda: lib.hr2d_linkset_message(self._raw))
        return True

    @cached_property
    def _links(self) -> Array:
        links = np.empty(self.L, _LINK)
        if self.L:
            lib.hr2d_linkset_read(self._raw, 0, self.L,
                                  ffi.from_buffer("hr2d_link[]", links, require_writable=True))
        return frozen(links)

    @property
    def pairs(self) -> Array:
        """Numbers of the elements, (L, 2)."""
        return self._links["elements"]

    @property
    def exchange_areas(self) -> Array:
        """AF of what the elements see of each other, in scene lengths, (L,)."""
        return self._links["exchange_area"]

    @cached_property
    def patches(self) -> Array:
        """Indices of the patches; with mirrors or a period those of images, too, (L, 2)."""
        return frozen(self.elements["patch"][self.pairs].astype(np.intp))

    @cached_property
    def lengths(self) -> Array:
        """Of the elements, in scene lengths, (L, 2)."""
        return frozen(self.elements["length"][self.pairs] * self.scene.unit)

    @cached_property
    def levels(self) -> Array:
        """Levels of the elements in their trees, 0 for a whole patch, (L, 2)."""
        whole = self.elements["length"][self.patches]
        return frozen(np.rint(np.log2(whole / self.elements["length"][self.pairs])).astype(int))

    @cached_property
    def intervals(self) -> Array:
        """Where the elements begin and end on their patches, from 0 to 1, (L, 2, 2)."""
        parts = np.ldexp(1.0, -self.levels)
        from_start = self.elements["a"][self.pairs] - self.elements["a"][self.patches]
        length = self.elements["length"][self.pairs]
        start = np.rint(np.hypot(from_start[..., 0], from_start[..., 1]) / length) * parts
        return frozen(np.stack([start, start + parts], axis=-1))

    @cached_property
    def kernel(self) -> Array:
        """The mean of the kernel, occlusion included, in 1/scene length, (L,)."""
        return frozen(self.exchange_areas / self.lengths[:, 0] / self.lengths[:, 1])

    def matrix(self) -> Any:
        """AF as a scipy.sparse.coo_matrix (N, N), with one entry per link and direction."""
        sparse: Any = import_module("scipy.sparse")

        row, column, area = *self.pairs.T, self.exchange_areas
        if not self.directed:
            row, column = np.concatenate([row, column]), np.concatenate([column, row])
            area = np.concatenate([area, area])
        return sparse.coo_matrix((area, (row, column)), shape=(self.N, self.N))


class Fit(NamedTuple):
    """L ≈ a + bN + cN² by least squares, and the slope of log L on log N."""

    a: float
    b: float
    c: float
    r2: float
    slope: float

    def __call__(self, N: Any) -> Any:
        """The quadratic at N, a number or an array."""
        return self.a + N * (self.b + N * self.c)


class Study:
    """L against N; arrays have an item per ε."""

    def __init__(self, scene: Any, rows: Array, raw: Any, pairs: Any):
        self.scene = scene
        self._raw = raw
        self._pairs = pairs
        self.epsilon: Array = rows["epsilon"].copy()
        self.N: Array = rows["N"].astype(np.int64)
        """Elements: all nodes of all trees."""
        self.L: Array = rows["L"].astype(np.int64)
        """Links."""
        self.leaves: Array = rows["leaves"].astype(np.int64)
        self.limited: Array = rows["limited"].astype(np.int64)
        """Links that only a limit of the level accepted."""
        self.oracle_calls: Array = rows["oracle_calls"].astype(np.int64)
        self.seconds: Array = rows["seconds"].copy()

    def __len__(self) -> int:
        return len(self.epsilon)

    def __repr__(self) -> str:
        if not len(self):
            return "<hr2d.Study of no ε>"
        return (f"<hr2d.Study of {len(self)} ε, N {self.N.min()} to {self.N.max()}, "
                f"L {self.L.min()} to {self.L.max()}>")

    def to_dataframe(self) -> Any:
        """A pandas.DataFrame with a row for each ε."""
        pandas: Any = import_module("pandas")

        names = ("epsilon", "N", "L", "leaves", "limited", "oracle_calls", "seconds")
        return pandas.DataFrame({name: getattr(self, name) for name in names})

    @cached_property
    def fit(self) -> Fit:
        """The least-squares fit of the paper's Figures 7 and 8; needs three different N."""
        raw = ffi.new("hr2d_study_fit *")
        with Call() as call:
            call.check(lib.hr2d_study_fit_rows(self._raw, len(self), raw))
        return Fit(raw.a, raw.b, raw.c, raw.r2, raw.slope)

    @cached_property
    def law(self) -> Law:
        """What the theorem says of L and N, with its constants; see Scene.study_law()."""
        return find_law(self._pairs)


def refine(scene: Any, paper: Dict[str, Any], limits: Dict[str, int], ordered: bool,
           progress: Optional[ProgressFunction]) -> Links:
    with Call(progress) as call:
        pairs = empty_links(scene, paper, call)
        options = refine_options(paper, limits)
        options.ordered = ordered
        call.check(lib.hr2d_refine(pairs, options), lambda: lib.hr2d_linkset_message(pairs))
    return Links(scene, pairs)


def study(scene: Any, epsilon: Union[Sequence[float], Array], paper: Dict[str, Any],
          limits: Dict[str, int], ordered: bool,
          progress: Optional[ProgressFunction]) -> Study:
    values = np.asarray(epsilon, np.float64)
    if values.ndim != 1:
        raise ValueError(f"epsilon is a sequence of numbers, not of shape {values.shape}")
    values = np.ascontiguousarray(values)
    rows = ffi.new("hr2d_study_row[]", max(1, len(values)))
    with Call(progress) as call:
        pairs = empty_links(scene, paper, call)
        options = refine_options(paper, limits)
        options.ordered = ordered
        if len(values):
            call.check(lib.hr2d_study_run(pairs, options, doubles(values), len(values), rows,
                                          ffi.NULL), lambda: lib.hr2d_linkset_message(pairs))
    return Study(scene, np.frombuffer(ffi.buffer(rows), _ROW)[:len(values)], rows, pairs)


def law(scene: Any, paper: Dict[str, Any], progress: Optional[ProgressFunction]) -> Law:
    with Call(progress) as call:
        pairs = empty_links(scene, paper, call)
    return find_law(pairs, progress)
