// A sewing pattern drawn as SVG. The only door to pugixml.
//   Scale: width="60cm" viewBox="0 0 600 800": the document says how long a unit of the drawing is.
//   Up: y of the drawing points down, y of the pattern up; x and the sizes stay.
#include <Eigen/LU>
#include <algorithm>
#include <cctype>
#include <cmath>
#include <pugixml.hpp>
#include <set>
#include <sstream>

#include "app/base/units.h"
#include "app/pattern/pattern_read.h"
#include "app/pattern/svg_values.h"
#include "mesh/base/errors.h"

namespace drape::app {
namespace {

using Affine = Eigen::Matrix<double, 2, 3>;

Affine operator_product(const Affine& a, const Affine& b) {
  Affine c;
  c.leftCols<2>() = a.leftCols<2>() * b.leftCols<2>();
  c.col(2) = a.leftCols<2>() * b.col(2) + a.col(2);
  return c;
}

Names words(const std::string& text) {
  std::istringstream stream(text);
  Names found;
  for (std::string word; stream >> word;) found.push_back(word);
  return found;
}

std::string in_quotes(const std::string& text) { return "'" + text + "'"; }

class SvgReader {
 public:
  SvgReader(std::string_view text, std::string name, Names& notes)
      : text_(text), name_(std::move(name)), notes_(notes) {}

  Pattern read() {
    pugi::xml_document document;
    const pugi::xml_parse_result result = document.load_buffer(text_.data(), text_.size());
    if (!result) throw InputError(at(result.offset) + ": is not XML: " + result.description());
    const pugi::xml_node root = document.document_element();
    if (local(root) != "svg")
      throw InputError(at(root) + ": is not an SVG drawing: it begins with <" + std::string(root.name()) +
                       ">");
    walk_children(root, document_map(root), 0);
    pattern_.where = name_;
    sort_shapes();
    for (const std::string& seam : words(root.attribute("data-seams").value()))
      pattern_.seams.push_back(parse_seam(seam, at(root) + ": data-seams"));
    return std::move(pattern_);
  }

 private:
  struct Shape {  // a subpath of an element
    std::string name;
    Chain chain;
    bool closed = false;
    bool grain = false;  // the line says where the warp runs, and is no line of the mesh
    double area = 0;
    std::vector<Vec2> corners;  // of the loop as a polygon, to see what is in what
  };

  std::string at(std::ptrdiff_t offset) const {
    const auto end =
        text_.begin() + std::clamp<std::ptrdiff_t>(offset, 0, static_cast<std::ptrdiff_t>(text_.size()));
    return name_ + ":" + std::to_string(1 + std::count(text_.begin(), end, '\n'));
  }
  std::string at(const pugi::xml_node& node) const { return at(node.offset_debug()); }

  static std::string local(const pugi::xml_node& node) {
    const std::string name = node.name();
    return name.substr(name.find(':') == name.npos ? 0 : name.find(':') + 1);
  }

  double page_length(const pugi::xml_node& root, const char* key) const {
    const std::string text = root.attribute(key).value();
    const std::string advice =
        "; write the size of the page, such as width=\"60cm\" height=\"80cm\" with "
        "viewBox=\"0 0 600 800\" for a drawing in mm";
    const std::size_t unit = text.find_last_of("0123456789.");
    if (text.empty()) throw InputError(at(root) + ": the drawing has no " + key + advice);
    const std::string suffix = unit == text.npos ? text : text.substr(unit + 1);
    if (suffix != "mm" && suffix != "cm" && suffix != "in" && suffix != "m" && suffix != "pt" &&
        suffix != "pc")
      throw InputError(at(root) + ": " + key + "=\"" + text + "\" has no unit of length" + advice);
    std::string number = text.substr(0, unit + 1);
    double scale = 1;  // points and picas are of print
    if (suffix == "pt") scale = 0.0254 / 72;
    if (suffix == "pc") scale = 0.0254 / 6;
    const double length = scale == 1 ? parse_quantity(number + " " + suffix, dimension::length)
                                     : scale * parse_quantity(number, dimension::number);
    if (!(length > 0)) throw InputError(at(root) + ": " + key + "=\"" + text + "\" is not greater than zero");
    return length;
  }

  // From the units of the drawing to metres, y up, the lower left corner of the page at the origin.
  Affine document_map(const pugi::xml_node& root) const {
    const double width = page_length(root, "width"), height = page_length(root, "height");
    std::string box_text = root.attribute("viewBox").value();
    std::replace(box_text.begin(), box_text.end(), ',', ' ');
    const Names box = words(box_text);
    double b[4] = {0, 0, 0, 0};
    if (box.size() != 4)
      throw InputError(at(root) +
                       ": the drawing has no viewBox of four numbers; write viewBox=\"0 0 WIDTH HEIGHT\" in "
                       "the units of the drawing, such as \"0 0 600 800\"");
    for (std::size_t i = 0; i < 4; ++i) {
      try {
        b[i] = parse_quantity(box[i], dimension::number);
      } catch (const InputError&) {
        throw InputError(at(root) + ": viewBox: " + in_quotes(box[i]) + " is not a number");
      }
    }
    if (!(b[2] > 0 && b[3] > 0))
      throw InputError(at(root) + ": viewBox: its width and height must be greater than zero");
    const double sx = width / b[2], sy = height / b[3];
    if (std::abs(sx - sy) > 1e-3 * sx)
      throw InputError(at(root) + ": a unit of the drawing is " + rounded(1000 * sx, 6) + " mm across and " +
                       rounded(1000 * sy, 6) + " mm down; make width, height and viewBox agree");
    Affine map;
    map << sx, 0, -sx * b[0], 0, -sx, sx * (b[1] + b[3]);
    return map;
  }

  void walk_children(const pugi::xml_node& parent, const Affine& map, int depth) {
    if (depth > kDeepest)
      throw InputError(at(parent) + ": more than " + std::to_string(kDeepest) +
                       " groups in one another; ungroup the drawing");
    for (const pugi::xml_node& node : parent.children())
      if (node.type() == pugi::node_element) walk(node, map, depth);
  }

  // What is not shown: display="none", or style="display:none", which counts more.
  static bool hidden(const pugi::xml_node& node) {
    std::string display = node.attribute("display").value();
    std::string style = node.attribute("style").value();
    std::erase_if(style, [](char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; });
    std::istringstream declarations(style);
    for (std::string text; std::getline(declarations, text, ';');)
      if (text.starts_with("display:")) display = text.substr(8);
    return display.substr(0, display.find('!')) == "none";  // without !important
  }

  void walk(const pugi::xml_node& node, const Affine& outer, int depth) {
    const std::string kind = local(node);
    static const std::set<std::string> silent = {
        "defs",   "metadata", "namedview", "title", "desc",   "style",          "symbol",
        "marker", "clipPath", "pattern",   "mask",  "filter", "linearGradient", "radialGradient"};
    if (hidden(node)) return;
    if (silent.contains(kind)) return;
    if (kind == "script" || kind == "text" || kind == "use" || kind == "image" || kind == "switch" ||
        kind == "foreignObject" || kind == "svg") {
      notes_.push_back(at(node) + ": <" + kind + "> is passed over" +
                       (kind == "use" ? "; unlink the clone to have its paths" : ""));
      return;
    }
    Affine map = outer;
    try {
      map = operator_product(outer, parse_svg_transform(node.attribute("transform").value()));
    } catch (const InputError& error) {
      throw InputError(at(node) + ": " + error.what());
    }
    if (kind == "g" || kind == "a") return walk_children(node, map, depth + 1);
    const std::string d = path_data(node, kind);
    if (d.empty()) {
      if (kind == "path") throw InputError(at(node) + ": a path without 'd'");
      notes_.push_back(at(node) + ": <" + kind + "> is passed over");
      return;
    }
    take(node, kind, d, map);
  }

  double number(const pugi::xml_node& node, const char* key) const {
    const std::string text = node.attribute(key).value();
    if (text.empty()) return 0;
    try {
      if (text.find('%') != text.npos) throw InputError("a share of the page");
      return parse_quantity(text, dimension::number);
    } catch (const InputError&) {
      throw InputError(at(node) + ": " + key + "=\"" + text +
                       "\": expected a number, in the units of the drawing");
    }
  }

  // Basic shapes as paths, drawn as SVG 1.1, chapter 9, says; empty for what is no shape.
  std::string path_data(const pugi::xml_node& node, const std::string& kind) const {
    const auto n = [&](const char* key) { return number(node, key); };
    const auto s = [](double x) { return shortest(x) + " "; };
    if (kind == "path") return node.attribute("d").value();
    if (kind == "polygon" || kind == "polyline") {
      const std::string points = node.attribute("points").value();
      if (points.empty()) throw InputError(at(node) + ": <" + kind + "> has no points");
      return "M " + points + (kind == "polygon" ? " z" : "");
    }
    if (kind == "line") return "M " + s(n("x1")) + s(n("y1")) + "L " + s(n("x2")) + s(n("y2"));
    if (kind == "rect") {
      if (n("rx") != 0 || n("ry") != 0)
        throw InputError(at(node) + ": a <rect> with round corners; make it a path");
      if (!(n("width") > 0 && n("height") > 0))
        throw InputError(at(node) + ": a <rect> needs a width and a height greater than zero");
      return "M " + s(n("x")) + s(n("y")) + "h " + s(n("width")) + "v " + s(n("height")) + "h " +
             s(-n("width")) + "z";
    }
    if (kind == "circle" || kind == "ellipse") {
      const double rx = n(kind == "circle" ? "r" : "rx"), ry = n(kind == "circle" ? "r" : "ry");
      if (!(rx > 0 && ry > 0))
        throw InputError(at(node) + ": a <" + kind + "> needs a radius greater than zero");
      const std::string arc = "a " + s(rx) + s(ry) + "0 0 1 ";
      return "M " + s(n("cx") + rx) + s(n("cy")) + arc + s(-rx) + s(ry) + arc + s(-rx) + s(-ry) + arc +
             s(rx) + s(-ry) + arc + s(rx) + s(ry) + "z";
    }
    return {};
  }

  void take(const pugi::xml_node& node, const std::string& kind, const std::string& d, const Affine& map) {
    std::string name = node.attribute("id").value();
    std::vector<SvgPath> paths;
    try {
      paths = parse_svg_path(d);
    } catch (const InputError& error) {
      throw InputError(at(node) + ": <" + kind + ">: " + error.what());
    }
    if (paths.empty()) throw InputError(at(node) + ": <" + kind + "> draws nothing");
    const bool grain = is_grain(node) && std::none_of(paths.begin(), paths.end(),
                                                      [](const SvgPath& path) { return path.closed; });
    if (grain) keep_longest(paths);
    const Names sides = words(node.attribute("data-sides").value());
    std::size_t used = 0;
    for (std::size_t i = 0; i < paths.size(); ++i) {
      Shape shape;
      shape.name = name, shape.closed = paths[i].closed, shape.grain = grain;
      shape.chain.where = at(node) + ": " + kind + (name.empty() ? "" : " " + in_quotes(name));
      for (const Segment& s : paths[i].segments)
        shape.chain.segments.push_back(mapped(s, map.leftCols<2>(), map.col(2)));
      std::vector<Segment>& drawn = shape.chain.segments;
      const double gap = (drawn.back().end - drawn.front().start).norm();
      if (grain && gap <= 1e-6)
        throw InputError(shape.chain.where +
                         ": a grain line goes from one end to another, and this one ends where it starts");
      if (!shape.closed && drawn.size() > 1 && gap <= 1e-6)
        shape.closed = true;  // m: drawn back to its start
      if (shape.closed) finish_loop(shape.chain, true);
      const std::size_t count = std::min(drawn.size(), sides.size() - used);
      const bool last = i + 1 == paths.size();
      const Names own(sides.begin() + static_cast<std::ptrdiff_t>(used),
                      last ? sides.end() : sides.begin() + static_cast<std::ptrdiff_t>(used + count));
      used += count;
      name_segments(shape.chain, own, shape.closed);
      if (shape.closed) outline(shape);
      shapes_.push_back(std::move(shape));
    }
  }

  // An id, a class or a label that begins with "grain", as in "Grainline" and "grain-front"; also behind the
  // name of a panel: "front.grain".
  static bool is_grain(const pugi::xml_node& node) {
    Names names = words(node.attribute("class").value());
    for (const char* key : {"id", "label", "inkscape:label"}) names.emplace_back(node.attribute(key).value());
    return std::any_of(names.begin(), names.end(), [](std::string name) {
      std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return std::tolower(c); });
      const std::size_t dot = name.rfind('.');
      return name.starts_with("grain") || (dot != name.npos && name.substr(dot + 1).starts_with("grain"));
    });
  }

  // The others are heads of its arrow.
  static void keep_longest(std::vector<SvgPath>& paths) {
    const auto reach = [](const SvgPath& path) {
      return (path.segments.back().end - path.segments.front().start).norm();
    };
    const auto longest = std::max_element(
        paths.begin(), paths.end(), [&](const SvgPath& a, const SvgPath& b) { return reach(a) < reach(b); });
    paths = {*longest};
  }

  static void outline(Shape& shape) {
    for (const Segment& s : shape.chain.segments)
      for (int i = 0; i < 32; ++i) shape.corners.push_back(point(s, i / 32.0));
    shape.area = std::abs(enclosed_area(shape.chain));
  }

  static bool holds(const Shape& shape, const Vec2& x) {
    bool inside = false;
    for (std::size_t i = 0; i < shape.corners.size(); ++i) {
      const Vec2 &a = shape.corners[i], &b = shape.corners[(i + 1) % shape.corners.size()];
      if ((a.y() > x.y()) == (b.y() > x.y())) continue;
      if (a.x() + (x.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x()) > x.x()) inside = !inside;
    }
    return inside;
  }

  // The smallest closed shape around most of a chain; -1: none.
  int around(std::size_t k) const {
    int best = -1;
    for (std::size_t i = 0; i < shapes_.size(); ++i) {
      if (i == k || !shapes_[i].closed || (shapes_[k].closed && shapes_[i].area <= shapes_[k].area)) continue;
      int in = 0, out = 0;
      for (const Segment& s : shapes_[k].chain.segments)
        for (const double t : {0.17, 0.5, 0.83}) ++(holds(shapes_[i], point(s, t)) ? in : out);
      if (in > out && (best < 0 || shapes_[i].area < shapes_[best].area)) best = static_cast<int>(i);
    }
    return best;
  }

  // Closed shapes in nothing are panels, those in a panel are holes, those in a hole are panels, and so on.
  void sort_shapes() {
    std::vector<int> parent(shapes_.size()), panel_of(shapes_.size(), -1);
    for (std::size_t k = 0; k < shapes_.size(); ++k) parent[k] = around(k);
    const auto depth = [&](std::size_t k) {
      int d = 0;
      for (int p = parent[k]; p >= 0; p = parent[p]) ++d;
      return d;
    };
    for (std::size_t k = 0; k < shapes_.size(); ++k) {
      if (!shapes_[k].closed || depth(k) % 2 != 0) continue;
      std::string name = shapes_[k].name;
      if (name.empty()) name = "panel-" + std::to_string(pattern_.panels.size() + 1);
      panel_of[k] = static_cast<int>(pattern_.panels.size());
      pattern_.panels.push_back({name, shapes_[k].chain, {}, {}});
    }
    for (std::size_t k = 0; k < shapes_.size(); ++k) {
      if (panel_of[k] >= 0) continue;
      Shape& shape = shapes_[k];
      const int owner = parent[k] < 0 ? -1 : panel_of[parent[k]];
      if (owner < 0)
        throw InputError(shape.chain.where +
                         (shape.grain    ? ": this grain line is in no panel"
                          : shape.closed ? ": this hole is in no panel"
                                         : ": this path is open and in no panel; close it (z), or draw "
                                           "it inside a panel as a line"));
      Panel& panel = pattern_.panels[owner];
      if (shape.grain) {
        if (panel.grain)
          throw InputError(shape.chain.where + ": panel '" + panel.name + "' has another grain line");
        panel.grain = shape.chain.segments.back().end - shape.chain.segments.front().start;
        continue;
      }
      if (!shape.closed) name_line(shape);
      (shape.closed ? panel.holes : panel.lines).push_back(shape.chain);
    }
  }

  // A line without side names has its own.
  static void name_line(Shape& shape) {
    const bool named = std::any_of(shape.chain.names.begin(), shape.chain.names.end(),
                                   [](const std::string& n) { return !n.empty(); });
    if (!named) std::fill(shape.chain.names.begin(), shape.chain.names.end(), shape.name);
  }

  static constexpr int kDeepest = 1000;  // groups in groups

  std::string_view text_;
  std::string name_;
  Names& notes_;
  Pattern pattern_;
  std::vector<Shape> shapes_;
};

}  // namespace

Pattern parse_svg_pattern(std::string_view text, const std::string& name, Names& notes) {
  return SvgReader(text, name, notes).read();
}

}  // namespace drape::app
