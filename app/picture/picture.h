// `drape picture`: an output folder or a mesh as PNG, without a display.
#pragma once

#include <string>
#include <vector>

namespace drape {

struct PictureWords {
  std::string input, out;         // a folder or an OBJ file; out empty: beside the input
  std::vector<std::string> with;  // further OBJ files
  std::string frame;              // "12", "last", "all"; empty: the last
  std::string view, color, size;  // "front", "30,20" ...; "strain" ...; "1280x960"; empty: chosen
  bool grid = false;              // frames side by side
  bool force = false;             // replace a file that is there
};
int picture(const PictureWords& words);  // exit code

}  // namespace drape
