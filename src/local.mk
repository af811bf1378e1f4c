# The library.  libhr2d-core.la holds it once for the shared library and once for
# the unit tests, which reach the internals that the shared library hides.
noinst_LTLIBRARIES += libhr2d-core.la
libhr2d_core_la_CPPFLAGS = -DHR2D_BUILDING -D_POSIX_C_SOURCE=200809L $(PUBLIC_CPPFLAGS) \
	-I$(srcdir)/src $(GSL_CFLAGS) $(JANSSON_CFLAGS)
libhr2d_core_la_CFLAGS = $(AM_CFLAGS) $(THREADS_CFLAGS)
libhr2d_core_la_LIBADD = $(GSL_LIBS) $(JANSSON_LIBS) -lm
libhr2d_core_la_SOURCES = \
	src/base/adaptive-gauss.c src/base/adaptive-gauss.h \
	src/base/alloc.c src/base/alloc.h \
	src/base/bin.h \
	src/base/bickley.c src/base/bickley.h src/base/bickley-tables.h \
	src/base/black-body.c src/base/black-body.h \
	src/base/choices.h \
	src/base/clock.h \
	src/base/c-locale.c src/base/c-locale.h \
	src/base/constants.c \
	src/base/krylov.c src/base/krylov.h \
	src/base/large-pages.c src/base/large-pages.h \
	src/base/legendre.c src/base/legendre.h \
	src/base/message.c src/base/message.h \
	src/base/neumaier-sum.h \
	src/base/options-init.c \
	src/base/ordered-dot.h \
	src/base/pi.h \
	src/base/read-file.c src/base/read-file.h \
	src/base/scaled-double.h \
	src/base/share.c src/base/share.h \
	src/base/sized-struct.h \
	src/base/sort.c src/base/sort.h \
	src/base/status.c \
	src/base/team.c src/base/team.h \
	src/base/union-find.h \
	src/base/version.c \
	src/base/watch.c src/base/watch.h \
	src/base/wide.h \
	src/geometry/apart.h \
	src/geometry/bernstein-ellipse.c src/geometry/bernstein-ellipse.h \
	src/geometry/crossings.c src/geometry/crossings.h \
	src/geometry/cut-points.c src/geometry/cut-points.h \
	src/geometry/determinant.c src/geometry/determinant.h \
	src/geometry/exchange-area.c src/geometry/exchange-area.h \
	src/geometry/exchange-area-scaled.c src/geometry/exchange-area-scaled.h \
	src/geometry/hull.c src/geometry/hull.h \
	src/geometry/kernel.c \
	src/geometry/orient-exact.c src/geometry/orient-exact.h \
	src/geometry/orient-incident.c src/geometry/orient-incident.h \
	src/geometry/orient-sign.h \
	src/geometry/point-view-factor.h \
	src/geometry/predicates.c src/geometry/predicates.h \
	src/geometry/stars.c src/geometry/stars.h \
	src/geometry/vector.h \
	src/triangulation/merge-vertices.c src/triangulation/merge-vertices.h \
	src/triangulation/cavity.c src/triangulation/cavity.h \
	src/triangulation/freeze.c src/triangulation/freeze.h \
	src/triangulation/constraints.c src/triangulation/constraints.h \
	src/triangulation/delaunay.c src/triangulation/delaunay.h \
	src/triangulation/snap-feet.c src/triangulation/snap-feet.h \
	src/triangulation/hilbert.h \
	src/triangulation/hull.c src/triangulation/hull.h \
	src/triangulation/in-circle.c src/triangulation/in-circle.h \
	src/triangulation/mesh.c src/triangulation/mesh.h \
	src/triangulation/check-crossings.c src/triangulation/check-crossings.h \
	src/triangulation/pieces.c src/triangulation/pieces.h \
	src/triangulation/points.c src/triangulation/points.h \
	src/triangulation/triangulation.c src/triangulation/triangulation.h \
	src/beams/area.c \
	src/beams/restrict.c \
	src/beams/line-class.h \
	src/beams/line-class-list.c src/beams/line-class-list.h \
	src/beams/triangular-expansion.c src/beams/triangular-expansion.h \
	src/beams/walk.c src/beams/walk.h \
	src/occlusion/occluder-hulls.c src/occlusion/occluder-hulls.h \
	src/occlusion/exchange-occluded.c \
	src/occlusion/area-past-hulls.c src/occlusion/area-past-hulls.h \
	src/occlusion/clipped-occluders.c src/occlusion/clipped-occluders.h \
	src/occlusion/wall-bodies.c src/occlusion/wall-bodies.h \
	src/occlusion/wall-tree.c src/occlusion/wall-tree.h \
	src/occlusion/walls.c src/occlusion/walls.h \
	src/scene/back-to-back.c src/scene/back-to-back.h \
	src/scene/band-groups.c src/scene/band-groups.h \
	src/scene/checks.c \
	src/scene/commit.c \
	src/scene/daylight.c \
	src/scene/effects.c \
	src/scene/emissivity.c src/scene/emissivity.h \
	src/scene/facing-in-part.c src/scene/facing-in-part.h \
	src/scene/find-occluder.c src/scene/find-occluder.h \
	src/scene/gas.c src/scene/gas.h \
	src/scene/in-between.c src/scene/in-between.h \
	src/scene/lit-parts.c \
	src/scene/need-plane.c \
	src/scene/one-cell.c \
	src/scene/panes.c src/scene/panes.h \
	src/scene/patch-light.c src/scene/patch-light.h \
	src/scene/patch-runs.c src/scene/patch-runs.h \
	src/scene/period-ends.c \
	src/scene/period-weights.c \
	src/scene/plane.c src/scene/plane.h \
	src/scene/quadrants.c \
	src/scene/reachability.c \
	src/scene/reading-notes.c src/scene/reading-notes.h \
	src/scene/scene.c \
	src/scene/scene-impl.h \
	src/scene/regions.c src/scene/regions.h \
	src/scene/relit-scene.c src/scene/relit-scene.h \
	src/scene/frozen-temperatures.c src/scene/frozen-temperatures.h \
	src/scene/side-layers.c src/scene/side-layers.h \
	src/scene/side-parts.c src/scene/side-parts.h \
	src/scene/continuous-sky.c \
	src/scene/sky.c src/scene/sky.h \
	src/scene/sky-model.c src/scene/sky-model.h src/scene/sky-radiance.c \
	src/scene/sky-section.c \
	src/scene/sky-arcs.c \
	src/scene/spectrum.c src/scene/spectrum.h \
	src/scene/sun.c \
	src/scene/sun-beams.c src/scene/sun-beams.h \
	src/scene/sunlight.c src/scene/sunlight.h \
	src/scene/symmetry.c src/scene/symmetry.h \
	src/scene/thermal.c \
	src/scene/unfold.c \
	src/scene/wall-pieces.c src/scene/wall-pieces.h \
	src/scene/with-images.c \
	src/scene/with-plane.c src/scene/with-plane.h \
	src/repair/snap.c \
	src/repair/snap-impl.h \
	src/repair/snap-stretches.c \
	src/repair/split-crossings.c \
	src/formats/geojson.c \
	src/formats/geojson-feature.c \
	src/formats/geojson-surface.c \
	src/formats/geojson-geometry.c \
	src/formats/geojson-impl.h \
	src/formats/geojson-meant.c src/formats/geojson-meant.h \
	src/formats/geojson-name.c \
	src/formats/geojson-sky.c \
	src/formats/geojson-sun.c \
	src/formats/geojson-medium.c \
	src/formats/geojson-symmetry.c \
	src/formats/geojson-text.c src/formats/geojson-text.h \
	src/formats/geojson-thermal.c \
	src/formats/geojson-values.c \
	src/formats/scene-file.c src/formats/scene-file.h \
	src/formats/vs2.c \
	src/formats/vs2-impl.h \
	src/formats/vs2-words.c \
	src/visibility/entry-table.c src/visibility/entry-table.h \
	src/visibility/exchange-matrix.c \
	src/visibility/exchange-rows.c \
	src/visibility/exchange-visit.c \
	src/visibility/image-rows.c src/visibility/image-rows.h \
	src/visibility/beam-cache.c src/visibility/beam-cache.h \
	src/visibility/pair-visibility.c src/visibility/pair-visibility.h \
	src/visibility/point-beams.c \
	src/visibility/point-view.c src/visibility/point-view.h \
	src/visibility/point-view-all.c \
	src/visibility/point-view-interval.c \
	src/visibility/point-view-impl.h \
	src/visibility/point-view-ray.c \
	src/visibility/point-view-walk.c \
	src/visibility/row-assembly.c src/visibility/row-assembly.h \
	src/visibility/sparse-accumulator.c src/visibility/sparse-accumulator.h \
	src/visibility/back-visibility.c src/visibility/back-visibility.h \
	src/visibility/any-visible.c src/visibility/any-visible.h \
	src/visibility/scatter.c src/visibility/scatter.h \
	src/visibility/periodic-tail.c src/visibility/periodic-tail.h \
	src/lint/gaps.c \
	src/lint/heat.c \
	src/lint/light.c \
	src/lint/lint.c \
	src/lint/lint-impl.h \
	src/lint/views.c \
	src/lint/warn.c \
	src/hierarchy/fields.c \
	src/hierarchy/hierarchy.c \
	src/hierarchy/hierarchy-impl.h \
	src/hierarchy/image-trees.c src/hierarchy/image-trees.h \
	src/hierarchy/pane-trees.c src/hierarchy/pane-trees.h \
	src/hierarchy/push-pull.c src/hierarchy/push-pull.h \
	src/hierarchy/unite.c \
	src/oracle/built-in.h \
	src/oracle/bounds.c \
	src/oracle/l1.c src/oracle/l1.h \
	src/oracle/l1-bounds.c \
	src/oracle/l1-breaks.c \
	src/oracle/l1-frame.c src/oracle/l1-frame.h \
	src/oracle/l1-grid.c src/oracle/l1-grid.h \
	src/oracle/l1-oracle.c \
	src/oracle/oracle.c \
	src/oracle/policy.c \
	src/oracle/squares.c src/oracle/squares.h \
	src/blocks/block.c src/blocks/block.h \
	src/blocks/blocks-of-links.c \
	src/blocks/directions.c \
	src/blocks/distant.c \
	src/blocks/line-frame.c \
	src/blocks/line-vector.h \
	src/blocks/gas-cells.c src/blocks/gas-cells.h \
	src/blocks/gas-shares.c \
	src/blocks/gas-lines.c src/blocks/gas-lines.h \
	src/blocks/lines.c src/blocks/lines.h \
	src/blocks/moment-batches.h \
	src/blocks/moments.c src/blocks/moments.h \
	src/blocks/rules.c \
	src/clusters/clusters.c src/clusters/clusters.h \
	src/clusters/clusters-impl.h \
	src/clusters/expansion.c src/clusters/expansion.h \
	src/clusters/facing.c src/clusters/facing.h \
	src/clusters/far-exchange.c \
	src/clusters/gas-series.c src/clusters/gas-series.h \
	src/clusters/interpolation.c src/clusters/interpolation.h \
	src/clusters/levels.c \
	src/clusters/occlusion.c src/clusters/occlusion.h \
	src/clusters/point-exchange.c src/clusters/point-exchange.h \
	src/clusters/root-pairs.c src/clusters/root-pairs.h \
	src/clusters/shaft.c src/clusters/shaft.h \
	src/clusters/transport.c \
	src/clusters/tree.c src/clusters/tree.h \
	src/links/block-numbers.h \
	src/links/components.c src/links/components.h \
	src/links/link-blocks.c src/links/link-blocks.h \
	src/links/linkset.c \
	src/links/linkset-impl.h \
	src/links/patch-defect.c src/links/patch-defect.h \
	src/links/row-pieces.h \
	src/links/store.c src/links/store.h \
	src/solution/band-solution.c src/solution/band-solution.h \
	src/solution/gatherer.c src/solution/gatherer.h \
	src/solution/panels.h \
	src/solution/point-gather.c \
	src/solution/solution.c \
	src/solution/solution-impl.h \
	src/solution/wedge-limit.c \
	src/field/above-plane.c src/field/above-plane.h \
	src/field/border-map.c src/field/border-map.h \
	src/field/borders.c src/field/borders.h \
	src/field/field-at.c src/field/field-at.h \
	src/field/field-grid.c \
	src/field/field-impl.h \
	src/field/field-rows.c \
	src/field/field-team.c \
	src/field/field-tile.c src/field/field-tile.h \
	src/field/irradiance.c \
	src/field/leaf-errors.c src/field/leaf-errors.h \
	src/field/leaves.c src/field/leaves.h \
	src/field/light-in-gas.c src/field/light-in-gas.h \
	src/field/light.c src/field/light.h \
	src/field/light-source.c src/field/light-source.h \
	src/field/light-strip.c src/field/light-strip.h \
	src/field/light-sum.h \
	src/field/locate.c src/field/locate.h \
	src/field/past-ends.c src/field/past-ends.h \
	src/field/visibility-polygon.c src/field/visibility-polygon.h \
	src/field/look.c src/field/look.h \
	src/field/offset-viewpoint.c \
	src/refine/count.c \
	src/refine/law-demand.c src/refine/law-demand.h \
	src/refine/law-quadrature.c src/refine/law-quadrature.h \
	src/refine/law-touch.c src/refine/law-touch.h \
	src/refine/law-view.c src/refine/law-view.h \
	src/refine/occluded-pairs.c src/refine/occluded-pairs.h \
	src/refine/part-rows.c src/refine/part-rows.h \
	src/refine/partition.c src/refine/partition.h \
	src/refine/projector.c src/refine/projector.h \
	src/refine/projector-start.c \
	src/refine/refine.c \
	src/refine/refine-how.h \
	src/refine/rounds.c src/refine/rounds.h \
	src/refine/trace-row.c src/refine/trace-row.h \
	src/refine/rows.c src/refine/rows.h \
	src/refine/study.c \
	src/refine/study-law.c \
	src/refine/unite-shares.c src/refine/unite-shares.h \
	src/refine/validate-links.c \
	src/refine/worker.c src/refine/worker.h \
	src/solve/background.c src/solve/background.h \
	src/solve/block-part.c src/solve/block-part.h \
	src/solve/closure.c src/solve/closure.h \
	src/solve/closure-mean.c \
	src/solve/closure-order-p.c \
	src/solve/energy-balance.c src/solve/energy-balance.h \
	src/solve/equation.c src/solve/equation.h \
	src/solve/stopping-test.c \
	src/solve/reduced-equation.c src/solve/reduced-equation.h \
	src/solve/equation-power.c \
	src/solve/equation-sign.c \
	src/solve/existence.c src/solve/existence.h \
	src/solve/gather-areas.c src/solve/gather-areas.h \
	src/solve/gather-blocks.c src/solve/gather-blocks.h \
	src/solve/gather-links.c src/solve/gather-links.h \
	src/solve/gather-one-way.c src/solve/gather-one-way.h \
	src/solve/first-guess.c src/solve/first-guess.h \
	src/solve/gas-heat.c src/solve/gas-heat.h \
	src/solve/gas-light.c src/solve/gas-light.h \
	src/solve/gas-rows.c src/solve/gas-rows.h \
	src/solve/heat-balance.c src/solve/heat-balance.h \
	src/solve/heat-scene.c src/solve/heat-scene.h \
	src/solve/image-map.c src/solve/image-map.h \
	src/solve/leading-blocks.c src/solve/leading-blocks.h \
	src/solve/external-irradiance.c src/solve/external-irradiance.h \
	src/solve/power-cut-off.c src/solve/power-cut-off.h \
	src/solve/row-sums.c src/solve/row-sums.h \
	src/solve/row-tails.c src/solve/row-tails.h \
	src/solve/scattering.c src/solve/scattering.h \
	src/solve/shared-gather.c src/solve/shared-gather.h \
	src/solve/solve.c \
	src/solve/solve-how.h \
	src/solve/transport.c src/solve/transport.h \
	src/mesh/admissibility.c src/mesh/admissibility.h \
	src/mesh/corner-exponent.c src/mesh/corner-exponent.h \
	src/mesh/reuse-links.c src/mesh/reuse-links.h \
	src/mesh/event-list.c src/mesh/event-list.h \
	src/mesh/events.c src/mesh/events.h \
	src/mesh/events-beams.c \
	src/mesh/events-impl.h \
	src/mesh/grader.h \
	src/mesh/grader-team.c \
	src/mesh/gas-marks.c \
	src/mesh/grading-marks.c \
	src/mesh/refine-marked.c src/mesh/refine-marked.h \
	src/mesh/derivative-jumps.c src/mesh/derivative-jumps.h \
	src/mesh/event-selection.c src/mesh/event-selection.h \
	src/mesh/mesh-grading.c src/mesh/mesh-grading.h \
	src/mesh/mirror-images.c src/mesh/mirror-images.h \
	src/mesh/point-grid.c src/mesh/point-grid.h \
	src/mesh/row-partition.c src/mesh/row-partition.h \
	src/mesh/visible-vertices.c src/mesh/visible-vertices.h \
	src/estimate/cluster-residuals.c src/estimate/cluster-residuals.h \
	src/estimate/coordinate-rounding.c src/estimate/coordinate-rounding.h \
	src/estimate/corner-residuals.c src/estimate/corner-residuals.h \
	src/estimate/error-estimate.c src/estimate/error-estimate.h \
	src/estimate/error-indicators.c src/estimate/error-indicators.h \
	src/estimate/estimator.c src/estimate/estimator.h \
	src/estimate/gap-residuals.c src/estimate/gap-residuals.h \
	src/estimate/graded-solve.c src/estimate/graded-solve.h \
	src/estimate/group-estimate.c src/estimate/group-estimate.h \
	src/estimate/importance.c src/estimate/importance.h \
	src/estimate/period-residuals.c src/estimate/period-residuals.h \
	src/estimate/points-gather.c src/estimate/points-gather.h \
	src/estimate/residual-series.c src/estimate/residual-series.h \
	src/estimate/resolution.c src/estimate/resolution.h \
	src/estimate/rounding-bound.c src/estimate/rounding-bound.h \
	src/estimate/unsigned-error.c src/estimate/unsigned-error.h \
	src/estimate/shadow-residuals.c src/estimate/shadow-residuals.h \
	src/estimate/shared-sums.c src/estimate/shared-sums.h \
	src/enclosure/enclosure.c \
	src/enclosure/enclosure-factors.c src/enclosure/enclosure-factors.h \
	src/enclosure/enclosure-impl.h \
	src/enclosure/enclosure-links.c src/enclosure/enclosure-links.h \
	src/enclosure/enclosure-marks.c src/enclosure/enclosure-marks.h \
	src/enclosure/enclosure-read.c \
	src/enclosure/enclosure-refused.c src/enclosure/enclosure-refused.h \
	src/enclosure/enclosure-sweep.c src/enclosure/enclosure-sweep.h \
	src/accuracy/heat-solve.c src/accuracy/heat-solve.h \
	src/accuracy/predict.c \
	src/accuracy/search.c src/accuracy/search.h \
	src/accuracy/fallback-solve.c src/accuracy/fallback-solve.h \
	src/accuracy/solution-distance.c src/accuracy/solution-distance.h \
	src/accuracy/solution-error.c \
	src/accuracy/solve-to.c src/accuracy/solve-to.h \
	src/accuracy/solve-to-call.c \
	src/accuracy/strategy.c src/accuracy/strategy.h \
	src/accuracy/target.c src/accuracy/target.h \
	src/accuracy/temperature.c \
	src/operator/equations.c \
	src/operator/gradient.c \
	src/operator/light.c \
	src/operator/operator.c \
	src/operator/operator-impl.h \
	src/operator/response.c \
	src/state/byte-stream.c src/state/byte-stream.h \
	src/state/scene-format.h \
	src/state/scene-read.c \
	src/state/scene-write.c \
	src/state/state-impl.h \
	src/state/state-read.c \
	src/state/state-write.c

lib_LTLIBRARIES += libhr2d.la
libhr2d_la_SOURCES =
libhr2d_la_LIBADD = libhr2d-core.la
libhr2d_la_LDFLAGS = $(AM_LDFLAGS) -no-undefined -version-info $(HR2D_VERSION_INFO) $(THREADS_LIBS)
if HAVE_VERSION_SCRIPT
libhr2d_la_LDFLAGS += -Wl,--version-script=$(srcdir)/src/libhr2d.map
EXTRA_libhr2d_la_DEPENDENCIES = src/libhr2d.map
else
libhr2d_la_LDFLAGS += -export-symbols-regex '^hr2d_'
endif
EXTRA_DIST += src/LAYERS src/base/make-bickley-tables.py src/libhr2d.abi src/libhr2d.map
