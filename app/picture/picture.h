// `drape picture`: output folders or a mesh as PNG, without a display.
#pragma once

#include <string>
#include <vector>

namespace drape {

struct PictureWords {
  std::vector<std::string> inputs;  // folders or OBJ files; several are drawn side by side
  std::string out;                  // empty: FOLDER/picture.png, or beside the mesh
  std::vector<std::string> with;    // OBJ files, drawn as bodies
  std::string frame;                // "12", "last", "all", "1,5,last"; empty: the last
  std::string view, color, size;    // "front", "30,20" ...; "strain" ...; "1280x960"; empty: chosen
  bool whole = false;               // all of the bodies in the picture
  bool grid = false;                // frames side by side
  bool edges = false;               // of the triangles
  bool force = false;               // replace a file that is there
};
int picture(const PictureWords& words);  // exit code

}  // namespace drape
