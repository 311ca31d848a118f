// Named fabrics: data/fabrics/NAME.toml, each with its source and with what was assumed.
// The data folder is $DRAPE_DATA, or else one that was set, or ../share/drape beside the program, or the one
// it was built with.
#pragma once

#include <filesystem>

#include "app/base/table.h"
#include "solver/forces/fabric.h"

namespace drape {

struct NamedFabric {
  std::string name;
  std::string description, source;
  Names assumed;  // keys that nobody measured
  Fabric fabric;
};

void set_data_folder(const std::filesystem::path& folder);

Names fabric_names();                                                         // sorted
NamedFabric load_fabric(const std::string& name, KeyNotes* notes = nullptr);  // throws InputError

// Reads the fabric keys that the table has over `fabric`.
void read_fabric(Table& table, Fabric& fabric);

}  // namespace drape
