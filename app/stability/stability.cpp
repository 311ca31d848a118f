#include "app/stability/stability.h"

#include <algorithm>
#include <cstdio>

#include "app/base/atomic_file.h"
#include "app/base/interrupt.h"
#include "app/base/table.h"
#include "mesh/base/errors.h"
#include "mesh/base/threads.h"

namespace drape::app {
namespace {

[[noreturn]] void refuse(const std::string& text, const std::string& name, const Names& known) {
  const std::string missing = missing_integrator(name);
  throw InputError(
      "--integrators " + text + ": " +
      (missing.empty() ? "there is no integrator '" + name + "'; " + suggestion(name, known) : missing));
}

void read(const std::string& text, const char* option, const Dimension& dimension, double& value,
          Range range = Range::positive) {
  if (text.empty()) return;
  try {
    value = quantity(parse_toml_value(text, option), dimension, range);
  } catch (const InputError& error) {
    throw InputError(std::string(option) + " " + text + ": " + error.what());
  }
}

// Those whose steps are as long as they are told to be.
bool chooses_its_steps(std::string_view name) {
  return name.starts_with("cvode") || name.starts_with("arkode");
}

std::vector<std::string> chosen_integrators(const std::string& text) {
  Names known, chosen;
  for (const IntegratorInfo& info : integrators()) {
    known.emplace_back(info.name);
    if (text.empty() && !chooses_its_steps(info.name)) chosen.emplace_back(info.name);
  }
  for (std::size_t begin = 0; !text.empty() && begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    const std::string name = text.substr(begin, end - begin);
    if (std::find(known.begin(), known.end(), name) == known.end()) refuse(text, name, known);
    if (std::find(chosen.begin(), chosen.end(), name) == chosen.end()) chosen.push_back(name);
    begin = end + 1;
  }
  return chosen;
}

StabilityOptions options_of(const StabilityWords& words, const Scene& scene) {
  StabilityOptions options;
  options.time = scene.simulation.duration;
  read(words.time, "--time", dimension::time, options.time);
  read(words.shake, "--shake", dimension::speed, options.shake, Range::not_negative);
  read(words.growth, "--growth", dimension::number, options.growth);
  read(words.precision, "--precision", dimension::number, options.precision);
  if (options.precision < 1e-6 || options.precision > 1)
    throw InputError("--precision " + words.precision + ": expected a part of the step, such as 0.01");
  options.longest = options.time / 10;
  read(words.longest, "--longest", dimension::time, options.longest);
  if (options.longest > options.time)
    throw InputError("--longest " + words.longest + ": is longer than a run of " + rounded(options.time, 4) +
                     " s");
  options.shortest = options.time / 50000;
  read(words.shortest, "--shortest", dimension::time, options.shortest);
  if (options.shortest > options.longest && words.shortest.empty())
    throw InputError("--longest " + words.longest + ": is shorter than the shortest step that is tried, " +
                     rounded(options.shortest, 4) + " s; give --shortest, too");
  if (options.shortest > options.longest)
    throw InputError("--shortest: " + rounded(options.shortest, 4) + " s is longer than the longest step, " +
                     rounded(options.longest, 4) + " s");
  options.integrators = chosen_integrators(words.integrators);
  return options;
}

}  // namespace

int stability(const std::filesystem::path& path, const StabilityWords& words, const CommonOptions& common) {
  for (const Setting& setting : common.settings)
    for (const auto& [option, instead] :
         {std::pair{"--integrator", "--integrators"}, {"--time-step", "--longest and --shortest"}})
      if (setting.where == option)
        throw InputError(std::string(option) + ": stability looks for steps of several integrators; give " +
                         instead);
  const Scene scene = read_scene(path, common.settings);
  StabilityTable table;
  table.scene = scene.label;
  table.options = options_of(words, scene);
  if (scene.simulation.threads > 0) set_threads(scene.simulation.threads);
  const std::filesystem::path folder =
      common.out.empty() ? std::filesystem::path("out") / "stability" / path.stem() : common.out;
  make_output_folder(folder, {"stability.json", "stability.csv"});
  catch_interrupts();
  table.spectrum = spectrum_of(scene);
  for (const std::string& integrator : table.options.integrators) {
    if (!common.quiet) std::fprintf(stderr, "looking for the largest step of %s\n", integrator.c_str());
    const auto row = largest_stable_step(scene, integrator, table.options, table.spectrum);
    if (!row) {
      if (!common.quiet) std::fprintf(stderr, "interrupted: nothing is written\n");
      return 130;
    }
    table.rows.push_back(*row);
  }
  std::vector<AtomicFile> files;
  const auto add = [&](const char* name, const std::string& text) {
    files.emplace_back(folder / name).write(text);
    files.back().close();
  };
  add("stability.json", stability_json(table));
  add("stability.csv", stability_csv(table));
  for (AtomicFile& file : files) file.keep();
  if (common.quiet) return 0;
  std::fputs(stability_text(table).c_str(), stdout);
  for (const AtomicFile& file : files) std::printf("wrote %s\n", file.path().string().c_str());
  return 0;
}

}  // namespace drape::app
