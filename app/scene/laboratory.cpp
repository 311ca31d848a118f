#include "app/scene/laboratory.h"

#include <algorithm>
#include <array>

#include "mesh/base/errors.h"
#include "solver/forces/woven.h"

namespace drape::app {
namespace {

constexpr double gf_per_cm = 100 * standard_gravity / 1000;  // N/m

// A word of a laboratory, the table that it belongs to ("": the fabric itself), and how it is written there.
struct Word {
  const char *word, *table, *written;
};
constexpr std::array<Word, 22> words{{
    {"bending_length", "", "bending_length = \"2.1 cm\""},
    {"overhang", "", "overhang = \"4.2 cm\""},
    {"kes", "", "kes = { B = \"0.118 gf.cm^2/cm\" }"},
    {"fast", "", "fast = { C = \"21 mm\" }"},
    {"B", "kes", "kes = { B = \"0.118 gf.cm^2/cm\" }"},
    {"2HB", "kes", "kes = { 2HB = \"0.12 gf.cm/cm\" }"},
    {"G", "kes", "kes = { G = \"0.8 gf/(cm.deg)\" }"},
    {"2HG", "kes", "kes = { 2HG = \"2.1 gf/cm\" }"},
    {"EMT", "kes", "kes = { EMT = \"3.5 %\" }"},
    {"G", "fast", "fast = { G = \"45 N/m\" }"},
    {"C", "fast", "fast = { C = \"21 mm\" }"},
    {"E5", "fast", "fast = { E5 = \"0.8 %\" }"},
    {"E20", "fast", "fast = { E20 = \"1.9 %\" }"},
    {"E100", "fast", "fast = { E100 = \"4 %\" }"},
    {"EB5", "fast", "fast = { EB5 = \"3.2 %\" }"},
    {"drape_coefficient", "file", "measured_drape = { coefficient = \"45 %\" } of a fabric file"},
    {"bending_rigidity", "file", "bend = \"10 uN.m\""},
    {"weight", "file", "area_density = \"150 g/m^2\""},
    {"W", "file", "area_density = \"15 mg/cm^2\""},
    {"LT", "no", ""},
    {"WT", "no", ""},
    {"RT", "no", ""},
}};

// The value at "kes.B"; null: there is none.
const Node* at(const Table& table, const std::string& path) {
  const std::size_t dot = path.find('.');
  const Node* const outer = table.find(path.substr(0, dot));
  if (!outer || dot == path.npos) return outer;
  const auto inner = outer->members.find(path.substr(dot + 1));
  return inner == outer->members.end() ? nullptr : &inner->second;
}

// Which of the keys is there. Two of them are refused, for both would say the same of the fabric.
std::string one_of(const Table& table, const char* what, const Names& keys) {
  std::string found;
  for (const std::string& key : keys) {
    const Node* const node = at(table, key);
    if (!node) continue;
    if (!found.empty())
      throw InputError(node->where + ": " + key + " = " + written(*node) + ": " +
                       std::string(found).append(" says ").append(what) +
                       " already; give one of the two, not both; see docs/fabrics.md");
    found = key;
  }
  return found;
}

void note_given(const Table& table, const std::string& quantity, const std::string& key,
                FabricRecord& record) {
  if (!key.empty()) record.given[quantity] = key + " = " + toml_text(*at(table, key));
}

Directions each(const Directions& from, double (*f)(double, double), double with) {
  Directions to{f(from.warp, with)};
  if (from.weft) to.weft = f(*from.weft, with);
  if (from.bias) to.bias = f(*from.bias, with);
  return to;
}

void set_bend(Fabric& fabric, const Directions& bend) {
  fabric.bend_spring.reset();
  fabric.bend = bend.warp;
  fabric.weave.bend_weft = bend.weft;
  fabric.weave.bend_bias = bend.bias;
  fabric.weave.bend_poisson = Weave().bend_poisson;
}

void set_stretch(Fabric& fabric, const Directions& stretch) {
  fabric.stretch_spring.reset();
  fabric.stretch = stretch.warp;
  fabric.weave.stretch_weft = stretch.weft;
  fabric.weave.shear.reset();
  fabric.weave.poisson = Weave().poisson;
}

void set_bend_of_length(Fabric& fabric, const Directions& length, double part) {
  set_bend(fabric, each(each(
                            length, [](double c, double k) { return k * c; }, part),
                        bend_of_length, fabric.area_density));
}

// A fabric that stands out further than that is none: the unit was left out, or is another.
const Directions& checked_length(const Table& table, const char* key, const Directions& length, double most) {
  for (const std::optional<double>& one : {std::optional<double>(length.warp), length.weft, length.bias})
    if (one && *one > most)
      table.fail(key, "comes to " + rounded(*one, 4) + " m; expected up to " + rounded(100 * most, 3) +
                          " cm, such as \"2.1 cm\"");
  return length;
}

void check_bias(const Table& table, const std::string& key, const Fabric& fabric) {
  const std::optional<double>& bias = fabric.weave.bend_bias;
  const double least = least_bend_bias(fabric);
  if (bias && !(*bias > least))
    throw InputError(at(table, key)->where + ": " + key + ".bias: comes to " + rounded(1e6 * *bias, 4) +
                     " uN.m, but with this warp and weft a bending rigidity at 45 degrees is greater than " +
                     rounded(1e6 * least, 4) + " uN.m");
}

double secant(double extension, double load) { return load / extension; }

struct Fast {
  std::optional<Directions> E5, E20, E100;
};

// More load, more extension.
void check_rises(const Table& fast, const Fast& e) {
  const auto rises = [&](const char* key, const std::optional<Directions>& small,
                         const std::optional<Directions>& large, const char* what) {
    if (!small || !large) return;
    const auto is_less = [](const Directions& a, const Directions& b) {
      return a.warp < b.warp && a.weft.value_or(a.warp) < b.weft.value_or(b.warp);
    };
    if (!is_less(*small, *large)) fast.fail(key, std::string("expected more than ") + what);
  };
  rises("E20", e.E5, e.E20, "E5, the extension at a quarter of the load");
  rises("E100", e.E20, e.E100, "E20, the extension at a fifth of the load");
  rises("E100", e.E5, e.E100, "E5, the extension at a twentieth of the load");
}

// FAST's formability takes the slope between the loads of 5 and 20 gf/cm. Where it is not known, the secant
// of the smallest load: what a cloth that hangs comes nearest to.
void set_stretch_of_fast(const Fast& e, Fabric& fabric) {
  if (!e.E5 || !e.E20) {
    if (e.E5)
      set_stretch(fabric, each(*e.E5, secant, 5 * gf_per_cm));
    else if (e.E20)
      set_stretch(fabric, each(*e.E20, secant, 20 * gf_per_cm));
    else if (e.E100)
      set_stretch(fabric, each(*e.E100, secant, 100 * gf_per_cm));
    return;
  }
  const auto slope = [](double small, double large) { return 15 * gf_per_cm / (large - small); };
  Directions stretch{slope(e.E5->warp, e.E20->warp)};
  if (e.E5->weft || e.E20->weft)
    stretch.weft = slope(e.E5->weft.value_or(e.E5->warp), e.E20->weft.value_or(e.E20->warp));
  set_stretch(fabric, stretch);
}

// Reads all but the shear stiffness into the fabric and the record, and returns the shear stiffness [N/m].
std::optional<double> read_kes(Table& table, Fabric& fabric, FabricRecord& record) {
  const Node* const node =
      table.take("kes", "a table", "numbers of Kawabata's instruments, with the units that they print");
  if (!node) return {};
  if (node->kind != Node::Kind::table)
    table.fail("kes", "expected a table such as { B = \"0.118 gf.cm^2/cm\" }");
  Table kes = table.inner("kes");
  refuse_misplaced(kes, "kes");
  if (const auto B = read_directions(kes, "B", dimension::sheet_bend, true, "bending rigidity: gives bend"))
    set_bend(fabric, *B);
  if (const auto width = read_directions(
          kes, "2HB", dimension::sheet_moment, false,
          "width of the hysteresis of bending: gives the friction that hysteresis = true asks for"))
    record.bending_hysteresis = width;
  if (const auto EMT =
          read_directions(kes, "EMT", dimension::sheet_extension, false,
                          "extension at 500 gf/cm = 490.3 N/m: gives stretch as the secant 490.3 N/m / EMT"))
    set_stretch(fabric, each(*EMT, secant, 500 * gf_per_cm));
  std::optional<double> shear;
  if (const auto G = read_directions(kes, "G", dimension::sheet_shear, false,
                                     "shear stiffness: gives the shear of stretch, of two numbers the mean"))
    shear = 0.5 * (G->warp + G->weft.value_or(G->warp));
  if (const auto width =
          read_directions(kes, "2HG", dimension::sheet_force, false,
                          "width of the hysteresis of shear; no model has it: it is kept and shown"))
    record.shear_hysteresis = width;
  kes.finish();
  return shear;
}

std::optional<double> read_fast(Table& table, Fabric& fabric) {
  const Node* const node =
      table.take("fast", "a table", "numbers of the FAST instruments, with the units that they print");
  if (!node) return {};
  if (node->kind != Node::Kind::table) table.fail("fast", "expected a table such as { C = \"21 mm\" }");
  Table fast = table.inner("fast");
  refuse_misplaced(fast, "fast");
  if (const auto C = read_directions(fast, "C", dimension::sheet_length, true, "bending length: gives bend"))
    set_bend_of_length(fabric, *C, 1);
  const auto extension = [&](const char* key, const char* about) {
    return read_directions(fast, key, dimension::sheet_extension, false, about);
  };
  Fast e;
  e.E5 = extension(
      "E5", "extension at 5 gf/cm: gives stretch, with E20 as 14.7 N/m / (E20 - E5), else 4.9 N/m / E5");
  e.E20 =
      extension("E20", "extension at 20 gf/cm: gives stretch, with E5 as said there, else 19.6 N/m / E20");
  e.E100 = extension(
      "E100", "extension at 100 gf/cm: gives stretch where neither E5 nor E20 is there, 98.1 N/m / E100");
  check_rises(fast, e);
  set_stretch_of_fast(e, fabric);
  std::optional<double> shear, bias_extension;
  fast.read("G", shear, dimension::sheet_force, Range::positive,
            {"shear rigidity: gives the shear of stretch", "none"});
  fast.read("EB5", bias_extension, dimension::sheet_extension, Range::positive,
            {"extension in the bias at 5 gf/cm, instead of G: 4.903 N/m / (4 EB5)", "none"});
  fast.finish();
  if (bias_extension) shear = 5 * gf_per_cm / (4 * *bias_extension);
  return shear;
}

}  // namespace

double bend_of_length(double bending_length, double area_density) {
  return standard_gravity * area_density * bending_length * bending_length * bending_length;
}

void use_hysteresis(const FabricRecord& record, Fabric& fabric) {
  const std::optional<Directions>& width = record.bending_hysteresis;
  if (!width)
    throw InputError(
        "friction inside the fabric needs the width of its hysteresis of bending, "
        "kes = { 2HB = \"0.12 gf.cm/cm\" }, and the fabric has none; see docs/fabrics.md");
  if (!(fabric.bend > 0) || fabric.bend_spring)
    throw InputError("friction inside the fabric needs its bending rigidity per width, and bend is 0");
  fabric.weave.bend_friction = 0.5 * width->warp;
  fabric.weave.bend_friction_weft.reset();
  if (width->weft) fabric.weave.bend_friction_weft = 0.5 * *width->weft;
}

std::optional<Directions> read_directions(Table& table, const std::string& key, const Dimension& dimension,
                                          bool bias, const About& about) {
  const std::string kind =
      std::string(dimension.noun) + " > 0, or { warp = , weft = " + (bias ? ", bias = }" : "}");
  const Node* const node = table.take(key, kind.c_str(), about);
  if (!node) return {};
  Directions value;
  if (node->kind != Node::Kind::table) {
    try {
      value.warp = quantity(*node, dimension, Range::positive);
    } catch (const InputError& error) {
      table.fail(key, error.what());
    }
    return value;
  }
  Table each(*node, key);
  each.read_required("warp", value.warp, dimension, Range::positive, "along the warp");
  each.read("weft", value.weft, dimension, Range::positive, "along the weft");
  if (bias) each.read("bias", value.bias, dimension, Range::positive, "at 45 degrees");
  each.finish();
  return value;
}

void read_laboratory(Table& table, Fabric& fabric, FabricRecord& record) {
  refuse_misplaced(table, "");
  const char* const rigidity = "the bending rigidity";
  const std::string bend =
      one_of(table, rigidity, {"bend", "bend_spring", "bending_length", "overhang", "kes.B", "fast.C"});
  Names pulls = {"stretch", "stretch_spring", "kes.EMT"};
  for (const char* of_fast : {"fast.E5", "fast.E20", "fast.E100"})
    if (at(table, of_fast)) {
      pulls.emplace_back(of_fast);
      break;
    }
  const std::string stretch = one_of(table, "the membrane stiffness", pulls);
  const std::string shear =
      one_of(table, "the shear stiffness", {"stretch.shear", "kes.G", "fast.G", "fast.EB5"});
  if (const auto c = read_directions(table, "bending_length", dimension::length, true,
                                     "instead of bend: c of a cantilever test, B = g area_density c^3"))
    set_bend_of_length(fabric, checked_length(table, "bending_length", *c, 0.5), 1);
  if (const auto L =
          read_directions(table, "overhang", dimension::length, true,
                          "instead of bend: length at which a strip bends down to 41.5 degrees, 2 c"))
    set_bend_of_length(fabric, checked_length(table, "overhang", *L, 1), 0.5);
  const std::optional<double> of_kes = read_kes(table, fabric, record), of_fast = read_fast(table, fabric);
  if (of_kes) fabric.weave.shear = of_kes;
  if (of_fast) fabric.weave.shear = of_fast;
  if (!bend.empty()) check_bias(table, bend, fabric);
  note_given(table, "area_density", table.has("area_density") ? "area_density" : "", record);
  if (!stretch.empty()) record.given.erase("shear");
  note_given(table, "stretch", stretch, record);
  if (stretch == "fast.E5" && at(table, "fast.E20"))
    record.given["stretch"] += ", fast.E20 = " + toml_text(*at(table, "fast.E20"));
  if (shear != "stretch.shear") note_given(table, "shear", shear, record);
  note_given(table, "bend", bend, record);
}

void refuse_misplaced(const Table& table, const std::string& name) {
  for (const Word& word : words) {
    if (!table.has(word.word)) continue;
    const bool here = std::any_of(words.begin(), words.end(), [&](const Word& other) {
      return std::string_view(other.word) == word.word && other.table == name;
    });
    if (here) continue;
    if (!*word.written)
      table.fail(word.word, "is of a laboratory, but no model takes it: leave it out; see docs/fabrics.md");
    table.fail(word.word, std::string("is of a laboratory, and is not written here: ") + word.written +
                              (name == "scene" ? ", in [[cloth]] or in a fabric file" : "") +
                              "; see docs/fabrics.md");
  }
}

}  // namespace drape::app
