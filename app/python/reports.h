// The reports of a step in the form that Python sees.
#pragma once

#include "app/python/bindings.h"
#include "app/recording/steps_csv.h"

namespace drape::app::python {

// A row of steps.csv as one object.
struct RunStep : StepReport {
  long step;
  double time, kinetic_energy, elastic_energy, gravity_energy, contact_energy, max_speed, max_edge_strain;
  double strain_min, strain_min_1pct, strain_max, area_min, area_kept;

  explicit RunStep(const StepRow& row)
      : StepReport(row.report),
        step(row.step),
        time(row.time),
        kinetic_energy(row.kinetic_energy),
        elastic_energy(row.elastic_energy),
        gravity_energy(row.gravity_energy),
        contact_energy(row.contact_energy),
        max_speed(row.max_speed),
        max_edge_strain(row.max_edge_strain),
        strain_min(row.strains.least),
        strain_min_1pct(row.strains.first_percent),
        strain_max(row.strains.largest),
        area_min(row.strains.area_least),
        area_kept(row.strains.area_kept) {}
};

// Raises drape.StepError with the report when the step was not done.
void require_done(const StepReport& report);
[[noreturn]] void raise_step_error(const std::string& text, const StepReport& report);

void add_reports_of_steps(py::module_& m);

}  // namespace drape::app::python
