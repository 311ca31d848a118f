// What `drape keys` says of scene files, and so docs/scene.md: every key that the readers ask for, none that
// they do not know.
#include <catch2/catch.hpp>
#include <filesystem>
#include <regex>
#include <set>

#include "app/commands/keys.h"
#include "app/scene/scene.h"
#include "mesh/base/errors.h"
#include "tests/folder.h"

using namespace drape;
using namespace drape::app;

namespace {

std::set<std::string> keys_of(const KeyNotes& notes) {
  std::set<std::string> keys;
  for (const KeySection& section : notes.sections())
    for (const KeyNote& note : section.keys) keys.insert(note.key);
  return keys;
}

KeySection section_of(const KeyNotes& notes, const std::string& table, const std::string& kind = {}) {
  for (const KeySection& section : notes.sections())
    if (section.table == table && section.kind == kind) return section;
  FAIL("no keys of '" << table << "' " << kind);
  return {};
}

// The tables of this name, wherever they are.
void collect(Node& node, const std::string& name, std::vector<Node*>& found) {
  for (auto& [key, member] : node.members) {
    if (key == name) {
      if (member.kind == Node::Kind::table) found.push_back(&member);
      for (Node& item : member.items)
        if (item.kind == Node::Kind::table) found.push_back(&item);
    }
    collect(member, name, found);
  }
  for (Node& item : node.items) collect(item, name, found);
}

// What reading the scene of every kind complains of when a key of one table has another value. "": nothing.
std::string complaint(const std::string& table, std::size_t which, const std::string& key,
                      const Node& value) {
  Node root = parse_toml(scene_of_every_kind(), "scene.toml");
  std::vector<Node*> tables;
  if (table.empty())
    tables.push_back(&root);
  else
    collect(root, table, tables);
  tables.at(which)->members[key] = value;
  try {
    read_scene(root, {}, {}, "scene.toml");
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

std::size_t count_of(const std::string& table) {
  if (table.empty()) return 1;
  Node root = parse_toml(scene_of_every_kind(), "scene.toml");
  std::vector<Node*> tables;
  collect(root, table, tables);
  return tables.size();
}

}  // namespace

TEST_CASE("every key that is listed is read where it is said to be", "[keys]") {
  // No key takes such a value, so every one that is read complains of it, by its name.
  Node wrong;
  wrong.kind = Node::Kind::array;
  wrong.items = {Node::of_list({}, "scene.toml")};
  wrong.where = "scene.toml";
  for (const KeySection& section : scene_keys().sections())
    for (const KeyNote& note : section.keys) {
      bool read = false;
      for (std::size_t k = 0; k < count_of(section.table); ++k) {
        const std::string said = complaint(section.table, k, note.key, wrong);
        INFO(section.table << " " << section.kind << " " << note.key << ": " << said);
        CHECK_FALSE(said.empty());
        read |= said.find(note.key) != said.npos && said.find("unknown") == said.npos;
      }
      INFO(section.table << " " << section.kind << " " << note.key);
      CHECK(read);
    }
}

TEST_CASE("a key that is not listed is refused in every table", "[keys]") {
  const Node value = Node::of_number(1, "scene.toml");
  std::set<std::string> tables;
  for (const KeySection& section : scene_keys().sections()) tables.insert(section.table);
  CHECK(tables.size() >= 13);
  for (const std::string& table : tables) {
    INFO(table);
    REQUIRE(count_of(table) > 0);
    CHECK(complaint(table, 0, "no_such_key", value).find("unknown key 'no_such_key'") != std::string::npos);
  }
}

TEST_CASE("every key that the readers' code names is listed", "[keys]") {
  std::set<std::string> listed = keys_of(scene_keys());
  listed.merge(keys_of(fabric_keys()));
  listed.merge(keys_of(pattern_keys()));
  const std::regex read(
      R"re((?:[.](?:read|read_required|read_part|take|tables|require)\(|read_directions\(\w+,)\s*"([A-Za-z0-9_]+)")re");
  int found = 0;
  for (const auto& file :
       std::filesystem::recursive_directory_iterator(std::filesystem::path(test::source_dir()) / "app")) {
    if (file.path().extension() != ".cpp") continue;
    const std::string code = test::content(file.path());
    for (std::sregex_iterator key(code.begin(), code.end(), read), end; key != end; ++key, ++found) {
      INFO(file.path().filename() << ": " << (*key)[1]);
      CHECK(listed.count((*key)[1]) == 1);
    }
  }
  CHECK(found > 90);
}

TEST_CASE("every shape has its keys listed", "[keys]") {
  const KeyNotes notes = scene_keys();
  for (const std::string& shape : shape_names())
    CHECK_FALSE(section_of(notes, "obstacle", "with shape = \"" + shape + "\"").keys.empty());
}

TEST_CASE("a key's default is what holds without it", "[keys]") {
  const KeySection simulation = section_of(scene_keys(), "simulation");
  for (const KeyNote& note : simulation.keys) {
    if (note.key == "contact" || note.key == "contact_tolerance" || note.key == "threads" ||
        note.key.starts_with("absolute_tolerance_"))
      continue;  // said in words
    INFO(note.key << " = " << note.otherwise);
    const Node value = parse_toml_value(note.otherwise, "scene.toml");
    Node root = parse_toml(scene_of_every_kind(), "scene.toml");
    root.members["simulation"].members[note.key] = value;
    const SimulationOptions given = read_scene(root, {}, {}, "scene.toml").simulation, none;
    CHECK(given.duration == none.duration);
    CHECK(given.time_step == none.time_step);
    CHECK(given.frame_rate == none.frame_rate);
    CHECK(given.gravity == none.gravity);
    CHECK(given.integrator == none.integrator);
    CHECK(given.linear_solver == none.linear_solver);
    CHECK(given.step.tolerance == none.step.tolerance);
    CHECK(given.step.max_inner_steps == none.step.max_inner_steps);
    CHECK(given.settle_speed == none.settle_speed);
    CHECK(given.stop_when_settled == none.stop_when_settled);
  }
}

TEST_CASE("drape keys prints a table, or says which there are", "[keys]") {
  const test::Folder folder;
  const test::Outcome cloth = folder.drape("keys cloth");
  CHECK(cloth.exit_code == 0);
  CHECK(cloth.out.find("bend ") != std::string::npos);
  CHECK(cloth.out.find("a mass per area > 0 [kg/m^2]; default: 0.15") != std::string::npos);
  const test::Outcome table = folder.drape("keys simulation --markdown");
  CHECK(table.out.find("| `time_step` | a time > 0 | s | 0.01 |") != std::string::npos);
  const test::Outcome wrong = folder.drape("keys obstcale");
  CHECK(wrong.exit_code == 2);
  CHECK(wrong.err.find("there is no table 'obstcale'; did you mean 'obstacle'?") != std::string::npos);
}
