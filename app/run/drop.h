// `drape drop`: makes a scene from a cloth and a body, without a scene file.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/scene/scene.h"

namespace drape::app {

struct DropOptions {
  std::filesystem::path cloth;  // OBJ
  std::string onto;             // an OBJ file or a built-in shape; empty: no body
  bool floor = false;           // a plane under everything
  std::string fabric = "cotton-poplin";
  std::optional<std::string> scale;  // scale of both meshes
  std::optional<std::string> friction, margin;
  std::vector<std::string> pinned_groups;
};

std::string onto_examples();  // "sphere:0.3, box:1x0.5x1": the built-in shapes of --onto

// Makes the scene. Throws InputError.
Scene drop_scene(const DropOptions& options, const std::vector<Setting>& settings, const std::string& label);

}  // namespace drape::app
