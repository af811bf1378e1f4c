# Tests of libhr2d-petsc on several ranks; without PETSc the scripts say so and are skipped.
# The longest come first.
PETSC_TESTS = tests/petsc/check-program.sh tests/petsc/check-failures.sh \
	tests/petsc/check-shares.sh tests/petsc/check-petsc.sh tests/petsc/check-state.sh
EXTRA_DIST += $(PETSC_TESTS) tests/petsc/ranks.sh tests/petsc/draw-many.py \
	tests/petsc/even-shares.py tests/petsc/same-averages.py tests/petsc/without-comment.py
TESTS += $(PETSC_TESTS)
if WITH_PETSC
RANKED = tests/petsc/check-rank-faults tests/petsc/check-rank-solution \
	tests/petsc/check-rank-state tests/petsc/check-ranks
check_PROGRAMS += $(RANKED)
RANKED_SCENES = tests/petsc/petsc-scenes.c tests/petsc/petsc-scenes.h \
	tests/support/symmetric-scenes.c tests/support/symmetric-scenes.h
RANKED_CPPFLAGS = $(PUBLIC_CPPFLAGS) -I$(srcdir)/petsc/include -I$(srcdir)/tests $(PETSC_CFLAGS)
RANKED_LDADD = libhr2d-petsc.la libhr2d.la $(PETSC_LIBS) $(MPI_LIBS) -lm
tests_petsc_check_ranks_SOURCES = tests/petsc/check-ranks.c $(RANKED_SCENES)
tests_petsc_check_ranks_CPPFLAGS = $(RANKED_CPPFLAGS)
tests_petsc_check_ranks_LDADD = $(RANKED_LDADD)
tests_petsc_check_rank_faults_SOURCES = tests/petsc/check-rank-faults.c $(RANKED_SCENES)
tests_petsc_check_rank_faults_CPPFLAGS = $(RANKED_CPPFLAGS)
tests_petsc_check_rank_faults_LDADD = $(RANKED_LDADD)
tests_petsc_check_rank_solution_SOURCES = tests/petsc/check-rank-solution.c \
	$(RANKED_SCENES) tests/petsc/petsc-viewer.h
tests_petsc_check_rank_solution_CPPFLAGS = $(RANKED_CPPFLAGS)
tests_petsc_check_rank_solution_LDADD = $(RANKED_LDADD)
tests_petsc_check_rank_state_SOURCES = tests/petsc/check-rank-state.c \
	$(RANKED_SCENES) tests/petsc/petsc-viewer.h
tests_petsc_check_rank_state_CPPFLAGS = $(RANKED_CPPFLAGS)
tests_petsc_check_rank_state_LDADD = $(RANKED_LDADD)

# These tests alone, without the programs of the others; two at a time, for their processes mostly
# wait.
check-petsc: $(RANKED) hr2d-mpi tools/hr2d
	@rm -f petsc-results; $(AM_TESTS_ENVIRONMENT) \
	printf '%s\n' $(PETSC_TESTS) | xargs -P 2 -n 1 $(SHELL) -c \
	  '$(SHELL) $(srcdir)/$$0; echo "$$? $$0" >>petsc-results'; \
	passed=`grep -c "^0 " petsc-results`; failed=`grep -vc "^0 " petsc-results`; \
	sed -n "/^0 /!s/^/FAIL with status /p" petsc-results; rm -f petsc-results; \
	echo "$$passed passed, $$failed failed"; test $$failed = 0
endif
.PHONY: check-petsc
