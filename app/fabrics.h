// Named fabrics: data/fabrics/NAME.toml, each with its source and with what was assumed.
// The data folder is $DRAPE_DATA, or else ../share/drape beside the program, or else the one it was built
// with.
#pragma once

#include "app/table.h"
#include "solver/fabric.h"

namespace drape {

struct NamedFabric {
  std::string name;
  std::string description, source;
  Names assumed;  // keys that nobody measured
  Fabric fabric;
};

Names fabric_names();                                                         // sorted
NamedFabric load_fabric(const std::string& name, KeyNotes* notes = nullptr);  // throws InputError

// Reads the fabric keys that the table has over `fabric`.
void read_fabric(Table& table, Fabric& fabric);

}  // namespace drape
