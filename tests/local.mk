# The tests: suites of Check, and scripts for the program and the package.  All suites are linked into
# one program, which runs the one whose file it is given: a program each would be 16 MB of library to
# link 140 times.  tests/support/suite.c says what it does with the marks of Check.
AM_CPPFLAGS = $(PUBLIC_CPPFLAGS) -I$(srcdir)/src -I$(srcdir)/tests $(GSL_CFLAGS) $(JANSSON_CFLAGS) \
	$(CHECK_CFLAGS) -D_mark_point=test_mark_point $(MPFR_CFLAGS)
LDADD = tests/libsupport.la libhr2d-core.la $(CHECK_LIBS) $(MPFR_LIBS) $(THREADS_LIBS)

# The longest ones begin: one that began last would run alone.
SUITES = \
	tests/unit/accuracy/check-short-patches.c \
	tests/unit/accuracy/check-gas-bounds.c \
	tests/unit/accuracy/check-shares.c \
	tests/unit/solution/check-irradiance-points.c \
	tests/unit/clusters/check-clusters.c \
	tests/unit/oracle/check-l1.c \
	tests/unit/oracle/check-bounds.c \
	tests/unit/field/check-field-grid.c \
	tests/faults/check-polls.c \
	tests/faults/check-faults-accuracy.c \
	tests/faults/check-scene-progress.c \
	tests/unit/base/check-bickley.c \
	tests/unit/base/check-black-body.c \
	tests/unit/base/check-options.c \
	tests/unit/base/check-status.c \
	tests/unit/geometry/check-geometry.c \
	tests/unit/geometry/check-exchange-area.c \
	tests/unit/geometry/check-hull.c \
	tests/unit/geometry/check-stars.c \
	tests/unit/triangulation/check-triangulation.c \
	tests/unit/beams/check-line-class.c \
	tests/unit/beams/check-walk.c \
	tests/bounds/check-bounds-geometry.c \
	tests/bounds/check-bounds-oracles.c \
	tests/bounds/check-bounds-l1.c \
	tests/bounds/check-bounds-study.c \
	tests/bounds/check-bounds-visibility.c \
	tests/bounds/check-bounds-solution.c \
	tests/hard/check-hard-geometry.c \
	tests/hard/check-hard-oracles.c \
	tests/unit/scene/check-patches.c \
	tests/unit/scene/check-positions.c \
	tests/unit/scene/check-redrawn.c \
	tests/unit/scene/check-commit-searches.c \
	tests/unit/scene/check-effect-reasons.c \
	tests/unit/repair/check-crossings.c \
	tests/unit/scene/check-bent-walls.c \
	tests/unit/repair/check-snap.c \
	tests/unit/scene/check-sunlight.c \
	tests/unit/scene/check-gas-scenes.c \
	tests/unit/scene/check-images.c \
	tests/unit/scene/check-period-weights.c \
	tests/unit/formats/check-geojson.c \
	tests/unit/formats/check-memory.c \
	tests/unit/formats/check-strangers.c \
	tests/unit/formats/check-vs2.c \
	tests/unit/lint/check-mistakes.c \
	tests/unit/lint/check-drawings.c \
	tests/unit/hierarchy/check-hierarchy.c \
	tests/unit/hierarchy/check-fields.c \
	tests/unit/refine/check-refine.c \
	tests/unit/refine/check-brightness.c \
	tests/unit/refine/check-partition.c \
	tests/unit/refine/check-rows.c \
	tests/unit/refine/check-claims.c \
	tests/unit/refine/check-image-elements.c \
	tests/unit/links/check-linkset.c \
	tests/unit/links/check-store.c \
	tests/unit/refine/check-validate.c \
	tests/unit/refine/check-validate-ulps.c \
	tests/paper/check-law.c \
	tests/paper/check-theorem.c \
	tests/unit/oracle/check-squares.c \
	tests/unit/solution/check-period-points.c \
	tests/unit/solution/check-shields.c \
	tests/unit/solution/check-points.c \
	tests/unit/solution/check-emissivity.c \
	tests/unit/solution/check-heat-bands.c \
	tests/unit/solution/check-heat-images.c \
	tests/unit/solution/check-heat-links.c \
	tests/unit/solution/check-temperatures.c \
	tests/unit/solution/check-thermal-calls.c \
	tests/unit/field/check-field.c \
	tests/unit/field/check-field-rows.c \
	tests/unit/field/check-field-errors.c \
	tests/unit/field/check-field-irradiance.c \
	tests/unit/field/check-past-ends.c \
	tests/unit/solve/check-gas.c \
	tests/unit/solve/check-gas-bands.c \
	tests/unit/solve/check-gas-clusters.c \
	tests/unit/solve/check-gas-rays.c \
	tests/unit/solve/check-gas-regions.c \
	tests/unit/solve/check-solve.c \
	tests/unit/solve/check-background.c \
	tests/unit/solve/check-continuous-sky.c \
	tests/unit/solve/check-sky.c \
	tests/unit/solve/check-sun.c \
	tests/unit/solve/check-mirrors.c \
	tests/unit/solve/check-panes.c \
	tests/unit/solve/check-periods.c \
	tests/unit/solve/check-closure.c \
	tests/unit/solve/check-equation-enough.c \
	tests/unit/solve/check-equation-part.c \
	tests/unit/solve/check-gather-areas.c \
	tests/unit/solve/check-gather-blocks.c \
	tests/unit/solve/check-gather-links.c \
	tests/unit/solve/check-leading-blocks.c \
	tests/unit/solve/check-row-sums.c \
	tests/unit/solve/check-adopt.c \
	tests/unit/solve/check-image-scales.c \
	tests/unit/solve/check-lengths.c \
	tests/unit/refine/check-occlusion.c \
	tests/unit/scene/check-effects.c \
	tests/unit/occlusion/check-visibility.c \
	tests/hard/check-hard-visibility.c \
	tests/hard/check-hard-scenes.c \
	tests/unit/visibility/check-exchange-matrix.c \
	tests/unit/visibility/check-exchange-rows.c \
	tests/unit/visibility/check-period-rows.c \
	tests/unit/visibility/check-image-memory.c \
	tests/unit/visibility/check-pair-visibility.c \
	tests/unit/visibility/check-back-visibility.c \
	tests/unit/visibility/check-beam-cache.c \
	tests/unit/mesh/check-visible-vertices.c \
	tests/unit/blocks/check-gas-areas.c \
	tests/unit/blocks/check-blocks.c \
	tests/unit/blocks/check-directions.c \
	tests/unit/blocks/check-moments.c \
	tests/unit/solve/check-order.c \
	tests/unit/solve/check-slices.c \
	tests/unit/accuracy/check-known-radiosities.c \
	tests/unit/accuracy/check-random-accuracy.c \
	tests/unit/accuracy/check-random-periods.c \
	tests/unit/accuracy/check-target-calls.c \
	tests/unit/accuracy/check-points-asked.c \
	tests/unit/estimate/check-cluster-residuals.c \
	tests/unit/estimate/check-error-indicators.c \
	tests/unit/estimate/check-single-blocks.c \
	tests/unit/accuracy/check-importance.c \
	tests/unit/accuracy/check-found-errors.c \
	tests/unit/enclosure/check-enclosure.c \
	tests/unit/enclosure/check-enclosure-factors.c \
	tests/unit/mesh/check-event-selection.c \
	tests/unit/accuracy/check-measured-errors.c \
	tests/unit/accuracy/check-budgets.c \
	tests/unit/accuracy/check-cracks.c \
	tests/unit/accuracy/check-dark.c \
	tests/unit/estimate/check-roundings.c \
	tests/unit/accuracy/check-shadow-edges.c \
	tests/unit/clusters/check-far-exchange.c \
	tests/unit/clusters/check-root-pairs.c \
	tests/unit/mesh/check-corner.c \
	tests/unit/mesh/check-events.c \
	tests/unit/mesh/check-shared-events.c \
	tests/unit/visibility/check-point-beams.c \
	tests/unit/visibility/check-point-view.c \
	tests/unit/visibility/check-point-view-walls.c \
	tests/unit/operator/check-operator.c \
	tests/unit/operator/check-operator-calls.c \
	tests/unit/operator/check-gradients.c \
	tests/unit/state/check-state.c \
	tests/unit/state/check-state-scene.c \
	tests/unit/refine/check-study.c \
	tests/hard/check-hard-refine.c \
	tests/hard/check-hard-solve.c \
	tests/arguments/check-arguments.c \
	tests/threads/check-threads.c \
	tests/faults/check-faults.c \
	tests/faults/check-divided-faults.c \
	tests/faults/check-share-faults.c \
	tests/faults/check-faults-callbacks.c

# They replace functions of the system, in a program of their own.
REPLACING = tests/threads/check-team tests/faults/check-faults-malloc

OUTSIDE = \
	tests/adversary/check-adversary.sh \
	tests/docs/check-docs.sh \
	tests/program/check-cli.sh \
	tests/program/check-completion.sh tests/program/check-help.sh \
	tests/program/check-program-faults.sh \
	tests/program/check-digits.sh \
	tests/program/check-field.sh \
	tests/program/check-vti.sh \
	tests/program/check-pfm.sh \
	tests/program/check-pictures.sh \
	tests/program/check-provenance.sh \
	tests/program/check-schemas.sh \
	tests/program/check-one-value.sh \
	tests/program/check-resume.sh \
	tests/program/check-temperatures.sh \
	tests/program/check-texts.sh \
	tests/program/check-town.sh \
	tests/package/check-choices.sh tests/package/check-constants.sh \
	tests/package/check-exports.sh \
	tests/package/check-hardening.sh \
	tests/package/check-headers.sh \
	tests/package/check-layers.sh \
	tests/package/check-examples.sh \
	tests/package/check-python.sh tests/package/check-wheel.sh \
	tests/package/check-release.sh \
	tests/package/check-vectors.sh \
	tests/package/check-recipes.sh \
	tests/package/check-sbom.sh \
	tests/adversary/check-adversary-controls.sh

TEST_EXTENSIONS = .sh .c
SH_LOG_COMPILER = $(SHELL)
C_LOG_COMPILER = $(SUITE_RUNNER) tests/check-suites$(EXEEXT)

if HAVE_TESTS
check_LTLIBRARIES += tests/libsupport.la
tests_check_suites_SOURCES = tests/suites.c $(SUITES) tests/arguments/stage.c tests/arguments/stage.h
tests_check_suites_CPPFLAGS = $(AM_CPPFLAGS) -I$(builddir)
tests_check_suites_LDFLAGS = -pthread
tests_threads_check_team_CPPFLAGS = -D_GNU_SOURCE $(AM_CPPFLAGS)
tests_threads_check_team_LDADD = $(LDADD) -ldl
tests_libsupport_la_SOURCES = \
	tests/support/accuracy-scenes.c tests/support/accuracy-scenes.h \
	tests/support/accuracy-tally.c tests/support/accuracy-tally.h \
	tests/support/block-stage.c tests/support/block-stage.h \
	tests/support/pair-kinds.c tests/support/pair-kinds.h \
	tests/support/elements.c tests/support/elements.h \
	tests/support/fault-calls.c tests/support/fault-calls.h \
	tests/support/fault-stage.c tests/support/fault-stage.h \
	tests/support/field-stage.c tests/support/field-stage.h \
	tests/support/grid-plans.c tests/support/grid-plans.h \
	tests/support/hard-rooms.c tests/support/hard-rooms.h \
	tests/support/hard.c tests/support/hard.h \
	tests/support/hill-climb.c tests/support/hill-climb.h \
	tests/support/lattice-scenes.c tests/support/lattice-scenes.h \
	tests/support/links.c tests/support/links.h \
	tests/support/memory.c tests/support/memory.h \
	tests/support/order.h \
	tests/support/pair-classes.c tests/support/pair-classes.h \
	tests/support/plane.h \
	tests/support/radiosity-scenes.c tests/support/radiosity-scenes.h \
	tests/support/random.c tests/support/random.h \
	tests/support/relit-rooms.c tests/support/relit-rooms.h \
	tests/support/room-plans.c tests/support/room-plans.h \
	tests/support/scene-files.c tests/support/scene-files.h \
	tests/support/scenes.c tests/support/scenes.h \
	tests/support/settings.c tests/support/settings.h \
	tests/support/shadow-scenes.c tests/support/shadow-scenes.h \
	tests/support/short-rooms.c tests/support/short-rooms.h \
	tests/support/slow-phases.c tests/support/slow-phases.h \
	tests/support/shares.c tests/support/shares.h \
	tests/support/slow-scenes.c tests/support/slow-scenes.h \
	tests/support/tape.c tests/support/tape.h \
	tests/support/suite.c tests/support/suite.h \
	tests/support/support.h \
	tests/support/symmetric-scenes.c tests/support/symmetric-scenes.h \
	tests/support/tables.c tests/support/tables.h \
	tests/support/triangulation-fault.c tests/support/triangulation-fault.h \
	tests/support/visibility-cases.c tests/support/visibility-cases.h \
	tests/independent/accuracy-nystrom.c tests/independent/accuracy-nystrom.h \
	tests/independent/brute-block.c tests/independent/brute-block.h \
	tests/independent/brute-visibility.c tests/independent/brute-visibility.h \
	tests/independent/convex-nystrom.c tests/independent/convex-nystrom.h \
	tests/independent/exact-sights.c tests/independent/exact-sights.h \
	tests/independent/lines-block.c tests/independent/lines-block.h \
	tests/independent/mpfr-exchange.c tests/independent/mpfr-exchange.h \
	tests/independent/mpfr-l1.c tests/independent/mpfr-l1.h \
	tests/independent/open-sweep.c tests/independent/open-sweep.h \
	tests/independent/pair-frame.c tests/independent/pair-frame.h \
	tests/independent/point-sweep.c tests/independent/point-sweep.h \
	tests/independent/sweep-nystrom.c tests/independent/sweep-nystrom.h \
	tests/independent/sweep-row.c tests/independent/sweep-row.h
check_PROGRAMS += tests/check-suites $(REPLACING)
# The longest one begins first.
TESTS += $(OUTSIDE) $(SUITES) $(REPLACING)
else
check-local:
	@echo "make check needs Check and MPFR; configure did not find them" >&2; exit 1
endif

# Calls of all public functions, made of their prototypes.
tests/arguments/check_suites-check-arguments.$(OBJEXT): tests/arguments/calls.inc
tests/arguments/calls.inc: $(srcdir)/tests/arguments/calls.awk $(hr2dinclude_HEADERS)
	@$(MKDIR_P) tests/arguments
	@echo '#include <hr2d/hr2d.h>' | $(CC) -E -P $(PUBLIC_CPPFLAGS) -x c - | \
	  $(AWK) -f $(srcdir)/tests/arguments/calls.awk >$@-new && mv $@-new $@
CLEANFILES += tests/arguments/calls.inc
EXTRA_DIST += tests/arguments/calls.awk

# What check-pictures.sh looks at pictures with.
check_PROGRAMS += tests/program/pixels
tests_program_pixels_CPPFLAGS = -D_POSIX_C_SOURCE=200809L $(CAIRO_CFLAGS)
tests_program_pixels_LDADD = $(CAIRO_LIBS)

# The adversary knows of the library what a user knows: public headers, exported symbols.  `make
# adversary RUNS=20000` prints the tables of many runs, and `make adversary CLIMB=100000` that of as
# many evaluations of each family, with other seeds each day.
check_PROGRAMS += tests/adversary/adversary
tests_adversary_adversary_CPPFLAGS = -D_POSIX_C_SOURCE=200809L $(PUBLIC_CPPFLAGS) \
	-I$(srcdir)/tests
tests_adversary_adversary_LDADD = libhr2d.la -lm
tests_adversary_adversary_SOURCES = \
	tests/adversary/adversary.c \
	tests/adversary/answer.c tests/adversary/answer.h \
	tests/adversary/claim.c tests/adversary/claim.h \
	tests/adversary/climb.c tests/adversary/climb.h \
	tests/adversary/corrupt.c \
	tests/adversary/families.c tests/adversary/families.h \
	tests/adversary/genome.c tests/adversary/genome.h \
	tests/adversary/judge.c tests/adversary/judge.h \
	tests/adversary/kinds.c tests/adversary/kinds.h \
	tests/adversary/kinds-day.c \
	tests/adversary/kinds-extreme.c \
	tests/adversary/kinds-open.c \
	tests/adversary/kinds-gas.c \
	tests/adversary/kinds-rooms.c \
	tests/adversary/kinds-symmetry.c \
	tests/adversary/law.c tests/adversary/law.h \
	tests/adversary/listed.h \
	tests/adversary/measure.c tests/adversary/measure.h \
	tests/adversary/random.h \
	tests/adversary/report.c tests/adversary/report.h \
	tests/adversary/scene.c tests/adversary/scene.h \
	tests/adversary/scene-file.c \
	tests/adversary/shrink.c tests/adversary/shrink.h \
	tests/adversary/transform.c tests/adversary/transform.h \
	tests/adversary/transform-symmetry.c
RUNS = 2000
CLIMB =
DAY = `date +%Y%m%d000`
adversary: tests/adversary/adversary$(EXEEXT)
	@if test -n "$(CLIMB)"; then set -- --climb $(CLIMB) --seed $(DAY); \
	else set -- --runs $(RUNS); fi; \
	tests/adversary/adversary$(EXEEXT) "$$@" >adversary.md; status=$$?; \
	cat adversary.md; exit $$status
.PHONY: adversary
CLEANFILES += adversary.md

# A tenth of the random cases; `make check-long` runs all of them.  A test may take 600 s before
# Check ends it, on a busy machine too.
AM_TESTS_ENVIRONMENT = \
	HR2D_TEST_MULTIPLIER="$${HR2D_TEST_MULTIPLIER-0.1}"; export HR2D_TEST_MULTIPLIER; \
	LSAN_OPTIONS='suppressions=$(abs_top_srcdir)/tests/lsan.supp:print_suppressions=0'; \
	export LSAN_OPTIONS; \
	CK_DEFAULT_TIMEOUT="$${CK_DEFAULT_TIMEOUT-600}"; export CK_DEFAULT_TIMEOUT; \
	HR2D_SRCDIR='$(abs_top_srcdir)'; export HR2D_SRCDIR; \
	HR2D_BUILDDIR='$(abs_top_builddir)'; export HR2D_BUILDDIR; \
	HR2D_TEST_DATA='$(abs_top_srcdir)/tests/data/reference'; export HR2D_TEST_DATA; \
	HR2D_SCENES='$(abs_top_srcdir)/examples/scenes'; export HR2D_SCENES; \
	HR2D_PROGRAM='$(abs_top_builddir)/tools/hr2d$(EXEEXT)'; export HR2D_PROGRAM; \
	HR2D_EXAMPLES='$(EXAMPLES)'; export HR2D_EXAMPLES; \
	HR2D_CFLAGS='$(CFLAGS) $(HR2D_CFLAGS) $(LDFLAGS)'; export HR2D_CFLAGS; \
	HR2D_HARDENING='$(HR2D_HARDENING)'; export HR2D_HARDENING; \
	CC='$(CC)'; export CC; CXX='$(CXX)'; export CXX; NM='$(NM)'; export NM;

check-long:
	HR2D_TEST_MULTIPLIER="$${HR2D_TEST_MULTIPLIER-1}" $(MAKE) check
.PHONY: check-long

# Only Check programs, without fork, and without most suites that take 20 s and more under valgrind,
# which compute numbers and run other methods.  These run under the sanitizers.
TOO_LONG = tests/bounds/check-bounds-geometry.c tests/bounds/check-bounds-l1.c \
	tests/faults/check-faults.c tests/faults/check-faults-accuracy.c \
	tests/faults/check-faults-callbacks.c tests/faults/check-polls.c \
	tests/faults/check-share-faults.c tests/faults/check-scene-progress.c \
	tests/hard/check-hard-oracles.c tests/hard/check-hard-refine.c tests/hard/check-hard-scenes.c \
	tests/hard/check-hard-solve.c tests/paper/check-theorem.c tests/unit/accuracy/check-budgets.c \
	tests/unit/estimate/check-cluster-residuals.c tests/unit/accuracy/check-cracks.c \
	tests/unit/accuracy/check-dark.c tests/unit/estimate/check-error-indicators.c \
	tests/unit/accuracy/check-importance.c tests/unit/accuracy/check-known-radiosities.c \
	tests/unit/accuracy/check-random-accuracy.c tests/unit/accuracy/check-random-periods.c \
	tests/unit/estimate/check-roundings.c tests/unit/accuracy/check-shadow-edges.c \
	tests/unit/accuracy/check-shares.c tests/unit/accuracy/check-short-patches.c \
	tests/unit/estimate/check-single-blocks.c tests/unit/accuracy/check-target-calls.c \
	tests/unit/blocks/check-blocks.c tests/unit/blocks/check-directions.c \
	tests/unit/clusters/check-clusters.c tests/unit/clusters/check-far-exchange.c \
	tests/unit/field/check-field.c tests/unit/field/check-field-grid.c \
	tests/unit/field/check-past-ends.c tests/unit/formats/check-vs2.c \
	tests/unit/geometry/check-exchange-area.c tests/unit/links/check-store.c \
	tests/unit/oracle/check-l1.c tests/unit/refine/check-image-elements.c \
	tests/unit/refine/check-occlusion.c tests/unit/refine/check-rows.c \
	tests/unit/refine/check-validate.c tests/unit/repair/check-crossings.c \
	tests/unit/scene/check-effects.c tests/unit/solution/check-emissivity.c \
	tests/unit/solution/check-heat-bands.c tests/unit/solution/check-heat-images.c \
	tests/unit/solution/check-heat-links.c tests/unit/solution/check-irradiance-points.c \
	tests/unit/solution/check-points.c tests/unit/solve/check-closure.c \
	tests/unit/solve/check-mirrors.c tests/unit/solve/check-order.c \
	tests/unit/solve/check-periods.c tests/unit/solve/check-row-sums.c \
	tests/unit/solve/check-sky.c tests/unit/solve/check-slices.c tests/unit/solve/check-solve.c \
	tests/unit/solve/check-sun.c tests/unit/mesh/check-events.c \
	tests/unit/visibility/check-exchange-rows.c tests/unit/visibility/check-period-rows.c
# Begins first, for a suite that begins last runs alone.
TAKES_LONGEST = tests/threads/check-team
MEMCHECK = $(VALGRIND) --quiet --error-exitcode=9 --leak-check=full \
	--errors-for-leak-kinds=definite,indirect
check-valgrind:
	$(MAKE) check-under RUNNER='$(MEMCHECK)'
# Under any program that runs others, ten times as slowly.
check-under:
	CK_FORK=no CK_DEFAULT_TIMEOUT=0 \
	HR2D_TEST_MULTIPLIER="$${HR2D_TEST_MULTIPLIER-0.01}" \
	$(MAKE) check LOG_COMPILER='$(RUNNER)' SUITE_RUNNER='$(RUNNER)' \
	TESTS='$(TAKES_LONGEST) $(filter-out $(TAKES_LONGEST) $(TOO_LONG) $(LEFT_OUT),$(SUITES) $(REPLACING))'

# Scripts about texts, names and digits, in which sanitizers have nothing to find.
PAPERWORK = tests/docs/check-docs.sh tests/program/check-completion.sh tests/program/check-help.sh tests/program/check-digits.sh \
	tests/package/check-constants.sh tests/package/check-exports.sh \
	tests/package/check-headers.sh tests/package/check-layers.sh \
	tests/package/check-python.sh \
	tests/package/check-wheel.sh \
	tests/package/check-vectors.sh \
	tests/package/check-recipes.sh \
	tests/package/check-sbom.sh \
	tests/adversary/check-adversary-controls.sh
# Each suite is one process: forks of a process with sanitizers took most of the time.
check-sanitized:
	CK_FORK=no $(MAKE) check TESTS='$(filter-out $(PAPERWORK),$(TESTS))'

# What callers, files and failing memory may do to the library and the program; and the headers, whose
# comments clang compares with what they declare.
HOSTILE = $(filter tests/arguments/% tests/faults/% tests/unit/formats/% tests/unit/state/% \
	tests/unit/repair/% tests/unit/triangulation/%,$(SUITES)) \
	tests/unit/operator/check-operator-calls.c tests/unit/accuracy/check-target-calls.c \
	tests/program/check-program-faults.sh tests/program/check-cli.sh tests/package/check-headers.sh
check-hostile:
	CK_FORK=no $(MAKE) check TESTS='$(HOSTILE)'

# All compilers, levels of optimisation and sanitizers; takes an hour.
check-matrix:
	$(SHELL) $(srcdir)/tests/matrix.sh
.PHONY: check-valgrind check-under check-sanitized check-hostile check-matrix

# The table of doc/hard-cases.md, measured by the suites of hard cases.
HARD = $(filter tests/hard/%,$(SUITES))
hard-cases: tests/check-suites$(EXEEXT)
	@rm -f hard-cases.md
	@for suite in $(HARD); do \
	  $(AM_TESTS_ENVIRONMENT) \
	  HR2D_TEST_MULTIPLIER=1 HR2D_HARD_CASES='$(abs_top_builddir)/hard-cases.md' CK_FORK=no \
	    tests/check-suites$(EXEEXT) $$suite >&2 || exit; \
	done
	@cat hard-cases.md
.PHONY: hard-cases
CLEANFILES += hard-cases.md

# The lines and branches of src/ and tools/ that the tests reach, by file.
if HAVE_COVERAGE
REPORT = $(GCOVR) --root '$(srcdir)' --exclude-unreachable-branches \
	--filter '$(srcdir)/src/' --filter '$(srcdir)/tools/'
coverage:
	find . -name '*.gcda' -exec rm -f {} +
	-$(MAKE) check
	$(MKDIR_P) coverage
	$(REPORT) --json coverage/counts.json --txt coverage/lines.txt \
		--html-details coverage/index.html .
	$(REPORT) --add-tracefile coverage/counts.json --branches --txt coverage/branches.txt
	tail -n 3 coverage/lines.txt coverage/branches.txt
else
coverage:
	@echo "make coverage needs gcovr, gcc and configure --enable-coverage" >&2; exit 1
endif
.PHONY: coverage

# An outside program, in C and in C++, against the files that `make install` installed.
installcheck-local:
	DESTDIR='$(DESTDIR)' libdir='$(libdir)' pkgconfigdir='$(pkgconfigdir)' \
	docdir='$(docdir)' \
	bindir='$(bindir)' PKG_CONFIG='$(PKG_CONFIG)' CC='$(CC)' CXX='$(CXX)' \
	VERSION='$(VERSION)' $(SHELL) $(srcdir)/tests/package/consumer/run.sh $(srcdir)/tests/package/consumer

EXTRA_DIST += $(OUTSIDE) tests/docs/blocks.awk tests/docs/compare.awk tests/docs/pages.sh tests/package/python.sh \
	tests/package/recipes.py \
	tests/digits.sh tests/lsan.supp tests/same-libm.c tests/matrix.sh tests/summary.sh \
	tests/data tests/program/cli tests/program/pfm.py tests/program/schemas.py tests/program/vti.py tests/program/vtp.py tests/threads/race.c \
	tests/package/consumer/main.c \
	tests/package/consumer/main.cpp tests/package/consumer/run.sh \
	tests/package/consumer/CMakeLists.txt tests/package/consumer/meson.build
