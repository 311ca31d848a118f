#include "constraints/mesh_kinds.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "mesh/base/errors.h"
#include "mesh/lattice/solid.h"

namespace drape::internal::kinds {
namespace {

// The box of the vertices that belong to triangles.
Eigen::AlignedBox3d box_of(const TriangleMesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const Triangle& t : mesh.triangles)
    for (const int v : t) box.extend(mesh.positions[v]);
  return box;
}

double half_least(const Vec3& extent) { return 0.5 * extent.minCoeff(); }

}  // namespace

Vec3 middle_of(const MeshBody& body) { return bounds_of(body).center(); }
Vec3 middle_of(const DeformingBody& body) { return bounds_of(body).center(); }
Vec3 middle_of(const LevelSetBody& body) { return body->to_world((body->lower() + body->upper()) / 2); }

Eigen::AlignedBox3d bounds_of(const MeshBody& body) { return box_of(body->mesh()); }
Eigen::AlignedBox3d bounds_of(const DeformingBody& body) { return box_of(body.surface->mesh()); }

// The box of the corners of the grid's own box, which may be turned.
Eigen::AlignedBox3d bounds_of(const LevelSetBody& body) {
  const Eigen::AlignedBox3d grid(body->lower(), body->upper());
  Eigen::AlignedBox3d box;
  for (int k = 0; k < 8; ++k)
    box.extend(body->to_world(grid.corner(static_cast<Eigen::AlignedBox3d::CornerType>(k))));
  return box;
}

TriangleMesh mesh_of(const MeshBody& body, int) { return body->mesh(); }
TriangleMesh mesh_of(const DeformingBody& body, int) { return body.surface->mesh(); }
TriangleMesh mesh_of(const LevelSetBody&, int) { return {}; }

std::optional<UniformSolid> uniform_solid(const MeshBody& body, double mass) {
  if (!body->closed()) return std::nullopt;
  const Solid solid = solid_of(body->mesh());
  return UniformSolid{solid.volume, solid.centre, mass / solid.volume * solid.inertia};
}

std::optional<UniformSolid> uniform_solid(const DeformingBody&, double) { return std::nullopt; }

// The integrals are sums over cubes along the grid's axes, as small as its voxels unless these are too many.
// A cube of side h that the surface passes, at a distance phi from the middle of the cube, counts by the
// share 1/2 - phi/h.
std::optional<UniformSolid> uniform_solid(const LevelSetBody& body, double mass) {
  constexpr double most = 3e5;  // cubes
  const Vec3 extent = body->upper() - body->lower(), corner = body->lower();
  const double h = std::max(body->voxel(), std::cbrt(extent.prod() / most));
  const Eigen::Array3i count = (extent / h).array().ceil().max(1.0).cast<int>();
  double volume = 0;
  Vec3 first = Vec3::Zero();   // integral of x, measured from the middle
  Mat3 second = Mat3::Zero();  // integral of x x^T
  const Vec3 origin = middle_of(body);
  for (int i = 0; i < count.x(); ++i)
    for (int j = 0; j < count.y(); ++j)
      for (int k = 0; k < count.z(); ++k) {
        const Vec3 at = body->to_world(corner + h * Vec3(i + 0.5, j + 0.5, k + 0.5));
        const double share = std::clamp(0.5 - body->closest(at).distance / h, 0.0, 1.0);
        if (share == 0) continue;
        const Vec3 x = at - origin;
        volume += share;
        first += share * x;
        second += share * (x * x.transpose() + h * h / 12 * Mat3::Identity());
      }
  if (!(volume > 0)) return std::nullopt;  // the solid is thinner than the grid resolves
  const Vec3 offset = first / volume;
  second = second / volume - offset * offset.transpose();
  return UniformSolid{volume * h * h * h, origin + offset,
                      mass * (second.trace() * Mat3::Identity() - second)};
}

double longest_edge(const MeshBody& body) { return half_least(bounds_of(body).sizes()); }
double longest_edge(const DeformingBody& body) { return half_least(bounds_of(body).sizes()); }
double longest_edge(const LevelSetBody& body) { return half_least(body->upper() - body->lower()); }

void check(const MeshBody& body) {
  if (!body) throw InputError("mesh: there is no surface");
}

void check(const DeformingBody& body) {
  if (!body.surface) throw InputError("mesh: there is no surface");
  if (!body.frames || body.frames->frame_count() == 0) throw InputError("mesh: there are no frames");
  const int vertices = body.surface->mesh().vertex_count();
  if (body.frames->vertex_count() != vertices)
    throw InputError("mesh: it has " + std::to_string(vertices) + " vertices, its frames have " +
                     std::to_string(body.frames->vertex_count()));
}

void check(const LevelSetBody& body) {
  if (!body) throw InputError("level-set: there is no grid");
}

}  // namespace drape::internal::kinds
