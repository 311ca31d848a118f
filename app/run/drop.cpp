#include "app/run/drop.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "app/base/table.h"
#include "app/scene/load_mesh.h"
#include "app/scene/shape_table.h"
#include "app/simulation/parts.h"
#include "mesh/obj/examine.h"
#include "mesh/obj/obj.h"
#include "mesh/triangles/extent.h"

namespace drape::app {
namespace {

// Of the vertices that carry triangles: a stray one must not push the body away.
Eigen::AlignedBox3d extent_of(const TriangleMesh& mesh) { return box_of(mesh.positions, mesh.triangles); }

Node number(double value) { return Node::of_number(value, "--onto"); }
Node point(const Vec3& p) { return Node::of_list({number(p[0]), number(p[1]), number(p[2])}, "--onto"); }

// "box:1x0.5x1" -> box and its sizes [m].
struct ShapeWord {
  std::string shape;
  Sizes sizes;
};

ShapeWord parse_shape(const std::string& word) {
  const std::size_t colon = word.find(':');
  ShapeWord parsed{word.substr(0, colon), {}};
  if (colon == word.npos) return parsed;
  std::string rest = word.substr(colon + 1);
  for (std::size_t begin = 0; begin <= rest.size();) {
    const std::size_t end = std::min(rest.find('x', begin), rest.size());
    try {
      parsed.sizes.push_back(parse_quantity(rest.substr(begin, end - begin), dimension::length));
    } catch (const InputError& error) {
      throw InputError("--onto " + word + ": " + error.what());
    }
    if (!(parsed.sizes.back() > 0)) throw InputError("--onto " + word + ": a size is greater than zero");
    begin = end + 1;
  }
  return parsed;
}

// The member as a scene has it; a place goes with the shape.
template <class Kind>
void add_member(Node& table, const Field<Kind, double>& field, double value, const Vec3&) {
  table.members[field.key()] = number(value);
}
template <class Kind>
void add_member(Node& table, const Field<Kind, Vec3>& field, const Vec3& value, const Vec3& move) {
  table.members[field.key()] = point(field.measure == Measure::place ? Vec3(value + move) : value);
}
template <class Kind>
void add_member(Node&, const Field<Kind, Mat3>&, const Mat3&, const Vec3&) {}  // it stands unturned

// The shape with its top `gap` under `top`, the middle of the cloth's lowest height, as a scene has it.
// bottom: its lowest height.
template <class Kind>
Node below(Kind shape, const Vec3& top, double gap, double& bottom) {
  const Vec3 peak = top - gap * Vec3::UnitY();
  const Eigen::AlignedBox3d box = bounds_of(shape);
  const Vec3 move = peak - box.max().y() * Vec3::UnitY();
  bottom = std::isfinite(box.min().y()) ? peak.y() - box.sizes().y() : peak.y();
  Node table = Node::of_table("--onto");
  table.members["shape"] = Node::of_text(std::string(name(shape)), "--onto");
  for_each_field<Kind>([&](const auto& field) { add_member(table, field, shape.*field.member, move); });
  return table;
}

Node built_in(const std::string& word, const Vec3& top, double gap, double& bottom) {
  const ShapeWord wanted = parse_shape(word);
  std::optional<Node> made;
  Names known, examples;
  for_each_built_in([&]<class Kind>(const Kind& standard) {
    constexpr Onto onto = Described<Kind>::onto;
    known.emplace_back(name(standard));
    examples.push_back(onto.example);
    if (*onto.sizes) examples.back() += " (" + std::string(onto.sizes) + ")";
    if (wanted.shape != name(standard)) return;
    if (wanted.sizes.size() < onto.least || wanted.sizes.size() > onto.most)
      throw InputError("--onto " + word + ": expected " + wanted.shape +
                       (onto.most > 0 ? " with its size in m, such as " : " without a size: ") +
                       onto.example);
    made = below(Described<Kind>::of_sizes(wanted.sizes), top, gap, bottom);
  });
  if (!made)
    throw InputError("--onto " + word + ": there is no such file and no such shape; shapes are: " +
                     listed(known) + ", as " + listed(examples));
  return *made;
}

class DropScene {
 public:
  DropScene(const DropOptions& options, const std::vector<Setting>& settings, std::string label)
      : options_(options), settings_(settings), label_(std::move(label)) {}

  Scene make() {
    add_simulation();
    add_cloth();
    if (!options_.onto.empty() || options_.floor)
      add_bodies();
    else if (options_.friction || options_.margin)
      throw InputError(std::string(options_.friction ? "--friction" : "--margin") +
                       ": there is nothing to touch; give --onto or --floor, too");
    return read_scene(root_, settings_, {}, label_);
  }

 private:
  void add_simulation() {
    Node simulation = Node::of_table("drape drop");
    simulation.members["duration"] = Node::of_text("3 s", "drape drop");
    // A drape wants no more: a ten-thousandth of the cloth's weight.
    simulation.members["tolerance"] = Node::of_number(1e-4, "drape drop");
    simulation.members["stop_when_settled"] = parse_toml_value("true", "drape drop");
    root_.members["simulation"] = std::move(simulation);
  }

  void add_cloth() {
    Node cloth = Node::of_table("drape drop");
    cloth.members["mesh"] = Node::of_text(options_.cloth.string(), "drape drop");
    const bool by_default = options_.fabric == DropOptions().fabric;  // which a setting may change
    cloth.members["fabric"] = Node::of_text(options_.fabric, by_default ? "drape drop" : "--fabric");
    cloth.members["self_contact"] = parse_toml_value("true", "drape drop");
    if (options_.scale) cloth.members["scale"] = parse_toml_value(*options_.scale, "--scale");
    Node pins = Node::of_list({}, "--pin");
    for (const std::string& group : options_.pinned_groups) {
      pins.items.push_back(Node::of_table("--pin"));
      pins.items.back().members["group"] = Node::of_text(group, "--pin");
    }
    if (!pins.items.empty()) cloth.members["pins"] = std::move(pins);
    root_.members["cloth"] = Node::of_list({std::move(cloth)}, "drape drop");
  }

  // What the cloth looks like after all settings: it decides where a body stands.
  TriangleMesh cloth_mesh() const {
    std::vector<Setting> of_cloth;
    for (const Setting& setting : settings_)
      if (!setting.path.starts_with("obstacle")) of_cloth.push_back(setting);
    const Scene scene = read_scene(root_, of_cloth, {}, label_);
    Names told_later;
    return load_cloth(scene.cloths.front(), told_later).mesh;
  }

  void add_bodies() {
    constexpr double fall = 0.5;  // m, to the floor, when there is no body
    const TriangleMesh mesh = cloth_mesh();
    const Eigen::AlignedBox3d cloth = extent_of(mesh);
    // Contact holds vertices; the straight edges between them must clear a curved body, the longer the edges
    // the farther.
    double margin = std::max(Obstacle().margin, examine(mesh).median_edge / 5);
    if (options_.margin) {
      Node given = Node::of_table("--margin");
      given.members["margin"] = parse_toml_value(*options_.margin, "--margin");
      Table(given, "--margin")
          .read("margin", margin, dimension::length, Range::any, "distance that the cloth keeps");
    }
    const Vec3 under(cloth.center()[0], cloth.min()[1], cloth.center()[2]);
    double bottom = under[1] - fall;
    Node list = Node::of_list({}, "drape drop");
    if (!options_.onto.empty()) list.items.push_back(body(under, margin, bottom));
    if (options_.floor) {
      Node floor = Node::of_table("--floor");
      floor.members["shape"] = Node::of_text("plane", "--floor");
      floor.members["name"] = Node::of_text("floor", "--floor");
      floor.members["point"] = point({0, bottom, 0});
      list.items.push_back(std::move(floor));
    }
    for (Node& obstacle : list.items) {
      if (options_.friction)
        obstacle.members["friction"] = parse_toml_value(*options_.friction, "--friction");
      obstacle.members["margin"] =
          options_.margin ? parse_toml_value(*options_.margin, "--margin") : number(margin);
    }
    root_.members["obstacle"] = std::move(list);
  }

  Node body(const Vec3& under, double margin, double& bottom) const {
    const bool looks_like_file = options_.onto.ends_with(".obj") || options_.onto.ends_with(".OBJ");
    if (!looks_like_file && !std::filesystem::exists(options_.onto)) {
      return built_in(options_.onto, under, 2 * margin, bottom);
    }
    Node mesh = Node::of_table("--onto");
    mesh.members["shape"] = Node::of_text("mesh", "--onto");
    mesh.members["mesh"] = Node::of_text(options_.onto, "--onto");
    if (options_.scale) mesh.members["scale"] = parse_toml_value(*options_.scale, "--scale");
    if (options_.floor) {
      Placement placement;
      if (options_.scale)
        placement.scale =
            quantity(parse_toml_value(*options_.scale, "--scale"), dimension::number, Range::positive);
      bottom = extent_of(placed(read_obj(options_.onto), placement, options_.onto)).min()[1];
    }
    return mesh;
  }

  const DropOptions& options_;
  const std::vector<Setting>& settings_;
  std::string label_;
  Node root_ = Node::of_table("drape drop");
};

}  // namespace

std::string onto_examples() {
  Names examples;
  for_each_built_in([&]<class Kind>(const Kind&) { examples.emplace_back(Described<Kind>::onto.example); });
  return listed(examples);
}

Scene drop_scene(const DropOptions& options, const std::vector<Setting>& settings, const std::string& label) {
  return DropScene(options, settings, label).make();
}

}  // namespace drape::app
