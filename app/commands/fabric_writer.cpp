#include "app/commands/fabric_writer.h"

#include <algorithm>

namespace drape::app {
namespace {

constexpr int digits = 6;

// The formula of a key of a laboratory.
std::string formula(const std::string& key) {
  if (key == "bending_length" || key == "fast.C") return "B = g area_density c^3, g = 9.80665 m/s^2";
  if (key == "overhang") return "B = g area_density (overhang / 2)^3, g = 9.80665 m/s^2";
  if (key == "kes.EMT") return "the secant 490.3325 N/m / EMT";
  if (key == "fast.E5") return "the secant 4.903325 N/m / E5";
  if (key == "fast.E20") return "the secant 19.6133 N/m / E20";
  if (key == "fast.E100") return "the secant 98.0665 N/m / E100";
  if (key == "fast.EB5") return "G = 4.903325 N/m / (4 EB5)";
  return {};
}

// Writes the file: a line for each parameter with what it is from, then the lists of what was measured.
class FabricFile {
 public:
  FabricFile(const Node& root, const NamedFabric& named, const Fitting* fitting)
      : root_(root), named_(named), fabric_(fitting ? fitting->fabric : named.fabric), fitting_(fitting) {}

  std::string text(const std::string& from) {
    text_ = "# Made by `drape fit` from " + one_line(from) + ".\n";
    for (const char* key : {"description", "source"})
      if (root_.members.contains(key)) keep(key);
    const Fabric& f = fabric_;
    line("area_density", quantity(1000 * f.area_density, "g/m^2"));
    add_stretch();
    add_bend();
    for (const char* key : {"thickness", "buckling_clamp", "damping", "damping_kind", "neighbour_weighting",
                            "compression", "viscosity", "measured_drape", "measured_cantilever",
                            "measured_bias_extension", "measured_picture_frame"})
      if (root_.members.contains(key)) keep(key);
    add_hysteresis();
    text_ += "\n";
    for (const auto& [list, names] : {std::pair{"measured", &measured_}, std::pair{"converted", &converted_},
                                      std::pair{"fitted", &fitted_}, std::pair{"assumed", &assumed_}}) {
      if (names->empty() && names == &fitted_) continue;
      text_ += std::string(list) + " = [";
      for (const std::string& name : *names) text_ += (&name == names->data() ? "\"" : ", \"") + name + "\"";
      text_ += "]\n";
    }
    return text_;
  }

 private:
  static std::string quantity(double value, const char* unit) {
    return "\"" + rounded(value, digits) + " " + unit + "\"";
  }

  // The list that the number at `from` ("kes.B", "" when nothing gave it) and what follows from it stand in.
  // A number that the file says nothing of counts as measured.
  Names& list_of(const std::string& from, bool by_formula) {
    const auto in = [&](const Names& names) {
      return std::any_of(names.begin(), names.end(), [&](const std::string& name) {
        return name == from || from.starts_with(name + ".") || name.starts_with(from + ".");
      });
    };
    if (from.empty() || in(named_.assumed)) return assumed_;
    if (in(named_.fitted)) return fitted_;
    return by_formula || in(named_.converted) ? converted_ : measured_;
  }

  // "kes.B" of "kes.B = \"0.1 gf.cm^2/cm\"".
  std::string key_of(const std::string& parameter) const {
    const auto given = named_.record.given.find(parameter);
    return given == named_.record.given.end() ? "" : given->second.substr(0, given->second.find(" = "));
  }

  // Whether the number was fitted. "bend" and "bend.warp" are one.
  bool is_fitted(const std::string& number) const {
    if (!fitting_) return false;
    const auto alone = [](const std::string& name) { return name == "bend" ? "bend.warp" : name; };
    return std::any_of(fitting_->parameters.begin(), fitting_->parameters.end(),
                       [&](const FittedParameter& p) { return alone(p.name) == alone(number); });
  }

  // What the numbers were fitted to: for a rigidity the tests that bend, for the shear those that do not, if
  // there are any.
  std::string fit_comment(bool bend) const {
    const std::vector<FittedValue>& all = fitting_->comparisons;
    const bool flat = std::any_of(all.begin(), all.end(), [](const FittedValue& c) { return !c.bends; });
    std::string text;
    for (const FittedValue& c : all) {
      if (c.bends != (bend || !flat)) continue;
      const auto amount = [&](double value) { return rounded(value / c.unit.in_si, 4); };
      text += (text.empty() ? "fitted: " : ", ") + c.name + " " + amount(c.found) + " " + c.unit.name +
              ", measured " + amount(c.measured);
    }
    return text + "; mesh " + rounded(1000 * fitting_->specimens.edge, 3) + " mm";
  }

  // The comment of a parameter, or of a table of which one number at least was fitted.
  std::string comment(const std::string& parameter) const {
    const bool some = parameter == "bend"
                          ? is_fitted("bend") || is_fitted("bend.weft") || is_fitted("bend.bias")
                      : parameter == "shear" ? is_fitted("stretch.shear")
                                             : false;
    if (!some) return origin(parameter);
    const std::string fit = fit_comment(parameter == "bend");
    return key_of(parameter).empty() ? fit : origin(parameter) + "; " + fit;
  }

  // Of a parameter that was not fitted.
  std::string origin(const std::string& parameter) const {
    const std::string key = key_of(parameter);
    if (key.empty()) return "nobody gave it: the program's default";
    const std::string& given = named_.record.given.at(parameter);
    const bool slope = given.find(", fast.E20 = ") != given.npos;
    const std::string by = slope ? "the slope 14.709975 N/m / (E20 - E5)" : formula(key);
    return (by.empty() ? "given as " : by + ", ") + given;
  }

  // "bend.weft" stands in the list of "kes.B.weft" where the file has that, else in the list of "kes.B".
  void mark(const std::string& number, const std::string& parameter) {
    if (is_fitted(number)) return fitted_.push_back(number);
    const std::string key = key_of(parameter);
    const std::size_t dot = number.find('.');
    const std::string own = key.empty() || dot == number.npos ? key : key + number.substr(dot);
    list_of(has(own) ? own : key, key != parameter).push_back(number);
  }

  // Whether the file has a value at "kes.B.warp".
  bool has(const std::string& path) const {
    const Node* node = &root_;
    for (std::size_t begin = 0; begin <= path.size();) {
      const std::size_t end = std::min(path.find('.', begin), path.size());
      const auto found = node->members.find(path.substr(begin, end - begin));
      if (found == node->members.end()) return false;
      node = &found->second;
      begin = end + 1;
    }
    return true;
  }

  void line(const std::string& parameter, const std::string& value) {
    text_ += parameter + " = " + value + "  # " + comment(parameter) + "\n";
    mark(parameter, parameter);
  }

  void add_stretch() {
    const Fabric& f = fabric_;
    const Weave& w = f.weave;
    if (f.stretch_spring) return keep("stretch_spring");
    const bool has_ratio = w.poisson != Weave().poisson;
    if (!w.stretch_weft && !w.shear && !has_ratio) return line("stretch", quantity(f.stretch, "N/m"));
    std::string members = "warp = " + quantity(f.stretch, "N/m"), why = comment("stretch");
    mark("stretch.warp", "stretch");
    if (w.stretch_weft) {
      members += ", weft = " + quantity(*w.stretch_weft, "N/m");
      mark("stretch.weft", "stretch");
    }
    if (w.shear) {
      const bool own = named_.record.given.contains("shear") || is_fitted("stretch.shear");
      members += ", shear = " + quantity(*w.shear, "N/m");
      mark("stretch.shear", own ? "shear" : "stretch");
      if (own) why += "; " + comment("shear");
    }
    if (has_ratio) {
      members += ", poisson = " + rounded(w.poisson, digits);
      mark("stretch.poisson", "stretch");
    }
    text_ += "stretch = { " + members + " }  # " + why + "\n";
  }

  void add_bend() {
    const Fabric& f = fabric_;
    const Weave& w = f.weave;
    if (f.bend_spring) return keep("bend_spring");
    const bool has_ratio = w.bend_poisson != Weave().bend_poisson;
    if (!w.bend_weft && !w.bend_bias && !has_ratio) return line("bend", quantity(1e6 * f.bend, "uN.m"));
    std::string members = "warp = " + quantity(1e6 * f.bend, "uN.m");
    mark("bend.warp", "bend");
    for (const auto& [key, value] : {std::pair{"weft", w.bend_weft}, std::pair{"bias", w.bend_bias}}) {
      if (!value) continue;
      members += std::string(", ") + key + " = " + quantity(1e6 * *value, "uN.m");
      mark(std::string("bend.") + key, "bend");
    }
    if (has_ratio) {
      members += ", poisson = " + rounded(w.bend_poisson, digits);
      mark("bend.poisson", "bend");
    }
    text_ += "bend = { " + members + " }  # " + comment("bend") + "\n";
  }

  // As the file has it.
  void keep(const std::string& key) {
    text_ += key + " = " + toml_text(root_.members.at(key)) + "\n";
    const Names words = {"description", "source", "damping_kind", "neighbour_weighting"};
    if (std::find(words.begin(), words.end(), key) == words.end()) list_of(key, false).push_back(key);
  }

  void add_hysteresis() {
    const auto kes = root_.members.find("kes");
    if (kes == root_.members.end()) return;
    std::string members;
    for (const char* key : {"2HB", "2HG"}) {
      const auto width = kes->second.members.find(key);
      if (width == kes->second.members.end()) continue;
      members += (members.empty() ? "" : ", ") + std::string(key) + " = " + toml_text(width->second);
      list_of(std::string("kes.") + key, false).push_back(std::string("kes.") + key);
    }
    if (!members.empty()) text_ += "kes = { " + members + " }  # as the file has it\n";
  }

  const Node& root_;
  const NamedFabric& named_;
  const Fabric& fabric_;
  const Fitting* fitting_;
  Names measured_, converted_, fitted_, assumed_;
  std::string text_;
};

}  // namespace

std::string fabric_file(const Node& root, const NamedFabric& named, const Fitting* fitting,
                        const std::string& from) {
  return FabricFile(root, named, fitting).text(from);
}

}  // namespace drape::app
