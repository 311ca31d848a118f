// `drape view`: makes one HTML file from an output folder; any browser plays it, offline.
#pragma once

#include <filesystem>
#include <string>

namespace drape::app {

struct ViewWords {
  std::string folder, out;  // as on the command line; an empty `out` stands for FOLDER/view.html
  bool force = false;       // whether a file that is there already is replaced
};
int view(const ViewWords& words);  // returns the exit code

// The page itself. Throws InputError when there is nothing to show, or when this build has no viewer.
std::string view_html(const std::filesystem::path& folder);

bool has_viewer();  // whether this build has the viewer

}  // namespace drape::app
