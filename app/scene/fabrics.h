// Named fabrics: data/fabrics/NAME.toml. Each file names its source and says which values were assumed.
// The data folder is the first of these: $DRAPE_DATA, the folder given to set_data_folder(), ../share/drape
// beside the program if it has fabrics, the data folder of the source tree that the program was built from.
#pragma once

#include <filesystem>

#include "app/base/table.h"
#include "solver/forces/fabric.h"

namespace drape::app {

struct NamedFabric {
  std::string name;
  std::string description, source;
  Names assumed;  // keys with values that nobody measured
  Fabric fabric;
};

void set_data_folder(const std::filesystem::path& folder);

Names fabric_names();                                                         // sorted
NamedFabric load_fabric(const std::string& name, KeyNotes* notes = nullptr);  // throws InputError

// Reads into `fabric` those fabric keys that the table has; the other values stay.
void read_fabric(Table& table, Fabric& fabric);

}  // namespace drape::app
