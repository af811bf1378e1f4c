# The program hr2d, which sees only what any program linked with the library sees.
bin_PROGRAMS += tools/hr2d
tools_hr2d_CPPFLAGS = -D_POSIX_C_SOURCE=200809L $(PUBLIC_CPPFLAGS) $(GSL_CFLAGS) \
	$(JANSSON_CFLAGS) $(CAIRO_CFLAGS)
tools_hr2d_LDADD = libhr2d.la $(GSL_LIBS) $(JANSSON_LIBS) $(CAIRO_LIBS) -lm
tools_hr2d_SOURCES = \
	tools/bands.c \
	tools/chart.c tools/chart.h \
	tools/commands.h \
	tools/complain.c tools/complain.h \
	tools/cost.c tools/cost.h \
	tools/cost-auto.c \
	tools/cost-chart.c \
	tools/cost-dense.c \
	tools/cost-files.c \
	tools/cost-fit.c \
	tools/cost-methods.c \
	tools/cost-refine.c \
	tools/cost-table.c \
	tools/csv.c tools/csv.h \
	tools/draw.c tools/draw.h \
	tools/draw-links.c \
	tools/draw-neighbours.c \
	tools/factors.c tools/factors.h \
	tools/factors-csv.c \
	tools/factors-json.c \
	tools/gnuplot.c tools/gnuplot.h \
	tools/help.c tools/help.h \
	tools/info.c \
	tools/joints.c \
	tools/labels.c \
	tools/layout.c \
	tools/leaves.c tools/leaves.h \
	tools/legend.c \
	tools/load.c tools/load.h \
	tools/main.c \
	tools/numbers.c tools/numbers.h \
	tools/options.c tools/options.h \
	tools/options-check.c \
	tools/output.c tools/output.h \
	tools/pair.c \
	tools/pair-line.c tools/pair-line.h \
	tools/palette.c tools/palette.h \
	tools/picture.h \
	tools/progress.c tools/progress.h \
	tools/report.c tools/report.h \
	tools/run.c tools/run.h \
	tools/run-target.c \
	tools/solve.c \
	tools/solve-csv.c \
	tools/solve-json.c \
	tools/solve-table.c \
	tools/state.c tools/state.h \
	tools/study.c tools/study.h \
	tools/study-csv.c \
	tools/study-json.c \
	tools/study-plan.c \
	tools/study-sweep.c \
	tools/suffix.c tools/suffix.h \
	tools/ticks.c tools/ticks.h \
	tools/values.c tools/values.h

dist_man_MANS = tools/hr2d.1
