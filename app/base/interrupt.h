// Ctrl-C, SIGTERM and the end of the terminal (SIGHUP, where nohup does not have it ignored) ask a run to end
// after the step that it is computing; the third such signal ends the program at once.
#pragma once

#include <exception>

namespace drape::app {

// Installs the handler of these signals.
void catch_interrupts();
// True after the first such signal.
bool interrupted();

// Thrown by work whose unfinished result is of no use. The work calls end_if_interrupted() between its
// frames, and the command catches the exception.
struct Interrupted : std::exception {
  const char* what() const noexcept override { return "interrupted"; }
};
void end_if_interrupted();  // throws Interrupted after the first such signal

// Gives the standard streams that are closed the null device. Else a file that the run opens could get the
// number of one of them, and what is printed would land in the file.
void open_closed_streams();
// Ignores SIGPIPE and SIGXFSZ, so that a write that fails reports its error instead of ending the program.
void ignore_broken_outputs();
// Throws InputError when what was printed did not arrive, as where the disk is full. Who stops reading, like
// `head`, has what they want.
void check_printed();

}  // namespace drape::app
