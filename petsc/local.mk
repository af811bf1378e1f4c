# libhr2d-petsc, a library of its own over the public headers of libhr2d and over PETSc, and the
# program hr2d-mpi; configure --with-petsc.
EXTRA_DIST += petsc/libhr2d-petsc.map
if WITH_PETSC
lib_LTLIBRARIES += libhr2d-petsc.la
libhr2d_petsc_la_CPPFLAGS = -DHR2DP_BUILDING -D_POSIX_C_SOURCE=200809L $(PUBLIC_CPPFLAGS) \
	-I$(srcdir)/petsc/include $(PETSC_CFLAGS)
libhr2d_petsc_la_CFLAGS = $(HR2D_CFLAGS)
libhr2d_petsc_la_LIBADD = libhr2d.la $(PETSC_LIBS) $(MPI_LIBS) -lm
libhr2d_petsc_la_LDFLAGS = $(AM_LDFLAGS) -version-info 0:0:0 -no-undefined
if HAVE_VERSION_SCRIPT
libhr2d_petsc_la_LDFLAGS += -Wl,--version-script=$(srcdir)/petsc/libhr2d-petsc.map
libhr2d_petsc_la_DEPENDENCIES = libhr2d.la petsc/libhr2d-petsc.map
endif
libhr2d_petsc_la_SOURCES = \
	petsc/agree.c \
	petsc/balance.c petsc/balance.h \
	petsc/closure.c petsc/closure.h \
	petsc/deal.c petsc/deal.h \
	petsc/equation.c petsc/equation.h \
	petsc/exact-sum.h \
	petsc/exchange.c petsc/exchange.h \
	petsc/exchange-shapes.c \
	petsc/hr2dp.c petsc/hr2dp-impl.h \
	petsc/krylov.c petsc/krylov.h \
	petsc/long-rows.c petsc/long-rows.h \
	petsc/memory.c \
	petsc/power.c \
	petsc/save.c \
	petsc/save-solution.c \
	petsc/share.c petsc/share.h \
	petsc/shares.c \
	petsc/solve.c \
	petsc/constants.h \
	petsc/state-head.c petsc/state-head.h \
	petsc/transport.c petsc/transport.h \
	petsc/trees.c petsc/trees.h petsc/trees-impl.h \
	petsc/units.c petsc/units.h
bin_PROGRAMS += hr2d-mpi
dist_man_MANS += petsc/hr2d-mpi.1
hr2d_mpi_CPPFLAGS = -D_POSIX_C_SOURCE=200809L -DPROGRAM_NAME='"hr2d-mpi"' $(PUBLIC_CPPFLAGS) \
	-I$(srcdir)/petsc/include -I$(srcdir)/petsc/program -I$(srcdir)/tools $(PETSC_CFLAGS) \
	$(GSL_CFLAGS) $(JANSSON_CFLAGS) $(CAIRO_CFLAGS)
hr2d_mpi_LDADD = libhr2d-petsc.la libhr2d.la $(PETSC_LIBS) $(MPI_LIBS) $(GSL_LIBS) \
	$(JANSSON_LIBS) $(DRAW_LIBS) -lm
hr2d_mpi_SOURCES = $(SOLVE_SOURCES) \
	petsc/program/main.c petsc/program/program.h \
	petsc/program/report.c \
	petsc/program/run.c \
	petsc/program/scene.c \
	petsc/program/stages.c \
	petsc/program/state-file.c \
	petsc/program/whole.c
include_HEADERS += petsc/include/hr2d-petsc.h
pkgconfig_DATA += hr2d-petsc.pc
else
EXTRA_DIST += petsc/include/hr2d-petsc.h petsc/hr2d-mpi.1
endif
