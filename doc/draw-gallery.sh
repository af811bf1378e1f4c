#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# draw-gallery.sh FOLDER: runs the commands of doc/gallery.md, as tests/docs/check-docs.sh does, and puts their
# pictures into FOLDER at half their size, with 256 dithered colours each: a quarter of the bytes.  Films
# stay as they are.  Needs a Python with Pillow.
#
# Environment: HR2D_PROGRAM, the program; HR2D_SRCDIR and HR2D_BUILDDIR, the tops of the sources and of
# the build.
set -eu
folder=$1
. "$HR2D_SRCDIR/tests/docs/pages.sh"
for python in ${PYTHON-} python3 /usr/bin/python3 ''; do
  [ -n "$python" ] || { echo "gallery: no python3 has Pillow (python3-pil)" >&2; exit 1; }
  ! "$python" -c 'import PIL' 2>/dev/null || break
done
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
make_reader "$work/bin"
run_page "$HR2D_SRCDIR/doc/gallery.md" "$work/page"
mkdir -p "$folder"
rm -f "$folder"/*.png
"$python" - "$folder" "$work/page/reader"/*.png <<'PY'
import shutil, sys
from pathlib import Path
from PIL import Image
for path in map(Path, sys.argv[2:]):
    picture = Image.open(path)
    if getattr(picture, "n_frames", 1) > 1:
        shutil.copy(path, sys.argv[1])
    else:
        half = picture.convert("RGB").resize((picture.width // 2, picture.height // 2), Image.Resampling.LANCZOS)
        colours = half.quantize(256, kmeans=3)
        listed = colours.getpalette()
        for k in range(0, len(listed), 3):
            if min(listed[k:k + 3]) > 245:
                listed[k:k + 3] = 255, 255, 255
        colours.putpalette(listed)
        few = half.quantize(palette=colours, dither=Image.Dither.FLOYDSTEINBERG)
        few.save(Path(sys.argv[1]) / path.name, optimize=True)
PY
