// How many threads the solver may use. The result does not depend on it.
#pragma once

namespace drape {

inline constexpr int most_threads = 1024;

int threads();                // at least 1; starts as the number of processors
void set_threads(int count);  // throws InputError when count < 1 or above the most

// f(context, k) for k = 0 .. count-1, each once, in any order and by any thread; returns when all are done.
// What f throws goes to the caller then.
void run_in_parallel(int count, void (*f)(const void* context, int k), const void* context);

}  // namespace drape
