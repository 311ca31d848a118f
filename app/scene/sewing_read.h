// Reads the parts of a [[cloth]] table that make a garment of a flat pattern: panels and seams.
#pragma once

#include "app/base/table.h"
#include "app/scene/scene.h"

namespace drape::app {

std::vector<PanelEntry> read_panels(Table& cloth);
std::vector<SeamEntry> read_seams(Table& cloth);

}  // namespace drape::app
