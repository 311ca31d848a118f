#include "app/recording/steps_csv.h"

#include <cstdio>
#include <utility>

namespace drape::app {

StepsWriter::StepsWriter(std::filesystem::path path) : file_(std::move(path)) {
  file_.write(
      "step,time,newton_iterations,linear_iterations,residual,contacts,kinetic_energy,elastic_energy,gravity_"
      "energy,"
      "max_speed,max_edge_strain,assemble_ms,solve_ms,collide_ms,step_ms,substeps,converged,guarded,linear_"
      "solves,"
      "penetration,inner_steps,inner_rejected,contact_energy,strain_min,strain_min_1pct,strain_max,"
      "area_min,area_kept,contact_residual,multigrid_solves,self_contacts,self_guarded,crossings,tangled,"
      "pinched,body_contacts,body_overlap,torn,self_held\n");
}

void StepsWriter::add(const StepRow& row) {
  const StepReport& r = row.report;
  char text[640];
  const int length = std::snprintf(
      text, sizeof text,
      "%ld,%.10g,%d,%d,%.4g,%d,%.10g,%.10g,%.10g,%.6g,%.6g,%.4f,%.4f,%.4f,%.4f,%d,%d,%d,%d,%.4g,%d,%d,%."
      "10g,%.6g,%.6g,%.6g,%.6g,%.6g,%.4g,%d,%d,%d,%d,%d,%d,%d,%.4g,%d,%d\n",
      row.step, row.time, r.newton_iterations, r.linear_iterations, r.residual, r.contacts,
      row.kinetic_energy, row.elastic_energy, row.gravity_energy, row.max_speed, row.max_edge_strain,
      r.assemble_ms, r.solve_ms, r.collide_ms, r.step_ms, r.substeps, r.converged ? 1 : 0, r.guarded,
      r.linear_solves, r.penetration, r.inner_steps, r.inner_rejected, row.contact_energy, row.strains.least,
      row.strains.first_percent, row.strains.largest, row.strains.area_least, row.strains.area_kept,
      r.contact_residual, r.multigrid_solves, r.self_contacts, r.self_guarded, row.crossings, r.tangled,
      r.pinched, r.body_contacts, r.body_overlap, r.torn, r.self_held);
  file_.write(text, static_cast<std::size_t>(length));
}

}  // namespace drape::app
