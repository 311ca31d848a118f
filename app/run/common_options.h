// Options of every command that runs a scene.
#pragma once

#include <filesystem>
#include <vector>

#include "app/base/settings.h"
#include "app/recording/output.h"

namespace drape::app {

struct CommonOptions {
  std::filesystem::path out;  // empty: out/NAME
  Frames frames = Frames::pc2;
  bool quiet = false;
  std::vector<Setting> settings;
};

}  // namespace drape::app
