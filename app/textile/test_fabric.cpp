#include "app/textile/test_fabric.h"

#include <algorithm>
#include <cstdio>

#include "app/base/atomic_file.h"
#include "app/base/interrupt.h"
#include "app/base/table.h"
#include "app/recording/output.h"
#include "app/scene/fabrics.h"
#include "app/textile/measurements.h"
#include "app/textile/options.h"
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

double lowering(const std::string& word) {
  try {
    const double value = quantity(parse_toml_value(word, "--lowering"), dimension::time, Range::positive);
    if (value > 30) throw InputError("expected a time up to 30 s");
    return value;
  } catch (const InputError& error) {
    throw InputError("--lowering " + word + ": " + error.what());
  }
}

ClothModel model_of(const std::string& name) {
  if (name == "woven") return ClothModel::woven;
  if (name == "noh-jung") return ClothModel::noh_jung;
  throw InputError("--model " + name + ": expected woven or noh-jung; the specimens are meshes of triangles");
}

void add_friction(const TestFabricWords& words, Plan& plan) {
  if (plan.model != ClothModel::woven)
    throw InputError("--hysteresis: goes with --model woven; the springs of " + words.model + " do not rub");
  try {
    use_hysteresis(plan.fabric.record, plan.fabric.fabric);
  } catch (const InputError& error) {
    throw InputError("--hysteresis, fabric " + plan.fabric.name + ": " + error.what());
  }
}

void set_bending(const std::string& word, Plan& plan) {
  if (plan.model != ClothModel::woven)
    throw InputError("--bending " + word + ": goes with --model woven; the springs of " + plan.model_name +
                     " bend in their own way");
  const Names names = bending_names();
  if (std::find(names.begin(), names.end(), word) == names.end())
    throw InputError("--bending " + word + ": there is no such bending; " + suggestion(word, names));
  plan.fabric.fabric.weave.bending = bending_of(word);
}

Plan plan_of(const TestFabricWords& words) {
  Plan plan;
  plan.fabric = load_fabric(words.fabric);
  check_widths(plan.fabric);
  plan.model_name = words.model.empty() ? "woven" : words.model;
  plan.model = model_of(plan.model_name);
  if (!words.bending.empty()) set_bending(words.bending, plan);
  if (words.hysteresis) add_friction(words, plan);
  for (const std::string& word : names_in(words.mesh.empty() ? "10 mm,5 mm" : words.mesh))
    plan.edges.push_back(specimen_length(word, "--mesh", least_edge, most_edge));
  plan.tests = words.tests.empty() ? test_names : names_in(words.tests);
  for (const std::string& name : plan.tests)
    if (std::find(test_names.begin(), test_names.end(), name) == test_names.end())
      throw InputError("--tests " + words.tests + ": there is no test '" + name + "'; " +
                       suggestion(name, test_names));
  const auto twice = [](const char* option, const std::string& text, const std::string& what) {
    return InputError(std::string(option) + " " + text + ": " + what + " stands there twice; name it once");
  };
  for (std::size_t k = 0; k < plan.tests.size(); ++k)
    if (std::count(plan.tests.begin(), plan.tests.end(), plan.tests[k]) > 1)
      throw twice("--tests", words.tests, plan.tests[k]);
  for (std::size_t k = 0; k < plan.edges.size(); ++k)
    for (std::size_t l = 0; l < k; ++l)
      if (millimetres(plan.edges[k]) == millimetres(plan.edges[l]))
        throw twice("--mesh", words.mesh, millimetres(plan.edges[k]));
  if (plan.fabric.tests.drape) {
    plan.drape.radius = 0.5 * plan.fabric.tests.drape->specimen;
    plan.drape.plate_radius = 0.5 * plan.fabric.tests.drape->plate;
  }
  if (!words.specimen.empty())
    plan.drape.radius = 0.5 * specimen_length(words.specimen, "--specimen", 0.2, 0.4);
  if (!words.plate.empty())
    plan.drape.plate_radius = 0.5 * specimen_length(words.plate, "--plate", 0.05, 0.3);
  if (!words.lowering.empty()) plan.drape.lowering = lowering(words.lowering);
  if (!words.repeats.empty()) plan.drape.repeats = repeats_of(words.repeats);
  if (std::find(plan.tests.begin(), plan.tests.end(), "drape") != plan.tests.end())
    for (double edge : plan.edges) check_overhang(plan.drape.radius, plan.drape.plate_radius, edge);
  return plan;
}

// What the output folder is called: "my" of my.toml, else the name of the fabric.
std::filesystem::path folder_name(const std::string& fabric) {
  const std::filesystem::path path(fabric);
  return is_fabric_file(fabric) ? path.stem() : path;
}

using Pictures = std::vector<std::pair<std::string, std::string>>;  // name and bytes of the file

Values run(const Plan& plan, const std::string& test, double edge, Pictures& pictures) {
  const Fabric& fabric = plan.fabric.fabric;
  if (test == "cantilever") return cantilever_test(fabric, plan.model, edge);
  if (test == "tensile") return tensile_test(fabric, plan.model, edge);
  if (test == "shear") return shear_test(fabric, plan.model, edge);
  const std::optional<double> coefficient = measured_value(plan.fabric, "drape coefficient");
  return drape_test(fabric, plan.model, edge, plan.drape, [&](int repeat, const Shadow& shadow) {
    pictures.emplace_back("drape-" + rounded(1000 * edge, 3) + "mm-" + std::to_string(repeat + 1) + ".png",
                          drawing::png(shadow.picture(plan.drape.radius, coefficient)));
  });
}

void add(FabricTable& table, const NamedFabric& fabric, const std::string& test, const Values& values) {
  for (const Value& value : values) {
    const auto same = std::find_if(table.rows.begin(), table.rows.end(), [&](const FabricRow& row) {
      return row.test == test && row.value.quantity == value.quantity;
    });
    FabricRow& row =
        same != table.rows.end()
            ? *same
            : table.rows.emplace_back(FabricRow{test, value, measured_value(fabric, value.quantity), {}});
    row.found.push_back(value.found);
  }
}

}  // namespace

int test_fabric(const TestFabricWords& words, const std::filesystem::path& out, bool quiet) {
  const Plan plan = plan_of(words);
  const std::filesystem::path folder =
      out.empty() ? std::filesystem::path("out") / "test-fabric" / folder_name(plan.fabric.name) : out;
  make_output_folder(folder, {"test-fabric.json"});
  catch_interrupts();
  FabricTable table{plan.fabric.name, plan.model_name, words.hysteresis, plan.edges, {}};
  Pictures pictures;
  for (const std::string& test : plan.tests)
    for (double edge : plan.edges) {
      if (!quiet) std::fprintf(stderr, "%s, mesh of %s\n", test.c_str(), millimetres(edge).c_str());
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
