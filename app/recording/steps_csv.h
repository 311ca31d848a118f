// Writes steps.csv, one row for each step. docs/output.md explains the columns. SI units; measured durations
// in ms.
#pragma once

#include <filesystem>
#include <string>

#include "app/base/atomic_file.h"
#include "solver/assembly/cloth.h"
#include "solver/integrators/integrator.h"

namespace drape::app {

struct StepRow {
  long step = 0;    // counts from 1
  double time = 0;  // s, at the end of the step
  StepReport report;
  double kinetic_energy = 0, elastic_energy = 0, gravity_energy = 0, contact_energy = 0;               // J
  double energy() const { return kinetic_energy + elastic_energy + gravity_energy + contact_energy; }  // J
  double max_speed = 0;                                                                                // m/s
  double max_edge_strain = 0;
  TriangleStrains strains;
  int crossings =
      0;  // pairs of triangles that pass through each other in the last frame so far, as it is written
};

class StepsWriter {
 public:
  explicit StepsWriter(std::filesystem::path path);

  void add(const StepRow& row);
  void close() { file_.close(); }
  void keep() { file_.keep(); }

 private:
  AtomicFile file_;
};

}  // namespace drape::app
