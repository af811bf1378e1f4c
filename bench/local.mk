# Measurements, built and run by `make bench` alone.
BENCHES = bench/bench-exchange-area bench/bench-refine bench/bench-l1 bench/bench-visibility \
	bench/bench-growth bench/bench-shaded-links bench/bench-blocks \
	bench/bench-accuracy bench/bench-budgets bench/bench-polls bench/bench-prediction \
	bench/bench-fibres bench/bench-solves bench/bench-threads bench/bench-triangulation bench/bench-field \
	bench/bench-bands bench/bench-operator bench/bench-choices
EXTRA_PROGRAMS += $(BENCHES)
CLEANFILES += $(BENCHES)
bench_bench_exchange_area_SOURCES = bench/bench-exchange-area.c bench/timing.h
bench_bench_exchange_area_LDADD = libhr2d-core.la $(THREADS_LIBS)
bench_bench_refine_SOURCES = bench/bench-refine.c bench/plain.c bench/plain.h bench/timing.h
bench_bench_refine_LDADD = libhr2d-core.la $(THREADS_LIBS) -lm
PLANS = bench/bars.c bench/bars.h bench/plans.c bench/plans.h bench/timing.h
bench_bench_visibility_SOURCES = bench/bench-visibility.c bench/rows.c bench/rows.h $(PLANS)
bench_bench_visibility_CFLAGS = $(AM_CFLAGS) -fmath-errno -ftrapping-math
bench_bench_visibility_LDADD = libhr2d-core.la $(THREADS_LIBS) -lm
bench_bench_growth_SOURCES = bench/bench-growth.c bench/alone.c bench/alone.h \
	bench/rows.c bench/rows.h $(PLANS)
bench_bench_growth_LDADD = libhr2d-core.la $(THREADS_LIBS) -lm
bench_bench_shaded_links_SOURCES = bench/bench-shaded-links.c $(PLANS)
bench_bench_shaded_links_LDADD = libhr2d-core.la $(THREADS_LIBS) -lm
bench_bench_blocks_SOURCES = bench/bench-blocks.c bench/bars.c bench/bars.h bench/timing.h \
	tests/support/pair-kinds.c tests/support/pair-kinds.h \
	tests/support/random.c tests/support/random.h tests/support/visibility-cases.h
bench_bench_blocks_CPPFLAGS = $(AM_CPPFLAGS)
bench_bench_blocks_LDADD = libhr2d-core.la $(THREADS_LIBS) -lm
bench_bench_bands_SOURCES = bench/bench-bands.c $(PLANS)
bench_bench_bands_CPPFLAGS = $(AM_CPPFLAGS) -DBENCH_SCENES='"$(abs_top_srcdir)/examples/scenes"'
bench_bench_bands_LDADD = libhr2d-core.la $(THREADS_LIBS) -lm
bench_bench_field_SOURCES = bench/bench-field.c bench/plain.c bench/plain.h $(PLANS)
bench_bench_field_CPPFLAGS = $(AM_CPPFLAGS) -DBENCH_SCENES='"$(abs_top_srcdir)/examples/scenes"'
bench_bench_field_LDADD = libhr2d-core.la $(THREADS_LIBS) -lm
bench_bench_l1_SOURCES = bench/bench-l1.c bench/timing.h
bench_bench_l1_CPPFLAGS = $(AM_CPPFLAGS)
bench_bench_l1_LDADD = libhr2d-core.la $(GSL_LIBS) $(THREADS_LIBS) -lm
bench_bench_accuracy_SOURCES = bench/bench-accuracy.c bench/dense.c bench/dense.h bench/many.c \
	bench/many.h bench/plain.c bench/plain.h bench/timing.h \
	tests/support/radiosity-scenes.c tests/support/radiosity-scenes.h \
	tests/support/random.c tests/support/random.h
bench_bench_accuracy_CPPFLAGS = $(AM_CPPFLAGS) $(LAPACK_CFLAGS) \
	-DBENCH_DATA='"$(abs_top_srcdir)/tests/data/reference"'
bench_bench_accuracy_LDADD = libhr2d-core.la $(LAPACK_LIBS) $(GSL_LIBS) $(THREADS_LIBS) -lm
SOLVE_TASKS = bench/solve-tasks.c bench/solve-tasks.h bench/many.c bench/many.h \
	tests/support/random.c tests/support/random.h \
	tests/support/slow-scenes.c tests/support/slow-scenes.h
bench_bench_solves_SOURCES = bench/bench-solves.c bench/plain.c bench/plain.h bench/timing.h \
	$(SOLVE_TASKS)
bench_bench_solves_CPPFLAGS = $(AM_CPPFLAGS) -DBENCH_SOURCE='"$(abs_top_srcdir)"'
bench_bench_solves_LDADD = libhr2d-core.la $(THREADS_LIBS) -lm
bench_bench_operator_SOURCES = bench/bench-operator.c bench/bars.c bench/bars.h bench/timing.h \
	$(SOLVE_TASKS)
bench_bench_operator_CPPFLAGS = $(AM_CPPFLAGS) -DBENCH_SOURCE='"$(abs_top_srcdir)"'
bench_bench_operator_LDADD = libhr2d-core.la $(THREADS_LIBS) -lm
bench_bench_choices_SOURCES = bench/bench-choices.c bench/timing.h $(SOLVE_TASKS)
bench_bench_choices_CPPFLAGS = $(AM_CPPFLAGS) -DBENCH_SOURCE='"$(abs_top_srcdir)"'
bench_bench_choices_LDADD = libhr2d-core.la $(THREADS_LIBS) -lm
EXTRA_DIST += bench/choices.sh bench/gas.sh bench/scenes
bench_bench_fibres_SOURCES = bench/bench-fibres.c bench/alone.c bench/alone.h bench/many.c \
	bench/many.h bench/timing.h tests/support/random.c tests/support/random.h
bench_bench_fibres_CPPFLAGS = $(AM_CPPFLAGS)
bench_bench_fibres_LDADD = libhr2d-core.la $(THREADS_LIBS) -lm
bench_bench_prediction_SOURCES = bench/bench-prediction.c \
	tests/adversary/kinds.c tests/adversary/kinds.h tests/adversary/kinds-day.c \
	tests/adversary/kinds-extreme.c tests/adversary/kinds-open.c \
	tests/adversary/kinds-gas.c tests/adversary/kinds-rooms.c tests/adversary/kinds-symmetry.c \
	tests/adversary/random.h tests/adversary/scene.c tests/adversary/scene.h
bench_bench_prediction_LDADD = libhr2d-core.la $(THREADS_LIBS) -lm
bench_bench_budgets_SOURCES = bench/bench-budgets.c bench/budget-scenes.c \
	bench/budget-scenes.h bench/many.c bench/many.h bench/timing.h \
	tests/support/random.c tests/support/random.h \
	tests/support/slow-scenes.c tests/support/slow-scenes.h
bench_bench_budgets_CPPFLAGS = $(AM_CPPFLAGS)
bench_bench_budgets_LDADD = libhr2d-core.la $(THREADS_LIBS) -lm
bench_bench_polls_SOURCES = bench/bench-polls.c tests/support/slow-phases.c \
	tests/support/slow-phases.h tests/support/slow-scenes.c tests/support/slow-scenes.h
bench_bench_polls_CPPFLAGS = $(AM_CPPFLAGS)
bench_bench_polls_LDADD = libhr2d-core.la $(THREADS_LIBS) -lm
bench_bench_threads_SOURCES = bench/bench-threads.c bench/timing.h $(SOLVE_TASKS)
bench_bench_threads_CPPFLAGS = $(AM_CPPFLAGS) -DBENCH_SOURCE='"$(abs_top_srcdir)"'
bench_bench_threads_LDFLAGS = -Wl,--wrap=hr2di_team_run
bench_bench_threads_LDADD = libhr2d-core.la $(THREADS_LIBS) -lm
bench_bench_triangulation_SOURCES = bench/bench-triangulation.c bench/timing.h \
	tests/support/random.c tests/support/random.h
bench_bench_triangulation_CPPFLAGS = $(AM_CPPFLAGS)
bench_bench_triangulation_LDADD = libhr2d-core.la $(THREADS_LIBS) -lm

benches: $(BENCHES)
bench: benches
	@for program in $(BENCHES); do echo "== $$program"; ./$$program || exit 1; done
.PHONY: bench benches
