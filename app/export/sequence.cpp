#include "app/export/sequence.h"

namespace drape::app {

Names sequence_files(const ExportSource& source, const std::string& ending) {
  Names names;
  for (std::size_t s = 0; s < source.shape_count(); ++s) {
    const std::string& name = source.shape(s).name;
    if (!source.moves(s)) names.push_back(name + ending);
    for (std::size_t k = 0; source.moves(s) && k < source.frame_count(); ++k)
      names.push_back(numbered(name, k + 1, ending));
  }
  return names;
}

}  // namespace drape::app
