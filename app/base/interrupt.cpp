#include "app/base/interrupt.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <string>

#include "mesh/base/errors.h"

namespace drape::app {
namespace {

volatile std::sig_atomic_t asked_to_end = 0;

// The step under way is finished first; who asks a third time does not want to wait. (Twice is not enough:
// `timeout` and some shells send the same signal to the process and to its group.)
void on_interrupt(int signal) {
  asked_to_end = asked_to_end + 1;
  if (asked_to_end >= 3) {
    std::signal(signal, SIG_DFL);
    std::raise(signal);
  }
}

}  // namespace

void catch_interrupts() {
  struct sigaction action = {};
  action.sa_handler = on_interrupt;
  action.sa_flags = SA_RESTART;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  struct sigaction before = {};
  sigaction(SIGHUP, nullptr, &before);
  if (before.sa_handler != SIG_IGN) sigaction(SIGHUP, &action, nullptr);  // nohup has it ignored
}

bool interrupted() { return asked_to_end != 0; }

void end_if_interrupted() {
  if (interrupted()) throw Interrupted();
}

void open_closed_streams() {
  for (int stream = STDIN_FILENO; stream <= STDERR_FILENO; ++stream)
    if (fcntl(stream, F_GETFD) == -1 && errno == EBADF) {
      // The lowest number that is free, which is this one. A program without a null device goes on without.
      [[maybe_unused]] const int opened = open("/dev/null", O_RDWR);
    }
}

void ignore_broken_outputs() {
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
}

void check_printed() {
  if (std::fflush(stdout) != 0 && errno != EPIPE && errno != EBADF)
    throw InputError(std::string("what was printed could not be written: ") + std::strerror(errno));
}

}  // namespace drape::app
