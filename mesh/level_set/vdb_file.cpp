// OpenVDB's part of the level sets: their files, and the zero surface of a grid that another program made.
// This code runs on one thread: its work is a small part of making a grid, and the rest of the program does
// not share threads with TBB.
#include "mesh/level_set/vdb_file.h"

#include "mesh/base/errors.h"
#include "mesh/base/hash.h"
#include "mesh/triangles/extent.h"

#ifdef DRAPE_HAVE_OPENVDB
#include <openvdb/io/Stream.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/SignedFloodFill.h>
#include <openvdb/tools/VolumeToMesh.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <sstream>
#endif

namespace drape::internal {

#ifdef DRAPE_HAVE_OPENVDB
namespace {

namespace vdb = openvdb;
using Grid = vdb::FloatGrid;

constexpr int format = 1;  // version of our files

template <class F>
void with_openvdb(const std::filesystem::path& path, const char* cannot, const F& f) {
  static std::once_flag once;
  std::call_once(once, [] { vdb::initialize(); });
  try {
    tbb::task_arena alone(1);
    alone.execute(f);
  } catch (const InputError& error) {
    throw InputError(path.string() + ": " + error.what());
  } catch (const std::exception& error) {  // a damaged file may also ask for any amount of memory
    throw InputError(path.string() + ": " + cannot + ": " + error.what());
  }
}

vdb::Coord coord(const Index& i) { return {i[0], i[1], i[2]}; }
vdb::Vec3d vec(const Vec3& x) { return {x[0], x[1], x[2]}; }
Vec3 vec(const vdb::Vec3d& x) { return {x[0], x[1], x[2]}; }

// Calls f(c, slot) for every triple c of numbers from 0, each below its entry of `sides`.
template <class F>
void for_box(const Index& sides, const F& f) {
  std::size_t slot = 0;
  for (Index c{}; c[0] < sides[0]; ++c[0])
    for (c[1] = 0; c[1] < sides[1]; ++c[1])
      for (c[2] = 0; c[2] < sides[2]; ++c[2]) f(c, slot++);
}

Index sides_in_bricks(const VoxelGrid& grid) { return {grid.side(0), grid.side(1), grid.side(2)}; }

// --- writing ----------------------------------------------------------------------------------------------

std::string checksum(const VoxelGrid& grid) {
  return std::to_string(Fnv1a().add_all(grid.far).add_all(grid.nodes).value());
}

void describe(Grid& surface, const VoxelGrid& grid) {
  surface.insertMeta("drape_checksum", vdb::StringMetadata(checksum(grid)));
  surface.insertMeta("drape_format", vdb::Int32Metadata(format));
  surface.insertMeta("drape_voxel", vdb::DoubleMetadata(grid.voxel));
  surface.insertMeta("drape_band", vdb::DoubleMetadata(grid.band));
  surface.insertMeta("drape_lower", vdb::Vec3DMetadata(vec(grid.box.min())));
  surface.insertMeta("drape_upper", vdb::Vec3DMetadata(vec(grid.box.max())));
  if (!grid.error) return;
  surface.insertMeta("drape_error_largest", vdb::DoubleMetadata(grid.error->largest));
  surface.insertMeta("drape_error_rms", vdb::DoubleMetadata(grid.error->rms));
  surface.insertMeta("drape_error_where", vdb::Vec3DMetadata(vec(grid.error->where)));
  surface.insertMeta("drape_error_vanished", vdb::DoubleMetadata(grid.error->vanished));
  surface.insertMeta("drape_error_vanished_where", vdb::Vec3DMetadata(vec(grid.error->vanished_where)));
}

Grid::Ptr surface_of(const VoxelGrid& grid) {
  float largest = 0;
  for (const float d : grid.nodes) largest = std::max(largest, std::abs(d));
  Grid::Ptr surface = Grid::create(largest);
  surface->setName("surface");
  surface->setGridClass(vdb::GRID_LEVEL_SET);
  surface->setTransform(vdb::math::Transform::createLinearTransform(grid.voxel));
  auto node = surface->getAccessor();
  const std::vector<Index> places = grid.places();
  constexpr int n = VoxelGrid::brick;
  for (std::size_t b = 0; b < places.size(); ++b)
    for_box({n, n, n}, [&](const Index& i, std::size_t slot) {
      if (grid.needed(places[b], i))
        node.setValue(coord(grid.node(places[b], i)), grid.nodes[b * VoxelGrid::in_brick + slot]);
    });
  vdb::tools::signedFloodFill(surface->tree(), false);
  describe(*surface, grid);
  return surface;
}

Grid::Ptr far_of(const VoxelGrid& grid) {
  Grid::Ptr far = Grid::create(0);
  far->setName("far");
  vdb::math::Transform::Ptr to_world =
      vdb::math::Transform::createLinearTransform(grid.voxel * VoxelGrid::cell);
  to_world->postTranslate(vec(grid.cell_centre({0, 0, 0})));
  far->setTransform(to_world);
  auto node = far->getAccessor();
  for_box(grid.cells, [&](const Index& c, std::size_t slot) { node.setValue(coord(c), grid.far[slot]); });
  return far;
}

vdb::BoolGrid::Ptr near_of(const VoxelGrid& grid) {
  vdb::BoolGrid::Ptr near = vdb::BoolGrid::create(false);
  near->setName("near");
  auto node = near->getAccessor();
  for_box(sides_in_bricks(grid), [&](const Index& b, std::size_t slot) {
    if (grid.bricks[slot] != VoxelGrid::none && grid.bricks[slot] < grid.near_count)
      node.setValue(coord(b), true);
  });
  return near;
}

// --- reading ----------------------------------------------------------------------------------------------

// The first grid of type G in the file that `wanted` accepts.
template <class G, class Wanted>
typename G::Ptr find(const vdb::GridPtrVec& grids, const Wanted& wanted) {
  for (const vdb::GridBase::Ptr& grid : grids)
    if (auto found = vdb::gridPtrCast<G>(grid); found && wanted(*found)) return found;
  return nullptr;
}

template <class T>
T meta(const Grid& surface, const char* name) {
  return surface.metaValue<T>(name);
}

LevelSetError error_of(const Grid& surface) {
  LevelSetError error;
  error.largest = meta<double>(surface, "drape_error_largest");
  error.rms = meta<double>(surface, "drape_error_rms");
  error.where = vec(meta<vdb::Vec3d>(surface, "drape_error_where"));
  error.vanished = meta<double>(surface, "drape_error_vanished");
  error.vanished_where = vec(meta<vdb::Vec3d>(surface, "drape_error_vanished_where"));
  return error;
}

// Reads a file of our own. Nothing is computed, so that the grid answers with the same bits as the written
// one.
VoxelGrid as_written(const Grid& surface, const Grid& far, const vdb::BoolGrid& near) {
  VoxelGrid grid = empty_grid(
      meta<double>(surface, "drape_voxel"), meta<double>(surface, "drape_band"),
      {vec(meta<vdb::Vec3d>(surface, "drape_lower")), vec(meta<vdb::Vec3d>(surface, "drape_upper"))});
  const vdb::CoordBBox box = far.evalActiveVoxelBoundingBox();
  if (box.min() != vdb::Coord(0, 0, 0) ||
      box.max() != vdb::Coord(grid.cells[0] - 1, grid.cells[1] - 1, grid.cells[2] - 1))
    throw InputError("its grids do not fit together");
  const auto far_node = far.getConstAccessor();
  const auto near_node = near.getConstAccessor();
  for_box(grid.cells, [&](const Index& c, std::size_t) { grid.far.push_back(far_node.getValue(coord(c))); });
  for_box(sides_in_bricks(grid), [&](const Index& b, std::size_t) {
    grid.bricks.push_back(near_node.getValue(coord(b)) ? 0 : VoxelGrid::none);
  });
  fill_bricks(grid, [&](const Index& i) { return surface.tree().getValue(coord(i)); });
  if (checksum(grid) != meta<std::string>(surface, "drape_checksum")) throw InputError("the file is damaged");
  if (surface.getMetadata<vdb::DoubleMetadata>("drape_error_largest")) grid.error = error_of(surface);
  return grid;
}

TriangleMesh zero_surface(const Grid& surface) {
  std::vector<vdb::Vec3s> points;
  std::vector<vdb::Vec3I> triangles;
  std::vector<vdb::Vec4I> quads;
  vdb::tools::volumeToMesh(surface, points, triangles, quads);
  TriangleMesh mesh;
  for (const vdb::Vec3s& p : points) mesh.positions.emplace_back(p[0], p[1], p[2]);
  const auto add = [&](auto a, auto b, auto c) {
    mesh.triangles.push_back({static_cast<int>(a), static_cast<int>(b), static_cast<int>(c)});
  };
  for (const vdb::Vec3I& t : triangles) add(t[0], t[1], t[2]);
  for (const vdb::Vec4I& q : quads) add(q[0], q[1], q[2]), add(q[0], q[2], q[3]);
  return mesh;
}

// Completes a grid that another program made: the nodes of its narrow band are kept, and all other nodes are
// measured from its zero surface. The sign is the one in the file everywhere.
VoxelGrid completed(Grid& surface, double voxel) {
  surface.setTransform(vdb::math::Transform::createLinearTransform(voxel));
  vdb::tools::signedFloodFill(surface.tree(), false);
  const TriangleMesh zero = zero_surface(surface);
  if (zero.triangles.empty()) throw InputError("its level set has no surface");
  const SurfaceDistance exact(zero);
  VoxelGrid grid = empty_grid(voxel, 3 * voxel, box_of(zero.positions));
  const auto signed_distance = [&](const Vec3& x, const vdb::Coord& node) {
    return std::copysign(std::abs(exact.closest(x).distance), surface.tree().getValue(node));
  };
  find_near_bricks(
      grid, [&](const Vec3& x) { return signed_distance(x, vdb::Coord::round(vec(Vec3(x / voxel)))); });
  fill_bricks(grid, [&](const Index& i) -> double {
    const vdb::Coord node = coord(i);
    if (float value = 0; surface.tree().probeValue(node, value)) return value;
    return signed_distance(voxel * Vec3(i[0], i[1], i[2]), node);
  });
  return grid;
}

// The spacing of the nodes [m]. Throws when the nodes are not a regular grid along the axes.
double voxel_of(const vdb::math::Transform& transform, const vdb::Vec3d& origin) {
  const double voxel = transform.indexToWorld(vdb::Vec3d(1, 0, 0))[0] - origin[0];
  for (int k = 0; k < 3; ++k) {
    vdb::Vec3d along(0, 0, 0);
    along[k] = 1;
    const vdb::Vec3d step = transform.indexToWorld(along) - origin;
    if (!(voxel > 0 && (step - voxel * along).length() < 1e-6 * voxel))
      throw InputError("its voxels are not cubes along the axes; resample it in the program that made it");
  }
  return voxel;
}

VdbFile decoded(const vdb::GridPtrVec& grids) {
  const auto named = [](const char* name) {
    return [name](const auto& grid) { return grid.getName() == name; };
  };
  const Grid::Ptr far = find<Grid>(grids, named("far"));
  const vdb::BoolGrid::Ptr near = find<vdb::BoolGrid>(grids, named("near"));
  const Grid::Ptr surface =
      find<Grid>(grids, [](const Grid& grid) { return grid.getGridClass() == vdb::GRID_LEVEL_SET; });
  if (!surface) throw InputError("there is no level set of floats in it (a grid of class LEVEL_SET)");
  const auto written = surface->getMetadata<vdb::Int32Metadata>("drape_format");
  if (written && far && near) {
    if (written->value() != format) throw InputError("another version of drape wrote it; make it again");
    return {as_written(*surface, *far, *near)};
  }
  const vdb::Vec3d origin = surface->transform().indexToWorld(vdb::Vec3d(0, 0, 0));
  const double voxel = voxel_of(surface->transform(), origin);
  return {completed(*surface, voxel), vec(origin)};
}

void multiply(VoxelGrid& grid, double scale) {
  if (scale == 1) return;
  grid.voxel *= scale;
  grid.band *= scale;
  grid.box = {grid.box.min() * scale, grid.box.max() * scale};
  for (float& d : grid.far) d = static_cast<float>(d * scale);
  for (float& d : grid.nodes) d = static_cast<float>(d * scale);
  for (float& d : grid.coefficients) d = static_cast<float>(d * scale);
  if (!grid.error) return;
  grid.error->largest *= scale;
  grid.error->rms *= scale;
  grid.error->where *= scale;
  grid.error->vanished_where *= scale;
}

}  // namespace

bool reads_openvdb() { return true; }

VdbFile read_vdb(const std::filesystem::path& path, double scale) {
  if (!std::filesystem::exists(path)) throw InputError(path.string() + ": no such file");
  VdbFile result;
  with_openvdb(path, "cannot be read", [&] {
    vdb::io::File file(path.string());
    file.open(false);  // reads all of the file at once
    result = decoded(*file.getGrids());
  });
  multiply(result.grid, scale);
  result.origin *= scale;
  return result;
}

std::string format_vdb(const VoxelGrid& grid) {
  constexpr double least_voxel = 1.5e-5;  // m: OpenVDB takes a cell of less than 3e-15 m^3 for none at all
  if (!(grid.voxel >= least_voxel))
    throw InputError("a .vdb file cannot hold a voxel of " + std::to_string(1e6 * grid.voxel) +
                     " um, which is less than 15 um; choose a larger voxel, or a larger scale");
  std::ostringstream bytes(std::ios::binary);
  with_openvdb("the level set", "cannot be written", [&] {
    vdb::io::Stream(bytes).write(vdb::GridCPtrVec{surface_of(grid), far_of(grid), near_of(grid)});
  });
  return std::move(bytes).str();
}

#else

namespace {
[[noreturn]] void missing(const std::filesystem::path& path) {
  throw InputError(
      path.string() +
      ": this build has no OpenVDB, which .vdb files need: install libopenvdb-dev and build again");
}
}  // namespace

bool reads_openvdb() { return false; }
VdbFile read_vdb(const std::filesystem::path& path, double) { missing(path); }
std::string format_vdb(const VoxelGrid&) { missing("the level set"); }

#endif

}  // namespace drape::internal
