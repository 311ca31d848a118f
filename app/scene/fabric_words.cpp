#include "app/scene/fabric_words.h"
#include "app/scene/fabrics.h"

namespace drape::app {
namespace {

// "1.95 / 0.61 uN.m": the numbers times the scale, in that unit.
std::string both(double warp, const std::optional<double>& weft, double scale, const char* unit) {
  std::string text = rounded(scale * warp, 4);
  if (weft) text += " / " + rounded(scale * *weft, 4);
  return text + " " + unit;
}

std::string words(const Fabric& f, bool mean) {
  const Weave& w = f.weave;
  const std::string plain = both(f.stretch, w.stretch_weft, 1, "N/m"),
                    bent = both(f.bend, w.bend_weft, 1e6, "uN.m");
  std::string text = rounded(1000 * f.area_density, 4) + " g/m^2, stretch ";
  text += f.stretch_spring ? rounded(*f.stretch_spring, 4) + " N/m each edge"
          : mean           ? rounded(mean_stretch(f), 4) + " N/m"
                           : plain;
  if (w.shear && !mean) text += ", shear " + rounded(*w.shear, 4) + " N/m";
  text += ", bend ";
  text += f.bend_spring ? rounded(*f.bend_spring, 4) + " N.m^2 each diagonal"
          : mean        ? rounded(1e6 * mean_bend(f), 4) + " uN.m"
                        : bent;
  if (w.bend_bias && !mean) text += " (" + rounded(1e6 * *w.bend_bias, 4) + " uN.m in the bias)";
  return text;
}

}  // namespace

std::string in_words(const Fabric& fabric) { return words(fabric, false); }
std::string mean_in_words(const Fabric& fabric) { return words(fabric, true); }

std::string beyond_springs(const Fabric& fabric) {
  const Weave &w = fabric.weave, usual;
  Names names;
  if (w.shear) names.emplace_back("shear");
  if (w.bend_bias) names.emplace_back("bend of the bias");
  if (w.poisson != usual.poisson || w.bend_poisson != usual.bend_poisson)
    names.emplace_back("Poisson's ratio");
  if (w.compression != usual.compression && w.compression != usual_compression)
    names.emplace_back("compression");
  if (w.stretch_time > 0 || w.shear_time > 0 || w.bend_time > 0) names.emplace_back("viscosity");
  return names.empty() ? "" : listed(names);
}

Names lines_of(const FabricRecord& record) {
  Names lines, given;
  for (const auto& [quantity, text] : record.given) given.push_back(text);
  if (!given.empty()) lines.push_back("as given: " + listed(given));
  if (record.thickness) lines.push_back("thickness " + rounded(1000 * *record.thickness, 4) + " mm");
  if (record.bending_hysteresis)
    lines.push_back("hysteresis of bending 2HB " +
                    both(record.bending_hysteresis->warp, record.bending_hysteresis->weft, 1000, "mN") +
                    ": friction of model = \"woven\" with hysteresis = true");
  if (record.shear_hysteresis)
    lines.push_back("hysteresis of shear 2HG " +
                    both(record.shear_hysteresis->warp, record.shear_hysteresis->weft, 1, "N/m") +
                    ": recorded, no model has friction against shear");
  return lines;
}

}  // namespace drape::app
