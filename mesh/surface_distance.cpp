// Signed distance to a triangle surface. Embree's tree finds the triangles worth asking; the closest point of
// each is ours, in double precision; the feature (vertex, edge or face) that holds it tells the side.
//   phi(x) = s |x - c|,  s = sign((x - c) . n_c),  n_c the angle-weighted pseudo-normal of the feature at c
//                        [Baerentzen & Aanaes 2005; closest point of a triangle: Ericson 2005, 5.1.5]
// Input that is not clean: triangles with a repeated vertex and second copies of a triangle are dropped;
// triangles of zero area stay in the topology (they close cracks) and leave the tree. A surface that is open
// as numbered is tried again with vertices of exactly equal position made one, as uv seams need.
#include "mesh/surface_distance.h"

#include <embree3/rtcore.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <tuple>

#include "mesh/obj.h"
#include "mesh/topology.h"

namespace drape {
namespace {

constexpr double flat = 1e-13;      // height / longest edge of a triangle that has no area
constexpr double touching = 1e-12;  // m: nearer than this the point is on the surface
constexpr double blurred = 1e-9;    // of the surface's size: nearer than this x - c is mostly rounding

enum Feature : int { at_vertex = 0, on_edge = 3, on_face = 6 };  // vertex k: k, edge k to k + 1: 3 + k

struct Face {
  Triangle v;
  Triangle across;  // the face beyond edge v[k] v[k+1]; -1: none, or several
};

struct Candidate {
  double squared = std::numeric_limits<double>::infinity();
  int face = -1;
  int feature = on_face;
  Vec3 point = Vec3::Zero();
};

int next(int k) { return k == 2 ? 0 : k + 1; }

// The point of a triangle nearest to x, and the feature that holds it.
std::pair<Vec3, int> closest_on_triangle(const Vec3& x, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a, ac = c - a, ax = x - a;
  const double ab_a = ab.dot(ax), ac_a = ac.dot(ax);
  if (ab_a <= 0 && ac_a <= 0) return {a, at_vertex};
  const Vec3 bx = x - b;
  const double ab_b = ab.dot(bx), ac_b = ac.dot(bx);
  if (ab_b >= 0 && ac_b <= ab_b) return {b, at_vertex + 1};
  const Vec3 cx = x - c;
  const double ab_c = ab.dot(cx), ac_c = ac.dot(cx);
  if (ac_c >= 0 && ab_c <= ac_c) return {c, at_vertex + 2};
  // Areas beside the edges, as cross products: differences of products of the dots would lose a sliver's
  // digits.
  const Vec3 n = ab.cross(ac);
  const double beside_ab = n.dot(ab.cross(ax));
  if (beside_ab <= 0 && ab_a >= 0 && ab_b <= 0) return {a + ab_a / (ab_a - ab_b) * ab, on_edge};
  const double beside_ca = n.dot(ax.cross(ac));
  if (beside_ca <= 0 && ac_a >= 0 && ac_c <= 0) return {a + ac_a / (ac_a - ac_c) * ac, on_edge + 2};
  const double along_b = ac_b - ab_b, along_c = ab_c - ac_c;
  const Vec3 bc = c - b;
  if (n.dot(bc.cross(bx)) <= 0 && along_b >= 0 && along_c >= 0)
    return {b + along_b / (along_b + along_c) * bc, on_edge + 1};
  const double scale = 1 / n.squaredNorm();
  return {a + beside_ca * scale * ab + beside_ab * scale * ac, on_face};
}

// Triangles of three different vertices, each once, in the mesh's order.
std::vector<Face> distinct_faces(const TriangleMesh& mesh, const std::vector<int>& weld) {
  std::vector<std::pair<Triangle, int>> keys;
  for (int t = 0; t < mesh.triangle_count(); ++t) {
    Triangle key;
    for (int k = 0; k < 3; ++k) key[k] = weld[mesh.triangles[t][k]];
    std::sort(key.begin(), key.end());
    if (key[0] != key[1] && key[1] != key[2]) keys.emplace_back(key, t);
  }
  std::sort(keys.begin(), keys.end());
  const auto same = [](const auto& p, const auto& q) { return p.first == q.first; };
  keys.erase(std::unique(keys.begin(), keys.end(), same), keys.end());
  std::vector<Face> faces;
  faces.reserve(keys.size());
  std::sort(keys.begin(), keys.end(), [](const auto& p, const auto& q) { return p.second < q.second; });
  for (const auto& [key, t] : keys) faces.push_back({mesh.triangles[t], {-1, -1, -1}});
  return faces;
}

// Fills `across`; true when every edge has exactly two faces.
bool join(std::vector<Face>& faces) {
  std::vector<std::tuple<int, int, int, int>> edges;  // lower vertex, higher vertex, face, side
  edges.reserve(3 * faces.size());
  for (int f = 0; f < static_cast<int>(faces.size()); ++f)
    for (int k = 0; k < 3; ++k) {
      const auto [u, v] = std::minmax({faces[f].v[k], faces[f].v[next(k)]});
      edges.emplace_back(u, v, f, k);
      faces[f].across[k] = -1;
    }
  std::sort(edges.begin(), edges.end());
  bool manifold = true;
  for (std::size_t i = 0, j = 0; i < edges.size(); i = j) {
    const auto [u, v, f, k] = edges[i];
    for (j = i; j < edges.size() && std::get<0>(edges[j]) == u && std::get<1>(edges[j]) == v;) ++j;
    manifold = manifold && j - i == 2;
    if (j - i != 2) continue;
    const auto [u2, v2, g, m] = edges[i + 1];
    faces[f].across[k] = g;
    faces[g].across[m] = f;
  }
  return manifold;
}

void turn(Face& f) {
  std::swap(f.v[1], f.v[2]);
  std::swap(f.across[0], f.across[2]);
}

// Winds a joined surface one way, piece by piece, with the normals out of the positive volume. False, with
// some faces turned, when it has one side only. `inside_out`: a piece was wound with its normals inwards,
// most of its faces so.
bool orient(std::vector<Face>& faces, const std::vector<Vec3>& positions, const Vec3& centre,
            bool& inside_out) {
  std::vector<char> seen(faces.size(), 0);
  std::vector<char> turned(faces.size(), 0);
  for (int seed = 0; seed < static_cast<int>(faces.size()); ++seed) {
    if (seen[seed]) continue;
    std::vector<int> piece{seed};
    seen[seed] = 1;
    double volume = 0;
    std::size_t turns = 0;
    for (std::size_t i = 0; i < piece.size(); ++i) {
      const Face f = faces[piece[i]];
      volume +=
          (positions[f.v[0]] - centre).cross(positions[f.v[1]] - centre).dot(positions[f.v[2]] - centre);
      turns += turned[piece[i]];
      for (int k = 0; k < 3; ++k) {
        Face& g = faces[f.across[k]];
        const auto runs_along = [&](int m) { return g.v[m] == f.v[k] && g.v[next(m)] == f.v[next(k)]; };
        const bool against = !runs_along(0) && !runs_along(1) && !runs_along(2);
        if (!against && seen[f.across[k]]) return false;
        if (!against) turn(g), turned[f.across[k]] = 1;
        if (!seen[f.across[k]]) piece.push_back(f.across[k]), seen[f.across[k]] = 1;
      }
    }
    if (volume < 0)
      for (int f : piece) turn(faces[f]);
    if (volume < 0 ? 2 * turns < piece.size() : 2 * turns > piece.size()) inside_out = true;
  }
  return true;
}

}  // namespace

struct SurfaceDistance::Tree {
  explicit Tree(const TriangleMesh& surface);

  TriangleMesh mesh;
  std::vector<Face> faces;  // in the mesh's order; from face_count on: those without an area
  int face_count = 0;
  std::vector<Vec3> vertex_normals;
  bool closed = false, inside_out = false;
  Vec3 centre = Vec3::Zero();
  double size = 0;  // m, diagonal of the box
  std::unique_ptr<RTCDeviceTy, decltype(&rtcReleaseDevice)> device{nullptr, rtcReleaseDevice};
  std::unique_ptr<RTCSceneTy, decltype(&rtcReleaseScene)> scene{nullptr, rtcReleaseScene};

  void clean(const std::vector<int>& weld);
  void grow();
  void connect(const std::vector<int>& weld);
  struct Query {
    const Tree& tree;
    Vec3 x;
    Candidate best;
  };
  static bool ask(RTCPointQueryFunctionArguments* call);
  Candidate find(const Vec3& x) const;
  Vec3 plain_normal(int face) const;
  Vec3 normal_beyond(int face, int side) const;
  Vec3 pseudo_normal(const Candidate& c) const;
  int longest_side(int face) const;
  const Vec3& corner(int face, int k) const { return mesh.positions[faces[face].v[k]]; }
};

// Embree found a triangle within the radius. The radius stays a little longer than the best distance: by more
// than embree's rounding to float, so that no nearer triangle and no tie is passed over. Of several equally
// near the first one is taken.
bool SurfaceDistance::Tree::ask(RTCPointQueryFunctionArguments* call) {
  auto& [tree, x, best] = *static_cast<Query*>(call->userPtr);
  const int f = static_cast<int>(call->primID);
  const auto [point, feature] =
      closest_on_triangle(x, tree.corner(f, 0), tree.corner(f, 1), tree.corner(f, 2));
  const double squared = (x - point).squaredNorm();
  if (!(squared < best.squared || (squared == best.squared && f < best.face))) return false;
  best = {squared, f, feature, point};
  const auto radius = static_cast<float>(std::sqrt(squared) * (1 + 1e-5) + 1e-6 * tree.size);
  if (radius >= call->query->radius) return false;
  call->query->radius = radius;
  return true;
}

SurfaceDistance::Tree::Tree(const TriangleMesh& surface) : mesh(surface) {
  const std::vector<int> weld = welded(mesh.positions);
  clean(weld);
  grow();
  connect(weld);
}

// Keeps each triangle once, those with an area first, and measures their box.
void SurfaceDistance::Tree::clean(const std::vector<int>& weld) {
  faces = distinct_faces(mesh, weld);
  const auto has_area = [&](const Face& f) {
    const Vec3 &a = mesh.positions[f.v[0]], &b = mesh.positions[f.v[1]], &c = mesh.positions[f.v[2]];
    const double longest = std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
    return (b - a).cross(c - a).norm() > flat * longest;
  };
  const auto flat_ones = std::stable_partition(faces.begin(), faces.end(), has_area);
  face_count = static_cast<int>(flat_ones - faces.begin());
  if (face_count == 0) throw InputError("the surface has no triangle with an area");
  Vec3 lo = corner(0, 0), hi = lo;
  for (int f = 0; f < face_count; ++f)
    for (int k = 0; k < 3; ++k) lo = lo.cwiseMin(corner(f, k)), hi = hi.cwiseMax(corner(f, k));
  centre = 0.5 * (lo + hi);
  size = (hi - lo).norm();
}

// Embree's tree, over positions about the box's centre: it works in float.
void SurfaceDistance::Tree::grow() {
  device.reset(rtcNewDevice("threads=1"));
  if (!device) throw std::runtime_error("embree does not start on this processor");
  scene.reset(rtcNewScene(device.get()));
  rtcSetSceneFlags(scene.get(), RTC_SCENE_FLAG_ROBUST);
  rtcSetSceneBuildQuality(scene.get(), RTC_BUILD_QUALITY_HIGH);
  const RTCGeometry geometry = rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* place = static_cast<float*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), mesh.positions.size()));
  auto* index = static_cast<unsigned*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(unsigned), face_count));
  if (place && index) {
    for (const Vec3& p : mesh.positions)
      for (int k = 0; k < 3; ++k) *place++ = static_cast<float>(p[k] - centre[k]);
    for (int f = 0; f < face_count; ++f)
      for (int v : faces[f].v) *index++ = static_cast<unsigned>(v);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene.get(), geometry);
    rtcCommitScene(scene.get());
  }
  rtcReleaseGeometry(geometry);
  if (rtcGetDeviceError(device.get()) != RTC_ERROR_NONE)
    throw std::runtime_error("embree cannot hold the surface");
}

// Finds the neighbours, as numbered or, if that leaves the surface open, with coinciding vertices made one.
void SurfaceDistance::Tree::connect(const std::vector<int>& weld) {
  for (bool weld_them : {false, true}) {
    if (closed) break;
    if (weld_them)
      for (Face& f : faces)
        for (int& v : f.v) v = weld[v];
    if (!join(faces)) continue;
    std::vector<Face> wound = faces;
    bool reversed = false;
    closed = orient(wound, mesh.positions, centre, reversed);
    if (closed) faces = std::move(wound), inside_out = reversed;
  }
  vertex_normals.assign(mesh.positions.size(), Vec3::Zero());
  for (int f = 0; f < static_cast<int>(faces.size()); ++f)
    for (int k = 0; k < 3; ++k) {
      const Vec3 p = corner(f, next(k)) - corner(f, k), q = corner(f, next(next(k))) - corner(f, k);
      vertex_normals[faces[f].v[k]] += std::atan2(p.cross(q).norm(), p.dot(q)) * plain_normal(f);
    }
}

Candidate SurfaceDistance::Tree::find(const Vec3& x) const {
  Query query{*this, x, {}};
  const Vec3 local = x - centre;
  RTCPointQuery ball{static_cast<float>(local.x()), static_cast<float>(local.y()),
                     static_cast<float>(local.z()), 0, std::numeric_limits<float>::infinity()};
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  rtcPointQuery(scene.get(), &ball, &context, ask, &query);
  return query.best;
}

int SurfaceDistance::Tree::longest_side(int f) const {
  double length[3];
  for (int k = 0; k < 3; ++k) length[k] = (corner(f, next(k)) - corner(f, k)).squaredNorm();
  return static_cast<int>(std::max_element(length, length + 3) - length);
}

// Unit normal of a face. One without an area is a part of the face beyond its longest side.
Vec3 SurfaceDistance::Tree::plain_normal(int f) const {
  if (f >= face_count) f = faces[f].across[longest_side(f)];
  if (f < 0 || f >= face_count) return Vec3::Zero();
  return (corner(f, 1) - corner(f, 0)).cross(corner(f, 2) - corner(f, 0)).normalized();
}

// Normal of the surface beyond a side of a face. Past the long side of a face without an area lie two.
Vec3 SurfaceDistance::Tree::normal_beyond(int f, int side) const {
  const int g = faces[f].across[side];
  if (g < 0) return Vec3::Zero();
  const int longest = g < face_count ? -1 : longest_side(g);
  if (longest < 0 || faces[g].across[longest] != f) return plain_normal(g);
  Vec3 sum = Vec3::Zero();
  for (int k : {next(longest), next(next(longest))})
    if (const int h = faces[g].across[k]; h >= 0 && h < face_count) sum += plain_normal(h);
  return sum.normalized();
}

Vec3 SurfaceDistance::Tree::pseudo_normal(const Candidate& c) const {
  const Vec3 face_normal = plain_normal(c.face);
  Vec3 n = face_normal;
  if (c.feature < on_edge) n = vertex_normals[faces[c.face].v[c.feature]];
  if (c.feature >= on_edge && c.feature < on_face) n += normal_beyond(c.face, c.feature - on_edge);
  const double length = n.norm();
  return length > 1e-9 ? Vec3(n / length) : face_normal;  // a sheet folded flat on itself has no other
}

SurfaceDistance::SurfaceDistance(const TriangleMesh& mesh) : tree_(std::make_unique<Tree>(mesh)) {}
SurfaceDistance::~SurfaceDistance() = default;

SurfacePoint SurfaceDistance::closest(const Vec3& x) const {
  const Candidate c = tree_->find(x);
  if (c.face < 0) return {std::numeric_limits<double>::quiet_NaN(), Vec3::UnitY()};  // x is not finite
  const Vec3 offset = x - c.point;
  const double d = offset.norm();
  const Vec3 n = tree_->pseudo_normal(c);
  const double side = offset.dot(n) < 0 ? -1 : 1;
  const bool clear = d >= touching && d >= blurred * tree_->size;
  const bool by_offset =
      clear && c.feature != on_face;  // a face's own normal has more digits than offset / d
  const Vec3 away = by_offset ? Vec3(offset / d) : Vec3(side * n);
  if (tree_->closed) return {side * d, side * away};
  return {d, d < touching ? n : away};
}

bool SurfaceDistance::closed() const { return tree_->closed; }
bool SurfaceDistance::inside_out() const { return tree_->inside_out; }
const TriangleMesh& SurfaceDistance::mesh() const { return tree_->mesh; }

}  // namespace drape
