# SPDX-License-Identifier: GPL-3.0-or-later
"""Drawings and meshes as scenes: DXF, SVG, gmsh and VTK files become GeoJSON.

    import hr2d, hr2d.convert
    scene = hr2d.Scene()
    scene.add(hr2d.convert.read("room.dxf", scale=.001, properties={"reflectance": .5}))

`hr2d-convert`, or `python3 -m hr2d.convert`, does it on the command line.
"""
from __future__ import annotations

import argparse
import json
import math
import os
import sys
import warnings
from typing import Any, Callable, Collection, Dict, List, Mapping, Optional, Sequence, Union

from . import _read_dxf, _read_mesh, _read_svg, _shapes
from ._errors import FormatError, SceneError
from ._shapes import Report, Shape

__all__ = ["ConvertWarning", "read"]

FORMATS = {".dxf": "dxf", ".svg": "svg", ".msh": "gmsh", ".vtk": "vtk", ".vtu": "vtu",
           ".vtp": "vtp"}
SURFACE = ("emission", "reflectance", "transmittance")
HEAT = ("temperature", "flux", "heat", "emissivity", "shield")


class ConvertWarning(UserWarning):
    """What of a file is not in the scene, or is there in another way than in the file."""


def _warn(line: str) -> None:
    warnings.warn(line, ConvertWarning, stacklevel=4)


def _format(path: str, given: Optional[str]) -> str:
    if given is not None:
        if given not in FORMATS.values():
            raise ValueError(f"format: {given!r} is none of {', '.join(FORMATS.values())}")
        return given
    suffix = os.path.splitext(path)[1].lower()
    if suffix not in FORMATS:
        raise FormatError(f"the name ends with none of {', '.join(FORMATS)}: give the format")
    return FORMATS[suffix]


def _check(**choices: Any) -> None:
    for key, (value, allowed) in choices.items():
        if value not in allowed:
            raise ValueError(f"{key}: {value!r} is none of {', '.join(allowed)}")


def _properties(general: Mapping[str, Any], own: Mapping[str, Any]) -> Dict[str, Any]:
    """Those of a name in front of those of all: a heated patch has no emission, and the other way
    round."""
    heat, surface = ("temperature", "flux", "heat", "shield"), ("emission", "reflectance")
    if any(own.get(key) is not None for key in heat):
        general = {k: v for k, v in general.items() if k not in heat + surface}
    elif any(own.get(key) is not None for key in surface):
        general = {k: v for k, v in general.items() if k not in HEAT}
    return {**general, **own}


def _select(shapes: List[Shape], only: Optional[Collection[str]], report: Report) -> List[Shape]:
    if only is None:
        return shapes
    there = {shape.name for shape in shapes}
    for name in only:
        if name not in there:
            raise SceneError(f"nothing is called {name!r}; there is "
                             f"{', '.join(sorted(there)) or 'nothing'}")
    for shape in shapes:
        if shape.name not in only:
            report.count("left out", shape.name)
    return [shape for shape in shapes if shape.name in only]


def read(path: Union[str, "os.PathLike[str]"], *, format: Optional[str] = None,
         tolerance: Optional[float] = None, scale: float = 1.0, faces: str = "in",
         front: str = "left", sides: str = "front", join: bool = False, names: str = "id",
         only: Optional[Collection[str]] = None, tags: Optional[str] = None,
         properties: Optional[Mapping[str, Any]] = None,
         materials: Optional[Mapping[str, Mapping[str, Any]]] = None,
         report: Optional[Callable[[str], None]] = None) -> Dict[str, Any]:
    """The scene of a file as GeoJSON, which Scene.add() takes: a feature for each name.

    A name is a layer of DXF, an id, a class or a group of SVG, a physical group of gmsh, a tag of
    the cells of VTK.  DXF files need ezdxf, SVG files svgelements, meshes meshio, and polygonal data
    of VTK the module vtk.

    format
        "dxf", "svg", "gmsh", "vtk", "vtu" or "vtp"; by default the end of the name tells it.
    tolerance
        How far a chord may be from the curve that it replaces, in units of the file.  Ends of
        chords lie on the curve.  By default it is 1/200 of the radius, which makes 32 chords of
        a circle, and 1/400 of the extent of the control points of other curves.
    scale
        Scene lengths per unit of the file: .001 makes metres of millimetres.
    faces
        "in": the fronts of closed rings look into the area that they enclose: those of the
        outermost ring inwards, those of rings in it outwards.  "out": away from this area.  Lines
        that form a ring together are one.  For a mesh it is the area of its cells.
    front
        Of lines that are part of no ring: "left" or "right", as they are drawn.
    sides
        "front" or "both", of all patches.
    join
        True: edges of one name that go on in the same direction become one.
    names
        "id", "class" or "group": what names shapes of SVG.
    only
        The names that are wanted; others are left out.
    tags
        The array that has the tags of cells, of meshes.
    properties, materials
        Properties of all features, as {"reflectance": .5}; and of those with a name, as
        {"lamp": {"emission": 1}}, which go before.
    report
        A function that gets each line about what was skipped, dropped or turned; by default it is a
        ConvertWarning.

    FormatError is raised of a file that is not of its format, SceneError of an empty scene and of
    coordinates that are not finite, ModuleNotFoundError where a module is missing.

    >>> import hr2d.convert, os, tempfile
    >>> path = os.path.join(tempfile.mkdtemp(), "room.svg")
    >>> with open(path, "w") as file:
    ...     _ = file.write('<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 4 3">'
    ...                    '<rect id="room" width="4" height="3"/></svg>')
    >>> found = hr2d.convert.read(path, properties={"emission": 1})
    >>> found["features"][0]["geometry"]["coordinates"]
    [[[0.0, 0.0], [4.0, 0.0], [4.0, 3.0], [0.0, 3.0], [0.0, 0.0]]]
    >>> found["features"][0]["properties"]
    {'name': 'room', 'faces': 'in', 'emission': 1}
    """
    _check(faces=(faces, ("in", "out")), front=(front, ("left", "right")),
           sides=(sides, ("front", "both")), names=(names, ("id", "class", "group")))
    if not (math.isfinite(scale) and scale > 0):
        raise ValueError(f"scale: {scale!r} is not finite and positive")
    if tolerance is not None and not (math.isfinite(tolerance) and tolerance > 0):
        raise ValueError(f"tolerance: {tolerance!r} is not finite and positive")
    path, kind = os.fspath(path), _format(os.fspath(path), format)
    with open(path, "rb"):
        pass  # what the system says of a file that is not there is the same for all kinds
    told = Report(report or _warn)
    if kind == "dxf":
        shapes = _read_dxf.read(path, tolerance, scale, told)
    elif kind == "svg":
        shapes = _read_svg.read(path, tolerance, names, told)
    else:
        shapes = _read_mesh.read(path, kind, tags, told)
    shapes = _select(shapes, only, told)
    shapes = _shapes.clean((s._replace(points=s.points * scale) for s in shapes), told)
    shapes = _shapes.clean(_shapes.weld(shapes, told), told)
    by_name: Mapping[str, Mapping[str, Any]] = materials or {}

    def properties_of(name: str) -> Dict[str, Any]:
        return _properties({"sides": sides, **(properties or {})}, by_name.get(name, {}))

    def one_sided(name: str) -> bool:
        return properties_of(name).get("sides") in (None, "front")

    shapes = _shapes.chain(_shapes.orient(shapes, faces, front, one_sided, told))
    if join:
        shapes = [_shapes.straighten(shape) for shape in shapes]
    told.tell()
    if not shapes:
        raise SceneError("there is no line in it: the scene would be empty")
    for name in by_name:
        if all(shape.name != name for shape in shapes):
            told.say(f"material of {name!r}: nothing has this name")
    return _shapes.collection(shapes, properties_of)


# ---- the command

def _values(text: str) -> Any:
    """A number, or numbers with commas, one for each band."""
    try:
        numbers = [float(part) for part in text.split(",")]
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r} is neither a number nor numbers with commas"
                                         ) from None
    if not all(math.isfinite(number) for number in numbers):
        raise argparse.ArgumentTypeError(f"{text!r} is not finite")
    return numbers if len(numbers) > 1 else numbers[0]


def _positive(text: str) -> float:
    value = _values(text)
    if not isinstance(value, float) or value <= 0:
        raise argparse.ArgumentTypeError(f"{text!r} is no number above 0")
    return value


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="hr2d-convert", allow_abbrev=False,
        description="Makes a scene of hr2d, GeoJSON, of a DXF, SVG, gmsh or VTK file.",
        epilog="For example: hr2d-convert plan.dxf --scale 0.001 --reflectance 0.5 -o plan.geojson")
    add = parser.add_argument
    add("file", metavar="FILE", help="of " + ", ".join(FORMATS))
    add("-o", "--output", metavar="FILE", default="-", help="the scene; - is standard output")
    add("--format", choices=list(FORMATS.values()), help="if the name does not tell it")
    add("--tolerance", metavar="T", type=_positive,
        help="how far chords may be from curves, in units of the file; 1/200 of a radius")
    add("--scale", metavar="S", type=_positive, default=1.0,
        help="scene lengths per unit of the file; 0.001 makes metres of mm")
    faces = parser.add_mutually_exclusive_group()
    faces.add_argument("--inside", dest="faces", action="store_const", const="in", default="in",
                       help="fronts of rings look into the area that they enclose (default)")
    faces.add_argument("--outside", dest="faces", action="store_const", const="out",
                       help="they look away from it")
    add("--front", choices=["left", "right"], default="left", help="of lines in no ring")
    add("--sides", choices=["front", "both"], default="front")
    add("--join", action="store_true", help="edges that go on in the same direction become one")
    add("--names", choices=["id", "class", "group"], default="id", help="what names shapes of SVG")
    add("--only", metavar="NAME", action="append", help="leave out all others; may be repeated")
    add("--tags", metavar="ARRAY", help="what names cells of meshes")
    add("--materials", metavar="FILE", help="JSON: an object from names to their properties")
    for key in SURFACE + HEAT[:4]:
        add(f"--{key}", metavar="X[,X]", type=_values, help="of all patches, one or one per band")
    return parser


def _materials(path: Optional[str]) -> Dict[str, Dict[str, Any]]:
    if path is None:
        return {}
    with open(path, encoding="utf-8-sig") as file:
        try:
            found = json.load(file)
        except ValueError as error:
            raise FormatError(f"{path}: no JSON: {error}") from None
    if not isinstance(found, dict) or not all(isinstance(v, dict) for v in found.values()):
        raise FormatError(f"{path}: no object from names to objects with their properties")
    return found


def text_of(scene: Mapping[str, Any]) -> str:
    """A feature on each line."""
    features = ",\n".join("  " + json.dumps(f, ensure_ascii=False, allow_nan=False)
                          for f in scene["features"])
    return f'{{ "type": "FeatureCollection", "features": [\n{features}\n] }}\n'


def _convert(options: argparse.Namespace, say: Callable[[str], None]) -> None:
    from ._scene import Scene

    given = {key: getattr(options, key) for key in SURFACE + HEAT[:4]}
    scene = read(options.file, format=options.format, tolerance=options.tolerance,
                 scale=options.scale, faces=options.faces, front=options.front,
                 sides=options.sides, join=options.join, names=options.names, only=options.only,
                 tags=options.tags, materials=_materials(options.materials), report=say,
                 properties={k: v for k, v in given.items() if v is not None})
    text = text_of(scene)
    Scene().add_text(text)  # its reader knows what values may be
    if options.output == "-":
        sys.stdout.write(text)
        sys.stdout.flush()
        return
    if os.path.exists(options.output) and os.path.samefile(options.file, options.output):
        raise SceneError("the output is the input")
    with open(options.output, "w", encoding="utf-8") as file:
        file.write(text)


def main(arguments: Optional[Sequence[str]] = None) -> int:
    """The command hr2d-convert; returns its exit status."""
    options = _parser().parse_args(arguments)

    def say(line: str) -> None:
        print(f"hr2d-convert: {options.file}: {line}", file=sys.stderr)

    try:
        _convert(options, say)
    except OSError as error:
        print(f"hr2d-convert: {error.filename or options.file}: {error.strerror or error}",
              file=sys.stderr)
        return 1
    except (ValueError, ModuleNotFoundError, NotImplementedError) as error:
        say(str(error))
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
