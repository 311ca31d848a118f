// What the vertices of a cloth have besides their positions, frame by frame, as arrays of NumPy:
//   fields/NAME.velocity.npy   float32 (frames, n, 3)   m/s
//   fields/NAME.strain.npy     float32 (frames, n)      what is stretched or compressed most at the vertex: of woven
//                                                    cloth a principal strain of a triangle, else an edge's l / L - 1
//   fields/NAME.contact.npy    uint8   (frames, n)      0 free, 1 slides, 2 sticks on a body, 3 on cloth, 4 stopped
// And, where the file has faces of more than three corners, how they are cut:
//   fields/NAME.triangles.npy  int32   (m, 3)           numbers of vertices, from 0
// A vertex that lies between several particles has the strain and the contact of the particle with the
// largest weight.
#pragma once

#include <optional>

#include "app/base/npy.h"
#include "app/simulation/simulation.h"

namespace drape::app {

class FrameFields {
 public:
  int arrays() const { return triangles_ ? 4 : 3; }

  FrameFields(const std::filesystem::path& folder, const Cloth& cloth);

  void add(const Cloth& cloth, const State& state, const Constraints& constraints);
  void close(const Cloth& cloth);  // as it is at the end
  void keep();

 private:
  void mark_touches(const Constraints& constraints, int particles);

  NpyWriter velocity_, strain_, contact_;
  std::optional<NpyWriter> triangles_;
  int vertices_;  // that there were at first
  std::vector<double> particle_strain_;
  std::vector<std::uint8_t> particle_contact_;
};

// What the vertices are copies of that a cloth got since it had so many, because it tore.
std::vector<int> copies_since(const Cloth& cloth, int vertices);

// Whether faces have to be cut: some have more than three corners.
bool has_polygons(const TriangleMesh& mesh);

std::filesystem::path field_path(const std::filesystem::path& folder, const std::string& name,
                                 const std::string& field);

}  // namespace drape::app
