// `drape test-fabric`: the tests of a textile laboratory on a named fabric, beside what was asked.
#pragma once

#include <filesystem>
#include <string>

#include "app/base/json.h"
#include "app/textile/virtual_tests.h"

namespace drape::app {

// As on the command line; empty when not given.
struct TestFabricWords {
  std::string fabric, mesh, tests, model, bending, repeats, specimen, plate, lowering;
  bool hysteresis = false;  // whether the threads rub, as kes.2HB says
};

// Returns the exit code: 0 done; 130 interrupted, with nothing written. Throws InputError.
int test_fabric(const TestFabricWords& words, const std::filesystem::path& out, bool quiet);

// One quantity on all meshes.
struct FabricRow {
  std::string test;
  Value value;                             // of the first mesh
  std::optional<double> measured;          // SI, of the cloth itself, where the fabric's file has it
  std::vector<std::vector<double>> found;  // of every mesh, for every repeat, SI
};

struct FabricTable {
  std::string fabric, model;
  bool hysteresis = false;
  std::vector<double> edges;  // m, of the meshes
  std::vector<FabricRow> rows;
};

std::string fabric_text(const FabricTable& table);  // for people to read
std::string fabric_json(const FabricTable& table);

}  // namespace drape::app
