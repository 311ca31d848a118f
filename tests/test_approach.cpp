// Pairs that could meet: how near they are, and what is proven of their ways.
#include <catch2/catch.hpp>
#include <random>

#include "mesh/distance/approach.h"

using namespace drape;

namespace {

using Random = std::mt19937;

Vec3 any_point(Random& random, double size) {
  std::uniform_real_distribution<double> number(-size, size);
  const double x = number(random), y = number(random), z = number(random);
  return {x, y, z};
}

// Ordinary ones, slivers, edges that are nearly parallel, and all of them far from the origin.
FourPoints any_pair(Random& random) {
  FourPoints x;
  for (Vec3& p : x) p = any_point(random, 1);
  std::uniform_int_distribution<int> kind(0, 3);
  switch (kind(random)) {
    case 1:
      x[3] = 0.5 * (x[1] + x[2]) + any_point(random, 1e-9);
      break;
    case 2:
      x[3] = x[2] + (x[1] - x[0]) + any_point(random, 1e-7);
      break;
    default:
      break;
  }
  if (kind(random) == 0)
    for (Vec3& p : x) p += Vec3(1000, -700, 300);
  return x;
}

FourPoints between(const FourPoints& a, const FourPoints& b, double s) {
  FourPoints x;
  for (std::size_t k = 0; k < 4; ++k) x[k] = a[k] + s * (b[k] - a[k]);
  return x;
}

// The least distance of points of the two sides on a grid of weights.
double sampled(bool edges, const FourPoints& x) {
  constexpr int n = 24;
  double least = 1e300;
  for (int i = 0; i <= n; ++i)
    for (int k = 0; k <= n; ++k) {
      const double u = static_cast<double>(i) / n, v = static_cast<double>(k) / n;
      const Vec3 first = edges ? Vec3(x[0] + u * (x[1] - x[0])) : x[0];
      const Vec3 second = edges ? Vec3(x[2] + v * (x[3] - x[2]))
                                : Vec3(x[1] + (1 - v) * u * (x[2] - x[1]) + v * (x[3] - x[1]));
      least = std::min(least, (first - second).norm());
    }
  return least;
}

}  // namespace

TEST_CASE("the nearest points of a pair are nearer than any others, and their normal separates",
          "[approach]") {
  Random random(1);
  for (int k = 0; k < 4000; ++k) {
    const bool edges = k % 2 == 0;
    const FourPoints x = any_pair(random);
    const Nearest near = nearest(edges, x);
    INFO("pair " << k);
    double size = 0;
    for (const Vec3& p : x) size = std::max(size, p.norm());
    CHECK(near.distance <= sampled(edges, x) + 1e-9 * size);
    Vec3 sum = Vec3::Zero();
    double weights = 0;
    for (std::size_t c = 0; c < 4; ++c) {
      sum += near.weights[c] * x[c];
      weights += near.weights[c];
    }
    CHECK(std::abs(weights) < 1e-9);
    CHECK((sum - near.distance * near.normal).norm() < 1e-9 * size);
    CHECK(separation(edges, x, near.normal) <= near.distance);
    if (near.distance > 1e-3) CHECK(separation(edges, x, near.normal) > 0.999 * near.distance - 1e-9 * size);
  }
}

TEST_CASE("what is proven to stay apart stays apart, and the rest comes near", "[approach]") {
  Random random(2);
  int apart = 0, near = 0;
  for (int k = 0; k < 4000; ++k) {
    const bool edges = k % 2 == 0;
    const FourPoints start = any_pair(random);
    FourPoints end = start;
    const Vec3 common = any_point(random, 3);
    for (Vec3& p : end) p += common + any_point(random, 0.6);
    const double gap = k % 3 == 0 ? 0.05 : 1e-6;
    const Approach found = approach(edges, start, end, gap);
    INFO("pair " << k);
    for (int i = 0; i <= 60; ++i) {
      const double s = found.until * i / 60;
      if (s < found.until) CHECK(nearest(edges, between(start, end, s)).distance > gap);
    }
    if (found.apart) {
      ++apart;
      CHECK(found.until == 1);
    } else {
      ++near;
      // It stops short of the gap by little: the next look would be at hardly another place.
      CHECK(nearest(edges, between(start, end, found.until)).distance < gap + 0.05);
    }
  }
  CHECK(apart > 500);
  CHECK(near > 100);
}

TEST_CASE("two edges that nearly touch are proven apart where they part while they turn", "[approach]") {
  Random random(3);
  std::uniform_real_distribution<double> place(0.1, 0.9), number(-1, 1);
  for (int k = 0; k < 2000; ++k) {
    const double distance = 1e-7, gap = k % 2 == 0 ? 1e-7 : 4e-7, parted = 1e-4 * place(random),
                 turned = 5 * parted * number(random);
    const FourPoints start = {Vec3(-place(random), distance, 0), Vec3(place(random), distance, 0),
                              Vec3(0, 0, -place(random)), Vec3(0, 0, place(random))};
    FourPoints end = start;
    for (int c : {0, 1}) end[c] += Vec3(0.01 * number(random), parted + turned * start[c][0], 0);
    INFO("pair " << k);
    const Approach found = approach_from_within(true, start, end, gap);
    CHECK(found.apart);
    for (int i = 0; i <= 60; ++i) {
      const double now = nearest(true, between(start, end, i / 60.0)).distance;
      CHECK(now > 0.4 * distance);
    }
    CHECK(nearest(true, end).distance > 0.99 * distance);
  }
}

TEST_CASE("two edges that roll on each other a few micrometres apart are proven apart", "[approach]") {
  for (const double distance : {5e-6, 1e-5, 2e-5})
    for (const double length : {5e-3, 1e-2})
      for (const double slope : {-0.1, 0.03, 0.1}) {
        INFO(distance << " m apart, " << length << " m long, slope " << slope);
        const FourPoints start = {Vec3(-length, distance, 0), Vec3(0.7 * length, distance, 0),
                                  Vec3(0, 0, -length), Vec3(0, 0, 0.6 * length)};
        FourPoints end = start;
        for (int c : {0, 1}) end[c] += Vec3(0, slope * start[c][0], 0);
        CHECK(approach_from_within(true, start, end, 1e-7).apart);
      }
}

TEST_CASE("a pair that stands, or goes as one, is apart however near it is", "[approach]") {
  const FourPoints x = {Vec3(0.2, 1e-8, 0.3), Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 0, 1)};
  CHECK(approach_from_within(false, x, x, 1e-6).apart);
  FourPoints moved = x;
  for (Vec3& p : moved) p += Vec3(0.25, 0.5, -0.125);
  CHECK(approach_from_within(false, x, moved, 1e-6).apart);
  moved[0] -= Vec3(0, 2e-8, 0);
  CHECK_FALSE(approach_from_within(false, x, moved, 1e-6).apart);
}
