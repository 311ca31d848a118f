#include "app/base/interrupt.h"
#include "app/commands/command_line.h"

int main(int argc, char** argv) {
  drape::app::open_closed_streams();
  drape::app::ignore_broken_outputs();
  return drape::app::command_line(argc, argv);
}
