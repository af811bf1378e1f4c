# Recipes for other package managers, and the bill of materials; see packaging/README.md and
# tests/package/check-recipes.sh.
EXTRA_DIST += \
	packaging/README.md \
	packaging/conda/recipe.yaml.in \
	packaging/homebrew/libhr2d.rb.in \
	packaging/homepage \
	packaging/make.sh \
	packaging/nix/default.nix.in \
	packaging/oss-fuzz/Dockerfile.in \
	packaging/oss-fuzz/build.sh.in \
	packaging/oss-fuzz/project.yaml.in \
	packaging/rpm/libhr2d.spec.in \
	packaging/sbom.py \
	packaging/spack/package.py.in \
	packaging/vcpkg/portfile.cmake.in \
	packaging/vcpkg/vcpkg.json.in

# With the checksums of the tarball, if `make dist` has made it.
recipes:
	@tarball=; test ! -f '$(distdir).tar.gz' || tarball='$(distdir).tar.gz'; \
	HOMEPAGE='$(HOMEPAGE)' DOWNLOAD='$(DOWNLOAD)' \
	  $(SHELL) $(srcdir)/packaging/make.sh recipes '$(VERSION)' $$tarball
clean-recipes:
	rm -rf recipes
clean-local: clean-recipes
.PHONY: recipes clean-recipes

# libhr2d-VERSION.spdx.json: what the library is made of, and under which licences.
sbom:
	@tarball=; test ! -f '$(distdir).tar.gz' || tarball='$(distdir).tar.gz'; \
	PKG_CONFIG='$(PKG_CONFIG)' HOMEPAGE='$(HOMEPAGE)' \
	  "$${PYTHON:-python3}" $(srcdir)/packaging/sbom.py $(srcdir) $$tarball >'$(distdir).spdx.json-new'
	@mv '$(distdir).spdx.json-new' '$(distdir).spdx.json'
	@echo '$(distdir).spdx.json'
.PHONY: sbom
CLEANFILES += $(distdir).spdx.json
