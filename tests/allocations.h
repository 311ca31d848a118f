// Counts the heap allocations of this process, whoever asks (new, malloc, Eigen), and lets one fail. Not
// under the sanitizers, which bring their own.
#pragma once

namespace drape::test {
bool counts_allocations();
long allocations();
// This thread's next allocation but so many fails, once; -1: none does. True when the last one asked for did.
bool fail_allocation(long after);
}  // namespace drape::test
