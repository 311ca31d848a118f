// The keys that say what a cloth is made of. A fabric file and a cloth of a scene share them.
#pragma once

#include "app/scene/laboratory.h"

namespace drape::app {

// The words for the ways in which a woven cloth bends; bending_of takes one of them.
Names bending_names();
std::string name_of(Bending bending);
Bending bending_of(const std::string& name);

// Reads into `fabric` those fabric keys that the table has; the other values stay.
// The record follows the fabric.
void read_fabric(Table& table, Fabric& fabric, FabricRecord& record);

}  // namespace drape::app
