/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file options.h
 * @brief The common rules of all structs of options, and the constants of the headers by name.
 *
 * @defgroup options Options
 * The common rules of all structs of options, and the constants of the headers by name.
 *
 * A struct of options begins with `struct_size`. In every other member 0 or NULL means the
 * default: a struct of zeros with its size asks for the same as no struct at all. Where a user
 * may want more than the default, or the number 0 itself, a named constant asks for it, for
 * instance #HR2D_ALL_THREADS.
 *
 * In C and C++ a struct starts from its macro …_INIT, or in C from
 * `{.struct_size = sizeof options}`. Other languages call the function hr2d_…_init(). All three
 * give the same. A `struct_size` below the size of this member gives HR2D_EINVAL.
 * @{
 */
#ifndef HR2D_OPTIONS_H
#define HR2D_OPTIONS_H

#include <hr2d/status.h>

#ifdef __cplusplus
extern "C" {
#endif

/** As `threads` in any options: one thread for each processor. The default is one thread. */
#define HR2D_ALL_THREADS ((unsigned)-1)

/**
 * The value of a constant, for languages that cannot read the headers.
 * @param name   of a macro with a number, or of a member of an enumeration, for example
 *               "HR2D_FLOOR" or "HR2D_EINVAL"
 * @param value  receives the value that the library was compiled with; exact for all constants;
 *               unchanged on failure
 * @retval HR2D_OK      success
 * @retval HR2D_EINVAL  no constant has this name
 *
 * Thread-safe. Cost linear in the number of constants.
 */
HR2D_API hr2d_status hr2d_constant(const char *name, double *value);

#ifdef __cplusplus
}
#endif
/** @} */
#endif
