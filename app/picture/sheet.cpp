#include "app/picture/sheet.h"

#include <algorithm>
#include <cmath>

#include "app/picture/legend.h"
#include "app/picture/render.h"
#include "app/picture/text.h"
#include "mesh/base/errors.h"
#include "mesh/triangles/extent.h"

namespace drape::app::drawing {
namespace {

constexpr double around = 0.35;  // of the cloth's size: how much of a body is shown with it
constexpr double around_small = 1;
constexpr double air = 0.04;  // of a panel, left free on every side

double size_of(const Eigen::AlignedBox3d& box) { return box.isEmpty() ? 0 : box.diagonal().norm(); }

bool holds(const Eigen::AlignedBox3d& box, const Vec3& p, double reach) {
  return (p - box.min()).minCoeff() >= -reach && (box.max() - p).minCoeff() >= -reach;
}

// f(point) of what must be on the picture: the cloths, and what of bodies is near them. A body that is no
// larger than the cloths may be farther away.
template <class F>
void for_framed(const Still& still, bool whole, const F& f) {
  Eigen::AlignedBox3d cloths;
  for (const StillPart& part : still.parts)
    if (!part.body) cloths.extend(box_of(part.positions));
  const double size = size_of(cloths);
  for (const StillPart& part : still.parts) {
    const double reach = (size_of(box_of(part.positions)) <= size ? around_small : around) * size;
    for (const Vec3& p : part.positions)
      if (whole || cloths.isEmpty() || !part.body || holds(cloths, p, reach)) f(p);
  }
}

// The ends are round numbers; beyond them is at most one value of a hundred.
Scale scale_of(Field field, std::vector<float>& values) {
  if (const auto words = words_of(field); !words.empty())
    return {field, 0, static_cast<double>(words.size()) - 1};
  const std::size_t rank = values.size() * 99 / 100;
  for (float& value : values) value = std::abs(value);
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(rank), values.end());
  const double most = std::max<double>(values[rank], 1e-6);
  const double step = round_step(most, field == Field::strain ? 2 : 4);
  const double end = step * std::ceil(most / step - 1e-9);
  return {field, field == Field::strain ? -end : 0, end};
}

}  // namespace

Sheet::Sheet(const std::vector<SheetPanel>& all, std::size_t together, const SheetOptions& options)
    : options_(options), together_(together), labelled_(!all.front().label.empty()) {
  letters_ = std::clamp(static_cast<int>(std::sqrt(double(options.width) * options.height) / 50), 11, 80);
  if (options.field) legend_height_ = legend_lines * letters_;
  if (options.field && (options.width < 160 || options.height < 120))
    throw InputError("--size " + std::to_string(options.width) + "x" + std::to_string(options.height) +
                     ": too small for the legend of --color; give 160x120 or more");
  columns_ = std::max(1, options.columns);
  if (options.columns == 0 && together > 1) choose_columns(all);
  if (place(0).framed.height < 16 || place(0).framed.width < 16)
    throw InputError(std::to_string(together) + " pictures do not fit on one of " +
                     std::to_string(options.width) + "x" + std::to_string(options.height) +
                     " pixels; give a larger --size, or fewer in --frame");
  survey(all);
}

Sheet::Place Sheet::place(std::size_t k) const {
  const int rows = static_cast<int>((together_ + columns_ - 1) / static_cast<std::size_t>(columns_));
  const int column = static_cast<int>(k) % columns_, row = static_cast<int>(k) / columns_;
  const double height = options_.height - legend_height_;
  const int x0 = options_.width * column / columns_, x1 = options_.width * (column + 1) / columns_;
  const int y0 = static_cast<int>(height * row / rows), y1 = static_cast<int>(height * (row + 1) / rows);
  const double label = labelled_ ? 1.9 * letters_ : 0;
  Place place;
  place.panel = {double(x0), double(y0), double(x1 - x0), y1 - y0 - std::ceil(label)};
  const double rim = air * std::min(place.panel.width, place.panel.height);
  place.framed = {x0 + rim, y0 + rim, place.panel.width - 2 * rim, place.panel.height - 2 * rim};
  return place;
}

void Sheet::choose_columns(const std::vector<SheetPanel>& all) {
  const Camera axes = facing(options_.view);
  Eigen::AlignedBox2d box;
  for (const SheetPanel& panel : all)
    for_framed(panel.subject->still(panel.frame, {}), options_.whole,
               [&](const Vec3& p) { box.extend(Eigen::Vector2d(p.dot(axes.right), p.dot(axes.up))); });
  const Eigen::Array2d size = box.sizes().array().max(1e-9);
  double best = -1;
  int chosen = 1;
  for (columns_ = 1; columns_ <= static_cast<int>(together_); ++columns_) {
    const PixelBox framed = place(0).framed;
    const double scale = std::min(framed.width / size.x(), framed.height / size.y());
    if (scale > best * (1 + 1e-9)) best = scale, chosen = columns_;
  }
  columns_ = chosen;
}

void Sheet::survey(const std::vector<SheetPanel>& all) {
  Framing framing(options_.view, place(0).framed);
  std::vector<float> values;
  for (const SheetPanel& panel : all) {
    const Still still = panel.subject->still(panel.frame, options_.field);
    for_framed(still, options_.whole, [&](const Vec3& p) {
      framing.add(p);
      box_.extend(p);
    });
    for (const StillPart& part : still.parts)
      for (double value : part.values) {
        if (!std::isfinite(value)) continue;
        values.push_back(static_cast<float>(value));
        least_ = std::min(least_, value);
        largest_ = std::max(largest_, value);
      }
  }
  camera_ = framing.camera();
  if (!options_.field) return;
  if (values.empty()) values.push_back(0);
  scale_ = scale_of(*options_.field, values);
}

Image Sheet::draw(const std::vector<SheetPanel>& panels) const {
  Image image(options_.width, options_.height, background);
  const Place first = place(0);
  for (std::size_t k = 0; k < panels.size(); ++k) {
    if (!panels[k].subject) continue;
    const Place here = place(k);
    Camera camera = camera_;
    camera.middle_x += here.panel.x - first.panel.x;
    camera.middle_y += here.panel.y - first.panel.y;
    Look look;
    if (options_.field) look.scale = scale_;
    look.edges = options_.edges;
    look.size = std::max(size_of(box_), 1e-6);
    look.middle = box_.center();
    render(panels[k].subject->still(panels[k].frame, options_.field), camera, look, image, here.panel);
    draw_text(image, static_cast<int>(here.panel.x + here.panel.width / 2),
              static_cast<int>(here.panel.y + here.panel.height + 1.25 * letters_), panels[k].label, letters_,
              Anchor::middle, ink);
  }
  const PixelBox strip = {0, options_.height - legend_height_, double(options_.width), legend_height_};
  if (options_.field) draw_legend(image, strip, scale_, least_, largest_, letters_);
  return image;
}

}  // namespace drape::app::drawing
