// What a plot of compare.html shows. It is drawn in the browser: app/view/web/src/compare.js.
#pragma once

#include <string>
#include <vector>

#include "app/base/json.h"

namespace drape::app {

struct Series {
  std::string name;
  // Points that cannot be shown (not finite, or <= 0 on a logarithmic axis) are left out.
  std::vector<double> x, y;
  bool line = true;
  int every = 1;        // one marker for so many points; 0: no markers
  bool dashed = false;  // in the colour of the text: a limit, not a measurement
  int look = -1;        // which colour and marker; -1: by its place among the series
};

struct Plot {
  std::string title, x_label, y_label;
  bool log_x = false, log_y = false;
  std::vector<Series> series;
};

// The plot as the page holds it, with the points that can be shown; null when no point can be shown.
Json json_of(const Plot& plot);

}  // namespace drape::app
