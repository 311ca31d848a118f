// A line plot as inline SVG: axes with ticks, linear or logarithmic, a legend,
// a title that screen readers say.
//   Lines, text and axes take the colour of the page, so it is legible on light and dark; every series has
//   its own colour and its own marker, so it is legible without colours.
#pragma once

#include <string>
#include <vector>

namespace drape {

struct Series {
  std::string name;
  std::vector<double> x, y;  // what cannot be shown (not finite, or <= 0 on a logarithmic axis) is left out
  bool line = true;
  int every = 1;        // how many points to a marker; 0: none
  bool dashed = false;  // in the colour of the text: a limit, not a measurement
  int look = -1;        // which colour and marker; -1: by its place among the series
};

struct Plot {
  std::string title, x_label, y_label;
  bool log_x = false, log_y = false;
  std::vector<Series> series;
};

// "<svg ...>...</svg>"; a sentence in its place when no point can be shown.
std::string svg(const Plot& plot);

}  // namespace drape
