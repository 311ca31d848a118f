#include "app/textile/test_fabric.h"

#include <algorithm>
#include <array>
#include <cstdio>

#include "app/base/atomic_file.h"
#include "app/base/interrupt.h"
#include "app/base/table.h"
#include "app/recording/output.h"
#include "app/scene/fabrics.h"
#include "mesh/base/errors.h"

namespace drape::app {
namespace {

const Names test_names = {"cantilever", "tensile", "shear", "drape"};

struct Plan {
  NamedFabric fabric;
  std::string model_name;
  ClothModel model;
  std::vector<double> edges;  // m
  Names tests;
  DrapeTest drape;
};

Names split(const std::string& text) {
  Names words;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    const std::size_t first = std::min(text.find_first_not_of(' ', begin), end);
    words.push_back(text.substr(first, end - first));
    begin = end + 1;
  }
  return words;
}

double length(const std::string& word, const char* option, double least, double most) {
  try {
    const double value = quantity(parse_toml_value(word, option), dimension::length, Range::positive);
    if (value < least || value > most)
      throw InputError("expected a length from " + rounded(1000 * least, 3) + " mm to " +
                       rounded(1000 * most, 3) + " mm");
    return value;
  } catch (const InputError& error) {
    throw InputError(std::string(option) + " " + word + ": " + error.what());
  }
}

ClothModel model_of(const std::string& name) {
  if (name == "woven") return ClothModel::woven;
  if (name == "noh-jung") return ClothModel::noh_jung;
  throw InputError("--model " + name + ": expected woven or noh-jung; the specimens are meshes of triangles");
}

Plan plan_of(const TestFabricWords& words) {
  Plan plan;
  plan.fabric = load_fabric(words.fabric);
  plan.model_name = words.model.empty() ? "woven" : words.model;
  plan.model = model_of(plan.model_name);
  for (const std::string& word : split(words.mesh.empty() ? "10 mm,5 mm" : words.mesh))
    plan.edges.push_back(length(word, "--mesh", 1e-3, 0.02));
  plan.tests = words.tests.empty() ? test_names : split(words.tests);
  for (const std::string& name : plan.tests)
    if (std::find(test_names.begin(), test_names.end(), name) == test_names.end())
      throw InputError("--tests " + words.tests + ": there is no test '" + name + "'; " +
                       suggestion(name, test_names));
  if (!words.specimen.empty()) plan.drape.radius = 0.5 * length(words.specimen, "--specimen", 0.2, 0.4);
  if (!words.repeats.empty()) {
    try {
      const double repeats =
          quantity(parse_toml_value(words.repeats, "--repeats"), dimension::number, Range::positive);
      plan.drape.repeats = static_cast<int>(repeats);
      if (plan.drape.repeats != repeats || repeats > 1000)
        throw InputError("expected a whole number to 1000");
    } catch (const InputError& error) {
      throw InputError("--repeats " + words.repeats + ": " + error.what());
    }
  }
  return plan;
}

using Pictures = std::vector<std::pair<std::string, std::string>>;  // name and bytes of the file

Values run(const Plan& plan, const std::string& test, double edge, Pictures& pictures) {
  const Fabric& fabric = plan.fabric.fabric;
  if (test == "cantilever") return cantilever_test(fabric, plan.model, edge);
  if (test == "tensile") return tensile_test(fabric, plan.model, edge);
  if (test == "shear") return shear_test(fabric, plan.model, edge);
  return drape_test(fabric, plan.model, edge, plan.drape, [&](int repeat, const Shadow& shadow) {
    pictures.emplace_back("drape-" + rounded(1000 * edge, 3) + "mm-" + std::to_string(repeat + 1) + ".png",
                          drawing::png(shadow.picture(plan.drape.radius)));
  });
}

std::optional<double> measured(const NamedFabric& fabric, const std::string& quantity) {
  if (!fabric.measured_drape) return {};
  if (quantity == "drape coefficient") return fabric.measured_drape->coefficient;
  return quantity == "nodes" ? fabric.measured_drape->nodes : std::nullopt;
}

void add(FabricTable& table, const NamedFabric& fabric, const std::string& test, const Values& values) {
  for (const Value& value : values) {
    const auto same = std::find_if(table.rows.begin(), table.rows.end(), [&](const FabricRow& row) {
      return row.test == test && row.value.quantity == value.quantity;
    });
    FabricRow& row =
        same != table.rows.end()
            ? *same
            : table.rows.emplace_back(FabricRow{test, value, measured(fabric, value.quantity), {}});
    row.found.push_back(value.found);
  }
}

}  // namespace

int test_fabric(const TestFabricWords& words, const std::filesystem::path& out, bool quiet) {
  const Plan plan = plan_of(words);
  const std::filesystem::path folder = out.empty() ? std::filesystem::path("out") / "test-fabric" /
                                                         std::filesystem::path(plan.fabric.name).stem()
                                                   : out;
  make_output_folder(folder, {"test-fabric.json"});
  catch_interrupts();
  FabricTable table{plan.fabric.name, plan.model_name, plan.edges, {}};
  Pictures pictures;
  for (const std::string& test : plan.tests)
    for (double edge : plan.edges) {
      if (!quiet) std::fprintf(stderr, "%s, mesh of %s mm\n", test.c_str(), rounded(1000 * edge, 3).c_str());
      add(table, plan.fabric, test, run(plan, test, edge, pictures));
      if (interrupted()) {
        if (!quiet) std::fprintf(stderr, "interrupted: nothing is written\n");
        return 130;
      }
    }
  std::vector<AtomicFile> files;
  const auto write = [&](const std::string& name, const std::string& bytes) {
    files.emplace_back(folder / name).write(bytes);
    files.back().close();
  };
  write("test-fabric.json", fabric_json(table));
  for (const auto& [name, bytes] : pictures) write(name, bytes);
  for (AtomicFile& file : files) file.keep();
  if (quiet) return 0;
  std::fputs(fabric_text(table).c_str(), stdout);
  for (const AtomicFile& file : files) std::printf("wrote %s\n", file.path().string().c_str());
  return 0;
}

}  // namespace drape::app
