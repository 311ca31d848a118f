#include "tests/allocations.h"

#include <atomic>
#include <cstddef>
#include <utility>

#if defined(__SANITIZE_ADDRESS__) || !defined(__GLIBC__)
namespace drape::test {
bool counts_allocations() { return false; }
long allocations() { return 0; }
bool fail_allocation(long) { return false; }
}  // namespace drape::test
#else
namespace {
std::atomic<long> count{0};
thread_local long until_failure = -1;
thread_local bool failed = false;

bool fails() {
  ++count;
  if (until_failure < 0 || until_failure-- > 0) return false;
  return failed = true;
}
}  // namespace

extern "C" {
// NOLINTBEGIN(bugprone-reserved-identifier): glibc has given them these names.
void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);
// NOLINTEND(bugprone-reserved-identifier)

void* malloc(std::size_t size) { return fails() ? nullptr : __libc_malloc(size); }
void* calloc(std::size_t n, std::size_t size) { return fails() ? nullptr : __libc_calloc(n, size); }
void* realloc(void* p, std::size_t size) { return fails() ? nullptr : __libc_realloc(p, size); }
void* aligned_alloc(std::size_t alignment, std::size_t size) {
  return fails() ? nullptr : __libc_memalign(alignment, size);
}
}

namespace drape::test {
bool counts_allocations() { return true; }
long allocations() { return count; }
bool fail_allocation(long after) {
  until_failure = after;
  return std::exchange(failed, false);
}
}  // namespace drape::test
#endif
