#include "app/scene/fabrics.h"

#include <algorithm>
#include <cstdlib>
#include <iterator>
#include <map>

#include "mesh/base/errors.h"

namespace drape::app {
namespace {

namespace fs = std::filesystem;

fs::path data_folder;  // that was set

fs::path built_in_fabrics() {
  if (!data_folder.empty()) return data_folder / "fabrics";
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  if (!error) {
    const fs::path installed = program.parent_path().parent_path() / "share" / "drape" / "fabrics";
    if (fs::is_directory(installed, error)) return installed;
  }
  return fs::path(DRAPE_DATA_DIR) / "fabrics";
}

// Name and file of every fabric; of two that have the same name the one that goes before.
std::map<std::string, fs::path> named_files() {
  std::map<std::string, fs::path> files;
  const auto add = [&](const fs::path& folder) {
    std::error_code error;
    for (fs::directory_iterator file(folder, error), end; !error && file != end; file.increment(error))
      if (file->path().extension() == ".toml") files.emplace(file->path().stem().string(), file->path());
  };
  if (const char* chosen = std::getenv("DRAPE_DATA"); chosen && *chosen) add(fs::path(chosen) / "fabrics");
  add(built_in_fabrics());
  return files;
}

fs::path file_of(const std::string& name, const fs::path& folder) {
  if (is_fabric_file(name)) return (folder / name).lexically_normal();
  const std::map<std::string, fs::path> files = named_files();
  if (const auto found = files.find(name); found != files.end()) return found->second;
  throw InputError("there is no fabric '" + name + "'; " + suggestion(name, fabric_names()));
}

// "bend.warp" and the like: the numbers of a fabric file.
void add_numbers(const Node& node, const std::string& path, Names& numbers) {
  if (node.kind != Node::Kind::table) return numbers.push_back(path);
  for (const auto& [key, member] : node.members)
    add_numbers(member, std::string(path).append(".").append(key), numbers);
}

Names numbers_of(const Node& root) {
  Names numbers;
  for (const auto& [key, member] : root.members) {
    const Names words = {"description", "source",  "measured",     "converted",
                         "fitted",      "assumed", "damping_kind", "neighbour_weighting"};
    if (std::find(words.begin(), words.end(), key) == words.end()) add_numbers(member, key, numbers);
  }
  return numbers;
}

// Every number that the four lists name is there, and is named once.
void check_marks(const Table& table, const Node& root, NamedFabric& named) {
  named.unmarked = numbers_of(root);
  Names marked;
  for (const auto& [list, names] :
       {std::pair{"measured", &named.measured}, std::pair{"converted", &named.converted},
        std::pair{"fitted", &named.fitted}, std::pair{"assumed", &named.assumed}})
    for (const std::string& name : *names) {
      const auto is_of = [&](const std::string& number) {
        return number == name || number.starts_with(name + ".");
      };
      if (std::any_of(marked.begin(), marked.end(), is_of))
        table.fail(list, name + " stands in two of the lists measured, converted, fitted and assumed");
      const Names numbers = numbers_of(root);
      if (std::none_of(numbers.begin(), numbers.end(), is_of))
        table.fail(list, "the file does not give " + name + "; it gives " + listed(numbers));
      std::copy_if(named.unmarked.begin(), named.unmarked.end(), std::back_inserter(marked), is_of);
      named.unmarked.erase(std::remove_if(named.unmarked.begin(), named.unmarked.end(), is_of),
                           named.unmarked.end());
    }
}

}  // namespace

void set_data_folder(const fs::path& folder) { data_folder = folder; }

Names fabric_names() {
  Names names;
  for (const auto& [name, file] : named_files()) names.push_back(name);
  return names;
}

bool is_fabric_file(const std::string& name) { return fs::path(name).extension() == ".toml"; }

NamedFabric read_fabric_file(const Node& root, const std::string& name, KeyNotes* notes) {
  Table table(root, "the fabric", notes);
  NamedFabric named;
  named.name = name;
  table.read("description", named.description, "fibre and weave, for `drape list`");
  table.read("source", named.source, "where the numbers are from");
  table.read("measured", named.measured, "keys whose values were measured, as \"bend\" or \"bend.warp\"");
  table.read("converted", named.converted,
             "keys whose values follow from what was measured, by a formula or in other units");
  table.read("fitted", named.fitted,
             "keys whose values make virtual tests give what was measured; `drape fit` looks for them");
  table.read("assumed", named.assumed, "keys whose values nobody measured");
  named.tests = read_measured(table);
  named.fabric.weave.compression = usual_compression;
  read_fabric(table, named.fabric, named.record);
  table.finish();  // before what is missing: that may be what a key was meant to be
  table.require("area_density");
  check_marks(table, root, named);
  return named;
}

NamedFabric load_fabric(const std::string& name, const fs::path& folder) {
  return read_fabric_file(read_toml(file_of(name, folder)), name);
}

}  // namespace drape::app
