#include "app/pattern/remarks.h"

#include <numbers>

namespace drape::app {

std::string in_cm(double metres) { return rounded(100 * metres, 4) + " cm"; }
std::string in_deg(double radians) { return rounded(radians * 180 / std::numbers::pi, 4) + " deg"; }

Names remarks(const PatternMesh& made, double min_angle, const std::string& where) {
  Names lines;
  constexpr std::size_t most = 10;
  for (std::size_t i = 0; i < made.sharp.size() && i < most; ++i)
    lines.push_back("note: " + where + ": a corner of panel " + made.sharp[i].panel +
                    " is sharper than the bound: " + in_deg(made.sharp[i].angle) +
                    " at x = " + in_cm(made.sharp[i].at.x()) + ", y = " + in_cm(made.sharp[i].at.y()));
  if (made.sharp.size() > most)
    lines.push_back("note: " + where + ": and " + std::to_string(made.sharp.size() - most) +
                    " more such corners");
  if (made.below > 0)
    lines.push_back("warning: " + where + ": " + counted(made.below, "triangle") + " below " +
                    in_deg(min_angle) + " that no sharp corner explains, down to " +
                    in_deg(made.smallest_angle_elsewhere) +
                    ": parts too fine for the edge length, or a bound too high");
  return lines;
}

}  // namespace drape::app
