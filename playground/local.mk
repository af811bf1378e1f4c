# The page with the library as WebAssembly: `make playground` makes it in playground/site/ of the
# build folder, `make check-playground` tests it in a browser; see playground/README.md.
EXTRA_DIST += \
	playground/README.md \
	playground/glue.c \
	playground/glue.h \
	playground/host.c \
	playground/host.h \
	playground/package.c \
	playground/page \
	playground/sources.sh \
	playground/tests/check-page.py \
	playground/tests/webdriver.py \
	playground/wasm.mk

PLAYGROUND = $(MAKE) -f '$(srcdir)/playground/wasm.mk' SRCDIR='$(srcdir)' \
	CORE='$(libhr2d_core_la_SOURCES)'
playground: include/hr2d/version.h
	$(PLAYGROUND)

check-playground: playground tools/hr2d$(EXEEXT)
	PYTHONDONTWRITEBYTECODE=1 python3 '$(srcdir)/playground/tests/check-page.py' playground/site \
	  tools/hr2d$(EXEEXT) '$(srcdir)/examples/scenes' $(PLAYGROUND_PICTURES)

clean-playground:
	rm -rf playground/site playground/wasm
mostlyclean-local: clean-playground
.PHONY: playground check-playground clean-playground
