// Ctrl-C and SIGTERM ask a run to end after its step; a second one ends the program at once.
#pragma once

namespace drape {

void catch_interrupts();
bool interrupted();

void ignore_broken_outputs();  // SIGPIPE and SIGXFSZ: a write that fails says so instead

}  // namespace drape
