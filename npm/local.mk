# The package of npm: `make npm` makes hr2d-VERSION.tgz in the build folder, from the WebAssembly of the
# playground; `make check-npm` installs it and compares its digits; see npm/README.md.
EXTRA_DIST += \
	npm/NOTICE \
	npm/README.md \
	npm/index.d.ts \
	npm/index.js \
	npm/package.json.in \
	npm/tests/check-npm.mjs \
	npm/tests/types.ts

# Neither the network nor files of the user's npm.
NPM = npm --offline --no-audit --no-fund --no-update-notifier --cache=npm/cache --loglevel=error
NPM_FILES = $(srcdir)/COPYING $(srcdir)/npm/NOTICE $(srcdir)/npm/README.md $(srcdir)/npm/index.d.ts \
	$(srcdir)/npm/index.js $(srcdir)/playground/page/module.js
npm: include/hr2d/version.h
	$(PLAYGROUND) playground/site/hr2d.wasm
	rm -rf npm/package
	$(MKDIR_P) npm/package
	cp $(NPM_FILES) playground/site/hr2d.wasm npm/package
	chmod 644 npm/package/*
	sed 's/[@]VERSION@/$(VERSION)/' '$(srcdir)/npm/package.json.in' >npm/package/package.json
	$(NPM) pack ./npm/package >/dev/null

check-npm: npm tools/hr2d$(EXEEXT)
	node '$(srcdir)/npm/tests/check-npm.mjs' 'hr2d-$(VERSION).tgz' tools/hr2d$(EXEEXT) '$(srcdir)'

clean-npm:
	rm -rf npm/package npm/cache 'hr2d-$(VERSION).tgz'
mostlyclean-local: clean-npm
.PHONY: npm check-npm clean-npm
