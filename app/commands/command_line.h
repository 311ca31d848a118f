// Reads the command line, runs the command and gives the exit code. The only file that includes the
// command-line library is command_line.cpp.
#pragma once

namespace drape::app {

// Exit code: 0 done, 1 the computation failed, 2 bad usage or input (one line on stderr), 130 interrupted.
int command_line(int argc, char** argv);

}  // namespace drape::app
