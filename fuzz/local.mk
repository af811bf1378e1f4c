# Harnesses that take any bytes.  `make check` replays them on their corpus; with
# --enable-fuzzers `make fuzz` runs them to find new inputs.
check_LTLIBRARIES += fuzz/libfuzz.la
fuzz_pair_cppflags = $(AM_CPPFLAGS) -I$(srcdir)/tools
fuzz_libfuzz_la_CPPFLAGS = -D_POSIX_C_SOURCE=200809L $(fuzz_pair_cppflags)
fuzz_libfuzz_la_SOURCES = \
	fuzz/api.h \
	fuzz/api-bytes.c \
	fuzz/api-misuse.c \
	fuzz/api-others.c \
	fuzz/api-refine.c \
	fuzz/api-solve.c \
	fuzz/callbacks.c \
	fuzz/fuzz.h \
	fuzz/input.c \
	fuzz/invariants.c \
	fuzz/memory.c \
	fuzz/scenes.c \
	fuzz/stream.c \
	tools/cli/numbers.c tools/cli/numbers.h \
	tools/pair/line.c tools/pair/line.h
fuzz_libs = fuzz/libfuzz.la libhr2d-core.la $(JANSSON_LIBS) $(THREADS_LIBS)

REPLAYS = fuzz/replay-scene fuzz/replay-state fuzz/replay-api fuzz/replay-pair
check_PROGRAMS += $(REPLAYS)
TESTS += $(REPLAYS)
fuzz_replay_scene_SOURCES = fuzz/fuzz-scene.c fuzz/replay.c
fuzz_replay_scene_LDADD = $(fuzz_libs)
fuzz_replay_state_SOURCES = fuzz/fuzz-state.c fuzz/replay.c
fuzz_replay_state_LDADD = $(fuzz_libs)
fuzz_replay_api_SOURCES = fuzz/fuzz-api.c fuzz/replay.c
fuzz_replay_api_LDADD = $(fuzz_libs)
fuzz_replay_pair_SOURCES = fuzz/fuzz-pair.c fuzz/replay.c
fuzz_replay_pair_CPPFLAGS = $(fuzz_pair_cppflags)
fuzz_replay_pair_LDADD = $(fuzz_libs)

# What has main(): libFuzzer, or another engine in the variable, as packaging/oss-fuzz/ has it.
FUZZING_ENGINE = -fsanitize=fuzzer
FUZZERS = fuzz/fuzz-scene fuzz/fuzz-state fuzz/fuzz-api fuzz/fuzz-pair
EXTRA_PROGRAMS += $(FUZZERS)
CLEANFILES += $(FUZZERS)
fuzz_fuzz_scene_SOURCES = fuzz/fuzz-scene.c
fuzz_fuzz_scene_LDADD = $(fuzz_libs)
fuzz_fuzz_scene_LDFLAGS = $(FUZZING_ENGINE)
fuzz_fuzz_state_SOURCES = fuzz/fuzz-state.c
fuzz_fuzz_state_LDADD = $(fuzz_libs)
fuzz_fuzz_state_LDFLAGS = $(FUZZING_ENGINE)
fuzz_fuzz_api_SOURCES = fuzz/fuzz-api.c
fuzz_fuzz_api_LDADD = $(fuzz_libs)
fuzz_fuzz_api_LDFLAGS = $(FUZZING_ENGINE)
fuzz_fuzz_pair_SOURCES = fuzz/fuzz-pair.c
fuzz_fuzz_pair_CPPFLAGS = $(fuzz_pair_cppflags)
fuzz_fuzz_pair_LDADD = $(fuzz_libs)
fuzz_fuzz_pair_LDFLAGS = $(FUZZING_ENGINE)

FUZZ_SECONDS = 60
if ENABLE_FUZZERS
fuzz: $(FUZZERS)
	$(SHELL) $(srcdir)/fuzz/run.sh $(FUZZ_SECONDS) $(srcdir)/fuzz
else
fuzz:
	@echo "make fuzz needs ./configure CC=clang --enable-fuzzers" >&2; exit 1
endif
.PHONY: fuzz

EXTRA_DIST += fuzz/corpus fuzz/pair.dict fuzz/run.sh fuzz/scene.dict
