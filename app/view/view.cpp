#include "app/view/view.h"

#include "mesh/obj.h"

namespace drape {

bool has_viewer() { return false; }

std::string view_html(const std::filesystem::path& folder) {
  throw InputError(folder.string() + ": the viewer is not in this build");
}

int view(const ViewWords& words) {
  view_html(words.folder);
  return 0;
}

}  // namespace drape
