#include "app/base/units.h"

#include <udunits2.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <iterator>
#include <memory>
#include <utility>

#include "mesh/base/errors.h"

namespace drape::app {
namespace {

struct FreeUnit {
  void operator()(ut_unit* unit) const { ut_free(unit); }
};
using Unit = std::unique_ptr<ut_unit, FreeUnit>;

ut_system* unit_system() {
  static ut_system* const system = [] {
    ut_set_error_message_handler(ut_ignore);
    return ut_read_xml(nullptr);
  }();
  if (!system)
    throw InputError(
        "the units database of udunits is missing; on Debian or Ubuntu: apt install libudunits2-data");
  return system;
}

bool is_letter(char c) { return std::isalpha(static_cast<unsigned char>(c)) || c == '_'; }
bool is_digit(char c) { return std::isdigit(static_cast<unsigned char>(c)); }

// What udunits does not know, or knows as something else (oz: a volume), by what it does know. Empty where a
// word makes a time stamp or a logarithm of the unit.
constexpr std::array<std::pair<std::string_view, std::string_view>, 11> other_names{
    {{"deg", "degree"},
     {"gsm", "(g/m^2)"},
     {"oz", "avoirdupois_ounce"},
     {"dyn", "dyne"},
     {"fps", "Hz"},
     {"since", ""},
     {"after", ""},
     {"from", ""},
     {"ref", ""},
     {"re", ""},
     {"lg", ""}}};

// The unit in udunits' words; false when it is not a plain unit.
bool spell(std::string_view unit, std::string& spelled) {
  if (is_digit(unit.front()) && !unit.starts_with("1/")) return false;
  if (unit.front() == '-' || unit.front() == '+' || unit.find('@') != unit.npos) return false;
  for (std::size_t i = 0; i < unit.size();) {
    if (i > 0 && is_digit(unit[i]) && unit[i - 1] == ' ') return false;  // "s 3" would be three seconds
    std::size_t end = i;
    while (end < unit.size() && is_letter(unit[end])) ++end;
    if (end == i) {
      spelled += unit[i++];
      continue;
    }
    std::string_view word = unit.substr(i, end - i);
    for (const auto& [ours, theirs] : other_names)
      if (word == ours) word = theirs;
    if (word.empty()) return false;
    spelled += word;
    i = end;
  }
  return true;
}

Unit parse_unit(std::string_view text) {
  std::string spelled;
  if (!spell(text, spelled)) return nullptr;
  return Unit(ut_parse(unit_system(), spelled.c_str(), UT_UTF8));
}

// udunits also converts Hz to s, by the reciprocal: so the ratio must be a number.
bool same_kind(const ut_unit* a, const ut_unit* b) {
  const Unit ratio(ut_divide(a, b));
  return ratio && ut_is_dimensionless(ratio.get()) && ut_are_convertible(a, b);
}

constexpr std::string_view angles[] = {"degrees", "degree", "deg",  "\xC2\xB0", "radians",   "radian",
                                       "rad",     "rpm",    "turn", "rotation", "revolution"};

// An angle has no dimension, so that udunits takes 1 Hz for 1 rad/s; whoever writes it may mean a turn.
bool names_an_angle(std::string_view unit) {
  return std::any_of(std::begin(angles), std::end(angles),
                     [&](std::string_view angle) { return unit.find(angle) != unit.npos; });
}

// Whether the unit is the wanted one per angle: seconds, which have a dimension, stand in for the angle.
bool is_per_angle(std::string unit, std::string_view wanted) {
  for (const std::string_view angle : angles)
    for (std::size_t at = unit.find(angle); at != unit.npos; at = unit.find(angle))
      unit.replace(at, angle.size(), "s");
  const Unit given = parse_unit(unit), per_second = parse_unit("(" + std::string(wanted) + ")/s");
  return given && same_kind(given.get(), per_second.get());
}

void check_angle(std::string_view unit, const Dimension& dimension) {
  const std::string quoted = "'" + std::string(unit) + "'";
  if (dimension.angle == Angle::in_it && !names_an_angle(unit))
    throw InputError(quoted + " names no angle: write rpm, deg/s or rad/s");
  if (dimension.angle == Angle::divides_it && !is_per_angle(std::string(unit), dimension.unit))
    throw InputError(quoted + " is not per angle: write gf/(cm.deg) or N/(m.rad)");
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  return text;
}

}  // namespace

std::string expected(const Dimension& dimension) {
  return "expected " + std::string(dimension.noun) + " such as \"" + std::string(dimension.example) + "\"";
}

double parse_quantity(std::string_view text, const Dimension& dimension) {
  text = trimmed(text);
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error == std::errc::invalid_argument)
    throw InputError("does not begin with a number; " + expected(dimension));
  if (error != std::errc() || !std::isfinite(value))
    throw InputError("is not a finite number; " + expected(dimension));

  const std::string_view unit_text = trimmed(text.substr(static_cast<std::size_t>(end - text.data())));
  if (unit_text.empty()) {
    if (dimension.needs_unit) throw InputError("has no unit; " + expected(dimension));
    return value;
  }
  const Unit unit = parse_unit(unit_text);
  if (!unit) throw InputError("'" + std::string(unit_text) + "' is not a unit; " + expected(dimension));
  const Unit wanted(ut_parse(unit_system(), std::string(dimension.unit).c_str(), UT_UTF8));
  if (!same_kind(unit.get(), wanted.get())) throw InputError(expected(dimension));
  check_angle(unit_text, dimension);

  cv_converter* const converter = ut_get_converter(unit.get(), wanted.get());
  if (!converter) throw InputError(expected(dimension));
  const double converted = cv_convert_double(converter, value);
  cv_free(converter);
  if (!std::isfinite(converted)) throw InputError("is not a finite number; " + expected(dimension));
  return converted;
}

}  // namespace drape::app
