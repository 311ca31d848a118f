// `drape export`: writes an output folder in the formats of other programs.
#pragma once

#include <string>

#include "app/base/words.h"

namespace drape::app {

struct ExportWords {
  // to: one of export_formats(). out: empty stands for FOLDER/export.
  std::string folder, to, out;
  int every = 1;       // only every so many frames
  bool force = false;  // whether files that are there already are replaced
};
int export_folder(const ExportWords& words);  // returns the exit code

Names export_formats();

}  // namespace drape::app
