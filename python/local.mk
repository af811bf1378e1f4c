# The Python package.  tests/package/check-python.sh installs and tests it; see README.md.
EXTRA_DIST += \
	python/README.md \
	python/bundled/NOTICE \
	python/bundled/make.sh \
	python/hr2d-convert.1 \
	python/hr2d/__init__.py \
	python/hr2d/_arrays.py \
	python/hr2d/_calls.py \
	python/hr2d/_curves.py \
	python/hr2d/_draw.py \
	python/hr2d/_enclosure.py \
	python/hr2d/_errors.py \
	python/hr2d/_film.py \
	python/hr2d/_geojson.py \
	python/hr2d/_hr2d.pyi \
	python/hr2d/_law.py \
	python/hr2d/_links.py \
	python/hr2d/_points.py \
	python/hr2d/_read_dxf.py \
	python/hr2d/_read_mesh.py \
	python/hr2d/_read_svg.py \
	python/hr2d/_scene.py \
	python/hr2d/_shapes.py \
	python/hr2d/_solution.py \
	python/hr2d/_operator.py \
	python/hr2d/_solve.py \
	python/hr2d/_state.py \
	python/hr2d/_strategy.py \
	python/hr2d/convert.py \
	python/hr2d/sun.py \
	python/hr2d/py.typed \
	python/hr2d_backend.py \
	python/hr2d_build.py \
	python/pyproject.toml \
	python/setup.py \
	python/tests/conftest.py \
	python/tests/data/room-4.1.msh \
	python/tests/data/room.dxf \
	python/tests/data/room.msh \
	python/tests/data/room.svg \
	python/tests/data/room.vtk \
	python/tests/data/room.vtp \
	python/tests/data/room.vtu \
	python/tests/test_callbacks.py \
	python/tests/test_complete.py \
	python/tests/test_convert.py \
	python/tests/test_daylight.py \
	python/tests/test_symmetry.py \
	python/tests/test_documentation.py \
	python/tests/test_draw.py \
	python/tests/test_drawings.py \
	python/tests/test_film.py \
	python/tests/test_law.py \
	python/tests/test_one_value.py python/tests/test_scene.py \
	python/tests/test_links.py \
	python/tests/test_operator.py \
	python/tests/test_solve.py \
	python/tests/test_sun.py \
	python/tests/test_thermal.py \
	python/tests/typed_example.py

# `make wheel` makes wheel/hr2d-*.whl, which carries the library, GSL and jansson, from the objects of
# the shared library.  tests/package/check-wheel.sh installs and tests it.
EXTRA_LTLIBRARIES = python/libstreams.la
python_libstreams_la_SOURCES = python/bundled/streams.c
python_libstreams_la_CPPFLAGS =
wheel: libhr2d.la python/libstreams.la
	@VERSION='$(VERSION)' PKG_CONFIG='$(PKG_CONFIG)' PYTHON='$(PYTHON)' \
	  $(SHELL) $(srcdir)/python/bundled/make.sh '$(abs_top_srcdir)' wheel \
	  ' $(GSL_LIBS) $(JANSSON_LIBS)'
clean-wheel:
	rm -rf wheel
clean-local: clean-wheel
.PHONY: wheel clean-wheel
CLEANFILES += python/libstreams.la
