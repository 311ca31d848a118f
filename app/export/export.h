// `drape export`: an output folder in the formats of other programs.
#pragma once

#include <string>

#include "app/base/words.h"

namespace drape {

struct ExportWords {
  std::string folder, to, out;  // a format of export_formats(); out empty: FOLDER/export
  int every = 1;                // every so many frames
  bool force = false;           // replace files that are there
};
int export_folder(const ExportWords& words);  // exit code

Names export_formats();

}  // namespace drape
