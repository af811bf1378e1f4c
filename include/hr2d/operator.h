/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file operator.h
 * @brief The transport operator of a scene, kept: other light, responses and gradients.
 *
 * @defgroup operator Operator: other light on the same geometry
 * The transport operator of a scene, kept: other light, responses and gradients.
 *
 * hr2d_solve_to() finds elements, links and their coefficients, and all that takes most of the
 * time. None of it depends on emission, and little on reflectance. An operator keeps it. Then
 * other emissions, reflectances, temperatures, and other light from outside take some gathers:
 *
 *     hr2d_operator *op;
 *     hr2d_status status = hr2d_operator_create(scene, NULL, &op, NULL);
 *     hr2d_light light = HR2D_LIGHT_INIT;
 *     light.emission.value = emission;
 *     hr2d_solution *solution = NULL;
 *     if (!status) status = hr2d_operator_solve(op, &light, NULL, &solution, NULL);
 *     hr2d_solution_destroy(solution);
 *     hr2d_operator_destroy(op);
 *
 * **Elements** end at the visibility events that may matter for light of the same largest
 * radiosity, and are divided for the light that the scene has. Other light may want them
 * divided elsewhere: the account of each solve measures the errors of that light on these
 * elements, and says if they are above the target. So let the scene have light, or several
 * bands of light, like what will come.
 *
 * **Threads.** One thread at a time may use an operator; its solutions may be read by other
 * ones at the same time.
 * @{
 */
#ifndef HR2D_OPERATOR_H
#define HR2D_OPERATOR_H

#include <hr2d/accuracy.h>
#include <hr2d/scene.h>
#include <hr2d/solve.h>
#include <hr2d/status.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/** The kept operator; opaque. */
typedef struct hr2d_operator hr2d_operator;

/** An array of up to three indices: of lights, of patches or pieces of the sky, and of bands.
 */
typedef struct hr2d_values {
  const double *value; /**< NULL: all values are those of the scene */
  ptrdiff_t stride[3]; /**< from one light, patch or piece, and band to the next, in doubles; 0
                            repeats a value. All three 0: packed, lights × patches × bands */
} hr2d_values;

/** One light or several. Start from #HR2D_LIGHT_INIT: that of the scene. */
typedef struct hr2d_light {
  size_t struct_size;      /**< so that the struct can grow */
  size_t count;            /**< k, lights that are solved for at once; 0 stands for 1 */
  hr2d_values emission;    /**< k × patches × bands: E, at least 0. NaN, and nothing else, for
                                patches of given temperature or flux */
  hr2d_values reflectance; /**< k × patches × bands: ρ, from 0 to 1; of patches of given
                                temperature it is 1 − ε. NaN, and nothing else, for patches of
                                given flux */
  hr2d_values temperature; /**< k × patches: kelvins of patches of given temperature. NaN, and
                                nothing else, for all others. An emissivity that depends on the
                                temperature stays as it is in the scene */
  hr2d_values flux; /**< k × patches: net fluxes of patches of given flux. NaN, and nothing
                         else, for all others */
  hr2d_values background; /**< k × 1 × bands: radiosity of the surroundings; above 0 only if the
                               scene has an even background, or is forced to look for one */
  hr2d_values sun; /**< k × 1 × bands: irradiance of the suns, whose directions stay; above 0
                        only in bands in which the sun of the scene shines */
  hr2d_values sky; /**< k × pieces × bands: radiosity of the pieces of the sky. This and
                        `background` can be changed if the sky of the scene jumps at all edges
                        of pieces, where elements end; and not under mirrors */
  int no_error;    /**< not 0: the account is left out; its errors are infinite */
} hr2d_light;

/** The light of the scene. */
#define HR2D_LIGHT_INIT                                                                        \
  {                                                                                            \
    sizeof(hr2d_light), 0, {NULL, {0, 0, 0}}, {NULL, {0, 0, 0}}, {NULL, {0, 0, 0}},            \
        {NULL, {0, 0, 0}}, {NULL, {0, 0, 0}}, {NULL, {0, 0, 0}}, {NULL, {0, 0, 0}}, 0          \
  }

/**
 * Does what #HR2D_LIGHT_INIT does, for languages without macros: sets all bytes to 0, and
 * `struct_size`.
 * @param light  the struct
 * @param size   its size as the caller knows it; may differ from that of the library
 */
HR2D_API void hr2d_light_init(hr2d_light *light, size_t size);

/**
 * Makes the operator of a scene, for a target error of its own light.
 *
 * @param scene    committed; must outlive the operator and its solutions
 * @param target   NULL for the defaults. `error`, `norm`, `floor` and `important` hold for all
 *                 solves, so do `threads` and `progress`; budgets are for this call. `share`
 *                 is NULL, or one alone
 * @param op       receives the operator, also with HR2D_EACCURACY if there are elements of
 *                 known error, otherwise NULL; the caller destroys it
 * @param account  receives the errors and the work for the light of the scene; infinite errors
 *                 without an operator; may be NULL
 * @retval HR2D_EUNSUPPORTED  temperatures of patches of given flux would have to be found in
 *                            several bands; or there are several shares
 * @retval other              as hr2d_solve_to()
 *
 * Cost: that of hr2d_solve_to(), and up to twice the time for row sums. Memory: that of the
 * account's blocks, (p + 2)² numbers for each link.
 */
HR2D_API hr2d_status hr2d_operator_create(const hr2d_scene *scene, const hr2d_target *target,
                                          hr2d_operator **op, hr2d_account *account);

/** Frees an operator; NULL is allowed. Its solutions stay. */
HR2D_API void hr2d_operator_destroy(hr2d_operator *op);

/** What the last call on an operator that failed has to say; "" if none has. Owned by it. */
HR2D_API const char *hr2d_operator_message(const hr2d_operator *op);

/**
 * Solves for other light.
 *
 * @param op        the operator
 * @param light     NULL for the light of the scene. Only read, and only during the call
 * @param start     a solution of this operator with as many lights, for light that is like this
 *                  one: fewer gathers are needed then. NULL for none
 * @param solution  receives the solution, otherwise NULL; the caller destroys it, before or
 *                  after the operator. Band b of light m is its band m · bands + b. Its
 *                  emission and reflectance are those of `light`
 * @param account   receives its errors, the largest over all lights, and the work; may be NULL
 * @retval HR2D_OK           the target is reached, or there is no account
 * @retval HR2D_EACCURACY    the elements do not suffice for this light, see
 *                           hr2d_account::reason. The solution and its errors are good; for
 *                           smaller ones make an operator of a scene with such light
 * @retval HR2D_EINVAL       a value is not valid; see hr2d_operator_message()
 * @retval HR2D_ESTATE       the call comes from a callback of a call on this operator
 * @retval other             as hr2d_solve()
 *
 * On failure `account` is unchanged. The errors are those on these elements, as for
 * hr2d_solve_to(). Cost: O(L) for each of a dozen gathers, and as many with two coefficients
 * more for the account. Where the number of lights or the suns change, light from outside is
 * made anew.
 */
HR2D_API hr2d_status hr2d_operator_solve(hr2d_operator *op, const hr2d_light *light,
                                         const hr2d_solution *start, hr2d_solution **solution,
                                         hr2d_account *account);

/**
 * The responses of averages of B to emissions: ∂B_i/∂E_j.
 *
 * @param op        the operator
 * @param light     whose reflectances count; its `count` is at most 1. NULL: those of the scene
 * @param first     the first column j
 * @param columns   how many
 * @param response  receives patches × columns × bands numbers
 * @return as hr2d_operator_solve(), or HR2D_EINVAL for columns that there are not
 *
 * Cost: that of as many solves, several at once.
 */
HR2D_API hr2d_status hr2d_operator_response(hr2d_operator *op, const hr2d_light *light,
                                            size_t first, size_t columns, double *response);

/** Derivatives of a functional. Members may be NULL. */
typedef struct hr2d_gradient {
  size_t struct_size;  /**< so that the struct can grow */
  double *emission;    /**< receives patches × bands: by E of a patch */
  double *reflectance; /**< receives patches × bands: by ρ of a patch; of patches of given
                            temperature E = (1 − ρ)σT⁴ changes, too; NaN for those of given
                            flux */
  double *temperature; /**< receives patches: by T of a patch of given temperature; NaN for all
                            others */
} hr2d_gradient;

/** Nothing is asked for. */
#define HR2D_GRADIENT_INIT                                                                     \
  { sizeof(hr2d_gradient), NULL, NULL, NULL }

/**
 * Does what #HR2D_GRADIENT_INIT does, for languages without macros.
 * @param gradient  the struct
 * @param size      its size as the caller knows it; may differ from that of the library
 */
HR2D_API void hr2d_gradient_init(hr2d_gradient *gradient, size_t size);

/**
 * The gradient of J = Σ v_kb B_kb + Σ w_kb H_kb, with averages B and H of patches, with respect
 * to all emissions, reflectances and temperatures.
 *
 * K is self-adjoint. So with X = (ρv + w)/A + ρKX and u = v/A + KX, δJ = ∫u(δE + Hδρ).
 * @param op        the operator
 * @param solution  of one light, of this operator
 * @param v         1 × patches × bands: weights of B; its value may be NULL: 0
 * @param w         likewise of H
 * @param gradient  its arrays receive the derivatives
 * @return as hr2d_solve(), or HR2D_EINVAL; HR2D_ENO_SOLUTION where light that is sent anywhere
 *         would have no solution
 *
 * The derivatives are those of the numbers that hr2d_operator_solve() gives on these elements,
 * to the tolerance of the iteration. Cost: one solve without an account, for all of them.
 */
HR2D_API hr2d_status hr2d_operator_gradient(hr2d_operator *op, const hr2d_solution *solution,
                                            const hr2d_values *v, const hr2d_values *w,
                                            hr2d_gradient *gradient);

#ifdef __cplusplus
}
#endif
/** @} */
#endif
