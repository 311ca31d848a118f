#include "app/pattern/svg_values.h"

#include <numbers>
#include <svgpp/adapter/path.hpp>
#include <svgpp/parser/path_data.hpp>
#include <svgpp/parser/transform_list.hpp>
#include <svgpp/policy/path.hpp>

#include "mesh/base/errors.h"

namespace drape::app {
namespace {

// Takes what svgpp reads: absolute coordinates, shorthands written out, arcs as arcs.
class PathTaker {
 public:
  using Absolute = svgpp::tag::coordinate::absolute;

  void path_move_to(double x, double y, const Absolute&) {
    start_ = at_ = Vec2(x, y);
    paths_.emplace_back();
  }
  void path_line_to(double x, double y, const Absolute&) { take(line_segment(at_, Vec2(x, y))); }
  void path_cubic_bezier_to(double x1, double y1, double x2, double y2, double x, double y, const Absolute&) {
    take(cubic_segment(at_, Vec2(x1, y1), Vec2(x2, y2), Vec2(x, y)));
  }
  void path_quadratic_bezier_to(double x1, double y1, double x, double y, const Absolute&) {
    take(quadratic_segment(at_, Vec2(x1, y1), Vec2(x, y)));
  }
  void path_elliptical_arc_to(double rx, double ry, double turn, bool large, bool sweep, double x, double y,
                              const Absolute&) {
    take(arc_segment(at_, Vec2(x, y), rx, ry, turn * std::numbers::pi / 180, large, sweep));
  }
  void path_close_subpath() {
    if (paths_.empty()) return;
    paths_.back().closed = true;
    at_ = start_;
    fresh_ = true;
  }
  void path_exit() {}

  std::vector<SvgPath> paths() && {
    std::erase_if(paths_, [](const SvgPath& path) { return path.segments.empty(); });
    return std::move(paths_);
  }

 private:
  void take(const Segment& segment) {
    if (paths_.empty() || (fresh_ && paths_.back().closed)) paths_.emplace_back();  // after 'z' without 'm'
    fresh_ = false;
    at_ = segment.end;
    if (!is_point(segment)) paths_.back().segments.push_back(segment);
  }

  std::vector<SvgPath> paths_;
  Vec2 start_ = Vec2::Zero(), at_ = Vec2::Zero();
  bool fresh_ = false;
};

struct TransformTaker {
  Eigen::Matrix<double, 2, 3> matrix;
  void transform_matrix(const boost::array<double, 6>& m) { matrix << m[0], m[2], m[4], m[1], m[3], m[5]; }
};

[[noreturn]] void fail(const std::string& what, const std::string& text) {
  throw InputError(what + " cannot be read: '" + text.substr(0, 60) + (text.size() > 60 ? "...'" : "'"));
}

}  // namespace

std::vector<SvgPath> parse_svg_path(const std::string& d) {
  PathTaker taker;
  using Parser = svgpp::value_parser<svgpp::tag::type::path_data,
                                     svgpp::path_policy<svgpp::policy::path::no_shorthands>>;
  bool good = false;
  try {
    good = Parser::parse(svgpp::tag::attribute::d(), taker, d, svgpp::tag::source::attribute());
  } catch (const std::exception&) {  // svgpp's own, without the place
  }
  if (!good) fail("the path", d);
  return std::move(taker).paths();
}

Eigen::Matrix<double, 2, 3> parse_svg_transform(const std::string& text) {
  TransformTaker taker{Eigen::Matrix<double, 2, 3>::Identity()};
  if (text.find_first_not_of(" \t\r\n") == text.npos) return taker.matrix;
  bool good = false;
  try {
    good = svgpp::value_parser<svgpp::tag::type::transform_list>::parse(
        svgpp::tag::attribute::transform(), taker, text, svgpp::tag::source::attribute());
  } catch (const std::exception&) {
  }
  if (!good) fail("the transform", text);
  return taker.matrix;
}

}  // namespace drape::app
