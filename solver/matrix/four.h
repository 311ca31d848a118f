// Four doubles at a time, read from anywhere.
#pragma once

#ifdef __AVX__
#include <immintrin.h>
#endif

namespace drape::internal {

typedef double Four __attribute__((vector_size(32), aligned(8)));
inline Four load(const double* p) { return *reinterpret_cast<const Four*>(p); }
inline Four load(const float* p) {
#ifdef __AVX__
  return _mm256_cvtps_pd(_mm_loadu_ps(p));  // GCC would split the conversion below into two halves
#else
  typedef float FourFloats __attribute__((vector_size(16), aligned(4)));
  return __builtin_convertvector(*reinterpret_cast<const FourFloats*>(p), Four);
#endif
}

}  // namespace drape::internal
