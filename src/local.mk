# The library.  libhr2d-core.la holds it once for the shared library and once for
# the unit tests, which reach the internals that the shared library hides.
noinst_LTLIBRARIES += libhr2d-core.la
libhr2d_core_la_CPPFLAGS = -DHR2D_BUILDING -D_POSIX_C_SOURCE=200809L $(PUBLIC_CPPFLAGS) \
	$(GSL_CFLAGS) $(JANSSON_CFLAGS)
libhr2d_core_la_CFLAGS = $(AM_CFLAGS) $(OPENMP_CFLAGS)
libhr2d_core_la_LIBADD = $(GSL_LIBS) $(JANSSON_LIBS) -lm
libhr2d_core_la_SOURCES = \
	src/alloc.c src/alloc.h \
	src/backs.c src/backs.h \
	src/balance.c src/balance.h \
	src/block.c src/block.h \
	src/block-near.c \
	src/block-shaded.c \
	src/block-touching.c \
	src/blocks.c src/blocks.h \
	src/bodies.c src/bodies.h \
	src/boxes.c src/boxes.h \
	src/bytes.c src/bytes.h \
	src/classes.c src/classes.h \
	src/clock.h \
	src/closure.c src/closure.h \
	src/closure-orders.c \
	src/cluster-beams.c src/cluster-beams.h \
	src/cluster-far.c src/cluster-far.h \
	src/cluster-gather.c \
	src/cluster-shade.c src/cluster-shade.h \
	src/cluster-sides.c src/cluster-sides.h \
	src/cluster-tree.c src/cluster-tree.h \
	src/clusters.c src/clusters.h \
	src/clusters-impl.h \
	src/commit.c \
	src/components.c src/components.h \
	src/corner.c src/corner.h \
	src/corridor.c src/corridor.h \
	src/count.c \
	src/crossings.c src/crossings.h \
	src/cuts.c src/cuts.h \
	src/determinant.c src/determinant.h src/dot.h \
	src/effects.c \
	src/equation.c src/equation.h \
	src/estimate.c src/estimate.h \
	src/events.c src/events.h \
	src/events-impl.h \
	src/events-rays.c \
	src/exchange-area.c src/exchange-area.h \
	src/exact-orient.c src/exact-orient.h \
	src/exchange-wide.c src/exchange-wide.h \
	src/existence.c src/existence.h \
	src/file.c src/file.h \
	src/find.h \
	src/fineness.c src/fineness.h \
	src/frame.c src/frame.h \
	src/gather.c \
	src/geojson.c \
	src/geojson-feature.c \
	src/geojson-geometry.c \
	src/geojson-impl.h \
	src/geojson-text.c src/geojson-text.h \
	src/grade.c src/grade.h \
	src/graded.c src/graded.h \
	src/hierarchy.c \
	src/hierarchy-impl.h \
	src/hierarchy-unite.c \
	src/images.c src/images.h \
	src/importance.c src/importance.h \
	src/kernel.c \
	src/krylov.c src/krylov.h \
	src/l1.c src/l1.h \
	src/l1-bounds.c \
	src/l1-breaks.c \
	src/l1-frame.c src/l1-frame.h \
	src/l1-grid.c src/l1-grid.h \
	src/legendre.c src/legendre.h \
	src/light.c \
	src/linkset.c \
	src/matrix.c \
	src/linkset-impl.h \
	src/linkset-validate.c \
	src/measure.c \
	src/message.c src/message.h \
	src/occluder.c src/occluder.h \
	src/options.h \
	src/oracle.c \
	src/oracle-l1.c \
	src/panels.h \
	src/point-factor.h \
	src/point-view.c src/point-view.h \
	src/point-view-impl.h \
	src/point-view-sweep.c \
	src/policy.c \
	src/predict.c \
	src/predicates.c src/predicates.h \
	src/project.c src/project.h \
	src/projector.c \
	src/push-pull.c src/push-pull.h \
	src/refine.c \
	src/roots.c src/roots.h \
	src/rows.c src/rows.h \
	src/runs.c src/runs.h \
	src/scene.c \
	src/scene-file.c src/scene-file.h \
	src/scene-impl.h \
	src/separation.c src/separation.h \
	src/shaded.c src/shaded.h \
	src/shaft.c src/shaft.h \
	src/side.h \
	src/sight.c src/sight.h \
	src/sky.c src/sky.h \
	src/solution.c \
	src/solution-impl.h \
	src/solve.c \
	src/split.c \
	src/state.c \
	src/state-impl.h \
	src/state-read.c \
	src/status.c \
	src/study.c \
	src/sum.h \
	src/target.c \
	src/transport.c src/transport.h \
	src/validate.c \
	src/version.c \
	src/visible.c \
	src/vs2.c \
	src/vs2-impl.h \
	src/vs2-words.c \
	src/walls.c src/walls.h \
	src/wide.h

lib_LTLIBRARIES += libhr2d.la
libhr2d_la_SOURCES =
libhr2d_la_LIBADD = libhr2d-core.la
libhr2d_la_LDFLAGS = -no-undefined -version-info $(HR2D_VERSION_INFO) $(OPENMP_CFLAGS)
if HAVE_VERSION_SCRIPT
libhr2d_la_LDFLAGS += -Wl,--version-script=$(srcdir)/src/libhr2d.map
EXTRA_libhr2d_la_DEPENDENCIES = src/libhr2d.map
else
libhr2d_la_LDFLAGS += -export-symbols-regex '^hr2d_'
endif
EXTRA_DIST += src/libhr2d.map
