# The program hr2d, which sees only what any program linked with the library sees.
bin_PROGRAMS += tools/hr2d
tools_hr2d_CPPFLAGS = -D_POSIX_C_SOURCE=200809L $(PUBLIC_CPPFLAGS) -I$(srcdir)/tools \
	$(GSL_CFLAGS) $(JANSSON_CFLAGS) $(CAIRO_CFLAGS)
tools_hr2d_LDADD = libhr2d.la $(GSL_LIBS) $(JANSSON_LIBS) $(DRAW_LIBS) -lm
# What `hr2d solve` and hr2d-mpi have in common.
SOLVE_SOURCES = \
	tools/output/apng.c tools/output/apng.h \
	tools/output/clock.c tools/output/clock.h \
	tools/output/complain.c tools/output/complain.h \
	tools/output/csv.c tools/output/csv.h \
	tools/output/gnuplot.c tools/output/gnuplot.h \
	tools/output/json.c tools/output/json.h \
	tools/output/metadata.c tools/output/metadata.h \
	tools/output/output.c tools/output/output.h \
	tools/output/palette.c tools/output/palette.h \
	tools/output/png.c tools/output/png.h \
	tools/output/progress.c tools/output/progress.h \
	tools/output/provenance.c tools/output/provenance.h \
	tools/output/sha256.c tools/output/sha256.h \
	tools/output/suffix.c tools/output/suffix.h \
	tools/output/printable.c tools/output/printable.h \
	tools/output/table.c tools/output/table.h \
	tools/output/ticks.c tools/output/ticks.h \
	tools/output/vtk.c tools/output/vtk.h \
	tools/cli/commands.c tools/cli/commands.h \
	tools/cli/names.c tools/cli/names.h \
	tools/cli/numbers.c tools/cli/numbers.h \
	tools/cli/option-table.c tools/cli/option-table.h \
	tools/cli/options.c tools/cli/options.h \
	tools/cli/options-check.c \
	tools/cli/scene.c tools/cli/scene.h \
	tools/cli/suggest.c tools/cli/suggest.h \
	tools/cli/values.c tools/cli/values.h \
	tools/cli/warnings.c tools/cli/warnings.h \
	tools/run/all-links.c \
	tools/run/heat.c \
	tools/run/leaves.c tools/run/leaves.h \
	tools/run/places.c \
	tools/run/run.c tools/run/run.h \
	tools/run/state.c tools/run/state.h \
	tools/run/target.c \
	tools/draw/arrows.c \
	tools/draw/bands.c \
	tools/draw/beams.c \
	tools/draw/cairo-late.c tools/draw/cairo-late.h \
	tools/draw/contour-labels.c \
	tools/draw/contours.c \
	tools/draw/draw.c tools/draw/draw.h \
	tools/draw/extent.c \
	tools/draw/fill.c \
	tools/draw/images.c \
	tools/draw/joints.c \
	tools/draw/labels.c \
	tools/draw/layout.c \
	tools/draw/legend.c \
	tools/draw/legend-scale.c \
	tools/draw/links.c \
	tools/draw/neighbours.c \
	tools/draw/obstacles.c \
	tools/draw/pen.c \
	tools/draw/picture.h \
	tools/draw/raster.c \
	tools/draw/scale.c \
	tools/draw/shade.c \
	tools/draw/tiles.c \
	tools/draw/title.c \
	tools/draw/watch.c \
	tools/solve/command.c \
	tools/solve/csv.c \
	tools/solve/json.c \
	tools/solve/solve.h \
	tools/solve/table.c \
	tools/solve/vtk.c
tools_hr2d_SOURCES = $(SOLVE_SOURCES) \
	tools/main.c \
	tools/cli/help.c tools/cli/help.h \
	tools/info/command.c \
	tools/study/chart.c \
	tools/study/command.c \
	tools/study/csv.c \
	tools/study/json.c \
	tools/study/law.c \
	tools/study/plan.c \
	tools/study/study.h \
	tools/study/sweep.c \
	tools/cost/auto.c \
	tools/cost/box.c tools/cost/box.h \
	tools/cost/chart.c \
	tools/cost/command.c \
	tools/cost/cost.h \
	tools/cost/factors.c \
	tools/cost/files.c \
	tools/cost/fit.c \
	tools/cost/methods.c \
	tools/cost/pace.c tools/cost/pace.h \
	tools/cost/pieces.c tools/cost/pieces.h \
	tools/cost/reference.c \
	tools/cost/refine.c \
	tools/cost/rows.c \
	tools/cost/table.c \
	tools/factors/command.c \
	tools/factors/csv.c \
	tools/factors/elmer.c \
	tools/factors/moose.c \
	tools/factors/group.c \
	tools/factors/factors.h \
	tools/factors/json.c \
	tools/factors/mtx.c \
	tools/factors/row.c \
	tools/field/command.c \
	tools/field/csv.c \
	tools/field/factors.c \
	tools/field/field.h \
	tools/field/json.c \
	tools/field/pfm.c \
	tools/field/points.c \
	tools/field/temperature.c \
	tools/field/vtk.c \
	tools/pair/command.c \
	tools/schema/command.c tools/schema/texts.h \
	tools/pair/line.c tools/pair/line.h

nodist_tools_hr2d_SOURCES = tools/schema/texts.c
tools/schema/texts.c: tools/schema/texts.awk $(dist_schemas_DATA)
	$(AM_V_GEN)$(MKDIR_P) $(@D) && LC_ALL=C $(AWK) -f $(srcdir)/tools/schema/texts.awk \
	  $(dist_schemas_DATA:%=$(srcdir)/%) >$@.new && mv $@.new $@
CLEANFILES += tools/schema/texts.c

dist_man_MANS = tools/hr2d.1
EXTRA_DIST += tools/LAYERS tools/schema/texts.awk

# What shells complete; each file asks the program.
bashcompletiondir = $(datadir)/bash-completion/completions
dist_bashcompletion_DATA = tools/completions/bash/hr2d
zshcompletiondir = $(datadir)/zsh/site-functions
dist_zshcompletion_DATA = tools/completions/_hr2d
fishcompletiondir = $(datadir)/fish/vendor_completions.d
dist_fishcompletion_DATA = tools/completions/hr2d.fish
