// The command line: reads it, runs the command, gives the exit code.
// The only door to the command line library.
#pragma once

namespace drape {

// 0 done, 1 the computation failed, 2 bad usage or input (one line on stderr), 130 interrupted.
int command_line(int argc, char** argv);

}  // namespace drape
