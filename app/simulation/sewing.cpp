#include "app/simulation/sewing.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <numbers>

#include "mesh/base/errors.h"
#include "mesh/pattern/panels.h"

namespace drape::app {
namespace {

// The seams of an entry: its two curves, or all that the mesh declares.
std::vector<Seam> seams_of(const SeamEntry& entry, const TriangleMesh& mesh) {
  if (!entry.curves.empty()) return {{entry.curves[0], entry.curves[1], entry.same_direction, entry.where}};
  std::vector<Seam> seams = declared_seams(mesh);
  if (seams.empty())
    throw InputError(entry.where +
                     ": seams: the mesh declares none ('# seam A B' lines); name two of its lines: curves = "
                     "[\"front.left\", \"back.right\"]");
  for (Seam& seam : seams) seam.where = entry.where;
  return seams;
}

void check_new(const Seam& seam, const std::vector<SeamPlan>& plans) {
  const std::string name = seam.a + " / " + seam.b, other_way = seam.b + " / " + seam.a;
  for (const SeamPlan& plan : plans)
    if (plan.name == name || plan.name == other_way)
      throw InputError(seam.where + ": seam " + one_line(name) + ": these two curves are sewn twice");
}

}  // namespace

void place_panels(const ClothEntry& entry, TriangleMesh& mesh, Names& messages) {
  std::vector<PanelPlace> places;
  for (const PanelEntry& panel : entry.panels)
    places.push_back(
        {panel.group, panel.wrap, panel.placement.rotation, panel.placement.translate, panel.where});
  const std::vector<double> widths = place_panels(mesh, places);
  for (std::size_t p = 0; p < places.size(); ++p) {
    const std::optional<double>& wrap = places[p].wrap;
    if (!wrap || !(widths[p] > 2 * std::numbers::pi * *wrap * (1 + 1e-6))) continue;
    messages.push_back("warning: panel " + one_line(places[p].group) + " is " + rounded(100 * widths[p], 4) +
                       " cm wide and goes more than once round a cylinder of radius " +
                       rounded(100 * *wrap, 4) + " cm: give a larger wrap");
  }
}

std::vector<SeamPlan> seam_plans(const ClothEntry& entry, const TriangleMesh& mesh) {
  std::vector<SeamPlan> plans;
  if (entry.seams.empty()) return plans;
  const std::vector<Polyline> lines = polylines(mesh);
  for (const SeamEntry& given : entry.seams)
    for (const Seam& seam : seams_of(given, mesh)) {
      SeamPlan plan{.name = seam.a + " / " + seam.b,
                    .pairs = seam_pairs(lines, seam),
                    .close = given.close,
                    .stiffness = given.stiffness,
                    .merge = given.merge};
      check_new(seam, plans);
      plans.push_back(std::move(plan));
    }
  return plans;
}

void tell_of_gathers(const OpenSeam& seam, Names& messages) {
  const double one = seam.length_one, two = seam.length_two;
  const double more = std::max(one, two) / std::min(one, two) - 1;
  if (!(more > 0.01)) return;
  const bool much = more > 2;  // three times as long
  messages.push_back((much ? "warning: seam " : "note: seam ") + one_line(seam.name) + ": " +
                     rounded(100 * one, 4) + " cm are sewn to " + rounded(100 * two, 4) +
                     " cm: gathered by " + rounded(100 * more, 3) + " %" +
                     (much ? "; is it the right pair?" : ""));
}

}  // namespace drape::app
