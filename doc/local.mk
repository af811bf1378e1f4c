# `make doxygen` writes html/ from the headers and doc/*.md.
EXTRA_DIST += doc/accuracy.md doc/cost.md doc/fuzzing.md doc/hard-cases.md doc/occlusion.md \
	doc/scene-files.md doc/testing.md doc/theorem.md doc/figures.sh doc/figures

doxygen: doc/Doxyfile
	@test -n '$(DOXYGEN)' || { echo "doxygen was not found by configure" >&2; exit 1; }
	$(DOXYGEN) doc/Doxyfile
.PHONY: doxygen

# `make figures` draws the figures of doc/theorem.md and doc/cost.md into the source tree, from
# sweeps that a second run resumes.
figures: tools/hr2d$(EXEEXT)
	HR2D_PROGRAM='$(abs_top_builddir)/tools/hr2d$(EXEEXT)' \
	HR2D_SCENES='$(abs_top_srcdir)/examples/scenes' \
	HR2D_SRCDIR='$(abs_top_srcdir)' \
	$(SHELL) $(srcdir)/doc/figures.sh '$(srcdir)/doc/figures' doc/figures-data
.PHONY: figures

clean-local:
	rm -rf html doc/figures-data
