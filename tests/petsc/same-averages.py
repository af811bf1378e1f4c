# SPDX-License-Identifier: GPL-3.0-or-later
"""Compares two files of --json: averages to 1e-12 of the largest, and counts exactly."""
import json
import sys

one, other = (json.load(open(path)) for path in sys.argv[1:3])
for key in ("elements", "leaves", "links", "limited_links", "levels", "epsilon", "effects"):
    assert one[key] == other[key], (key, one[key], other[key])
for key in ("oracle_calls", "facing_tests", "visibility_tests", "exchange_areas", "partial_links"):
    assert one["work"][key] == other["work"][key], key
for key in ("average", "irradiance"):
    a = [x for patch in one["patches"] for x in patch[key]]
    b = [x for patch in other["patches"] for x in patch[key]]
    assert len(a) == len(b) > 0
    off = max(abs(x - y) for x, y in zip(a, b)) / max(map(abs, a))
    assert off <= 1e-12, (key, off)
for a, b in zip(one["power"], other["power"]):
    most = max(a[key] for key in ("emitted", "received", "absorbed", "escaped"))
    for key in ("emitted", "received", "absorbed", "escaped"):
        assert abs(a[key] - b[key]) <= 1e-12 * most, (key, a[key], b[key])
