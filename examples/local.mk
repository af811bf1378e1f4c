# Examples use the library as any program does; `make check` compares what they
# print with NAME.expected.
EXAMPLES = examples/conduction examples/digits examples/furnace-section examples/own-oracle \
	examples/resume examples/room-climate examples/shares examples/solar-panels \
	examples/street-canyon examples/tour
check_PROGRAMS += $(EXAMPLES)
examples_conduction_CPPFLAGS = $(PUBLIC_CPPFLAGS)
examples_conduction_LDADD = libhr2d.la -lm
examples_digits_CPPFLAGS = $(PUBLIC_CPPFLAGS)
examples_digits_LDADD = libhr2d.la
examples_furnace_section_CPPFLAGS = $(PUBLIC_CPPFLAGS)
examples_furnace_section_LDADD = libhr2d.la -lm
examples_own_oracle_CPPFLAGS = $(PUBLIC_CPPFLAGS)
examples_own_oracle_LDADD = libhr2d.la -lm
examples_resume_CPPFLAGS = $(PUBLIC_CPPFLAGS)
examples_resume_LDADD = libhr2d.la
examples_room_climate_CPPFLAGS = $(PUBLIC_CPPFLAGS)
examples_room_climate_LDADD = libhr2d.la -lm
examples_shares_CPPFLAGS = $(PUBLIC_CPPFLAGS)
examples_shares_LDADD = libhr2d.la -lm
examples_solar_panels_CPPFLAGS = $(PUBLIC_CPPFLAGS)
examples_solar_panels_LDADD = libhr2d.la -lm
examples_street_canyon_CPPFLAGS = $(PUBLIC_CPPFLAGS)
examples_street_canyon_LDADD = libhr2d.la -lm
examples_tour_CPPFLAGS = $(PUBLIC_CPPFLAGS)
examples_tour_LDADD = libhr2d.la

# Built and run by `make installcheck`, with the installed library.
CXX_EXAMPLES = examples/room

EXTRA_DIST += examples/scenes $(EXAMPLES:=.expected) $(CXX_EXAMPLES:=.cpp) $(CXX_EXAMPLES:=.expected)
