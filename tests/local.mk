# The tests: Check programs, and scripts for the program and the package.  A program
# without a list of sources is built from the one file of its name.  tests/support/suite.c says what
# it does with the marks of Check.
AM_CPPFLAGS = $(PUBLIC_CPPFLAGS) -I$(srcdir)/src -I$(srcdir)/tests $(GSL_CFLAGS) $(JANSSON_CFLAGS) \
	$(CHECK_CFLAGS) -D_mark_point=test_mark_point $(MPFR_CFLAGS)
LDADD = tests/libsupport.la libhr2d-core.la $(CHECK_LIBS) $(MPFR_LIBS) $(THREADS_LIBS)

# The longest ones begin: one that began last would run alone.
SUITES = \
	tests/unit/accuracy/check-short-patches \
	tests/unit/accuracy/check-shares \
	tests/unit/solution/check-irradiance-points \
	tests/unit/clusters/check-clusters \
	tests/unit/oracle/check-l1 \
	tests/unit/field/check-field-grid \
	tests/faults/check-polls \
	tests/faults/check-faults-accuracy \
	tests/faults/check-scene-progress \
	tests/unit/base/check-black-body \
	tests/unit/base/check-options \
	tests/unit/base/check-status \
	tests/unit/geometry/check-geometry \
	tests/unit/geometry/check-exchange-area \
	tests/unit/geometry/check-hull \
	tests/unit/geometry/check-stars \
	tests/unit/triangulation/check-triangulation \
	tests/unit/beams/check-line-class \
	tests/unit/beams/check-walk \
	tests/bounds/check-bounds-geometry \
	tests/bounds/check-bounds-oracles \
	tests/bounds/check-bounds-l1 \
	tests/bounds/check-bounds-study \
	tests/bounds/check-bounds-visibility \
	tests/bounds/check-bounds-solution \
	tests/hard/check-hard-geometry \
	tests/hard/check-hard-oracles \
	tests/unit/scene/check-patches \
	tests/unit/scene/check-positions \
	tests/unit/scene/check-redrawn \
	tests/unit/scene/check-commit-searches \
	tests/unit/scene/check-effect-reasons \
	tests/unit/repair/check-crossings \
	tests/unit/scene/check-bent-walls \
	tests/unit/repair/check-snap \
	tests/unit/scene/check-sunlight \
	tests/unit/scene/check-images \
	tests/unit/scene/check-period-weights \
	tests/unit/formats/check-geojson \
	tests/unit/formats/check-memory \
	tests/unit/formats/check-vs2 \
	tests/unit/lint/check-mistakes \
	tests/unit/lint/check-drawings \
	tests/unit/hierarchy/check-hierarchy \
	tests/unit/hierarchy/check-fields \
	tests/unit/refine/check-refine \
	tests/unit/refine/check-partition \
	tests/unit/refine/check-rows \
	tests/unit/refine/check-claims \
	tests/unit/refine/check-image-elements \
	tests/unit/links/check-linkset \
	tests/unit/links/check-store \
	tests/unit/refine/check-validate \
	tests/unit/refine/check-validate-ulps \
	tests/paper/check-theorem \
	tests/unit/oracle/check-squares \
	tests/unit/solution/check-period-points \
	tests/unit/solution/check-points \
	tests/unit/solution/check-emissivity \
	tests/unit/solution/check-heat-bands \
	tests/unit/solution/check-heat-images \
	tests/unit/solution/check-heat-links \
	tests/unit/solution/check-temperatures \
	tests/unit/solution/check-thermal-calls \
	tests/unit/field/check-field \
	tests/unit/field/check-field-rows \
	tests/unit/field/check-field-errors \
	tests/unit/field/check-past-ends \
	tests/unit/solve/check-solve \
	tests/unit/solve/check-background \
	tests/unit/solve/check-sky \
	tests/unit/solve/check-sun \
	tests/unit/solve/check-mirrors \
	tests/unit/solve/check-periods \
	tests/unit/solve/check-closure \
	tests/unit/solve/check-equation-enough \
	tests/unit/solve/check-equation-part \
	tests/unit/solve/check-gather-areas \
	tests/unit/solve/check-gather-links \
	tests/unit/solve/check-leading-blocks \
	tests/unit/solve/check-row-sums \
	tests/unit/solve/check-adopt \
	tests/unit/solve/check-image-scales \
	tests/unit/solve/check-lengths \
	tests/unit/refine/check-occlusion \
	tests/unit/scene/check-effects \
	tests/unit/occlusion/check-visibility \
	tests/hard/check-hard-visibility \
	tests/hard/check-hard-scenes \
	tests/unit/visibility/check-exchange-matrix \
	tests/unit/visibility/check-exchange-rows \
	tests/unit/visibility/check-period-rows \
	tests/unit/visibility/check-image-memory \
	tests/unit/visibility/check-pair-visibility \
	tests/unit/visibility/check-back-visibility \
	tests/unit/visibility/check-beam-cache \
	tests/unit/mesh/check-visible-vertices \
	tests/unit/blocks/check-blocks \
	tests/unit/blocks/check-directions \
	tests/unit/blocks/check-moments \
	tests/unit/solve/check-order \
	tests/unit/solve/check-slices \
	tests/unit/accuracy/check-known-radiosities \
	tests/unit/accuracy/check-random-accuracy \
	tests/unit/accuracy/check-random-periods \
	tests/unit/accuracy/check-target-calls \
	tests/unit/estimate/check-cluster-residuals \
	tests/unit/estimate/check-error-indicators \
	tests/unit/estimate/check-single-blocks \
	tests/unit/accuracy/check-importance \
	tests/unit/accuracy/check-found-errors \
	tests/unit/enclosure/check-enclosure \
	tests/unit/enclosure/check-enclosure-factors \
	tests/unit/mesh/check-event-selection \
	tests/unit/accuracy/check-measured-errors \
	tests/unit/accuracy/check-budgets \
	tests/unit/accuracy/check-cracks \
	tests/unit/accuracy/check-dark \
	tests/unit/estimate/check-roundings \
	tests/unit/accuracy/check-shadow-edges \
	tests/unit/clusters/check-far-exchange \
	tests/unit/clusters/check-root-pairs \
	tests/unit/mesh/check-corner \
	tests/unit/mesh/check-events \
	tests/unit/mesh/check-shared-events \
	tests/unit/visibility/check-point-beams \
	tests/unit/visibility/check-point-view \
	tests/unit/visibility/check-point-view-walls \
	tests/unit/state/check-state \
	tests/unit/state/check-state-scene \
	tests/unit/refine/check-study \
	tests/hard/check-hard-refine \
	tests/hard/check-hard-solve \
	tests/arguments/check-arguments \
	tests/threads/check-threads \
	tests/threads/check-team \
	tests/faults/check-faults \
	tests/faults/check-divided-faults \
	tests/faults/check-share-faults \
	tests/faults/check-faults-callbacks \
	tests/faults/check-faults-malloc

OUTSIDE = \
	tests/adversary/check-adversary.sh \
	tests/docs/check-docs.sh \
	tests/program/check-cli.sh \
	tests/program/check-help.sh \
	tests/program/check-program-faults.sh \
	tests/program/check-digits.sh \
	tests/program/check-field.sh \
	tests/program/check-vti.sh \
	tests/program/check-pictures.sh \
	tests/program/check-one-value.sh \
	tests/program/check-resume.sh \
	tests/program/check-temperatures.sh \
	tests/program/check-texts.sh \
	tests/package/check-choices.sh tests/package/check-constants.sh \
	tests/package/check-exports.sh \
	tests/package/check-hardening.sh \
	tests/package/check-headers.sh \
	tests/package/check-layers.sh \
	tests/package/check-examples.sh \
	tests/package/check-python.sh \
	tests/package/check-release.sh \
	tests/adversary/check-adversary-controls.sh

TEST_EXTENSIONS = .sh
SH_LOG_COMPILER = $(SHELL)

if HAVE_TESTS
check_LTLIBRARIES += tests/libsupport.la
tests_threads_check_threads_LDFLAGS = -pthread
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
check_PROGRAMS += $(SUITES)
# The longest one begins first.
TESTS += $(OUTSIDE) $(SUITES)
else
check-local:
	@echo "make check needs Check and MPFR; configure did not find them" >&2; exit 1
endif

# Calls of all public functions, made of their prototypes.
tests_arguments_check_arguments_SOURCES = tests/arguments/check-arguments.c \
	tests/arguments/stage.c tests/arguments/stage.h
tests_arguments_check_arguments_CPPFLAGS = $(AM_CPPFLAGS) -I$(builddir)
tests/arguments/check_arguments-check-arguments.$(OBJEXT): \
	tests/arguments/calls.inc
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
TOO_LONG = tests/bounds/check-bounds-geometry tests/bounds/check-bounds-l1 \
	tests/faults/check-faults tests/faults/check-faults-accuracy \
	tests/faults/check-faults-callbacks tests/faults/check-polls tests/faults/check-share-faults \
	tests/faults/check-scene-progress \
	tests/hard/check-hard-oracles tests/hard/check-hard-refine tests/hard/check-hard-scenes \
	tests/hard/check-hard-solve tests/paper/check-theorem tests/unit/accuracy/check-budgets \
	tests/unit/estimate/check-cluster-residuals tests/unit/accuracy/check-cracks \
	tests/unit/accuracy/check-dark tests/unit/estimate/check-error-indicators \
	tests/unit/accuracy/check-importance tests/unit/accuracy/check-known-radiosities \
	tests/unit/accuracy/check-random-accuracy tests/unit/accuracy/check-random-periods \
	tests/unit/estimate/check-roundings tests/unit/accuracy/check-shadow-edges \
	tests/unit/accuracy/check-shares tests/unit/accuracy/check-short-patches \
	tests/unit/estimate/check-single-blocks tests/unit/accuracy/check-target-calls tests/unit/blocks/check-blocks \
	tests/unit/blocks/check-directions tests/unit/clusters/check-clusters \
	tests/unit/clusters/check-far-exchange tests/unit/field/check-field \
	tests/unit/field/check-field-grid tests/unit/field/check-past-ends tests/unit/formats/check-vs2 \
	tests/unit/geometry/check-exchange-area tests/unit/links/check-store tests/unit/oracle/check-l1 \
	tests/unit/refine/check-image-elements tests/unit/refine/check-occlusion \
	tests/unit/refine/check-rows tests/unit/refine/check-validate tests/unit/repair/check-crossings \
	tests/unit/scene/check-effects tests/unit/solution/check-emissivity \
	tests/unit/solution/check-heat-bands tests/unit/solution/check-heat-images \
	tests/unit/solution/check-heat-links tests/unit/solution/check-irradiance-points \
	tests/unit/solution/check-points tests/unit/solve/check-closure tests/unit/solve/check-mirrors \
	tests/unit/solve/check-order tests/unit/solve/check-periods tests/unit/solve/check-row-sums \
	tests/unit/solve/check-sky tests/unit/solve/check-slices tests/unit/solve/check-solve \
	tests/unit/solve/check-sun tests/unit/mesh/check-events \
	tests/unit/visibility/check-exchange-rows tests/unit/visibility/check-period-rows
# Begins first, for a suite that begins last runs alone.
TAKES_LONGEST = tests/threads/check-team
MEMCHECK = $(VALGRIND) --quiet --error-exitcode=9 --leak-check=full \
	--errors-for-leak-kinds=definite,indirect
check-valgrind:
	CK_FORK=no CK_DEFAULT_TIMEOUT=0 \
	HR2D_TEST_MULTIPLIER="$${HR2D_TEST_MULTIPLIER-0.01}" \
	$(MAKE) check TESTS='$(TAKES_LONGEST) $(filter-out $(TAKES_LONGEST) $(TOO_LONG),$(SUITES))' \
	LOG_COMPILER='$(MEMCHECK)'

# Scripts about texts, names and digits, in which sanitizers have nothing to find.
PAPERWORK = tests/docs/check-docs.sh tests/program/check-help.sh tests/program/check-digits.sh \
	tests/package/check-constants.sh tests/package/check-exports.sh \
	tests/package/check-headers.sh tests/package/check-layers.sh \
	tests/package/check-python.sh tests/adversary/check-adversary-controls.sh
# Each suite is one process: forks of a process with sanitizers took most of the time.
check-sanitized:
	CK_FORK=no $(MAKE) check TESTS='$(filter-out $(PAPERWORK),$(TESTS))'

# All compilers, levels of optimisation and sanitizers; takes an hour.
check-matrix:
	$(SHELL) $(srcdir)/tests/matrix.sh
.PHONY: check-valgrind check-sanitized check-matrix

# The table of doc/hard-cases.md, measured by the suites of hard cases.
HARD = $(filter tests/hard/%,$(SUITES))
hard-cases: $(HARD)
	@rm -f hard-cases.md
	@for suite in $(HARD); do \
	  $(AM_TESTS_ENVIRONMENT) \
	  HR2D_TEST_MULTIPLIER=1 HR2D_HARD_CASES='$(abs_top_builddir)/hard-cases.md' CK_FORK=no \
	    ./$$suite >&2 || exit; \
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

EXTRA_DIST += $(OUTSIDE) tests/docs/blocks.awk tests/docs/compare.awk tests/docs/pages.sh \
	tests/digits.sh tests/lsan.supp tests/matrix.sh tests/summary.sh \
	tests/data tests/program/cli tests/program/vti.py tests/threads/race.c \
	tests/package/consumer/main.c \
	tests/package/consumer/main.cpp tests/package/consumer/run.sh \
	tests/package/consumer/CMakeLists.txt tests/package/consumer/meson.build
