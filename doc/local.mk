# `make doxygen` writes html/ from the headers and doc/*.md.
EXTRA_DIST += doc/scene-files.md

doxygen: doc/Doxyfile
	@test -n '$(DOXYGEN)' || { echo "doxygen was not found by configure" >&2; exit 1; }
	$(DOXYGEN) doc/Doxyfile
.PHONY: doxygen

clean-local:
	rm -rf html
