# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes an SVG or a PNG without what tells where it comes from, which names the program."""
import re
import struct
import sys

data = open(sys.argv[1], "rb").read()
if data.startswith(b"\x89PNG"):
    plain, at = data[:8], 8
    while at < len(data):
        size, kind = struct.unpack(">I4s", data[at : at + 8])
        if kind != b"iTXt":
            plain += data[at : at + 12 + size]
        at += 12 + size
else:
    plain = re.sub(b"<metadata>.*?</metadata>", b"", data)
if plain == data:
    sys.exit(sys.argv[1] + " tells nothing")
sys.stdout.buffer.write(plain)
