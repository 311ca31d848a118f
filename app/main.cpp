#include "app/command_line.h"
#include "app/interrupt.h"

int main(int argc, char** argv) {
  drape::ignore_broken_outputs();
  return drape::command_line(argc, argv);
}
