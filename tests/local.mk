# The tests: Check programs, and scripts for what is seen from outside.  A program
# without a list of sources is made from the one file that is called as it is.
AM_CPPFLAGS = $(PUBLIC_CPPFLAGS) -I$(srcdir)/src $(GSL_CFLAGS) $(JANSSON_CFLAGS) \
	$(CHECK_CFLAGS) $(MPFR_CFLAGS)
LDADD = tests/libsupport.la libhr2d-core.la $(CHECK_LIBS) $(MPFR_LIBS) $(OPENMP_CFLAGS)

SUITES = \
	tests/check_status \
	tests/check_geometry \
	tests/check_exchange_area \
	tests/check_bounds_geometry \
	tests/check_bounds_oracles \
	tests/check_bounds_l1 \
	tests/check_bounds_study \
	tests/check_bounds_visibility \
	tests/check_bounds_solution \
	tests/check_hard_geometry \
	tests/check_hard_oracles \
	tests/check_scene \
	tests/check_crossings \
	tests/check_geojson \
	tests/check_memory \
	tests/check_vs2 \
	tests/check_hierarchy \
	tests/check_refine \
	tests/check_linkset \
	tests/check_validate \
	tests/check_theorem \
	tests/check_l1 \
	tests/check_solve \
	tests/check_occlusion \
	tests/check_effects \
	tests/check_visibility \
	tests/check_hard_visibility \
	tests/check_hard_scenes \
	tests/check_exchange_matrix \
	tests/check_blocks \
	tests/check_order \
	tests/check_accuracy \
	tests/check_clusters \
	tests/check_corner \
	tests/check_events \
	tests/check_point_view \
	tests/check_state \
	tests/check_study \
	tests/check_hard_refine \
	tests/check_hard_solve \
	tests/check_threads \
	tests/check_faults \
	tests/check_faults_accuracy \
	tests/check_faults_callbacks \
	tests/check_faults_malloc

OUTSIDE = \
	tests/check_cli.sh \
	tests/check-program-faults.sh \
	tests/check_digits.sh \
	tests/check_resume.sh \
	tests/check-exports.sh \
	tests/check-headers.sh \
	tests/check-layers.sh \
	tests/check-examples.sh

TEST_EXTENSIONS = .sh
SH_LOG_COMPILER = $(SHELL)

if HAVE_TESTS
check_LTLIBRARIES += tests/libsupport.la
tests_check_threads_LDFLAGS = -pthread
tests_libsupport_la_SOURCES = \
	tests/accuracy_nystrom.c tests/accuracy_nystrom.h \
	tests/accuracy_scenes.c tests/accuracy_scenes.h \
	tests/brute_block.c tests/brute_block.h \
	tests/mpfr_exchange.c tests/mpfr_exchange.h \
	tests/mpfr_l1.c tests/mpfr_l1.h \
	tests/pair_classes.c tests/pair_classes.h \
	tests/brute_visibility.c tests/brute_visibility.h \
	tests/fault_stage.c tests/fault_stage.h \
	tests/hard.c tests/hard.h \
	tests/hill_climb.c tests/hill_climb.h \
	tests/hard_rooms.c tests/hard_rooms.h \
	tests/radiosity_scenes.c tests/radiosity_scenes.h \
	tests/room_plans.c tests/room_plans.h \
	tests/support.c tests/support.h \
	tests/visibility_cases.c tests/visibility_cases.h
check_PROGRAMS += $(SUITES)
TESTS += $(SUITES) $(OUTSIDE)
else
check-local:
	@echo "make check needs Check and MPFR; configure did not find them" >&2; exit 1
endif

# A test may take 600 s before Check ends it, on a busy machine too.
AM_TESTS_ENVIRONMENT = \
	LSAN_OPTIONS='suppressions=$(abs_top_srcdir)/tests/lsan.supp:print_suppressions=0'; \
	export LSAN_OPTIONS; \
	CK_DEFAULT_TIMEOUT="$${CK_DEFAULT_TIMEOUT-600}"; export CK_DEFAULT_TIMEOUT; \
	HR2D_SRCDIR='$(abs_top_srcdir)'; export HR2D_SRCDIR; \
	HR2D_BUILDDIR='$(abs_top_builddir)'; export HR2D_BUILDDIR; \
	HR2D_TEST_DATA='$(abs_top_srcdir)/tests/reference'; export HR2D_TEST_DATA; \
	HR2D_SCENES='$(abs_top_srcdir)/examples/scenes'; export HR2D_SCENES; \
	HR2D_PROGRAM='$(abs_top_builddir)/tools/hr2d$(EXEEXT)'; export HR2D_PROGRAM; \
	HR2D_EXAMPLES='$(EXAMPLES)'; export HR2D_EXAMPLES; \
	CC='$(CC)'; export CC; CXX='$(CXX)'; export CXX; NM='$(NM)'; export NM;

# Check programs alone, unforked and in one thread: libgomp's threads show as leaks.
# Without the suites that take too long: the sanitizers run these.
TOO_LONG = tests/check_accuracy tests/check_blocks tests/check_clusters tests/check_occlusion \
	tests/check_theorem tests/check_faults_accuracy tests/check_faults_callbacks
MEMCHECK = $(VALGRIND) --quiet --error-exitcode=9 --leak-check=full \
	--errors-for-leak-kinds=definite,indirect
check-valgrind:
	CK_FORK=no CK_DEFAULT_TIMEOUT=0 OMP_NUM_THREADS=1 \
	HR2D_TEST_MULTIPLIER="$${HR2D_TEST_MULTIPLIER-0.01}" \
	$(MAKE) check TESTS='$(filter-out $(TOO_LONG),$(SUITES))' LOG_COMPILER='$(MEMCHECK)'

# With all compilers, levels of optimisation and sanitizers: takes an hour.
check-matrix:
	$(SHELL) $(srcdir)/tests/matrix.sh
.PHONY: check-valgrind check-matrix

# The table of doc/hard-cases.md, as these suites measure it.
HARD = $(filter tests/check_hard_%,$(SUITES))
hard-cases: $(HARD)
	@rm -f hard-cases.md
	@for suite in $(HARD); do \
	  $(AM_TESTS_ENVIRONMENT) \
	  HR2D_HARD_CASES='$(abs_top_builddir)/hard-cases.md' CK_FORK=no ./$$suite >&2 || exit; \
	done
	@cat hard-cases.md
.PHONY: hard-cases
CLEANFILES += hard-cases.md

# Lines and branches of src/ and tools/ that the tests reach, by file.
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

# An outside program, in C and in C++, against what `make install` left behind.
installcheck-local:
	DESTDIR='$(DESTDIR)' libdir='$(libdir)' pkgconfigdir='$(pkgconfigdir)' \
	bindir='$(bindir)' PKG_CONFIG='$(PKG_CONFIG)' CC='$(CC)' CXX='$(CXX)' \
	$(SHELL) $(srcdir)/tests/consumer/run.sh $(srcdir)/tests/consumer

EXTRA_DIST += $(OUTSIDE) tests/summary.sh tests/lsan.supp tests/cli tests/malformed tests/reference \
	tests/matrix.sh tests/digits.sh tests/race.c \
	tests/consumer/main.c tests/consumer/main.cpp tests/consumer/run.sh
