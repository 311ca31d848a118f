#include "app/commands/fit.h"

#include <cstdio>

#include "app/base/atomic_file.h"
#include "app/base/interrupt.h"
#include "app/commands/fabric_writer.h"
#include "app/scene/fabric_words.h"
#include "app/textile/options.h"
#include "mesh/base/errors.h"

namespace drape::app {
namespace {

void check_output(const FitWords& words) {
  const std::filesystem::path out(words.out);
  if (!is_fabric_file(words.out)) throw InputError(words.out + ": expected a name that ends in .toml");
  std::error_code error;
  if (std::filesystem::equivalent(out, words.from, error))
    throw InputError(words.out + ": is the file that is read; give the new one another name");
  if (!words.force && std::filesystem::exists(out))
    throw InputError(words.out + ": is there already; --force replaces it");
}

// Unset: formulas give everything that the file can give.
std::optional<Fitting> fit_what_is_open(const FitWords& words, const NamedFabric& named) {
  const Names parameters = words.parameters.empty() ? Names() : names_in(words.parameters);
  if (parameters.empty() && parameters_to_fit(named).empty()) {
    for (const auto& [option, value] :
         {std::pair{"--mesh", &words.mesh}, std::pair{"--repeats", &words.repeats}})
      if (!value->empty())
        throw InputError(std::string(option) + " " + *value + ": is of virtual tests, and " + words.from +
                         " needs none: formulas give what it measured");
    return {};
  }
  SpecimenOptions specimens;
  if (!words.mesh.empty()) specimens.edge = specimen_length(words.mesh, "--mesh", least_edge, most_edge);
  if (!words.repeats.empty()) specimens.repeats = repeats_of(words.repeats);
  return fit_fabric(named, parameters, specimens, [&](const std::string& line) {
    if (!words.quiet) std::fprintf(stderr, "%s\n", line.c_str());
  });
}

// What is said when a measurement is not met: nothing is written then.
void print_misfit(const Fitting& fitting) {
  Names names, values, missed;
  for (const FittedParameter& p : fitting.parameters) {
    names.push_back(p.name);
    values.push_back(parameter_text(p));
  }
  for (const FittedValue& c : fitting.comparisons)
    if (!c.met())
      missed.push_back(c.name + " comes out as " + rounded(c.found / c.unit.in_si, 4) + " " + c.unit.name +
                       " and not " + rounded(c.measured / c.unit.in_si, 4));
  std::fprintf(stderr, "error: no %s fits: at best, with %s, %s; check the measurement and area_density\n",
               listed(names).c_str(), listed(values).c_str(), listed(missed).c_str());
}

}  // namespace

int fit(const FitWords& words) {
  if (!words.out.empty()) check_output(words);
  const Node root = read_toml(words.from);
  const NamedFabric named = read_fabric_file(root, words.from);
  catch_interrupts();
  std::optional<Fitting> fitting;
  try {
    fitting = fit_what_is_open(words, named);
  } catch (const Interrupted&) {
    if (!words.quiet) std::fprintf(stderr, "interrupted: nothing is written\n");
    return 130;
  }
  if (fitting && !words.quiet)
    std::fputs(fitting_text(*fitting, one_line(words.from)).c_str(), words.out.empty() ? stderr : stdout);
  if (fitting && !fitting->met()) {
    print_misfit(*fitting);
    return 1;
  }
  const std::string text = fabric_file(root, named, fitting ? &*fitting : nullptr, words.from);
  if (words.out.empty()) {
    std::fputs(text.c_str(), stdout);
    return 0;
  }
  AtomicFile file(words.out);
  file.write(text);
  file.keep();
  if (words.quiet) return 0;
  std::printf("%s\n", in_words(fitting ? fitting->fabric : named.fabric).c_str());
  for (const std::string& line : lines_of(named.record)) std::printf("%s\n", one_line(line).c_str());
  std::printf("wrote %s\n", words.out.c_str());
  return 0;
}

}  // namespace drape::app
