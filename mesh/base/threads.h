// How many threads the library may use. No result depends on the number.
#pragma once

namespace drape {

inline constexpr int most_threads = 1024;

int threads();                // at least 1; the number of processors until set_threads is called
void set_threads(int count);  // throws InputError when count < 1 or count > most_threads

// Calls f(context, k) once for every k = 0 .. count-1, in any order and on any thread, and returns when all
// calls are done. If a call throws, the first exception is passed on to the caller after all calls are done.
void run_in_parallel(int count, void (*f)(const void* context, int k), const void* context);

}  // namespace drape
