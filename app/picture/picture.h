// `drape picture`: draws output folders or a mesh as PNG, without a display.
#pragma once

#include <string>
#include <vector>

namespace drape::app {

struct PictureWords {
  std::vector<std::string> inputs;  // folders or OBJ files; several are drawn side by side
  std::string out;                  // empty: FOLDER/picture.png, or beside the mesh
  std::vector<std::string> with;    // OBJ files that are drawn as bodies
  std::string frame;                // "12", "last", "all", "1,5,last"; empty: the last one
  std::string view, color, size;    // "front", "30,20" ...; "strain" ...; "1280x960"; empty: the default
  bool whole = false;               // whether all of the bodies must be in the picture
  bool grid = false;                // whether frames stand side by side
  bool edges = false;               // whether the edges of the triangles are drawn
  bool force = false;               // whether a file that is there already is replaced
};
int picture(const PictureWords& words);  // returns the exit code

}  // namespace drape::app
