// Ctrl-C and SIGTERM ask a run to end after its step; a second one ends the program at once.
#pragma once

#include <exception>

namespace drape {

void catch_interrupts();
bool interrupted();

// For work that is nothing when it is not done: looked for between its frames, caught by its command.
struct Interrupted : std::exception {
  const char* what() const noexcept override { return "interrupted"; }
};
void end_if_interrupted();  // throws Interrupted

void ignore_broken_outputs();  // SIGPIPE and SIGXFSZ: a write that fails says so instead

}  // namespace drape
