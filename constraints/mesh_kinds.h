// The answers to the questions of shape.h for shapes that are meshes, or were made of one.
#pragma once

#include "constraints/shape.h"

namespace drape::internal::kinds {

// What holds for a kind of shape, whatever its sizes.
struct Nature {
  std::string_view name;
  bool convex;  // every straight line meets the solid in one piece
  bool reacts;  // it may have a mass and be moved by what acts on it
};

constexpr Nature nature(const MeshBody&) { return {"mesh", false, true}; }
constexpr Nature nature(const DeformingBody&) { return {"mesh", false, true}; }
constexpr Nature nature(const LevelSetBody&) { return {"level-set", false, true}; }

inline SurfacePoint closest(const MeshBody& body, const Vec3& x) { return body->closest(x); }
inline SurfacePoint closest(const DeformingBody& body, const Vec3& x, double s) {
  return body.surface->closest(x, s);
}
inline SurfacePoint closest(const LevelSetBody& body, const Vec3& x) { return body->closest(x); }

Vec3 middle_of(const MeshBody& body);
Vec3 middle_of(const DeformingBody& body);
Vec3 middle_of(const LevelSetBody& body);

inline Mat3 axes_of(const MeshBody&) { return Mat3::Identity(); }
inline Mat3 axes_of(const DeformingBody&) { return Mat3::Identity(); }
inline Mat3 axes_of(const LevelSetBody&) { return Mat3::Identity(); }

inline void make_unit(MeshBody&) {}
inline void make_unit(DeformingBody&) {}
inline void make_unit(LevelSetBody&) {}

Eigen::AlignedBox3d bounds_of(const MeshBody& body);
Eigen::AlignedBox3d bounds_of(const DeformingBody& body);
Eigen::AlignedBox3d bounds_of(const LevelSetBody& body);

TriangleMesh mesh_of(const MeshBody& body, int coarser);
TriangleMesh mesh_of(const DeformingBody& body, int coarser);
TriangleMesh mesh_of(const LevelSetBody& body, int coarser);

std::optional<UniformSolid> uniform_solid(const MeshBody& body, double mass);
std::optional<UniformSolid> uniform_solid(const DeformingBody& body, double mass);
std::optional<UniformSolid> uniform_solid(const LevelSetBody& body, double mass);

double longest_edge(const MeshBody& body);
double longest_edge(const DeformingBody& body);
double longest_edge(const LevelSetBody& body);

void check(const MeshBody& body);
void check(const DeformingBody& body);
void check(const LevelSetBody& body);

}  // namespace drape::internal::kinds
