// Stills side by side on one picture, all seen by the same camera and in the same colours; one alone fills
// the picture. Under each its time, under all the legend of the colours.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "app/picture/camera.h"
#include "app/picture/colours.h"
#include "app/picture/still.h"

namespace drape::drawing {

struct SheetPanel {
  const Subject* subject;
  int frame;          // from 0
  std::string label;  // empty: none
};

struct SheetOptions {
  int width = 1280, height = 960;  // pixels
  View view;
  std::optional<Field> field;
  bool whole = false;  // all of the bodies is to be seen
  bool edges = false;
  int columns = 0;  // 0: so that what is shown is largest
};

// How all pictures of a sequence are drawn.
class Sheet {
 public:
  // `all`: everything that will be drawn; `together`: how many of these on one picture.
  Sheet(const std::vector<SheetPanel>& all, std::size_t together, const SheetOptions& options);

  Image draw(const std::vector<SheetPanel>& panels) const;

 private:
  struct Place {
    PixelBox panel, framed;  // whole pixels; within the panel
  };
  Place place(std::size_t k) const;
  void choose_columns(const std::vector<SheetPanel>& all);
  void survey(const std::vector<SheetPanel>& all);

  SheetOptions options_;
  std::size_t together_;
  bool labelled_;
  int columns_ = 1, letters_ = 0;  // size of the letters, pixels
  double legend_height_ = 0;
  Camera camera_;            // of the first panel
  Eigen::AlignedBox3d box_;  // m, of what is framed
  Scale scale_;
  double largest_ = 0;
};

}  // namespace drape::drawing
