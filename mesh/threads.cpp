#include "mesh/threads.h"

#include <omp.h>

#include <atomic>

#include "mesh/obj.h"

namespace drape {
namespace {
std::atomic<int> chosen{0};
}

int threads() {
  const int count = chosen.load(std::memory_order_relaxed);
  return count > 0 ? count : omp_get_num_procs();
}

void set_threads(int count) {
  if (count < 1) throw InputError("threads: " + std::to_string(count) + " is not a number of threads; give 1 or more");
  chosen = count;
}

}  // namespace drape
