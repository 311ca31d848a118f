#include "app/export/gltf.h"

#include <optional>

#include "app/base/json.h"
#include "app/export/bytes.h"
#include "app/export/faces.h"
#include "app/export/gltf_buffer.h"
#include "app/export/rigid.h"
#include "app/recording/drawn.h"

namespace drape::app {
namespace {

constexpr auto little = std::endian::little;

// What a frame adds to the first, so that both together are nearest to what is meant in float32.
std::vector<Vec3> from(const std::vector<Vec3>& first, const std::vector<Vec3>& now) {
  std::vector<Vec3> difference(now.size());
  for (std::size_t i = 0; i < now.size(); ++i) difference[i] = now[i] - first[i].cast<float>().cast<double>();
  return difference;
}

struct Shape {
  std::size_t number = 0;  // in the recording
  TriangleMesh mesh;       // as it is drawn in the first frame
  Corners corners;
  std::optional<std::vector<RigidPlace>> places;  // of a body that moves as a whole
  bool morphs = false;
  int indices = 0, positions = 0, normals = 0, uv = -1;  // accessors
  std::vector<std::pair<int, int>> targets;  // positions and normals of each frame after the first
  int weights = -1, translations = -1, rotations = -1;
};

class GltfWriter {
 public:
  explicit GltfWriter(const ExportSource& source) : source_(source) {
    for (std::size_t s = 0; s < source.shape_count(); ++s) plan(s);
    plan_animation();
  }

  void write(AtomicFile& file, Names& notes) const {
    file.write(glb_start(compact_json_text(json()), buffer_.size(), file.path().string()));
    for (const Shape& shape : shapes_) {
      write_mesh(file, shape);
      const std::size_t own = shape.mesh.positions.size(), doubled = shape.corners.size() - own;
      if (doubled > 0)
        notes.push_back(source_.shape(shape.number).name + ": " +
                        counted(static_cast<long>(doubled), "double") +
                        " of vertices with several uv or normals, after the first " + std::to_string(own));
    }
    write_animation(file);
  }

 private:
  // Places of the mesh's vertices; those of a body that is moved by its node about its centre. Ropes are
  // tubes.
  std::vector<Vec3> positions(const Shape& shape, std::size_t k) const {
    std::vector<Vec3> x =
        DrawnShape(source_.shape(shape.number)).positions(source_.positions(shape.number, k));
    if (shape.places)
      for (Vec3& point : x) point -= shape.places->front().centre;
    return x;
  }

  void plan(std::size_t s) {
    Shape shape;
    shape.number = s;
    shape.mesh = source_.shape(s).mesh;
    if (const DrawnShape drawn(source_.shape(s)); drawn.is_tube())
      shape.mesh = {drawn.positions(source_.positions(s, 0)), drawn.triangles(), {}, nullptr};
    shape.corners = split_corners(shape.mesh, faces_of(shape.mesh), crease_of(source_.shape(s).body));
    const bool moves = source_.moves(s) && source_.frame_count() > 1;
    if (moves && source_.shape(s).body) shape.places = rigid_places(source_, s);
    shape.morphs = moves && !shape.places;
    const std::size_t vertices = shape.corners.size();
    shape.indices = buffer_.add(GltfUse::indices, 3 * shape.corners.triangles.size(), "SCALAR");
    const std::vector<Vec3> first = positions(shape, 0);
    shape.positions = add_positions(shape, first);
    shape.normals = buffer_.add(GltfUse::vertices, vertices, "VEC3");
    if (!shape.corners.uv.empty()) shape.uv = buffer_.add(GltfUse::vertices, vertices, "VEC2");
    for (std::size_t k = 1; shape.morphs && k < source_.frame_count(); ++k) {
      const int target = add_positions(shape, from(first, positions(shape, k)));
      shape.targets.emplace_back(target, buffer_.add(GltfUse::vertices, vertices, "VEC3"));
    }
    shapes_.push_back(std::move(shape));
  }

  int add_positions(const Shape& shape, const std::vector<Vec3>& x) {
    const int accessor = buffer_.add(GltfUse::vertices, shape.corners.size(), "VEC3");
    const Eigen::AlignedBox3f box = float_range(x);
    buffer_.set_range(accessor, {box.min()[0], box.min()[1], box.min()[2]},
                      {box.max()[0], box.max()[1], box.max()[2]});
    return accessor;
  }

  void plan_animation() {
    const std::size_t frames = source_.frame_count();
    for (Shape& shape : shapes_) {
      if (!shape.morphs && !shape.places) continue;
      if (times_ < 0) {
        times_ = buffer_.add(GltfUse::animation, frames, "SCALAR");
        buffer_.set_range(times_, {static_cast<float>(source_.time(0))},
                          {static_cast<float>(source_.time(frames - 1))});
      }
      if (shape.morphs) shape.weights = buffer_.add(GltfUse::animation, frames * (frames - 1), "SCALAR");
      if (!shape.places) continue;
      shape.translations = buffer_.add(GltfUse::animation, frames, "VEC3");
      shape.rotations = buffer_.add(GltfUse::animation, frames, "VEC4");
    }
  }

  Json json_of_mesh(const Shape& shape) const {
    Json::Members attributes{{"POSITION", shape.positions}, {"NORMAL", shape.normals}};
    if (shape.uv >= 0) attributes.emplace_back("TEXCOORD_0", shape.uv);
    Json::Members primitive{{"attributes", attributes},
                            {"indices", shape.indices},
                            {"material", source_.shape(shape.number).body ? 1 : 0}};
    Json::List targets;
    Names names;
    for (const auto& [position, normal] : shape.targets) {
      targets.push_back(Json::Members{{"POSITION", position}, {"NORMAL", normal}});
      names.push_back("frame " + std::to_string(source_.frames[targets.size()] + 1));
    }
    if (!targets.empty()) primitive.emplace_back("targets", targets);
    Json::Members members{{"name", source_.shape(shape.number).name}, {"primitives", Json::List{primitive}}};
    if (!targets.empty()) {
      members.emplace_back("weights", std::vector<double>(targets.size(), 0.0));
      members.emplace_back("extras", Json::Members{{"targetNames", names}});
    }
    return members;
  }

  Json json_of_node(std::size_t number) const {
    Json::Members node{{"name", source_.shape(number).name}, {"mesh", static_cast<long>(number)}};
    if (const auto& places = shapes_[number].places) {
      const Vec3& c = places->front().centre;
      node.emplace_back("translation", std::vector<double>{c[0], c[1], c[2]});
    }
    return node;
  }

  static Json material(const std::string& name, const std::vector<double>& color, double roughness) {
    return Json::Members{
        {"name", name},
        {"pbrMetallicRoughness",
         Json::Members{{"baseColorFactor", color}, {"metallicFactor", 0.0}, {"roughnessFactor", roughness}}},
        {"doubleSided", true}};
  }

  Json json_of_animation() const {
    Json::List channels, samplers;
    const auto add = [&](std::size_t node, int output, const char* path) {
      if (output < 0) return;
      channels.push_back(
          Json::Members{{"sampler", static_cast<long>(samplers.size())},
                        {"target", Json::Members{{"node", static_cast<long>(node)}, {"path", path}}}});
      samplers.push_back(Json::Members{{"input", times_}, {"interpolation", "LINEAR"}, {"output", output}});
    };
    for (std::size_t s = 0; s < shapes_.size(); ++s) {
      add(s, shapes_[s].weights, "weights");
      add(s, shapes_[s].translations, "translation");
      add(s, shapes_[s].rotations, "rotation");
    }
    return Json::Members{{"name", source_.name}, {"channels", channels}, {"samplers", samplers}};
  }

  Json json() const {
    Json::List meshes, nodes, roots;
    bool bodies = false;
    for (std::size_t s = 0; s < shapes_.size(); ++s) {
      meshes.push_back(json_of_mesh(shapes_[s]));
      nodes.push_back(json_of_node(s));
      roots.emplace_back(static_cast<long>(s));
      bodies = bodies || source_.shape(s).body;
    }
    Json::List materials{material("cloth", {0.35, 0.5, 0.75, 1}, 0.9)};
    if (bodies) materials.push_back(material("body", {0.7, 0.65, 0.6, 1}, 0.6));
    Json::Members all{{"asset", Json::Members{{"version", "2.0"}, {"generator", "drape " DRAPE_VERSION}}},
                      {"scene", 0},
                      {"scenes", Json::List{Json::Members{{"name", source_.name}, {"nodes", roots}}}},
                      {"nodes", nodes},
                      {"meshes", meshes},
                      {"materials", materials}};
    if (times_ >= 0) all.emplace_back("animations", Json::List{json_of_animation()});
    all.emplace_back("accessors", buffer_.accessors());
    all.emplace_back("bufferViews", buffer_.views());
    all.emplace_back("buffers", Json::List{Json::Members{{"byteLength", static_cast<long>(buffer_.size())}}});
    return all;
  }

  static void write_vectors(AtomicFile& file, const std::vector<Vec3>& vectors) {
    std::string bytes;
    append_floats<little>(bytes, vectors);
    file.write(bytes);
  }
  // Of the mesh's vertices, one for each of the file's.
  static void write_doubled(AtomicFile& file, const Shape& shape, const std::vector<Vec3>& vectors) {
    std::vector<Vec3> all;
    all.reserve(shape.corners.size());
    for (const int v : shape.corners.origin) all.push_back(vectors[v]);
    write_vectors(file, all);
  }

  // In the order of plan().
  void write_mesh(AtomicFile& file, const Shape& shape) const {
    std::string bytes;
    for (const Triangle& t : shape.corners.triangles)
      for (const int v : t) append_int<little>(bytes, v);
    file.write(bytes);
    const std::vector<Vec3> first = positions(shape, 0), first_normals = normals_of(shape.corners, first);
    write_doubled(file, shape, first);
    write_vectors(file, first_normals);
    bytes.clear();
    for (const Uv& uv : shape.corners.uv) {
      append_float<little>(bytes, uv[0]);
      append_float<little>(bytes, 1 - uv[1]);  // v goes down there
    }
    file.write(bytes);
    for (std::size_t k = 1; k <= shape.targets.size(); ++k) {
      const std::vector<Vec3> now = positions(shape, k);
      write_doubled(file, shape, from(first, now));
      write_vectors(file, from(first_normals, normals_of(shape.corners, now)));
    }
  }

  // In the order of plan_animation().
  void write_animation(AtomicFile& file) const {
    const std::size_t frames = source_.frame_count();
    std::string bytes;
    for (std::size_t k = 0; times_ >= 0 && k < frames; ++k) append_float<little>(bytes, source_.time(k));
    for (const Shape& shape : shapes_) {
      for (std::size_t k = 0; shape.morphs && k < frames; ++k) {
        for (std::size_t target = 1; target < frames; ++target) append_float<little>(bytes, target == k);
        file.write(bytes);
        bytes.clear();
      }
      if (!shape.places) continue;
      for (const RigidPlace& place : *shape.places) append_floats<little>(bytes, {place.centre});
      for (const RigidPlace& place : *shape.places)  // x y z w
        for (const double q : place.turn.coeffs()) append_float<little>(bytes, q);
    }
    file.write(bytes);
  }

  const ExportSource& source_;
  GltfBuffer buffer_;
  std::vector<Shape> shapes_;
  int times_ = -1;
};

}  // namespace

Names gltf_files(const ExportSource& source) { return {source.name + ".glb"}; }

void write_gltf(const ExportSource& source, ExportFiles& files, Names& notes) {
  const GltfWriter writer(source);
  writer.write(files.open(source.name + ".glb"), notes);
}

}  // namespace drape::app
