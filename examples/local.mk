# Examples use the library as any program does; `make check` compares what they
# print with NAME.expected.
EXAMPLES = examples/adiabatic-walls examples/conduction examples/digits \
	examples/fibre-bed examples/fit-emissivities examples/frame-cavity \
	examples/furnace-section examples/heating-furnace examples/lamp-powers \
	examples/own-oracle examples/paint-oven \
	examples/resume examples/room-climate examples/shares examples/sky-types examples/solar-panels \
	examples/solar-year examples/street-canyon examples/streets examples/together examples/tour
check_PROGRAMS += $(EXAMPLES)
examples_adiabatic_walls_CPPFLAGS = $(PUBLIC_CPPFLAGS)
examples_adiabatic_walls_LDADD = libhr2d.la -lm
examples_conduction_CPPFLAGS = $(PUBLIC_CPPFLAGS)
examples_conduction_LDADD = libhr2d.la -lm
examples_digits_CPPFLAGS = $(PUBLIC_CPPFLAGS)
examples_digits_LDADD = libhr2d.la
examples_fibre_bed_CPPFLAGS = $(PUBLIC_CPPFLAGS)
examples_fibre_bed_LDADD = libhr2d.la -lm
examples_fit_emissivities_CPPFLAGS = $(PUBLIC_CPPFLAGS) $(GSL_CFLAGS)
examples_fit_emissivities_LDADD = libhr2d.la $(GSL_LIBS) -lm
examples_frame_cavity_CPPFLAGS = $(PUBLIC_CPPFLAGS)
examples_frame_cavity_LDADD = libhr2d.la -lm
examples_furnace_section_CPPFLAGS = $(PUBLIC_CPPFLAGS)
examples_furnace_section_LDADD = libhr2d.la -lm
examples_heating_furnace_CPPFLAGS = $(PUBLIC_CPPFLAGS)
examples_heating_furnace_LDADD = libhr2d.la -lm
examples_lamp_powers_CPPFLAGS = $(PUBLIC_CPPFLAGS) $(GSL_CFLAGS)
examples_lamp_powers_LDADD = libhr2d.la $(GSL_LIBS) -lm
examples_own_oracle_CPPFLAGS = $(PUBLIC_CPPFLAGS)
examples_own_oracle_LDADD = libhr2d.la -lm
examples_paint_oven_CPPFLAGS = $(PUBLIC_CPPFLAGS)
examples_paint_oven_LDADD = libhr2d.la -lm
examples_resume_CPPFLAGS = $(PUBLIC_CPPFLAGS)
examples_resume_LDADD = libhr2d.la
examples_room_climate_CPPFLAGS = $(PUBLIC_CPPFLAGS)
examples_room_climate_LDADD = libhr2d.la -lm
examples_shares_CPPFLAGS = $(PUBLIC_CPPFLAGS)
examples_shares_LDADD = libhr2d.la -lm
examples_sky_types_CPPFLAGS = $(PUBLIC_CPPFLAGS)
examples_sky_types_LDADD = libhr2d.la
examples_solar_panels_CPPFLAGS = $(PUBLIC_CPPFLAGS)
examples_solar_panels_LDADD = libhr2d.la -lm
examples_solar_year_CPPFLAGS = $(PUBLIC_CPPFLAGS)
examples_solar_year_LDADD = libhr2d.la -lm
examples_street_canyon_CPPFLAGS = $(PUBLIC_CPPFLAGS)
examples_street_canyon_LDADD = libhr2d.la -lm
examples_streets_CPPFLAGS = $(PUBLIC_CPPFLAGS)
examples_streets_LDADD = libhr2d.la -lm
examples_together_CPPFLAGS = -D_POSIX_C_SOURCE=200809L $(PUBLIC_CPPFLAGS)
examples_together_LDADD = libhr2d.la -lm
examples_tour_CPPFLAGS = $(PUBLIC_CPPFLAGS)
examples_tour_LDADD = libhr2d.la

# Built and run by `make installcheck`, with the installed library.
CXX_EXAMPLES = examples/room

# Installed as text: programs to copy, and scenes.
examplesdir = $(docdir)/examples
dist_examples_DATA = $(EXAMPLES:=.c) $(CXX_EXAMPLES:=.cpp)
scenesdir = $(examplesdir)/scenes
dist_scenes_DATA = \
	examples/scenes/README.md \
	examples/scenes/blk1.vs2 \
	examples/scenes/castel-del-monte.geojson \
	examples/scenes/corner.geojson \
	examples/scenes/enfilade.geojson \
	examples/scenes/furnace-enclosure.geojson \
	examples/scenes/furnace-flue-gas.geojson \
	examples/scenes/furnace-flame.geojson \
	examples/scenes/furnace-gas.geojson \
	examples/scenes/furnace-walls.geojson \
	examples/scenes/furnace.geojson \
	examples/scenes/lit-room.geojson \
	examples/scenes/occ128.vs2 \
	examples/scenes/occluders-200.geojson \
	examples/scenes/orth-far.geojson \
	examples/scenes/orth-near.geojson \
	examples/scenes/par-far.geojson \
	examples/scenes/par-near.geojson \
	examples/scenes/partition.geojson \
	examples/scenes/screened-room.geojson \
	examples/scenes/greenhouse.geojson \
	examples/scenes/radiation-shields.geojson \
	examples/scenes/solar-panels.geojson \
	examples/scenes/square-room.geojson \
	examples/scenes/street-canyon.geojson

EXTRA_DIST += $(EXAMPLES:=.expected) $(CXX_EXAMPLES:=.expected)
