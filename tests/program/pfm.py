# SPDX-License-Identifier: GPL-3.0-or-later
"""pfm.py FILE.pfm FILE.csv X0 Y0 X1 Y1: whether both files of `hr2d field` have the same numbers, and
those of the table are at the centres of the pixels into which this box is divided.

The map is read by what its format says: three lines, and floats of the byte order of the scale."""
import csv
import math
import struct
import sys

with open(sys.argv[1], "rb") as file:
    kind, size, scale = (file.readline().decode("ascii") for _ in range(3))
    data = file.read()
assert kind in ("Pf\n", "PF\n"), kind
bands = {"Pf\n": 1, "PF\n": 3}[kind]
width, height = map(int, size.split())
assert size == f"{width} {height}\n" and scale == "-1.0\n", (size, scale)
assert len(data) == 4 * bands * width * height, len(data)
pixels = struct.unpack(f"<{len(data) // 4}f", data)

with open(sys.argv[2], newline="") as file:
    rows = list(csv.DictReader(file))
assert len(rows) == len(pixels), f"{len(rows)} rows, {len(pixels)} floats"
x0, y0, x1, y1 = map(float, sys.argv[3:])
for k, (row, value) in enumerate(zip(rows, pixels)):
    pixel, band = divmod(k, bands)
    line, column = divmod(pixel, width)  # lines count from the bottom
    x = x0 + (column + 0.5) * (x1 - x0) / width
    y = y0 + (line + 0.5) * (y1 - y0) / height
    assert int(row["band"]) == band
    assert abs(float(row["x"]) - x) < 1e-12 and abs(float(row["y"]) - y) < 1e-12, (k, row, x, y)
    if row["mean"] == "":
        assert math.isnan(value), (k, value)
    else:
        assert value == struct.unpack("<f", struct.pack("<f", float(row["mean"])))[0], (k, value, row)
