#include "app/compare/plot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>

#include "app/base/markup.h"
#include "app/base/words.h"

namespace drape {
namespace {

constexpr double left = 80, top = 34, inner_width = 430, inner_height = 290, width = 710, height = 380;

// Okabe & Ito's colours, those that are legible on white and on black.
constexpr std::array<const char*, 7> colours = {"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                                "#e69f00", "#56b4e9", "#999999"};

std::size_t look_of(const Series& series, std::size_t place) {
  return series.look < 0 ? place : static_cast<std::size_t>(series.look);
}

std::string colour_of(const Series& series, std::size_t place) {
  return series.dashed ? "currentColor" : colours[look_of(series, place) % colours.size()];
}

struct Tick {
  double value;
  std::string text;  // empty: a small one
};

// From data to pixels along one axis.
class Axis {
 public:
  Axis(bool logarithmic, double low, double high, double start, double length)
      : logarithmic_(logarithmic), start_(start), length_(length) {
    if (logarithmic_) {
      low_ = std::floor(std::log10(low) + 1e-9);
      high_ = std::max(std::ceil(std::log10(high) - 1e-9), low_ + 1);
    } else {
      const double margin = high > low ? 0 : std::max(1.0, std::abs(high));
      low_ = low - margin;
      high_ = high + margin;
    }
  }

  double operator()(double value) const {
    return start_ + length_ * ((logarithmic_ ? std::log10(value) : value) - low_) / (high_ - low_);
  }

  std::vector<Tick> ticks() const { return logarithmic_ ? log_ticks() : linear_ticks(); }

 private:
  std::vector<Tick> log_ticks() const {
    std::vector<Tick> all;
    const int every = static_cast<int>(std::ceil((high_ - low_) / 8));
    for (double e = low_; e <= high_; ++e) {
      const bool named = static_cast<int>(e - low_) % every == 0;
      all.push_back({std::pow(10, e), named ? rounded(std::pow(10, e), 6) : ""});
      if (high_ - low_ > 4 || e == high_) continue;
      for (const int k : {2, 5}) {
        const double value = k * std::pow(10, e);
        all.push_back({value, high_ - low_ <= 2 ? rounded(value, 6) : ""});
      }
    }
    return all;
  }

  std::vector<Tick> linear_ticks() const {
    const double rough = (high_ - low_) / 6, power = std::pow(10, std::floor(std::log10(rough)));
    const double step = power * (rough / power > 5 ? 10 : rough / power > 2 ? 5 : rough / power > 1 ? 2 : 1);
    std::vector<Tick> all;
    for (double k = std::ceil(low_ / step - 1e-9); k * step <= high_ * (1 + 1e-9); ++k)
      all.push_back({k * step, rounded(k == 0 ? 0 : k * step, 6)});
    return all;
  }

  bool logarithmic_;
  double low_, high_, start_, length_;
};

bool visible(const Plot& plot, double x, double y) {
  return std::isfinite(x) && std::isfinite(y) && (!plot.log_x || x > 0) && (!plot.log_y || y > 0);
}

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f", value);
  return text;
}

std::string text_at(double x, double y, const std::string& anchor, const std::string& text,
                    const std::string& more = "") {
  return "<text x=\"" + number(x) + "\" y=\"" + number(y) + "\" text-anchor=\"" + anchor + "\"" + more + ">" +
         escaped(text) + "</text>\n";
}

std::string line(double x1, double y1, double x2, double y2, double opacity) {
  return "<line x1=\"" + number(x1) + "\" y1=\"" + number(y1) + "\" x2=\"" + number(x2) + "\" y2=\"" +
         number(y2) + "\" stroke=\"currentColor\" stroke-opacity=\"" + rounded(opacity, 2) + "\"/>\n";
}

// Circle, square, triangle, diamond, in turn.
std::string marker(std::size_t series, double x, double y, const std::string& colour) {
  const std::string fill = "\" fill=\"" + colour + "\"/>";
  const auto point = [](double px, double py) { return number(px) + "," + number(py) + " "; };
  switch (series % 4) {
    case 0:
      return "<circle r=\"3.5\" cx=\"" + number(x) + "\" cy=\"" + number(y) + fill;
    case 1:
      return "<polygon points=\"" + point(x - 3.5, y - 3.5) + point(x + 3.5, y - 3.5) +
             point(x + 3.5, y + 3.5) + point(x - 3.5, y + 3.5) + fill;
    case 2:
      return "<polygon points=\"" + point(x, y - 4.5) + point(x + 4.5, y + 3.5) + point(x - 4.5, y + 3.5) +
             fill;
    default:
      return "<polygon points=\"" + point(x, y - 5) + point(x + 5, y) + point(x, y + 5) + point(x - 5, y) +
             fill;
  }
}

std::string axes(const Plot& plot, const Axis& x, const Axis& y) {
  const double bottom = top + inner_height;
  std::string text;
  for (const Tick& t : x.ticks()) {
    text += line(x(t.value), top, x(t.value), bottom, t.text.empty() ? 0.08 : 0.2);
    text += text_at(x(t.value), bottom + 17, "middle", t.text);
  }
  for (const Tick& t : y.ticks()) {
    text += line(left, y(t.value), left + inner_width, y(t.value), t.text.empty() ? 0.08 : 0.2);
    text += text_at(left - 7, y(t.value) + 4, "end", t.text);
  }
  text += line(left, bottom, left + inner_width, bottom, 0.8) + line(left, top, left, bottom, 0.8);
  text += text_at(left + inner_width / 2, height - 12, "middle", plot.x_label);
  const std::string turn = " transform=\"rotate(-90 14 " + number(top + inner_height / 2) + ")\"";
  return text + text_at(14, top + inner_height / 2, "middle", plot.y_label, turn);
}

std::string drawn(const Plot& plot, std::size_t k, const Axis& x, const Axis& y) {
  const Series& series = plot.series[k];
  const std::string colour = colour_of(series, k);
  std::string points, marks;
  for (std::size_t i = 0; i < series.x.size(); ++i) {
    if (!visible(plot, series.x[i], series.y[i])) continue;
    points += number(x(series.x[i])) + "," + number(y(series.y[i])) + " ";
    if (series.every > 0 && i % static_cast<std::size_t>(series.every) == 0)
      marks += marker(look_of(series, k), x(series.x[i]), y(series.y[i]), colour) + "\n";
  }
  std::string text;
  if (series.line)
    text = "<polyline fill=\"none\" stroke-width=\"1.8\" stroke=\"" + colour + "\"" +
           (series.dashed ? " stroke-dasharray=\"5 4\"" : "") + " points=\"" + points + "\"/>\n";
  return text + marks;
}

std::string legend_entry(const Series& series, std::size_t k) {
  const std::string colour = colour_of(series, k);
  const double x = left + inner_width + 16, y = top + 12 + 20 * static_cast<double>(k);
  std::string text;
  if (series.line)
    text = "<line x1=\"" + number(x) + "\" y1=\"" + number(y) + "\" x2=\"" + number(x + 24) + "\" y2=\"" +
           number(y) + "\" stroke-width=\"1.8\" stroke=\"" + colour + "\"" +
           (series.dashed ? " stroke-dasharray=\"5 4\"" : "") + "/>\n";
  if (series.every > 0) text += marker(look_of(series, k), x + 12, y, colour) + "\n";
  return text + text_at(x + 30, y + 4, "start", series.name);
}

}  // namespace

std::string svg(const Plot& plot) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  double low_x = infinity, high_x = -infinity, low_y = infinity, high_y = -infinity;
  std::string names;
  for (const Series& series : plot.series) {
    names += (names.empty() ? "" : ", ") + series.name;
    for (std::size_t i = 0; i < series.x.size(); ++i) {
      if (!visible(plot, series.x[i], series.y[i])) continue;
      low_x = std::min(low_x, series.x[i]), high_x = std::max(high_x, series.x[i]);
      low_y = std::min(low_y, series.y[i]), high_y = std::max(high_y, series.y[i]);
    }
  }
  if (!(low_x <= high_x)) return "<p>" + escaped(plot.title) + ": there is nothing to plot.</p>\n";
  const Axis x(plot.log_x, low_x, high_x, left, inner_width),
      y(plot.log_y, low_y, high_y, top + inner_height, -inner_height);
  std::string text = "<svg role=\"img\" viewBox=\"0 0 " + number(width) + " " + number(height) +
                     "\" font-size=\"13\" fill=\"currentColor\">\n<title>" + escaped(plot.title) +
                     "</title>\n<desc>" +
                     escaped(plot.y_label + " against " + plot.x_label + " of " + names) +
                     "; the numbers stand in the tables</desc>\n";
  text += text_at(left, 18, "start", plot.title, " font-weight=\"bold\"") + axes(plot, x, y);
  for (std::size_t k = 0; k < plot.series.size(); ++k)
    text += drawn(plot, k, x, y) + legend_entry(plot.series[k], k);
  return text + "</svg>\n";
}

}  // namespace drape
