// What the benchmarks share: medians, and sheets hung by two corners. Deterministic, no random numbers.
#pragma once

#include <algorithm>
#include <chrono>
#include <functional>
#include <vector>

#include "solver/drape.h"

namespace drape::bench {

inline double now_ms() {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

inline double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2),
                   values.end());
  return values[values.size() / 2];
}

// Median milliseconds of `repeats` calls, after one that is not counted.
inline double timed(int repeats, const std::function<void()>& f) {
  f();
  std::vector<double> ms;
  for (int k = 0; k < repeats; ++k) {
    const double start = now_ms();
    f();
    ms.push_back(now_ms() - start);
  }
  return median(ms);
}

// 1 m x 1 m, 0.2 kg/m^2, bend 10 uN.m, hung by two corners.
struct Sheet {
  TriangleMesh mesh;
  System system;
  Constraints constraints;
  State state;

  Sheet(int side, double stretch)
      : mesh(grid(side, side, 1, 1)), system(lumped_mass(mesh, 0.2)), state(at_rest(mesh)) {
    Fabric fabric;
    fabric.area_density = 0.2;
    fabric.stretch = stretch;
    fabric.bend = 1e-5;
    system.add(noh_jung(mesh, fabric));
    system.add(Gravity{});
    constraints.pin({0, side - 1});
    mesh = {};  // the solver does not need it
  }
};

}  // namespace drape::bench
