# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads --json of hr2d-mpi: no rank has more than 1.15 of the mean of links, and 1.3 of the mean
of visibility tests."""
import json
import sys

found = json.load(open(sys.argv[1], encoding="utf-8"))
ranks = found["ranks"]
links = ranks["most_links"] * ranks["count"] / found["links"]
tests = found["work"]["visibility_tests"]
tests = ranks["most_visibility_tests"] * ranks["count"] / tests if tests else 1
print(f"links {links:.3f}, visibility tests {tests:.3f}")
assert links <= 1.15 and tests <= 1.3
