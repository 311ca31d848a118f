// What the tests of cloth that tears share.
#pragma once

#include <algorithm>
#include <catch2/catch.hpp>
#include <numeric>
#include <string>
#include <vector>

#include "mesh/obj/obj.h"
#include "mesh/triangles/topology.h"
#include "solver/system/state.h"

namespace drape::test {

// A sheet of quads, nx by nz vertices, x and z from 0 in steps of h [m], with uv; two groups, near (low z)
// and far.
inline std::string quads(int nx, int nz, double h) {
  std::string text, faces;
  for (int j = 0; j < nz; ++j)
    for (int i = 0; i < nx; ++i)
      text += "v " + std::to_string(h * i) + " 0 " + std::to_string(h * j) + "\nvt " +
              std::to_string(0.1 * i) + " " + std::to_string(0.1 * j) + "\n";
  for (int j = 0; j + 1 < nz; ++j) {
    if (j == 0) faces += "g near\n";
    if (j == nz / 2) faces += "g far\n";
    for (int i = 0; i + 1 < nx; ++i) {
      faces += "f";
      for (const int v : {j * nx + i, (j + 1) * nx + i, (j + 1) * nx + i + 1, j * nx + i + 1})
        faces += " " + std::to_string(v + 1) + "/" + std::to_string(v + 1);
      faces += "\n";
    }
  }
  return text + faces;
}
// Two such sheets one behind the other, `gap` apart [m]: the groups near and far, and along the two sides
// that face each other the lines near.side and far.side. Vertex i of row j of sheet p is (p nz + j) nx + i.
inline std::string two_sheets(int nx, int nz, double h, double gap) {
  std::string text, faces, lines;
  for (int row = 0; row < 2 * nz; ++row)
    for (int i = 0; i < nx; ++i) {
      const double z = h * (row < nz ? row : row - 1) + (row < nz ? 0 : gap);
      text += "v " + std::to_string(h * i) + " 0 " + std::to_string(z) + "\nvt " + std::to_string(0.1 * i) +
              " " + std::to_string(0.1 * row) + "\n";
    }
  for (int row = 0; row + 1 < 2 * nz; ++row) {
    if (row == 0) faces += "g near\n";
    if (row == nz) faces += "g far\n";
    for (int i = 0; i + 1 < nx && row + 1 != nz; ++i) {
      faces += "f";
      for (const int v : {row * nx + i, (row + 1) * nx + i, (row + 1) * nx + i + 1, row * nx + i + 1})
        faces += " " + std::to_string(v + 1) + "/" + std::to_string(v + 1);
      faces += "\n";
    }
  }
  for (const int p : {0, 1}) {
    lines += p == 0 ? "g near.side\nl" : "g far.side\nl";
    for (int i = 0; i < nx; ++i) lines += " " + std::to_string((nz - 1 + p) * nx + i + 1);
    lines += "\n";
  }
  return text + faces + lines;
}

inline TriangleMesh quad_sheet(int nx, int nz, double h) { return parse_obj(quads(nx, nz, h), "quads.obj"); }

inline int pieces(const TriangleMesh& mesh) {
  const std::vector<int> piece = connected_pieces(mesh);
  return 1 + *std::max_element(piece.begin(), piece.end());
}

inline double sum(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

inline Vec3 weighted(const std::vector<double>& masses, const VecX& x) {
  Vec3 all = Vec3::Zero();
  for (std::size_t i = 0; i < masses.size(); ++i) all += masses[i] * x.segment<3>(3 * static_cast<int>(i));
  return all;
}

// A tear leaves the mass, the momentum and the centre of mass as they were.
inline void check_kept(const std::vector<double>& before, const State& was, const std::vector<double>& after,
                       const State& is) {
  REQUIRE(after.size() > before.size());
  const double mass = sum(before);
  CHECK(sum(after) == Approx(mass).epsilon(1e-14));
  CHECK((weighted(after, is.v) - weighted(before, was.v)).norm() < 1e-14 * weighted(before, was.v).norm());
  CHECK((weighted(after, is.x) - weighted(before, was.x)).norm() < 1e-14 * mass);
  CHECK(*std::min_element(after.begin(), after.end()) > 0);
}

}  // namespace drape::test
