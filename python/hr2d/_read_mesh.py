# SPDX-License-Identifier: GPL-3.0-or-later
"""Lines and boundaries of meshes as shapes: gmsh and VTK files by meshio, VTK's polygonal data by
VTK itself, which meshio does not read."""
from __future__ import annotations

from typing import Any, Dict, List, NamedTuple, Optional, Tuple

import numpy as np

from . import _shapes
from ._arrays import Array
from ._errors import FormatError, SceneError
from ._shapes import Report, Shape

LINES = {"line": (0, 1), "line3": (0, 2, 1), "line4": (0, 2, 3, 1)}
"""The nodes of a cell on its way; curved cells run through their nodes."""
EDGES = {"triangle": ((0, 1), (1, 2), (2, 0)), "quad": ((0, 1), (1, 2), (2, 3), (3, 0)),
         "triangle6": ((0, 3, 1), (1, 4, 2), (2, 5, 0))}
EDGES["quad8"] = EDGES["quad9"] = ((0, 4, 1), (1, 5, 2), (2, 6, 3), (3, 7, 0))
USUAL_TAGS = ("gmsh:physical", "medit:ref", "CellEntityIds", "gmsh:geometrical")

Nodes = Tuple[int, ...]


class Block(NamedTuple):
    """Cells of one kind."""

    kind: str
    cells: Any
    """The nodes of each."""
    tags: Any
    """The tag of each, or None."""


class Mesh(NamedTuple):
    points: Array
    blocks: List[Block]
    tagged: str
    """The name of what tags them."""
    names: Dict[Tuple[int, int], str]
    """Of tags, by dimension."""


def _three(points: Any) -> Array:
    if len(points) == 0:
        raise FormatError("there are no points")
    points = np.asarray(points, dtype=float).reshape(len(points), -1)
    return np.column_stack([points, np.zeros((len(points), 3 - points.shape[1]))])


def _tags(data: Any, wanted: Optional[str]) -> Optional[str]:
    """The array of cells that names them: the one that is asked for, a usual one, or the only one
    of integers."""
    if wanted is not None:
        if wanted not in data:
            raise FormatError(f"no tags {wanted!r} of cells, but {', '.join(data) or 'none'}")
        if any(np.size(block) != len(block) for block in data[wanted]):
            raise FormatError(f"{wanted!r} has several numbers for each cell")
        return wanted
    for name in USUAL_TAGS:
        if name in data:
            return name
    whole = [name for name, blocks in data.items()
             if all(np.size(b) == len(b) and np.issubdtype(np.asarray(b).dtype, np.integer)
                    for b in blocks)]
    return whole[0] if len(whole) == 1 else None


def _by_meshio(path: str, kind: str, wanted: Optional[str]) -> Mesh:
    meshio: Any = _shapes.need("meshio", "Meshes", "python3-meshio", "meshio")
    try:
        mesh = meshio.read(path, file_format=kind)
    except (Exception, SystemExit) as error:  # of any kind, for its readers check little
        raise FormatError(f"no {kind} file that meshio can read: {error or type(error).__name__}"
                          ) from error
    tags = _tags(mesh.cell_data, wanted)
    blocks = [Block(block.type, block.data, np.ravel(mesh.cell_data[tags][k]) if tags else None)
              for k, block in enumerate(mesh.cells)]
    names = {(int(dimension), int(tag)): str(name)
             for name, (tag, dimension) in mesh.field_data.items()
             } if tags == "gmsh:physical" else {}
    return Mesh(_three(mesh.points), blocks, tags or "", names)


def _by_vtk(path: str, module: str, reader: str, wanted: Optional[str]) -> Mesh:
    io: Any = _shapes.need(f"vtkmodules.{module}", "VTK's polygonal data", "python3-vtk9", "vtk")
    to_numpy = _shapes.need("vtkmodules.util.numpy_support", "VTK's polygonal data", "python3-vtk9",
                            "vtk").vtk_to_numpy
    source = getattr(io, reader)()
    source.SetFileName(path)
    wrong: List[int] = []
    source.AddObserver("ErrorEvent", lambda *_: wrong.append(1))
    source.Update()
    data = source.GetOutput()
    if wrong or data is None or data.GetPoints() is None:
        raise FormatError("no polygonal data that VTK can read")
    arrays = {data.GetCellData().GetArrayName(k): to_numpy(data.GetCellData().GetArray(k))
              for k in range(data.GetCellData().GetNumberOfArrays())
              if data.GetCellData().GetArray(k) is not None}
    tags = _tags({name: [array] for name, array in arrays.items()}, wanted)
    blocks = []
    for k in range(data.GetNumberOfCells()):
        cell = data.GetCell(k)
        nodes = [cell.GetPointId(i) for i in range(cell.GetNumberOfPoints())]
        kind = {0: "vertex", 1: "line", 2: "polygon"}[cell.GetCellDimension()]
        tag = [np.ravel(arrays[tags])[k]] if tags else None
        pairs = [nodes[i:i + 2] for i in range(len(nodes) - 1)] if kind == "line" else [nodes]
        if cell.GetCellType() == 6:  # a strip of triangles
            pairs = [nodes[i:i + 3] for i in range(len(nodes) - 2)]
        blocks.append(Block(kind, pairs, tag and tag * len(pairs)))
    return Mesh(_three(to_numpy(data.GetPoints().GetData())), blocks, tags or "", {})


def _polygonal(path: str) -> bool:
    """Whether a legacy file has polygonal data."""
    with open(path, "rb") as file:
        head = file.read(2000).upper()
    return b"DATASET" in head and head.split(b"DATASET")[1].split()[:1] == [b"POLYDATA"]


def _load(path: str, kind: str, wanted: Optional[str]) -> Mesh:
    if kind == "vtp":
        return _by_vtk(path, "vtkIOXML", "vtkXMLPolyDataReader", wanted)
    if kind == "vtk" and _polygonal(path):
        return _by_vtk(path, "vtkIOLegacy", "vtkPolyDataReader", wanted)
    return _by_meshio(path, kind, wanted)


def _flat(points: Array, nodes: Any) -> bool:
    part = points[list(nodes)]
    size = np.ptp(part, axis=0)
    return bool(size[2] <= 1e-9 * size.max())


def _check_points(mesh: Mesh) -> None:
    """Those that cells have are there, and are finite."""
    wrong = ~np.isfinite(mesh.points).all(axis=1)
    for block in mesh.blocks:
        if block.tags is not None and len(block.tags) != len(block.cells):
            raise FormatError(f"{len(block.cells)} cells have {len(block.tags)} tags")
        ways = [LINES.get(block.kind, (0,)), *EDGES.get(block.kind, ())]
        needed = 1 + max(max(way) for way in ways)
        for nodes in block.cells:
            if len(nodes) < needed or min(nodes) < 0 or max(nodes) >= len(wrong):
                raise FormatError("a cell has a point that is not there")
            for node in nodes:
                if wrong[node]:
                    raise SceneError(f"point {node + 1} of the mesh: a coordinate is not finite")


def _edges(block: Block, mesh: Mesh, report: Report) -> List[Tuple[Nodes, Any]]:
    """The edges of cells with an area, counterclockwise, and the tags of the cells."""
    found: List[Tuple[Nodes, Any]] = []
    for k, nodes in enumerate(block.cells):
        if not _flat(mesh.points, nodes):
            report.count("skipped", f"{block.kind} out of the plane")
            continue
        ways = EDGES.get(block.kind) or [(i, (i + 1) % len(nodes)) for i in range(len(nodes))]
        edges = [tuple(int(nodes[i]) for i in way) for way in ways]
        if _shapes.area(mesh.points[[e[0] for e in edges], :2]) < 0:
            edges = [edge[::-1] for edge in edges]
        tag = None if block.tags is None else block.tags[k]
        found += [(edge, tag) for edge in edges]
    return found


def _label(mesh: Mesh, tag: Any, dimension: int, otherwise: str) -> str:
    if tag is None:
        return otherwise
    return mesh.names.get((dimension, int(tag)), f"{mesh.tagged.rpartition(':')[2]} {tag}")


def read(path: str, kind: str, wanted: Optional[str], report: Report) -> List[Shape]:
    mesh = _load(path, kind, wanted)
    _check_points(mesh)
    lines: List[Tuple[Nodes, Any]] = []
    edges: List[Tuple[Nodes, Any]] = []
    for block in mesh.blocks:
        if block.kind in LINES:
            cells = [tuple(int(nodes[i]) for i in LINES[block.kind]) for nodes in block.cells]
            flat = [_flat(mesh.points, cell) for cell in cells]
            report.count("skipped", f"{block.kind} out of the plane", flat.count(False))
            tags = [None] * len(cells) if block.tags is None else block.tags
            lines += [(cell, tag) for cell, tag, ok in zip(cells, tags, flat) if ok]
        elif block.kind in EDGES or block.kind == "polygon":
            edges += _edges(block, mesh, report)
        else:
            report.count("skipped", block.kind, len(block.cells))
    cells_at: Dict[frozenset[int], List[Tuple[Nodes, Any]]] = {}
    for edge in edges:
        cells_at.setdefault(frozenset((edge[0][0], edge[0][-1])), []).append(edge)
    border = {key: cells[0] for key, cells in cells_at.items() if len(cells) == 1}
    if not lines:
        return [_shape(mesh, edge, _label(mesh, tag, 2, "boundary"), True)
                for edge, tag in border.values()]
    found = []
    for nodes, tag in lines:
        known = border.pop(frozenset((nodes[0], nodes[-1])), None)
        if known and known[0][0] != nodes[0]:
            nodes = nodes[::-1]
        found.append(_shape(mesh, nodes, _label(mesh, tag, 1, "line"), known is not None))
    report.count("skipped", "edge of the boundary that is no line of the mesh", len(border))
    return found


def _shape(mesh: Mesh, nodes: Nodes, name: str, sure: bool) -> Shape:
    return Shape(name, mesh.points[list(nodes), :2], False, "", sure)
