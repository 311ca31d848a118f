// A line plot as inline SVG: axes with ticks, linear or logarithmic, a legend, and a title that
// screen readers read out.
//   Lines, text and axes take the colour of the page, so the plot is legible on light and dark pages. Every
//   series has its own colour and its own marker, so it is legible without colours.
#pragma once

#include <string>
#include <vector>

namespace drape {

struct Series {
  std::string name;
  // Points that cannot be shown (not finite, or <= 0 on a logarithmic axis) are left out.
  std::vector<double> x, y;
  bool line = true;
  int every = 1;        // a marker at every so many points; 0: none
  bool dashed = false;  // and in the colour of the text: for a limit, not a measurement
  int look = -1;        // number of the colour and marker; -1: by the place among the series
};

struct Plot {
  std::string title, x_label, y_label;
  bool log_x = false, log_y = false;
  std::vector<Series> series;
};

// "<svg ...>...</svg>", or a sentence in its place when no point can be shown.
std::string svg(const Plot& plot);

}  // namespace drape
