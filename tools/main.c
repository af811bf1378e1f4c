/* SPDX-License-Identifier: GPL-3.0-or-later */
/* hr2d runs one command; the exit status is its result. */
#include <fcntl.h>
#include <gsl/gsl_errno.h>
#include <signal.h>
#include <unistd.h>

#include "cli/commands.h"
#include "cli/help.h"
#include "output/complain.h"
#include "output/output.h"

/* If a standard stream is closed, the next file that is opened would take its number.  A stream
   that is opened in the wrong mode makes every use fail, as a closed one does. */
static void occupy_standard_streams(void) {
  for (int fd = 0; fd < 3; fd++)
    if (fcntl(fd, F_GETFD) < 0) open("/dev/null", fd == 0 ? O_WRONLY : O_RDONLY);
}

static int run(const options *o) {
  if (o->version) {
    help_print_version();
    return EXIT_DONE;
  }
  if (o->help) {
    help_print(o->command);
    return EXIT_DONE;
  }
  switch (o->command) {
  case INFO:
    return info_command(o);
  case SOLVE:
    return solve_command(o);
  case STUDY:
    return study_command(o);
  case COST:
    return cost_command(o);
  case FIELD:
    return field_command(o);
  case FACTORS:
    return factors_command(o);
  case SCHEMA:
    return schema_command(o);
  default:
    return pair_command(o);
  }
}

int main(int argc, char **argv) {
  occupy_standard_streams();
  signal(SIGPIPE, SIG_IGN);    /* a closed pipe is a failed write */
  signal(SIGXFSZ, SIG_IGN);    /* so is a file that may not grow */
  gsl_set_error_handler_off(); /* the default one aborts */
  options o;
  int status = options_read(argc, argv, &o);
  if (!status) status = run(&o);
  options_release(&o);
  return output_finish(status);
}
