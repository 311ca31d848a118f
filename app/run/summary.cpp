#include "app/run/summary.h"

#include <algorithm>

#include "app/simulation/measure.h"

namespace drape::app {
namespace {

std::string hints(const RunRecord& record, const Output& output) {
  std::string text;
  if (record.max_edge_strain > 0.1 && record.softs.empty() && !record.cloths.empty())
    text += "hint: an edge is stretched by " + rounded(100 * record.max_edge_strain, 2) +
            " %, more than woven cloth does: raise stretch, or check the units of the mesh\n";
  const bool springs = std::any_of(record.cloths.begin(), record.cloths.end(),
                                   [](const ClothCounts& c) { return c.fabric["model"].text() != "woven"; });
  if (record.strains.area_kept < 0.9 && springs)
    text += "hint: the cloth has lost " + rounded(100 * (1 - record.strains.area_kept), 2) +
            " % of its area: edges do not push in the models of springs; model = \"woven\" keeps it\n";
  if (record.crossings > 0)
    text += "hint: " + counted(record.crossings, "pair") + " of triangles cross (" +
            std::to_string(record.crossings_at_start) + " at the start): drape check " +
            output.folder().string() +
            " says where; with self_contact = true, cloth that starts clean, does not tear, closes no seam "
            "through cloth that lies between, and has no two vertices at one place, does not pass through "
            "itself and others; drape untangle brings a mesh apart\n";
  if (record.self_guarded > 0)
    text += "hint: vertices were pushed aside " + counted(record.self_held, "time") +
            " and stopped on their way " + counted(record.self_guarded - record.self_held, "time") +
            ", so that no cloth passes through cloth: a smaller time step is smoother\n";
  if (record.pinched > 0)
    text += "hint: a body passes through the cloth, or holds it against itself or another body, near " +
            counted(record.pinched, "vertex") +
            ": it started there, or could not be kept off without cloth passing through cloth or a body\n";
  if (record.max_penetration > 1e-4)
    text +=
        "hint: a vertex was inside a body by up to " + rounded(1000 * record.max_penetration, 2) + " mm\n";
  if (record.steps_cut > 0)
    text += "hint: " + counted(record.steps_cut, "step") + " had to be taken in up to " +
            std::to_string(record.substeps_max) + " pieces: a smaller time step is steadier\n";
  if (record.steps_not_converged > 0 && record.integrator == "pbd")
    text +=
        "hint: pbd ends its substeps after as many iterations as were asked for, and the cloth stretches "
        "more than its "
        "stiffness says: residual in steps.csv says by which share of the weight, and more substeps make it "
        "less\n";
  if (record.contact_residual > 1e-3 && record.integrator == "pbd")
    text += "hint: the impulses between clusters had not settled in every step (by up to " +
            rounded(100 * record.contact_residual, 2) + " % of the largest velocity)\n";
  if (record.steps_not_converged > 0 && record.integrator != "pbd")
    text += "hint: " + counted(record.steps_not_converged, "step") +
            " ended before the solve reached its tolerance or the contacts had settled (by up to " +
            rounded(100 * record.contact_residual, 2) + " % of the weight)\n";
  if (record.state() == "moving" && !record.interrupted && !record.missed)
    text += "hint: it still moves: give it a longer duration\n";
  return text;
}

// "auto" says which share of the solves went to multigrid.
std::string solver_text(const RunRecord& record) {
  if (record.linear_solver != "auto") return record.linear_solver;
  double solves = 0;
  for (const double of_step : record.linear_solves) solves += of_step;
  if (solves == 0) return "auto";
  const double share = 100 * static_cast<double>(record.multigrid_solves) / solves;
  return share == 0 ? "auto (mpcg+block-ic0)"
         : share == 100
             ? "auto (ppcg+multigrid)"
             : "auto (" + rounded(std::clamp(share, 0.1, 99.9), 3) + " % of the solves by ppcg+multigrid)";
}

}  // namespace

std::string summary(const RunRecord& record, const Output& output) {
  const Distribution ms = distribution(record.step_ms), iterations = distribution(record.linear_iterations);
  std::string text = (record.interrupted ? "interrupted after " : "simulated ") +
                     rounded(record.simulated_seconds, 4) + " s in " + counted(record.steps, "step") + ", " +
                     rounded(record.wall_seconds, 3) + " s of wall time\n";
  if (!record.step_as_asked)
    text += "steps of " + rounded(1000 * record.time_step, 4) + " ms between frames, " +
            rounded(1000 * record.time_step_asked, 4) + " ms were asked for\n";
  for (const ClothCounts& c : record.cloths)
    text += c.name + ": " + counted(c.particles, "particle") + ", " + counted(c.triangles, "triangle") + "\n";
  for (const SoftCounts& s : record.softs)
    text += s.name + ": " + counted(s.particles, "particle") + ", " +
            counted(s.springs.structural + s.springs.shear + s.springs.bend, "spring") + ", " +
            counted(s.triangles, "triangle") + "\n";
  for (const RopeCounts& r : record.ropes)
    text += r.name + ": " + counted(r.particles, "particle") + ", " + rounded(r.length, 4) + " m of rope\n";
  text += record.integrator + ", " + solver_text(record) + ", " + counted(record.threads, "thread") + ": " +
          rounded(ms.median, 3) + " ms a step (95 % below " + rounded(ms.p95, 3) + "), " +
          rounded(iterations.mean, 3) + " linear iterations a step\n";
  text += "state: " + record.state() + ", largest speed " + rounded(record.max_speed, 2) +
          " m/s, largest edge strain " + rounded(100 * record.max_edge_strain, 2) + " %\n";
  text += "energy: " + rounded(record.energy.start, 3) + " J at the start, " + rounded(record.energy.end, 3) +
          " J at the end; the most that it rose on the way, also by what moves the cloth: " +
          rounded(record.energy.largest_rise, 2) + " J\n";
  if (record.self_contacts_max > 0 || record.self_guarded > 0)
    text += "cloth on cloth: " + counted(record.self_contacts, "pair") + " of places " +
            (record.self_contacts == 1 ? "pushes" : "push") + " each other at the end, " +
            std::to_string(record.self_contacts_max) + " at most; " +
            (record.crossings_max == 0 ? std::string("nothing crosses in any frame")
                                       : counted(record.crossings_max, "pair") +
                                             " of triangles or segments cross in a frame at most") +
            "\n";
  if (!record.cloths.empty())
    text += "area kept: " + rounded(100 * record.strains.area_kept, 3) + " %, strain of triangles from " +
            rounded(100 * record.strains.least, 3) + " % (one in a hundred below " +
            rounded(100 * record.strains.first_percent, 3) + " %) to " +
            rounded(100 * record.strains.largest, 3) + " %\n";
  if (record.torn > 0)
    text += "torn: " + counted(record.torn, "edge") + " cut, the first at " + rounded(*record.first_torn, 4) +
            " s\n";
  text += hints(record, output);
  for (const auto& [path, amount] : output.written())
    text += "wrote " + path.string() + (amount.empty() ? "" : " (" + amount + ")") + "\n";
  return text;
}

}  // namespace drape::app
