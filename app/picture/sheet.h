// Stills side by side on one picture, all seen by the same camera and in the same colours; a single still
// fills the picture. The time stands under each still, and the legend of the colours under all.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "app/picture/camera.h"
#include "app/picture/colours.h"
#include "app/picture/still.h"

namespace drape::app::drawing {

struct SheetPanel {
  const Subject* subject;
  int frame;          // from 0
  std::string label;  // empty when there is none
};

struct SheetOptions {
  int width = 1280, height = 960;  // pixels
  View view;
  std::optional<Field> field;
  bool whole = false;  // whether all of the bodies must be in the picture
  bool edges = false;
  int columns = 0;  // 0: chosen so that the stills are as large as possible
};

// Fixes how all pictures of a sequence are drawn.
class Sheet {
 public:
  // `all` is everything that will be drawn; `together` says how many panels stand on one picture.
  Sheet(const std::vector<SheetPanel>& all, std::size_t together, const SheetOptions& options);

  Image draw(const std::vector<SheetPanel>& panels) const;

 private:
  struct Place {
    PixelBox panel, framed;  // in whole pixels; `framed` lies within `panel`
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
  double least_ = 0, largest_ = 0;
};

}  // namespace drape::app::drawing
