// The keys that say what a cloth is made of. A fabric file and a cloth of a scene share them.
#pragma once

#include "app/scene/laboratory.h"

namespace drape::app {

// Reads into `fabric` those fabric keys that the table has; the other values stay.
// The record follows the fabric.
void read_fabric(Table& table, Fabric& fabric, FabricRecord& record);

}  // namespace drape::app
