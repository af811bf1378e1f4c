# Measurements, built and run by `make bench` alone.
BENCHES = bench/bench_exchange_area bench/bench_refine bench/bench_l1 bench/bench_visibility
EXTRA_PROGRAMS += $(BENCHES)
CLEANFILES += $(BENCHES)
bench_bench_exchange_area_SOURCES = bench/bench_exchange_area.c bench/timing.h
bench_bench_exchange_area_LDADD = libhr2d-core.la $(OPENMP_CFLAGS)
bench_bench_refine_SOURCES = bench/bench_refine.c bench/timing.h
bench_bench_refine_LDADD = libhr2d-core.la $(OPENMP_CFLAGS)
bench_bench_visibility_SOURCES = bench/bench_visibility.c bench/timing.h
bench_bench_visibility_LDADD = libhr2d-core.la $(OPENMP_CFLAGS) -lm
bench_bench_l1_SOURCES = bench/bench_l1.c bench/timing.h
bench_bench_l1_CPPFLAGS = $(AM_CPPFLAGS)
bench_bench_l1_LDADD = libhr2d-core.la $(GSL_LIBS) $(OPENMP_CFLAGS) -lm

bench: $(BENCHES)
	@for program in $(BENCHES); do echo "== $$program"; ./$$program || exit 1; done
.PHONY: bench
