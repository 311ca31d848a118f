// Counts the heap allocations of this process, whoever asks (new, malloc, Eigen). Not under the sanitizers,
// which bring their own.
#pragma once

namespace drape::test {
bool counts_allocations();
long allocations();
}  // namespace drape::test
