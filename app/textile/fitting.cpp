#include "app/textile/fitting.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>

#include "app/base/interrupt.h"
#include "app/base/words.h"
#include "app/textile/least_squares.h"
#include "app/textile/options.h"
#include "mesh/base/errors.h"
#include "solver/forces/woven.h"

namespace drape::app {
namespace {

bool in(const Names& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

bool is_bend(const std::string& name) { return name.starts_with("bend"); }

// The number that is fitted: all of a stiffness, but of the bias what it has above the least.
double fitted_number(const Fabric& fabric, const std::string& name) {
  const Weave& w = fabric.weave;
  if (name == "bend.weft") return w.bend_weft.value_or(fabric.bend);
  if (name == "bend.bias") return *w.bend_bias - least_bend_bias(fabric);
  return name == "stretch.shear" ? *w.shear : fabric.bend;
}

void set_number(Fabric& fabric, const std::string& name, double value) {
  if (name == "bend.weft")
    fabric.weave.bend_weft = value;
  else if (name == "bend.bias")
    fabric.weave.bend_bias = least_bend_bias(fabric) + value;
  else if (name == "stretch.shear")
    fabric.weave.shear = value;
  else
    fabric.bend = value;
}

double value_of(const Fabric& fabric, const std::string& name) {
  return name == "bend.bias" ? *fabric.weave.bend_bias : fitted_number(fabric, name);
}

bool given(const NamedFabric& named, const std::string& name) {
  if (name == "stretch.shear") return named.fabric.weave.shear.has_value();
  const bool bend = named.record.given.contains("bend");
  if (name == "bend.weft") return bend && named.fabric.weave.bend_weft;
  if (name == "bend.bias") return bend && named.fabric.weave.bend_bias;
  return bend;
}

void check_names(const NamedFabric& named, const Names& names) {
  const auto refuse = [](const std::string& name, const std::string& why) {
    throw InputError("--parameters " + name + ": " + why);
  };
  for (const std::string& name : names) {
    if (!in(fit_parameters, name))
      refuse(name, "there is no such parameter; " + suggestion(name, fit_parameters));
    if (std::count(names.begin(), names.end(), name) > 1) refuse(name, "stands there twice; name it once");
    if (given(named, name)) refuse(name, named.name + " gives it already; leave it out here or there");
    if (name == "bend" && (in(names, "bend.warp") || in(names, "bend.weft")))
      refuse(name, "is the same along warp and weft; name bend, or bend.warp and bend.weft");
    const bool beside_warp = name == "bend.weft" || name == "bend.bias";
    if (beside_warp && !in(names, "bend.warp") && !in(names, "bend") && !given(named, "bend"))
      refuse(name, "is fitted beside bend.warp; name that, too");
  }
}

// The unknowns, in the order in which they are set: the bias after warp and weft.
struct Unknowns {
  Names names;
  Fabric start;

  Fabric at(const Eigen::VectorXd& x) const {
    Fabric fabric = start;
    for (std::size_t k = 0; k < names.size(); ++k)
      set_number(fabric, names[k],
                 fitted_number(start, names[k]) * std::exp(x[static_cast<Eigen::Index>(k)]));
    return fabric;
  }
};

Unknowns unknowns_of(const NamedFabric& named, const Names& chosen) {
  Unknowns unknowns{{}, named.fabric};
  for (const std::string& name : fit_parameters) {
    if (!in(chosen, name)) continue;
    unknowns.names.push_back(name);
    const double area_density = named.fabric.area_density;
    double start = name == "stretch.shear"
                       ? shear_to_start_from(named.tests)
                       : bend_to_start_from(named.tests, area_density, name.substr(name.find('.') + 1));
    if (name == "bend.bias") start = std::max(start - least_bend_bias(unknowns.start), 0.2 * start);
    set_number(unknowns.start, name, start);
  }
  return unknowns;
}

// Runs virtual tests, each once for the same numbers.
class Laboratory {
 public:
  explicit Laboratory(std::vector<Measurement> measurements)
      : measurements_(std::move(measurements)), known_(measurements_.size()) {}

  const std::vector<Measurement>& measurements() const { return measurements_; }
  int tests() const { return tests_; }

  const Found& found(std::size_t k, const Fabric& fabric) {
    const Weave& w = fabric.weave;
    const double shear = w.shear.value_or(0);
    const auto [entry, is_new] = known_[k].try_emplace(
        measurements_[k].bends
            ? std::vector<double>{shear, fabric.bend, w.bend_weft.value_or(0), w.bend_bias.value_or(0)}
            : std::vector<double>{shear});
    if (is_new) {
      entry->second = measurements_[k].test(fabric);
      ++tests_;
      end_if_interrupted();
    }
    return entry->second;
  }

 private:
  std::vector<Measurement> measurements_;
  std::vector<std::map<std::vector<double>, Found>> known_;
  int tests_ = 0;
};

std::string amount(double value, const Unit& unit) {
  return rounded(value / unit.in_si, 4) + " " + unit.name;
}

std::string bend_or_shear(const std::string& name, double value) {
  return is_bend(name) ? rounded(1e6 * value, 4) + " uN.m" : rounded(value, 4) + " N/m";
}

std::vector<Measurement> chosen_measurements(const NamedFabric& named, const Names& names, bool by_user,
                                             const SpecimenOptions& specimens) {
  const bool bend = std::any_of(names.begin(), names.end(), is_bend), shear = in(names, "stretch.shear");
  std::vector<Measurement> chosen;
  // Shear has a part in the drape of a disc, too; but where shear alone is sought, flat specimens say more of
  // it.
  for (Measurement& m : measurements_of(named.tests, specimens))
    if (m.bends ? bend || by_user : shear) chosen.push_back(std::move(m));
  return chosen;
}

void check_count(const NamedFabric& named, const Names& names, std::size_t measured) {
  if (measured >= names.size()) return;
  const std::string has = measured == 0
                              ? "no measurement"
                              : std::to_string(measured) + (measured == 1 ? " measurement" : " measurements");
  throw InputError(named.name + ": " + has + " for " + std::to_string(names.size()) + " parameters (" +
                   listed(names) + "); give more measurements, or fewer --parameters");
}

// Throws InputError when the residuals do not depend on a parameter, or on two of them in the same way.
void check_slopes(const NamedFabric& named, const Names& names, const Eigen::MatrixXd& slopes) {
  Eigen::MatrixXd unit = slopes;
  for (Eigen::Index k = 0; k < slopes.cols(); ++k) {
    const double size = slopes.col(k).norm();  // in tolerances, for a change to e times the value
    if (!(size > 0.05))
      throw InputError(named.name + ": as simulated, nothing measured depends on " +
                       names[static_cast<std::size_t>(k)] +
                       "; give it, measure what does, or take a finer --mesh");
    unit.col(k) /= size;
  }
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(unit);
  if (svd.singularValues().minCoeff() < 0.1)
    throw InputError(named.name + ": the measurements cannot tell " + listed(names) +
                     " apart; give fewer --parameters, or measure in more directions");
}

std::vector<FittedParameter> fitted(const Unknowns& unknowns, const Fabric& fabric,
                                    const Eigen::MatrixXd& slopes) {
  const Eigen::MatrixXd variance = (slopes.transpose() * slopes).inverse();
  std::vector<FittedParameter> all;
  for (std::size_t k = 0; k < unknowns.names.size(); ++k) {
    const std::string& name = unknowns.names[k];
    const auto i = static_cast<Eigen::Index>(k);
    const double value = value_of(fabric, name);
    all.push_back({name, value, std::sqrt(variance(i, i)) * fitted_number(fabric, name) / value});
  }
  return all;
}

}  // namespace

bool FittedValue::met() const { return std::abs(found - measured) <= tolerance; }

bool Fitting::met() const {
  return std::all_of(comparisons.begin(), comparisons.end(), [](const FittedValue& c) { return c.met(); });
}

Names parameters_to_fit(const NamedFabric& fabric) {
  const MeasuredTests& tests = fabric.tests;
  Names names;
  if (!given(fabric, "bend")) {
    bool weft = false, bias = false;
    for (const MeasuredCantilever& c : tests.cantilevers) {
      weft |= c.droop.weft.has_value();
      bias |= c.droop.bias.has_value();
    }
    if (!tests.cantilevers.empty() || tests.drape) names.emplace_back(weft || bias ? "bend.warp" : "bend");
    if (weft) names.emplace_back("bend.weft");
    if (bias) names.emplace_back("bend.bias");
  }
  if (!given(fabric, "stretch.shear") && !(tests.bias_extensions.empty() && tests.frames.empty()))
    names.emplace_back("stretch.shear");
  return names;
}

Fitting fit_fabric(const NamedFabric& named, Names parameters, const SpecimenOptions& specimens,
                   const std::function<void(const std::string&)>& say) {
  const bool by_user = !parameters.empty();
  if (!by_user) parameters = parameters_to_fit(named);
  check_names(named, parameters);
  check_widths(named);
  Laboratory laboratory(chosen_measurements(named, parameters, by_user, specimens));
  const std::vector<Measurement>& measured = laboratory.measurements();
  check_count(named, parameters, measured.size());
  const Unknowns unknowns = unknowns_of(named, parameters);

  const Residuals residuals = [&](const Eigen::VectorXd& x, Eigen::VectorXd& r) {
    const Fabric fabric = unknowns.at(x);
    const int before = laboratory.tests();
    std::string line;
    for (const std::string& name : unknowns.names)
      line += (line.empty() ? "" : ", ") + name + " " + bend_or_shear(name, value_of(fabric, name));
    for (std::size_t k = 0; k < measured.size(); ++k) {
      const double found = laboratory.found(k, fabric).value;
      r[static_cast<Eigen::Index>(k)] = (found - measured[k].measured) / measured[k].tolerance;
      line += (k == 0 ? ": " : ", ") + measured[k].name + " " + amount(found, measured[k].unit);
    }
    if (laboratory.tests() > before) say(line);
    return r.allFinite();
  };
  const double step = std::max_element(measured.begin(), measured.end(), [](const auto& a, const auto& b) {
                        return a.step < b.step;
                      })->step;
  const LeastSquares best = least_squares(residuals, static_cast<int>(unknowns.names.size()),
                                          static_cast<int>(measured.size()), step, 60);
  check_slopes(named, unknowns.names, best.slopes);

  Fitting fitting;
  fitting.fabric = unknowns.at(best.x);
  fitting.parameters = fitted(unknowns, fitting.fabric, best.slopes);
  for (std::size_t k = 0; k < measured.size(); ++k) {
    const Found& found = laboratory.found(k, fitting.fabric);
    const Measurement& m = measured[k];
    fitting.comparisons.push_back(
        {m.name, m.unit, m.measured, found.value, m.tolerance, m.bends, found.beside});
  }
  fitting.tests = laboratory.tests();
  fitting.rounds = best.rounds;
  fitting.ended = best.ended;
  fitting.specimens = specimens;
  return fitting;
}

std::string parameter_text(const FittedParameter& p) { return p.name + " " + bend_or_shear(p.name, p.value); }

std::string fitting_text(const Fitting& fitting, const std::string& from) {
  std::string text =
      from + ", fitted by virtual tests on a mesh of " + millimetres(fitting.specimens.edge) + "\n";
  for (const FittedValue& c : fitting.comparisons) {
    text += "  " + c.name + ": measured " + rounded(c.measured / c.unit.in_si, 4) + " ± " +
            amount(c.tolerance, c.unit) + ", found " + amount(c.found, c.unit) +
            (c.beside.empty() ? "" : "; " + c.beside) + "\n";
  }
  for (const FittedParameter& p : fitting.parameters)
    text += "  " + parameter_text(p) +
            (p.uncertainty < 1
                 ? ", ± " + rounded(100 * p.uncertainty, 2) + " % if the measurements are off by their ±\n"
                 : ", which what was measured hardly ties down\n");
  const bool same = fitting.parameters.front().name == "bend";
  if (same)
    text +=
        "  bend is that of a fabric which is the same along warp and weft: nothing here tells them apart\n";
  const double c = std::cbrt(fitting.fabric.bend / (fitting.fabric.area_density * standard_gravity));
  const bool bends = std::any_of(fitting.comparisons.begin(), fitting.comparisons.end(),
                                 [](const FittedValue& value) { return value.bends; });
  if (bends && fitting.specimens.edge > 0.6 * c)
    text += "  this mesh is too coarse for a bending length of " + millimetres(c) + "; take --mesh " +
            millimetres(0.5 * c) + " or finer\n";
  return text + "  " + std::to_string(fitting.tests) + " virtual tests in " + std::to_string(fitting.rounds) +
         (fitting.rounds == 1 ? " round" : " rounds") + " of Levenberg and Marquardt's method; " +
         fitting.ended + "\n";
}

}  // namespace drape::app
