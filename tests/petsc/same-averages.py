# SPDX-License-Identifier: GPL-3.0-or-later
"""Compares two files of --json: averages to 1e-12 of the largest, and counts exactly.  With a third
one, the averages of the second and the third have to be the same in all bits.  After --but stand
counts of work that may differ, separated by commas."""
import json
import sys

free = sys.argv.pop(1).split(",") if sys.argv[1] == "--but" and sys.argv.pop(1) else []
one, other = (json.load(open(path, encoding="utf-8")) for path in sys.argv[1:3])
for key in ("elements", "leaves", "links", "limited_links", "levels", "epsilon", "effects"):
    assert one[key] == other[key], (key, one[key], other[key])
for key in ("oracle_calls", "facing_tests", "visibility_tests", "exchange_areas", "partial_links"):
    assert key in free or one["work"][key] == other["work"][key], key


def values(found, key):
    return [x for patch in found["patches"] for x in patch[key]]


for key in ("average", "irradiance"):
    a, b = values(one, key), values(other, key)
    assert len(a) == len(b) > 0
    off = max(abs(x - y) for x, y in zip(a, b)) / max(map(abs, a))
    assert off <= 1e-12, (key, off)
    if len(sys.argv) > 3:
        assert b == values(json.load(open(sys.argv[3], encoding="utf-8")), key), key
for a, b in zip(one["power"], other["power"]):
    most = max(a[key] for key in ("emitted", "received", "absorbed", "escaped"))
    for key in ("emitted", "received", "absorbed", "escaped"):
        assert abs(a[key] - b[key]) <= 1e-12 * most, (key, a[key], b[key])
if "error" in other and other["order"] > 1:
    for key in ("estimate", "bound", "sup_estimate", "sup_bound"):
        a, b = one["error"][key], other["error"][key]
        assert a == b or abs(a - b) <= 1e-6 * a + 1e-13, (key, a, b)
