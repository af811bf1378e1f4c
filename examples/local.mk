# Examples use the library as any program does; `make check` compares what they
# print with NAME.expected.
EXAMPLES = examples/own-oracle examples/tour
check_PROGRAMS += $(EXAMPLES)
examples_own_oracle_CPPFLAGS = $(PUBLIC_CPPFLAGS)
examples_own_oracle_LDADD = libhr2d.la -lm
examples_tour_CPPFLAGS = $(PUBLIC_CPPFLAGS)
examples_tour_LDADD = libhr2d.la

EXTRA_DIST += examples/scenes examples/own-oracle.expected examples/tour.expected
