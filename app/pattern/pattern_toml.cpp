// A sewing pattern as TOML: polygons with straight and curved sides. docs/patterns.md has an example.
#include "app/base/table.h"
#include "app/pattern/pattern_read.h"
#include "mesh/base/errors.h"

namespace drape::app {
namespace {

class PatternTable {
 public:
  PatternTable(const Node& root, KeyNotes* notes) : root_(root, "a pattern", notes), notes_(notes) {}

  Pattern read(const std::string& name) {
    Pattern pattern;
    pattern.where = name;
    root_.read("unit", unit_, dimension::length, Range::positive,
               {"of the lengths that are numbers", "none: every length names its unit"});
    for (Table& table : root_.tables("panel", "each a piece of cloth"))
      pattern.panels.push_back(read_panel(table));
    for (Table& table : root_.tables("seam", "each two curves that are sewn together")) {
      Names curves;
      bool same_way = false;
      table.read_required("curves", curves, "two, each PANEL.SIDE");
      table.read("same_way", same_way,
                 "the first points of both belong together; else the first and the last, outlines counting "
                 "counter-clockwise");
      table.finish();
      if (curves.size() != 2)
        table.fail("curves", "expected two curves, such as [\"front.left\", \"back.right\"]");
      pattern.seams.push_back({curves[0], curves[1], same_way, table.where()});
    }
    root_.finish();
    return pattern;
  }

 private:
  Panel read_panel(Table& table) {
    Panel panel;
    table.read_required("name", panel.name, "of the group of the mesh");
    Names sides;
    const Node* const outline = take_outline(table, sides);
    panel.outline = read_chain(outline, true, sides);
    panel.outline.where = table.where() + ": panel '" + panel.name + "'";
    if (const Node* holes = table.take("holes", "a list of outlines",
                                       "each a list of points, or a table of outline and sides")) {
      if (holes->kind != Node::Kind::array) table.fail("holes", "expected a list of outlines");
      for (const Node& hole : holes->items)
        panel.holes.push_back(hole.kind == Node::Kind::table ? read_named(hole, true)
                                                             : read_chain(&hole, true, {}));
    }
    for (Table& line : table.tables("line", "each a line along which the mesh has edges"))
      panel.lines.push_back(read_line(line));
    panel.grain = read_grain(table);
    table.finish();
    return panel;
  }

  static std::optional<Vec2> read_grain(Table& table) {
    const Node* const node = table.take("grain", "[x, y], two numbers",
                                        {"direction of the warp, for model = \"woven\"; the texture "
                                         "coordinates are turned so that it runs along v",
                                         "[0, 1]"});
    if (!node) return {};
    const bool two = node->kind == Node::Kind::array && node->items.size() == 2;
    if (!two) table.fail("grain", "expected a direction [x, y], such as [0, 1]");
    Vec2 grain;
    try {
      for (int i = 0; i < 2; ++i) grain[i] = quantity(node->items[i], dimension::number, Range::any);
    } catch (const InputError& error) {
      table.fail("grain", error.what());
    }
    if (!(grain.norm() > 0)) table.fail("grain", "a direction is not [0, 0]");
    return grain;
  }

  // { outline = [...], sides = [...] }
  Chain read_named(const Node& node, bool loop) {
    Table table(node, "a hole", notes_, "holes");
    Names sides;
    const Node* const outline = take_outline(table, sides);
    Chain chain = read_chain(outline, loop, sides);
    table.finish();
    return chain;
  }

  static const Node* take_outline(Table& table, Names& sides) {
    table.require("outline");
    const Node* const outline =
        table.take("outline", "a list of points",
                   "points [x, y], and between two of them how the way curves; closes by itself");
    table.read("sides", sides, "a name for each side, in order; equal names in a row are one curve");
    return outline;
  }

  Chain read_line(Table& table) {
    std::string name;
    table.read("name", name, "one word");
    table.require("points");
    Chain chain =
        read_chain(table.take("points", "a list of points", "as of an outline, but not closed"), false, {});
    if (name.find_first_of(" \t\r\n=:#\"") != name.npos)
      table.fail("name", "expected one word without = : #");
    std::fill(chain.names.begin(), chain.names.end(), name);
    table.finish();
    return chain;
  }

  [[noreturn]] static void fail(const Node& node, const std::string& what) {
    throw InputError(node.where + ": " + written(node) + ": " + what);
  }

  double length(const Node& node) const {
    if (node.kind == Node::Kind::text) return quantity(node, dimension::length, Range::any);
    if (!unit_)
      throw InputError("a number without a unit; write \"12 cm\", or unit = \"1 cm\" at the top of the file");
    return *unit_ * quantity(node, dimension::number, Range::any);
  }

  Vec2 read_point(const Node& node) const {
    try {
      if (node.kind != Node::Kind::array || node.items.size() != 2)
        throw InputError("expected a point [x, y]");
      return {length(node.items[0]), length(node.items[1])};
    } catch (const InputError& error) {
      fail(node, error.what());
    }
  }

  // Points; between two of them a table says how the way curves, else it is straight.
  Chain read_chain(const Node* node, bool loop, const Names& sides) const {
    Chain chain;
    chain.where = node->where;
    if (node->kind != Node::Kind::array || node->items.empty()) fail(*node, "expected a list of points");
    const std::vector<Node>& items = node->items;
    if (items.front().kind == Node::Kind::table) fail(items.front(), "a point must come first");
    const Vec2 first = read_point(items.front());
    Vec2 at = first;
    const Node* curve = nullptr;
    for (std::size_t i = 1; i <= items.size(); ++i) {
      if (i < items.size() && items[i].kind == Node::Kind::table) {
        if (curve) fail(items[i], "two curves without a point between them");
        curve = &items[i];
        continue;
      }
      if (i == items.size() && (!loop || (!curve && (at - first).norm() <= 1e-9))) break;
      const Vec2 next = i < items.size() ? read_point(items[i]) : first;
      chain.segments.push_back(curve ? read_curve(*curve, at, next) : line_segment(at, next));
      curve = nullptr, at = next;
    }
    if (curve) fail(*curve, "a curve must end at a point");
    if (loop) finish_loop(chain, true);
    if (chain.segments.empty()) fail(*node, "expected at least two points");
    name_segments(chain, sides, loop);
    return chain;
  }

  Segment read_curve(const Node& node, const Vec2& from, const Vec2& to) const {
    Table table(node, "a curve", notes_, "a curve");
    const Node* const bezier =
        table.take("bezier", "[[x, y]], or two points", "one or two control points; this or arc");
    const Node* const arc =
        table.take("arc", "a length", "radius of an arc of a circle; positive: turning left");
    const Node* const large = table.take("large", "true or false", {"the longer way round", "false"});
    table.finish();
    if ((bezier != nullptr) == (arc != nullptr))
      throw InputError(node.where +
                       ": a curve is { bezier = [[x, y]] }, with one or two points, or { arc = \"30 cm\" }");
    if (arc) {
      double radius = 0;  // positive: turning left, counter-clockwise
      try {
        radius = length(*arc);
      } catch (const InputError& error) {
        fail(*arc, error.what());
      }
      if (radius == 0 || (from - to).norm() > 2 * std::abs(radius) * (1 + 1e-9))
        fail(*arc, "an arc of this radius does not reach from one point to the other");
      if (large && large->kind != Node::Kind::boolean) fail(*large, "expected true or false");
      return arc_segment(from, to, radius, radius, 0, large && large->boolean, radius > 0);
    }
    if (bezier->kind != Node::Kind::array || bezier->items.empty() || bezier->items.size() > 2)
      fail(*bezier, "expected a list of one or two control points");
    const Vec2 p = read_point(bezier->items[0]);
    if (bezier->items.size() == 1) return quadratic_segment(from, p, to);
    return cubic_segment(from, p, read_point(bezier->items[1]), to);
  }

  Table root_;
  KeyNotes* notes_;
  std::optional<double> unit_;
};

}  // namespace

Pattern parse_toml_pattern(std::string_view text, const std::string& name, KeyNotes* notes) {
  const Node root = parse_toml(text, name);
  for (const char* key : {"simulation", "cloth", "obstacle"})
    if (const auto of_scene = root.members.find(key); of_scene != root.members.end())
      throw InputError(of_scene->second.where + ": '" + key +
                       "' belongs to a scene, but a pattern is expected here; `drape simulate` runs a scene");
  return PatternTable(root, notes).read(name);
}

}  // namespace drape::app
