// run.json: what was run and how it went.
#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "app/base/json.h"
#include "app/base/words.h"
#include "app/simulation/simulation.h"
#include "mesh/base/vectors.h"

namespace drape::app {

struct ClothCounts {
  std::string name;
  int particles = 0, triangles = 0, edges = 0, diagonals = 0;
  Json fabric = {}, pins = {}, seams = {};  // app/recording/scene_record.h
  double imperfection = 0;                  // m
  // Of a cloth that may tear: the edges that were cut, and what the last vertices are copies of.
  std::optional<double> tear = {};
  int torn = 0;
  std::vector<int> copy_of = {};
  int edges_at_end = 0, diagonals_at_end = 0;  // the counts above are of the start
};

struct SoftCounts {
  std::string name;
  int particles = 0, vertices = 0, triangles = 0;  // the latter two of the mesh that the particles carry
  LatticeCounts springs = {};
  Json material = {}, pins = {};  // app/recording/scene_record.h
};

struct RopeCounts {
  std::string name;
  int particles = 0,
      segments = 0;   // vertices of its line count as particles, also where they are of another part
  double length = 0;  // m, at rest
  Json material = {}, pins = {}, ends = {};  // app/recording/scene_record.h
};

struct BodyRecord {
  std::string name, file, shape;  // file: below the output folder, empty for a plane
  bool moves = false;             // whether a motion moves it
  bool deforms = false;           // whether it goes from frame to frame
  Pose place;                     // at the end of the run
  std::optional<Plane> plane;     // as it was drawn in the scene
  Json::Members contact = {};     // friction, margin, restitution

  struct Reacting {
    double mass;                              // kg
    Vec3 position, velocity, spin, momentum;  // m, m/s, rad/s, N s, of the centre of mass at the end
  };
  std::optional<Reacting> reacting;
};

struct Failure {
  long step = 0;
  double time = 0;  // s, of the state that is left
  std::string what, term, cloth;
  int vertex = -1;  // of the cloth's file, from 0
};

// The energy of cloth, soft bodies and ropes along a run: kinetic, elastic, of contact and of gravity [J].
struct EnergyCourse {
  double start = 0, end = 0;
  double largest_rise = 0;  // the most that it was at any time above what it had been before that time

  void begin(double energy) { start = end = least_ = energy; }
  void add(double energy) {
    end = energy;
    least_ = std::min(least_, energy);
    largest_rise = std::max(largest_rise, energy - least_);
  }

 private:
  double least_ = 0;
};

struct RunRecord {
  std::string scene, integrator, contact, linear_solver;
  std::vector<ClothCounts> cloths;
  std::vector<SoftCounts> softs;
  std::vector<RopeCounts> ropes;
  std::vector<BodyRecord> bodies;
  Names warnings;
  int threads = 1;
  double duration = 0, time_step = 0, time_step_asked = 0, simulated_seconds = 0, wall_seconds = 0;  // s
  bool step_as_asked = true;
  Json::Members numerics = {};  // frame_rate, gravity and so on, as the scene has them
  Json settings = {};
  long steps = 0, steps_cut = 0, steps_not_converged = 0;
  int substeps_max = 1;
  long inner_rejected = 0;                                                     // inner steps of the whole run
  std::vector<double> step_ms, linear_iterations, linear_solves, inner_steps;  // of each step
  long multigrid_solves = 0;  // of the whole run, by the linear solver "auto"
  double assemble_ms = 0, solve_ms = 0, collide_ms = 0, write_ms = 0;  // of the whole run
  double max_speed = 0, max_edge_strain = 0;                           // at the end [m/s], [-]
  double largest_speed = 0, largest_edge_strain = 0;                   // of the whole run
  EnergyCourse energy;
  TriangleStrains strains;                       // at the end
  double max_penetration = 0;                    // m, of the whole run
  double contact_residual = 0;                   // the largest of the whole run
  int self_contacts = 0, self_contacts_max = 0;  // pairs of cloth and cloth that push, at the end and at most
  long self_guarded = 0;                         // how often a particle was pushed or stopped
  long self_held = 0;                            // how often it was pushed, and not stopped
  int pinched = 0, pinched_max = 0;              // see StepReport::pinched; at the end and at most
  // Pairs of triangles that pass through each other: at the start, at the end, and the most of all frames.
  int crossings_at_start = 0, crossings = 0, crossings_max = 0;
  long torn = 0;                     // edges of cloth that were cut
  std::optional<double> first_torn;  // s, at the end of the step that cut the first
  bool settled = false, interrupted = false;
  bool missed = false;  // cloth fell past all bodies
  std::string state_hash;
  std::string frames;               // how they were written: pc2, obj, none
  std::vector<double> frame_times;  // s, the times of the states in the frames
  std::optional<Failure> failure;

  std::string state() const { return failure ? "failed" : settled ? "settled" : "moving"; }
};

std::string run_json(const RunRecord& record);

}  // namespace drape::app
