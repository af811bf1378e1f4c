# SPDX-License-Identifier: GPL-3.0-or-later
# The page with the library as WebAssembly; the rule `playground` of local.mk calls this with
#   SRCDIR        the top of the tree
#   CORE          the files of the library, relative to SRCDIR
# in the folder of the build.
MAKEFLAGS += --no-builtin-rules
EMCC = emcc
# What Debian's emcc would call for each file, after half a second of its own.
CLANG = clang-14
CC := $(CLANG) $(shell $(EMCC) --cflags)
PAGE = $(SRCDIR)/playground/page
SCENES = $(wildcard $(SRCDIR)/examples/scenes/*.geojson $(SRCDIR)/examples/scenes/*.vs2)
OUT = playground/site
SOURCES = playground/wasm/sources

# No fast-math, no fused products, no threads, no AVX2: the operations of the library as it is
# everywhere, in their order.  -Os makes the module a seventh smaller than -O3, and 3 % slower.
FLAGS = -std=c11 -Os -ffp-contract=off -fno-math-errno -fno-trapping-math -MMD
LIBRARY = $(FLAGS) -Wall -Wextra -DHR2D_BUILDING -D_POSIX_C_SOURCE=200809L -Iinclude \
	-I$(SRCDIR)/include -I$(SRCDIR)/src -Iplayground/wasm/include
GLUE = $(FLAGS) -Wall -Wextra -Wshadow -Wconversion -Wno-sign-conversion \
	-D_DEFAULT_SOURCE -Iinclude -I$(SRCDIR)/include -I$(SRCDIR)/tools -Iplayground/wasm/include
PROGRAM = $(FLAGS) -Wall -Wextra -D_DEFAULT_SOURCE -Iinclude -I$(SRCDIR)/include \
	-I$(SRCDIR)/tools -Iplayground/wasm/include
FOREIGN = $(FLAGS) -w -DHAVE_STDINT_H -Iplayground/wasm/include

# What the library calls of GSL, and what that calls; the linker drops the rest.
GSL = blas/blas cblas/dasum cblas/daxpy cblas/dcopy cblas/ddot cblas/dgemm cblas/dgemv cblas/dger \
	cblas/dnrm2 cblas/drot cblas/dscal cblas/dtrmm cblas/dtrmv cblas/dtrsm cblas/dtrsv \
	cblas/xerbla err/error err/stream fit/linear integration/qk integration/qk15 \
	linalg/householder linalg/qr matrix/matrix matrix/rowcol matrix/submatrix matrix/view \
	specfunc/debye specfunc/psi vector/copy vector/init vector/subvector vector/vector vector/view
# What `hr2d solve --json` is made of.  host.c takes the place of files that need a machine.
SOLVE = cli/commands cli/names cli/numbers cli/option-table cli/options cli/options-check \
	cli/scene cli/suggest cli/values cli/warnings output/clock output/json output/printable \
	output/provenance output/sha256 output/suffix run/heat run/places run/run run/target \
	solve/json
CALLS = glue host package
JANSSON = dump error hashtable hashtable_seed load memory strbuffer strconv utf value

OBJECTS = $(patsubst %.c,playground/wasm/object/%.o,$(filter %.c,$(CORE))) \
	$(GSL:%=playground/wasm/object/gsl/%.o) $(JANSSON:%=playground/wasm/object/jansson/%.o) \
	$(SOLVE:%=playground/wasm/object/tools/%.o) $(CALLS:%=playground/wasm/object/calls/%.o)
STATIC = $(patsubst $(PAGE)/%,$(OUT)/%,$(wildcard $(PAGE)/*)) $(OUT)/scenes/list.json

all: $(OUT)/hr2d.wasm $(STATIC)

# A module that imports a clock, and go_on() of glue.c.  emcc warns of go_on(); if any other name
# were missing, library.js could not start the module.
$(OUT)/hr2d.wasm: $(OBJECTS)
	@mkdir -p $(@D)
	$(EMCC) -Os --no-entry -sSTANDALONE_WASM -sALLOW_MEMORY_GROWTH -sMAXIMUM_MEMORY=2147483648 \
	  -sTOTAL_STACK=1048576 -sERROR_ON_UNDEFINED_SYMBOLS=0 $(OBJECTS) -o $@

$(OUT)/%: $(PAGE)/%
	@mkdir -p $(@D)
	cp $< $@

$(OUT)/scenes/list.json: $(SCENES) $(SRCDIR)/playground/wasm.mk
	@mkdir -p $(@D)
	cp $(SCENES) $(@D)
	(printf '['; printf '"%s"\n' $(notdir $(SCENES)) | paste -sd , -; printf ']\n') >$@

playground/wasm/object/calls/%.o: $(SRCDIR)/playground/%.c $(SOURCES)/ready
	@mkdir -p $(@D)
	$(CC) $(GLUE) -c $< -o $@

playground/wasm/object/gsl/%.o: $(SOURCES)/ready
	@mkdir -p $(@D)
	$(CC) $(FOREIGN) -I$(SOURCES)/gsl -c $(SOURCES)/gsl/$*.c -o $@

playground/wasm/object/jansson/%.o: $(SOURCES)/ready
	@mkdir -p $(@D)
	$(CC) $(FOREIGN) -c $(SOURCES)/jansson/src/$*.c -o $@

playground/wasm/object/tools/%.o: $(SRCDIR)/tools/%.c $(SOURCES)/ready
	@mkdir -p $(@D)
	$(CC) $(PROGRAM) -c $< -o $@

playground/wasm/object/%.o: $(SRCDIR)/%.c $(SOURCES)/ready
	@mkdir -p $(@D)
	$(CC) $(LIBRARY) -c $< -o $@

# Headers as they would be installed, and the little that the sources ask of config.h.
$(SOURCES)/ready: $(SRCDIR)/playground/sources.sh
	sh $< $(SOURCES)
	@mkdir -p playground/wasm/include/gsl
	cp $(SOURCES)/gsl/gsl_*.h $(SOURCES)/gsl/*/gsl_*.h playground/wasm/include/gsl
	echo '#define GSL_COERCE_DBL(x) (x)' >playground/wasm/include/config.h
	echo '#define RETURN_IF_NULL(x) if (!x) { return; }' >>playground/wasm/include/config.h
	cp $(SOURCES)/jansson/src/jansson.h playground/wasm/include
	: >playground/wasm/include/jansson_private_config.h
	sed -e 's/@json_inline@/inline/' -e 's/@json_have_long_long@/1/' -e 's/@json_have_[a-z_]*@/0/' \
	  $(SOURCES)/jansson/src/jansson_config.h.in >playground/wasm/include/jansson_config.h
	touch $@

.PHONY: all
-include $(OBJECTS:.o=.d)
