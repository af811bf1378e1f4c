# What find_package(hr2d) of CMake reads; pkg-config stays the first way to the library.
cmakedir = $(libdir)/cmake/hr2d
nodist_cmake_DATA = cmake/hr2d-config.cmake cmake/hr2d-config-version.cmake
EXTRA_DIST += cmake/hr2d-config.cmake.in
CLEANFILES += cmake/hr2d-config.cmake

# The folders are known to make alone: configure has them as ${exec_prefix}/lib.
cmake/hr2d-config.cmake: cmake/hr2d-config.cmake.in Makefile
	@$(MKDIR_P) cmake
	$(AM_V_GEN)sed -e 's|@libdir[@]|$(libdir)|' -e 's|@includedir[@]|$(includedir)|' \
	  '$(srcdir)/cmake/hr2d-config.cmake.in' >$@-new
	@mv $@-new $@
