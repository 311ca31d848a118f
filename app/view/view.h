// `drape view`: an output folder as one HTML file that plays it in any browser, offline.
#pragma once

#include <filesystem>
#include <string>

namespace drape {

struct ViewWords {
  std::string folder, out;  // as the command line gives them; out empty: FOLDER/view.html
  bool force = false;       // replace a file that is there
};
int view(const ViewWords& words);  // exit code

// The page itself. Throws InputError when there is nothing to show, or the viewer is not in this build.
std::string view_html(const std::filesystem::path& folder);

bool has_viewer();  // of this build

}  // namespace drape
