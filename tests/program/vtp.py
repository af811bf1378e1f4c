# SPDX-License-Identifier: GPL-3.0-or-later
"""vtp.py format|vtk FILE.vtp FILE.csv FILE.json: whether the three files of one `hr2d solve` have
the same numbers.

`format` reads the file by what the VTK file formats say; `vtk` by VTK's own reader."""
import base64
import csv
import json
import math
import struct
import sys
import xml.etree.ElementTree


def by_format(path):
    root = xml.etree.ElementTree.parse(path).getroot()
    assert root.tag == "VTKFile" and root.get("type") == "PolyData" and root.get("header_type") == "UInt64"
    swap = {"LittleEndian": "<", "BigEndian": ">"}[root.get("byte_order")]

    def numbers(item):
        text = item.text.strip()
        (size,) = struct.unpack(swap + "Q", base64.b64decode(text[:12], validate=True))
        data = base64.b64decode(text[12:], validate=True)
        assert len(data) == size
        kind = {"Float64": "d", "Int64": "q"}[item.get("type")]
        flat = struct.unpack(f"{swap}{size // 8}{kind}", data)
        each = int(item.get("NumberOfComponents"))
        return flat if each == 1 else [flat[k : k + each] for k in range(0, len(flat), each)]

    (data,) = root
    fields, piece = data
    assert fields.tag == "FieldData"
    count = int(piece.get("NumberOfLines"))
    points, lines, cells = piece
    ends = numbers(points[0])
    assert len(ends) == int(piece.get("NumberOfPoints")) == 2 * count
    at = {item.get("Name"): numbers(item) for item in lines}
    assert list(at["connectivity"]) == list(range(2 * count))
    assert list(at["offsets"]) == list(range(2, 2 * count + 1, 2))
    return [(ends[2 * k], ends[2 * k + 1]) for k in range(count)], {i.get("Name"): numbers(i) for i in cells}


def by_vtk(path):
    from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

    reader = vtkXMLPolyDataReader()
    assert reader.CanReadFile(path)
    reader.SetFileName(path)
    reader.Update()
    assert reader.GetErrorCode() == 0
    data = reader.GetOutput()
    assert data.GetFieldData().GetAbstractArray("provenance").GetValue(0).startswith("hr2d ")
    lines = []
    for k in range(data.GetNumberOfCells()):
        points = data.GetCell(k).GetPoints()
        assert points.GetNumberOfPoints() == 2
        lines.append((points.GetPoint(0), points.GetPoint(1)))
    cells = data.GetCellData()
    arrays = [cells.GetArray(k) for k in range(cells.GetNumberOfArrays())]
    return lines, {a.GetName(): [a.GetValue(k) for k in range(a.GetNumberOfTuples())] for a in arrays}


def same(one, other):
    return one == other or (math.isnan(one) and math.isnan(other))


def main(how, path, table, result):
    lines, cells = (by_vtk if how == "vtk" else by_format)(path)
    with open(table, newline="", encoding="utf-8") as stream:
        rows = list(csv.DictReader(stream))
    with open(result, encoding="utf-8") as stream:
        patches = json.load(stream)["patches"]
    assert len(rows) == len(lines)
    bands = len(patches[0]["average"])
    heat = ["T", "patch_T"] if "T" in rows[0] else []
    assert sorted(cells) == sorted(["patch", *heat] + [p + q + str(b) for p in ("", "patch_") for q in "BH"
                                                       for b in range(bands)])
    for k, row in enumerate(rows):
        assert lines[k] == ((float(row["ax"]), float(row["ay"]), 0), (float(row["bx"]), float(row["by"]), 0)), k
        patch = patches[int(row["patch"])]
        assert cells["patch"][k] == patch["index"]
        for b in range(bands):
            assert cells[f"B{b}"][k] == float(row[f"B{b}"]) and cells[f"H{b}"][k] == float(row[f"H{b}"]), k
            assert cells[f"patch_B{b}"][k] == patch["average"][b], k
            assert cells[f"patch_H{b}"][k] == patch["irradiance"][b], k
        if heat:
            assert same(cells["T"][k], float(row["T"] or "nan")), k
            known = patch["temperature"]
            assert same(cells["patch_T"][k], math.nan if known is None else known), k
    print(f"{len(rows)} lines")


main(*sys.argv[1:])
