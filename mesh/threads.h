// How many threads the solver may use. The result does not depend on it.
#pragma once

namespace drape {

int threads();              // at least 1; starts as the number of processors
void set_threads(int count);  // throws InputError when count < 1

}  // namespace drape
