# SPDX-License-Identifier: GPL-3.0-or-later
# HR2D_HARDEN appends to HR2D_CFLAGS and sets HR2D_LDFLAGS so that a fault in memory ends the
# program rather than obeys a stranger's file.  HR2D_HARDENING is the list of what the tools have;
# hr2d_hardening says it in words.  Comes after the choice of sanitizers, fuzzers and coverage, which
# look for the same faults, or count lines, and are not mixed with it.
AC_DEFUN([HR2D_HARDEN], [
AC_ARG_ENABLE([hardening],
  [AS_HELP_STRING([--disable-hardening],
    [leave out stack protectors, checked copies and read-only relocations])],
  [], [enable_hardening=yes])
HR2D_HARDENING= HR2D_LDFLAGS= hr2d_hardening=
AS_IF([test "x$enable_hardening" = xno], [hr2d_hardening=no],
  [test "x$enable_sanitizers$enable_fuzzers$enable_coverage" != xnonono],
  [hr2d_hardening="no: sanitizers, fuzzers or coverage"])
AS_IF([test -z "$hr2d_hardening"],
  [for hr2d_flag in -fstack-protector-strong -fstack-clash-protection -fcf-protection; do
     # gcc for Windows ends with an internal error in functions with long frames.
     AS_CASE([$host_os,$hr2d_flag], [mingw*,-fstack-clash-protection], [continue])
     AX_CHECK_LINK_FLAG([$hr2d_flag],
       [AS_VAR_APPEND([HR2D_HARDENING], [" $hr2d_flag"])], [], [-Werror])
   done
   # Before a level that somebody has defined already, of 0 too, and without optimisation there is
   # nothing to add.  Headers warn of a level that they or the compiler do not have.
   for hr2d_level in 3 2; do
     AC_MSG_CHECKING([for checked copies of level $hr2d_level])
     hr2d_cflags=$CFLAGS
     hr2d_checked=no
     CFLAGS="$CFLAGS $HR2D_CFLAGS -Werror -DHR2D_LEVEL=$hr2d_level"
     AC_LINK_IFELSE([AC_LANG_SOURCE([[
#if defined _FORTIFY_SOURCE || !defined __OPTIMIZE__
#error nothing to add
#endif
#define _FORTIFY_SOURCE HR2D_LEVEL
#include <stdio.h>
#include <string.h>
int main(int argc, char **argv) {
  char text[8];
  memset(text, 0, sizeof text);
  return snprintf(text, sizeof text, "%d %p", argc, (void *)argv) < 0;
}
]])],
       [hr2d_checked=yes])
     CFLAGS=$hr2d_cflags
     AC_MSG_RESULT([$hr2d_checked])
     AS_IF([test $hr2d_checked = yes],
       [AS_VAR_APPEND([HR2D_HARDENING], [" -D_FORTIFY_SOURCE=$hr2d_level"])
        break])
   done
   AS_VAR_APPEND([HR2D_CFLAGS], ["$HR2D_HARDENING"])
   for hr2d_flag in -Wl,-z,relro -Wl,-z,now -Wl,-z,noexecstack; do
     AX_CHECK_LINK_FLAG([$hr2d_flag],
       [AS_VAR_APPEND([HR2D_LDFLAGS], [" $hr2d_flag"])], [], [-Werror])
   done
   AS_VAR_APPEND([HR2D_HARDENING], ["$HR2D_LDFLAGS"])
   hr2d_hardening="${HR2D_HARDENING:-no: the tools have none}"
   hr2d_hardening=${hr2d_hardening# }])
AC_SUBST([HR2D_HARDENING])
AC_SUBST([HR2D_LDFLAGS])
])
