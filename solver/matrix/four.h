// Four doubles or four floats at a time, read from anywhere and written anywhere.
#pragma once

#ifdef __AVX__
#include <immintrin.h>
#else
#include <cmath>
#endif

namespace drape::internal {

typedef double Four __attribute__((vector_size(32), aligned(8)));
typedef float FourFloats __attribute__((vector_size(16), aligned(4)));
inline Four load(const double* p) { return *reinterpret_cast<const Four*>(p); }
inline Four load(const float* p) {
#ifdef __AVX__
  return _mm256_cvtps_pd(_mm_loadu_ps(p));  // GCC would split the conversion below into two halves
#else
  return __builtin_convertvector(*reinterpret_cast<const FourFloats*>(p), Four);
#endif
}
inline Four root(const Four& v) {
#ifdef __AVX__
  return _mm256_sqrt_pd(v);
#else
  return Four{std::sqrt(v[0]), std::sqrt(v[1]), std::sqrt(v[2]), std::sqrt(v[3])};
#endif
}
inline FourFloats narrow(const Four& v) { return __builtin_convertvector(v, FourFloats); }
inline FourFloats floats(const float* p) { return *reinterpret_cast<const FourFloats*>(p); }
inline FourFloats floats(const double* p) { return narrow(load(p)); }
inline void store(const FourFloats& v, float* p) { *reinterpret_cast<FourFloats*>(p) = v; }

}  // namespace drape::internal
