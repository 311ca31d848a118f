#include "app/compare/options.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "app/base/units.h"
#include "mesh/base/errors.h"
#include "solver/integrators/integrator.h"

namespace drape::app {
namespace {

[[noreturn]] void refuse(const std::string& option, const std::string& given, const std::string& why) {
  throw InputError(option + " " + given + ": " + why);
}

// "a,b" -> a, b, without blanks around; an empty part is a mistake.
Names parts_of(const std::string& option, const std::string& text) {
  Names parts;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    std::string part = text.substr(begin, end - begin);
    part.erase(0, part.find_first_not_of(' '));
    part.erase(part.find_last_not_of(' ') + 1);
    if (part.empty()) refuse(option, text, "expected names or numbers with commas between");
    if (std::find(parts.begin(), parts.end(), part) != parts.end())
      refuse(option, text, "'" + part + "' is there twice");
    parts.push_back(part);
    begin = end + 1;
  }
  return parts;
}

double number(const std::string& option, const std::string& text, const std::string& expected) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
    refuse(option, text, "expected " + expected);
  return value;
}

int whole(const std::string& option, const std::string& text, int least, int most) {
  const std::string expected = "a whole number from " + std::to_string(least) + " to " + std::to_string(most);
  const double value = number(option, text, expected);
  if (value != std::floor(value) || value < least || value > most)
    refuse(option, text, "expected " + expected);
  return static_cast<int>(value);
}

// A solver says itself whether it knows its name: it may carry a preconditioner.
void check_solver(const std::string& text, const std::string& name) {
  try {
    make_linear_solver(name);
  } catch (const InputError& error) {
    Names known;
    for (const LinearSolverInfo& info : linear_solvers()) known.emplace_back(info.name);
    const std::string near = nearest(name, known);
    throw InputError("--solvers " + text + ": " + error.what() +
                     (near.empty() ? "" : "; did you mean '" + near + "'?"));
  }
}

SolverChoice solver(const std::string& text) {
  SolverChoice choice{text, text.substr(0, text.find('@')), {}};
  check_solver(text, choice.name);
  if (choice.name.size() < text.size()) {
    const std::string expected =
        "NAME@TOLERANCE with a tolerance greater than zero and less than 1, such as mpcg@1e-3";
    const std::string given = text.substr(choice.name.size() + 1);
    double tolerance = 0;
    const auto [end, error] = std::from_chars(given.data(), given.data() + given.size(), tolerance);
    if (error != std::errc() || end != given.data() + given.size() || !(tolerance > 0) || !(tolerance < 1))
      refuse("--solvers", text, "expected " + expected);
    choice.tolerance = tolerance;
  }
  return choice;
}

std::vector<SolverChoice> solvers(const std::string& text) {
  std::vector<SolverChoice> choices;
  if (text.empty()) {
    for (const LinearSolverInfo& info : linear_solvers())
      choices.push_back({std::string(info.name), std::string(info.name), {}});
  } else {
    for (const std::string& part : parts_of("--solvers", text)) choices.push_back(solver(part));
  }
  return choices;
}

Names integrator_names(const std::string& text) {
  if (text.empty()) return {};
  Names known;
  for (const IntegratorInfo& info : integrators()) known.emplace_back(info.name);
  Names names = parts_of("--integrators", text);
  for (const std::string& name : names) {
    if (const std::string missing = missing_integrator(name); !missing.empty())
      refuse("--integrators", name, missing);
    if (std::find(known.begin(), known.end(), name) == known.end())
      refuse("--integrators", name, "there is no such integrator; " + suggestion(name, known));
  }
  return names;
}

std::vector<double> time_steps(const std::string& text) {
  std::vector<double> steps;
  if (text.empty()) return steps;
  for (const std::string& part : parts_of("--time-steps", text)) {
    try {
      steps.push_back(parse_quantity(part, dimension::time));
    } catch (const InputError& error) {
      refuse("--time-steps", part, error.what());
    }
    if (!(steps.back() > 0)) refuse("--time-steps", part, "a time step is greater than zero");
  }
  std::sort(steps.rbegin(), steps.rend());
  return steps;
}

// 1k, 2.5k, 1M or a plain number of vertices.
std::vector<int> sizes(const std::string& text) {
  std::vector<int> counts;
  if (text.empty()) return counts;
  for (const std::string& part : parts_of("--sizes", text)) {
    const std::string expected = "how many vertices, 16 to 4M, such as 1k, 2500 or 1M";
    double factor = 1;
    std::string digits = part;
    if (part.ends_with('k') || part.ends_with('K')) factor = 1e3, digits.pop_back();
    if (part.ends_with('M')) factor = 1e6, digits.pop_back();
    const double count = factor * number("--sizes", digits, expected);
    if (!(count >= 16) || !(count <= 4e6)) refuse("--sizes", part, "expected " + expected);
    counts.push_back(static_cast<int>(std::lround(count)));
  }
  std::sort(counts.begin(), counts.end());
  return counts;
}

}  // namespace

CompareOptions compare_options(const CompareWords& words) {
  CompareOptions options;
  options.solvers = solvers(words.solvers);
  options.solvers_given = !words.solvers.empty();
  if (!words.steps.empty()) options.steps = whole("--steps", words.steps, 1, 1000000);
  if (!words.repeats.empty()) options.repeats = whole("--repeats", words.repeats, 1, 1000);
  if (!words.at.empty())
    for (const std::string& part : parts_of("--at", words.at))
      options.at.push_back(whole("--at", part, 1, 1000000));
  std::sort(options.at.begin(), options.at.end());
  if (options.steps > 0 && !options.at.empty() && options.at.back() > options.steps)
    throw InputError("--at " + std::to_string(options.at.back()) + ": is after the last step, --steps " +
                     std::to_string(options.steps));
  options.integrators = integrator_names(words.integrators);
  options.time_steps = time_steps(words.time_steps);
  options.sizes = sizes(words.sizes);
  options.save_systems = words.save_systems;
  if (options.integrators.empty() && !options.time_steps.empty())
    throw InputError("--time-steps: are those of --integrators, which is not given");
  return options;
}

}  // namespace drape::app
