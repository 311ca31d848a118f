// Fabrics of files. A named fabric is fabrics/NAME.toml of a data folder; a fabric of one's own is any other
// file that ends in .toml. Each file names its source and says of its numbers which were measured, converted,
// fitted and assumed.
//
// Data folders: $DRAPE_DATA when it is set, whose fabrics go before those of the same name in the built-in
// folder. That is the first of these: the folder given to set_data_folder(), ../share/drape beside the
// program if it has fabrics, the data folder of the source tree that the program was built from.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "app/scene/fabric_read.h"
#include "app/scene/measured.h"

namespace drape::app {

// The share of compression (Weave::compression) that a fabric has where its file does not say it. Threads in
// a weave buckle when they are pushed together. With this share drape coefficients depend least on the mesh,
// and garments on a floor keep 97 % or more of their area.
constexpr double usual_compression = 0.1;

struct NamedFabric {
  std::string name;  // as it was asked for: "cotton-broad", "my.toml"
  std::string description, source;
  // Of the numbers of the file, as "area_density" or "bend.warp"; "bend" is all of a table.
  Names measured, converted;  // from what was measured, by a formula or into other units
  Names fitted;               // virtual tests give with these what was measured (`drape fit`)
  Names assumed;              // nobody measured these
  Names unmarked;             // the file says of these numbers none of the four
  MeasuredTests tests;
  Fabric fabric;
  FabricRecord record;
};

void set_data_folder(const std::filesystem::path& folder);

Names fabric_names();                          // of the data folders, sorted
bool is_fabric_file(const std::string& name);  // "my.toml" is a file, "cotton-broad" a name

// `name` is one of fabric_names(), or a file, which is looked for from `folder`. Throws InputError, which
// names file and line.
NamedFabric load_fabric(const std::string& name, const std::filesystem::path& folder = {});

// The same, with the file as data. notes: receives what is said of the keys; may be null.
NamedFabric read_fabric_file(const Node& root, const std::string& name, KeyNotes* notes = nullptr);

}  // namespace drape::app
