# `make doc` writes html/, the site of the headers, the pages of doc/ and the examples.
EXTRA_DIST += \
	doc/README.md \
	doc/adversary.md \
	doc/accuracy.md \
	doc/measurements.md \
	doc/method.md \
	doc/architecture.md \
	doc/compatibility.md \
	doc/cost.md \
	doc/distributed.md \
	doc/fuzzing.md \
	doc/hard-cases.md \
	doc/mirrors-and-periods.md \
	doc/field.md \
	doc/occlusion.md \
	doc/panes.md \
	doc/releasing.md \
	doc/results.md \
	doc/scene-files.md \
	doc/speed.md \
	doc/sun-and-sky.md \
	doc/temperatures.md \
	doc/testing.md \
	doc/theorem.md \
	doc/architecture-figure.sh \
	doc/figures.sh \
	doc/figures \
	doc/gallery \
	doc/gallery.md \
	doc/draw-gallery.sh \
	doc/gas.md \
	doc/howto \
	doc/tutorial \
	doc/check-links.awk \
	doc/footer.html \
	doc/header.html.in \
	doc/label.awk \
	doc/manual.awk \
	doc/menu.awk \
	doc/site.awk \
	doc/site.css

dist_doc_DATA = NEWS README.md

# `make install-html` installs the site.
html-local: doc
install-html-local: doc
	$(MKDIR_P) '$(DESTDIR)$(htmldir)/html'
	cp -R html/. '$(DESTDIR)$(htmldir)/html'

doc: doc/Doxyfile doc/examples.dox doc/header.html doc/manual.dox include/hr2d/version.h
	@test -n '$(DOXYGEN)' || { echo "doxygen was not found by configure" >&2; exit 1; }
	rm -rf html
	$(DOXYGEN) doc/Doxyfile
	$(AWK) -f $(srcdir)/doc/check-links.awk html/*.html html/*.html
doxygen: doc
.PHONY: doc doxygen

# The head of each page, with the menu, which is the list of pages in doc/README.md.
doc/header.html: doc/header.html.in doc/README.md doc/label.awk doc/menu.awk
	@$(MKDIR_P) doc
	@$(AWK) -f $(srcdir)/doc/label.awk -f $(srcdir)/doc/menu.awk $(srcdir)/doc/README.md \
	  $(srcdir)/doc/header.html.in >$@

# The manual page of the program.
doc/manual.dox: tools/hr2d.1 doc/manual.awk
	@$(MKDIR_P) doc
	@$(AWK) -f $(srcdir)/doc/manual.awk $(srcdir)/tools/hr2d.1 >$@

# Each example as a page: its first comment, what it prints, its text.
doc/examples.dox: doc/local.mk $(EXAMPLES:=.c) $(CXX_EXAMPLES:=.cpp)
	@$(MKDIR_P) doc
	@for example in $(EXAMPLES:=.c) $(CXX_EXAMPLES:=.cpp); do \
	  name=$${example##*/}; \
	  echo "/** @example $$name"; \
	  $(AWK) '!/SPDX/ { last = sub(/ *\*\/ *$$/, ""); sub(/^\/\*/, ""); print } last { exit }' \
	    "$(srcdir)/$$example"; \
	  echo; echo " It prints"; echo " @verbinclude $${name%.*}.expected"; echo "*/"; \
	done >$@
CLEANFILES += doc/examples.dox doc/header.html doc/manual.dox

# `make figures` draws the figures of README.md, doc/occlusion.md, doc/theorem.md and doc/cost.md
# into the source tree, from sweeps that a second run resumes.
figures: tools/hr2d$(EXEEXT)
	HR2D_PROGRAM='$(abs_top_builddir)/tools/hr2d$(EXEEXT)' \
	HR2D_SCENES='$(abs_top_srcdir)/examples/scenes' \
	HR2D_SRCDIR='$(abs_top_srcdir)' \
	$(SHELL) $(srcdir)/doc/figures.sh '$(srcdir)/doc/figures' doc/figures-data

# `make gallery` draws the pictures of doc/gallery.md into the source tree, by the commands of that page.
gallery: tools/hr2d$(EXEEXT)
	HR2D_PROGRAM='$(abs_top_builddir)/tools/hr2d$(EXEEXT)' \
	HR2D_SRCDIR='$(abs_top_srcdir)' HR2D_BUILDDIR='$(abs_top_builddir)' \
	$(SHELL) $(srcdir)/doc/draw-gallery.sh '$(abs_top_srcdir)/doc/gallery'
.PHONY: gallery

# `make architecture-figure` draws the storeys of src/ for doc/architecture.md, from the tree.
architecture-figure: libhr2d-core.la
	NM='$(NM)' $(SHELL) $(srcdir)/doc/architecture-figure.sh '$(srcdir)/src' src >doc/architecture.svg
	mv doc/architecture.svg '$(srcdir)/doc/figures/architecture.svg'
.PHONY: figures architecture-figure

clean-local:
	rm -rf html doc/figures-data
