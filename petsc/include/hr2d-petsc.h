/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file hr2d-petsc.h
 * @brief Spreads the links and the radiosity of one scene over the ranks of an MPI
 * communicator.
 *
 * The library libhr2d-petsc stands on the public headers of libhr2d and on PETSc. Every rank
 * has the whole committed scene. The links, and the elements that carry radiosity, are shared
 * out:
 *
 *     hr2d_scene *scene = …;                     the same on every rank, committed
 *     hr2dp *p;
 *     Vec b;
 *     hr2dp_create(PETSC_COMM_WORLD, scene, NULL, &p);
 *     hr2dp_refine(p, NULL);
 *     hr2dp_vector(p, &b);
 *     hr2dp_solve(p, NULL, b, NULL, NULL);
 *     hr2dp_averages(p, b, average);             on every rank
 *     VecDestroy(&b);
 *     hr2dp_destroy(&p);
 *
 * **Same bits.** No bit of B depends on the number of ranks. Sums over links and over leaves
 * are exact, or are rounded in a way that does not depend on their order. Counts of a
 * refinement are those of one process; of a further refinement (multigridding) all but the
 * visibility tests. B differs from that of hr2d_solve() by roundings.
 *
 * **Two ways.** An hr2dp shares out links and elements. Its elements carry one constant (order
 * 1), as where links are many for each element; oracles that read the brightness of a former
 * solution get emission alone, and cannot be refined further. hr2dp_share_create() shares out
 * links and their blocks alone, for hr2d_solve_to(), for orders above 1, and where the solution
 * is wanted whole:
 *
 *     hr2d_share *share;
 *     hr2d_target target = HR2D_TARGET_INIT;
 *     hr2dp_share_create(PETSC_COMM_WORLD, &share);
 *     target.share = share;
 *     hr2d_solve_to(scene, &target, &solution, &account);   on every rank
 *     …
 *     hr2d_solution_destroy(solution);
 *     hr2dp_share_destroy(&share);
 *
 * **Errors.** Each function returns a PetscErrorCode, which is 0 for success. All ranks return
 * the same code: a failure on one rank is agreed upon before any rank waits for it. A failure
 * of libhr2d or of an allocation raises PETSC_ERR_LIB with the message of hr2dp_message();
 * hr2dp_status() has its kind. The handler of PETSc decides about printing; see
 * PetscPushErrorHandler().
 *
 * **Calls.** All functions are collective unless they say otherwise: all ranks call them, in
 * the same order and with the same arguments. An hr2dp may be used by one thread at a time.
 */
#ifndef HR2D_PETSC_H
#define HR2D_PETSC_H

#include <hr2d/hr2d.h>
#include <petscmat.h>
#include <petscvec.h>
#include <petscviewer.h>

/** Marks an exported function. */
#if defined HR2DP_BUILDING && defined __GNUC__
#define HR2DP_API __attribute__((visibility("default")))
#else
#define HR2DP_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

/** The part of a scene's links and elements that one rank has; opaque. */
typedef struct hr2dp hr2dp;

/** How links are chosen. Start from #HR2DP_OPTIONS_INIT. */
typedef struct hr2dp_options {
  size_t struct_size;          /**< so that the options can grow */
  const hr2d_oracle *oracle;   /**< NULL for hr2d_oracle_size(); the table is copied */
  void *oracle_ctx;            /**< of this rank; stays the caller's, `destroy` is not called */
  const hr2d_policy *policy;   /**< NULL for hr2d_policy_original(); the table is copied */
  void *policy_ctx;            /**< of this rank; stays the caller's, `destroy` is not called */
  unsigned order;              /**< 0 or 1: one constant per element. More is refused with
                                    HR2D_EUNSUPPORTED */
  const hr2d_allocator *alloc; /**< of this library's own arrays; NULL for malloc() */
} hr2dp_options;

/** The defaults: the oracle `size`, the policy `original`, order 1, malloc(). */
#define HR2DP_OPTIONS_INIT                                                                     \
  { sizeof(hr2dp_options), NULL, NULL, NULL, NULL, 0, NULL }

/** The result of a refinement. All ranks get the same numbers but those called `own`. */
typedef struct hr2dp_counts {
  size_t struct_size;       /**< so that the counts can grow */
  hr2d_refine_counts whole; /**< as hr2d_refine() counts on one process, exactly */
  uint64_t
      repeated_calls;        /**< oracle calls that two ranks or more made for one pair; not in
                                  `whole`. Some hundred at most, and none where patches are many */
  uint64_t max_links;        /**< links of the rank that has most */
  uint64_t max_tests;        /**< the same of visibility tests */
  uint64_t max_elements;     /**< the same of elements whose radiosity it keeps */
  uint64_t own_links;        /**< links of this rank */
  uint64_t own_tests;        /**< visibility tests of this rank */
  uint64_t own_elements;     /**< elements whose radiosity this rank keeps */
  uint64_t own_leaves;       /**< those of them without children: its entries of a vector */
  uint64_t touched_elements; /**< elements in the trees of this rank, of others, too */
  uint64_t halo_elements;    /**< elements of others that links of this rank need */
  uint64_t own_bytes;        /**< of this rank's links, elements and fields */
} hr2dp_counts;

/** The work of a solve. Start from #HR2DP_REPORT_INIT; all ranks get the same. */
typedef struct hr2dp_report {
  size_t struct_size;  /**< so that the report can grow */
  uint64_t sweeps;     /**< gathers over all links */
  uint64_t iterations; /**< of the Krylov method */
  uint64_t row_sums;   /**< leaves whose exchange with all patches was summed */
  double residual;     /**< ‖E + ρKB − B‖/‖B‖, the largest over the bands */
  hr2d_power *power;   /**< one per band, or NULL: receives the balance of power */
} hr2dp_report;

/** No powers are wanted. */
#define HR2DP_REPORT_INIT                                                                      \
  { sizeof(hr2dp_report), 0, 0, 0, 0, NULL }

/**
 * Shares out a scene.
 * @param comm     a communicator; it is duplicated
 * @param scene    committed, and the same on every rank, as of hr2d_scene_read() from one file
 * or of hr2d_state_read_scene(); must outlive the object
 * @param options  NULL for the defaults
 * @param p        receives the object, or NULL after a failure
 * @return PETSC_ERR_ARG_WRONGSTATE: the scene is not committed, or not the same on all ranks;
 *         PETSC_ERR_SUP: the order is not supported; PETSC_ERR_MEM: out of memory;
 *         PETSC_ERR_LIB: the scene has patches of given flux in several bands, a sun, or a sky
 *         in pieces, which hr2dp_share_create() supports
 *
 * Cost and memory O(n) on every rank.
 */
HR2DP_API PetscErrorCode hr2dp_create(MPI_Comm comm, const hr2d_scene *scene,
                                      const hr2dp_options *options, hr2dp **p);

/**
 * Destroys an object, and sets it to NULL. Destroy its operators first.
 * @param p  an object, or NULL in it
 * @return 0, or the failure of PETSc
 */
HR2DP_API PetscErrorCode hr2dp_destroy(hr2dp **p);

/**
 * The kind of the last failure. Not collective; all ranks have the same.
 * @param p  an object
 * @return a status of libhr2d; HR2D_OK if nothing failed
 */
HR2DP_API hr2d_status hr2dp_status(const hr2dp *p);

/**
 * The reason of the last failure. Not collective; all ranks have the same.
 * @param p  an object
 * @return a sentence, owned by the object; "" if nothing failed
 */
HR2DP_API const char *hr2dp_message(const hr2dp *p);

/**
 * Refines: makes the links of all ranks, or refines them further (multigridding).
 *
 * Before the first refinement, ranks count the links and tests of rows at four times the ε,
 * and share out the rows so that links and tests of visibility are even. Rows are of patches;
 * where patches are few and nothing stands in the way, they are of parts of patches.
 *
 * @param p        an object
 * @param options  as of hr2d_refine(), or NULL. `progress` asks on rank 0 alone. Of each rank
 *                 count `max_links`, `max_bytes` and `max_elements`. `row_from`, `row_to`,
 *                 `rows`, `claim` and `row_counts` are refused
 * @return 0; after a failure, PETSC_ERR_LIB, the object has no links, and the next refinement
 *         starts from nothing
 *
 * Cost: that of hr2d_refine() divided by the ranks, and O(n) on each.
 */
HR2DP_API PetscErrorCode hr2dp_refine(hr2dp *p, const hr2d_refine_options *options);

/**
 * The result of the refinements. Not collective.
 * @param p       an object
 * @param counts  with `struct_size` set; receives the counts, 0 before the first refinement
 * @return PETSC_ERR_ARG_SIZ: `struct_size` is too small
 */
HR2DP_API PetscErrorCode hr2dp_get_counts(const hr2dp *p, hr2dp_counts *counts);

/**
 * Makes a vector for a field on leaves: the leaves of all patches in the order of patches and
 * of positions on them, with one entry for each band. This order does not depend on the number
 * of ranks.
 * @param p  refined
 * @param v  receives a vector of zeros; the caller destroys it
 * @return PETSC_ERR_ARG_WRONGSTATE: there was no refinement
 *
 * After a further refinement there are more leaves: old vectors have no meaning then.
 */
HR2DP_API PetscErrorCode hr2dp_vector(hr2dp *p, Vec *v);

/**
 * The transport operator H = K B on leaves as a MATSHELL, for user-written Krylov methods. K
 * is self-adjoint in Σ A x y over leaves if links serve both directions.
 * @param p        refined; must outlive the operator, and not be refined as long as that is
 * used
 * @param options  `closure` matters, `threads` and the others do not; NULL for the defaults
 * @param k        receives the operator, with MATOP_MULT and MATOP_CREATE_VECS
 * @return PETSC_ERR_ARG_WRONGSTATE: there was no refinement
 */
HR2DP_API PetscErrorCode hr2dp_operator(hr2dp *p, const hr2d_solve_options *options, Mat *k);

/**
 * Solves for B as hr2d_solve() does.
 * @param p        refined
 * @param options  as of hr2d_solve(), or NULL; `start` is refused, `threads` does not matter.
 *                 `progress` asks on rank 0 alone
 * @param b        of hr2dp_vector(); holds the start, zeros for none, and receives B
 * @param h        of hr2dp_vector(), or NULL: receives the irradiance
 * @param report   with `struct_size` set, or NULL
 * @return 0 or PETSC_ERR_LIB with the failures of hr2d_solve()
 *
 * Cost of an iteration: the links of the rank that has most, its halo of elements, and four
 * reductions of some numbers.
 */
HR2DP_API PetscErrorCode hr2dp_solve(hr2dp *p, const hr2d_solve_options *options, Vec b, Vec h,
                                     hr2dp_report *report);

/**
 * The averages of a field over patches.
 * @param p        refined
 * @param v        of hr2dp_vector()
 * @param average  receives n × bands averages, on every rank
 * @return 0 or a failure of PETSc
 */
HR2DP_API PetscErrorCode hr2dp_averages(hr2dp *p, Vec v, double *average);

/**
 * Saves B, so that a run can go on from there on any number of ranks. Links are not saved: they
 * are made again as fast as they would be read.
 * @param p       refined
 * @param b       of hr2dp_vector()
 * @param viewer  PETSCVIEWERBINARY or PETSCVIEWERHDF5, open for writing
 * @return 0 or a failure of PETSc
 *
 * 8 bytes for each leaf and band. The bytes do not depend on the number of ranks.
 */
HR2DP_API PetscErrorCode hr2dp_save(hr2dp *p, Vec b, PetscViewer viewer);

/**
 * Loads a state of hr2dp_save(): refines to the ε of the state, and gives its B.
 * @param p        without links; of the scene, the oracle and the policy of the state
 * @param options  as for the refinements that led to the state, or NULL; `epsilon` does not
 *                 matter
 * @param viewer   of the same kind, open for reading
 * @param b        receives B, to start the next hr2dp_solve() with; the caller destroys it
 * @param epsilon  receives the ε of the state; may be NULL
 * @return 0; PETSC_ERR_LIB with HR2D_EINVAL for another scene, oracle, policy or other options,
 *         HR2D_ESYNTAX for a damaged state, or a failure of hr2dp_refine(); or a failure of
 * PETSc
 *
 * A sum of hashes detects damage of B.
 */
HR2DP_API PetscErrorCode hr2dp_load(hr2dp *p, const hr2d_refine_options *options,
                                    PetscViewer viewer, Vec *b, double *epsilon);

/**
 * Saves B of a solution that was solved with shares, as hr2dp_save() does: without links, and
 * with the same bytes on any number of ranks. At order 1 hr2dp_load() and
 * hr2dp_load_solution() each load the states of both.
 * @param solution  of hr2d_solve() or hr2d_solution_adopt(), the same on all ranks; its
 *                  hierarchy was not refined since
 * @param viewer    PETSCVIEWERBINARY or PETSCVIEWERHDF5, open for writing, on the communicator
 *                  of the shares
 * @return 0; PETSC_ERR_MEM; PETSC_ERR_LIB if the scene cannot be written, see
 *         hr2d_state_write_scene(); or a failure of PETSc
 *
 * 8 bytes for each leaf, coefficient and band.
 */
HR2DP_API PetscErrorCode hr2dp_save_solution(const hr2d_solution *solution, PetscViewer viewer);

/**
 * Loads a state of hr2dp_save_solution(): refines to the ε of the state, and adopts its B.
 * @param links       of the scene, the oracle, the policy and the order of the state. Where the
 *                    oracle needs the brightness of former stages, they are loaded in their
 *                    order into the same set
 * @param refinement  as for the refinement that led to the state, with `share` and, if it had
 *                    it, `brightness`; `epsilon` does not matter
 * @param options     as of hr2d_solution_adopt(), or NULL
 * @param viewer      of the same kind, open for reading, on the communicator of the shares
 * @param solution    receives the solution, whole on each rank; the caller destroys it
 * @return 0; PETSC_ERR_ARG_INCOMP for another scene or method, or other options;
 *         PETSC_ERR_FILE_UNEXPECTED for a damaged state; PETSC_ERR_LIB with the message of the
 *         links after a failure of hr2d_refine() or hr2d_solution_adopt(); PETSC_ERR_MEM; or a
 *         failure of PETSc
 *
 * After a failure the links may be refined.
 */
HR2DP_API PetscErrorCode hr2dp_load_solution(hr2d_linkset *links,
                                             const hr2d_refine_options *refinement,
                                             const hr2d_solve_options *options,
                                             PetscViewer viewer, hr2d_solution **solution);

/**
 * Makes a share of the solves of libhr2d for each rank, see share.h of libhr2d: the argument of
 * hr2d_target::share and hr2d_refine_options::share.
 * @param comm   a communicator; it is duplicated
 * @param share  receives the share of this rank, number 0 on rank 0
 * @return 0 or a failure of PETSc
 *
 * A time budget is that of the clock of rank 0. An MPI failure is fatal.
 */
HR2DP_API PetscErrorCode hr2dp_share_create(MPI_Comm comm, hr2d_share **share);

/**
 * Destroys a share, and sets it to NULL. Destroy the links and solutions made with it first.
 * @param share  a share, or NULL in it
 * @return 0 or a failure of PETSc
 */
HR2DP_API PetscErrorCode hr2dp_share_destroy(hr2d_share **share);

#ifdef __cplusplus
}
#endif
#endif
