# SPDX-License-Identifier: GPL-3.0-or-later
"""vti.py format|vtk FILE.vti FILE.csv: whether both files of `hr2d field` have the same numbers.

`format` reads the file by what the VTK file formats say, strictly; `vtk` by VTK's own reader, which
is that of ParaView."""
import base64
import csv
import math
import struct
import sys
import xml.etree.ElementTree


def numbers(text, swap):
    """An array in base64: the number of bytes as 8 bytes, which stand alone, and then doubles."""
    text = text.strip()
    (size,) = struct.unpack(swap + "Q", base64.b64decode(text[:12], validate=True))
    data = base64.b64decode(text[12:], validate=True)
    assert len(data) == size, f"{len(data)} bytes, not {size}"
    return struct.unpack(f"{swap}{size // 8}d", data)


def by_format(path):
    root = xml.etree.ElementTree.parse(path).getroot()
    assert root.tag == "VTKFile" and root.get("type") == "ImageData"
    assert root.get("version") == "1.0" and root.get("header_type") == "UInt64"
    swap = {"LittleEndian": "<", "BigEndian": ">"}[root.get("byte_order")]
    (image,) = root
    (fields, piece) = image
    (text,) = fields
    assert (fields.tag, text.tag, text.get("type")) == ("FieldData", "DataArray", "String")
    *codes, end = (int(code) for code in text.text.split())
    assert end == 0 and bytes(codes).startswith(b"hr2d "), codes
    (points,) = piece
    assert (image.tag, piece.tag, points.tag) == ("ImageData", "Piece", "PointData")
    extent = [int(x) for x in image.get("WholeExtent").split()]
    assert extent == [int(x) for x in piece.get("Extent").split()]
    arrays = {}
    for item in points:
        assert item.tag == "DataArray" and item.get("type") == "Float64"
        assert item.get("format") == "binary"
        flat = numbers(item.text, swap)
        each = int(item.get("NumberOfComponents"))
        arrays[item.get("Name")] = [flat[k : k + each] for k in range(0, len(flat), each)]
    return (
        extent,
        [float(x) for x in image.get("Origin").split()],
        [float(x) for x in image.get("Spacing").split()],
        arrays,
    )


def by_vtk(path):
    from vtkmodules.vtkIOXML import vtkXMLImageDataReader

    reader = vtkXMLImageDataReader()
    assert reader.CanReadFile(path), "VTK cannot read it"
    reader.SetFileName(path)
    reader.Update()
    assert reader.GetErrorCode() == 0, f"VTK's error {reader.GetErrorCode()}"
    image = reader.GetOutput()
    assert image.GetFieldData().GetAbstractArray("provenance").GetValue(0).startswith("hr2d ")
    data = image.GetPointData()
    arrays = {}
    for k in range(data.GetNumberOfArrays()):
        array = data.GetArray(k)
        arrays[data.GetArrayName(k)] = [
            array.GetTuple(n) for n in range(array.GetNumberOfTuples())
        ]
    return list(image.GetExtent()), image.GetOrigin(), image.GetSpacing(), arrays


def same(one, other):
    return one == other or (math.isnan(one) and math.isnan(other))


def main(how, path, table):
    extent, origin, spacing, arrays = (by_vtk if how == "vtk" else by_format)(path)
    with open(table, newline="", encoding="ascii") as stream:
        rows = list(csv.DictReader(stream))
    bands = 1 + max(int(row["band"]) for row in rows)
    columns, lines = extent[1] + 1, extent[3] + 1
    assert extent == [0, columns - 1, 0, lines - 1, 0, 0]
    assert len(rows) == columns * lines * bands
    names = [f"{name}{b}" for b in range(bands) for name in ("mean", "flux")]
    assert sorted(arrays) == sorted(names + ["sky", "place"]), sorted(arrays)
    assert all(len(array) == columns * lines for array in arrays.values())
    outside = 0
    for k, row in enumerate(rows):
        point, band = divmod(k, bands)
        assert math.isclose(float(row["x"]), origin[0] + point % columns * spacing[0], abs_tol=1e-12)
        assert math.isclose(float(row["y"]), origin[1] + point // columns * spacing[1], abs_tol=1e-12)
        mean, x, y = (float(row[name] or "nan") for name in ("mean", "flux_x", "flux_y"))
        assert same(arrays[f"mean{band}"][point][0], mean), k
        flux = arrays[f"flux{band}"][point]
        assert same(flux[0], x) and same(flux[1], y) and flux[2] == 0, k
        assert arrays["sky"][point][0] == float(row["sky"]), k
        assert (arrays["place"][point][0] == 2) == (row["mean"] == ""), k
        outside += row["mean"] == ""
    print(f"{len(rows)} rows, {outside} of them outside")


main(*sys.argv[1:])
