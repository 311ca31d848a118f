// The keys that say what a cloth is made of. A fabric file and a cloth of a scene share them.
#pragma once

#include "app/base/table.h"
#include "solver/forces/fabric.h"

namespace drape::app {

// Reads into `fabric` those fabric keys that the table has; the other values stay.
void read_fabric(Table& table, Fabric& fabric);

}  // namespace drape::app
