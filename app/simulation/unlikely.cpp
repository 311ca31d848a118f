#include "app/simulation/unlikely.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "mesh/triangles/extent.h"

namespace drape::app {
namespace {

// Woven and knitted cloth weighs 10 to 1000 g/m^2.
void tell_of_area_density(const ClothEntry& entry, Names& messages) {
  constexpr double heaviest = 10, lightest = 2e-3;  // kg/m^2
  if (entry.fabric.area_density < lightest)
    messages.push_back("warning: cloth " + entry.name + ": an area density of " +
                       rounded(1000 * entry.fabric.area_density, 3) +
                       " g/m^2 is lighter than any cloth: was it meant in kg/m^2?");
  if (entry.fabric.area_density <= heaviest) return;
  messages.push_back("warning: cloth " + entry.name + ": an area density of " +
                     rounded(entry.fabric.area_density, 3) +
                     " kg/m^2 is heavier than any cloth: was it meant in g/m^2?");
}

// Leather of a few millimetres has 1 to 10 mN m.
void tell_of_bend(const ClothEntry& entry, Names& messages) {
  constexpr double stiffest = 0.1;  // N m
  if (entry.fabric.bend_spring || entry.fabric.bend <= stiffest) return;
  messages.push_back("warning: cloth " + entry.name + ": a bending rigidity of " +
                     rounded(entry.fabric.bend, 3) +
                     " N.m is stiffer than any cloth, which has 1 to 1000 uN.m: was it meant in uN.m?");
}

// Webbing of aramid bears 1e6 N/m at a strain of 1 by its straight part.
void tell_of_stretch(const ClothEntry& entry, Names& messages) {
  constexpr double stiffest = 1e7;  // N/m
  if (entry.fabric.stretch_spring || entry.fabric.stretch <= stiffest) return;
  messages.push_back("warning: cloth " + entry.name + ": a membrane stiffness of " +
                     rounded(entry.fabric.stretch, 3) +
                     " N/m is stiffer than any cloth, which has 100 to 100000 N/m: is the unit right?");
}

// Yarns break at strains of 3 to 50 %, and knitted cloth at twice its length or three times.
void tell_of_tear(const ClothEntry& entry, Names& messages) {
  constexpr double largest = 3;
  if (!entry.tear || *entry.tear <= largest) return;
  messages.push_back("warning: cloth " + entry.name + ": tear = " + rounded(*entry.tear, 4) +
                     " is a strain of " + rounded(100 * *entry.tear, 4) +
                     " %, which no cloth bears: was it meant in percent, \"" + rounded(*entry.tear, 4) +
                     " %\"?");
}

// A rope of polyamide as thick as an arm weighs 6 kg/m.
void tell_of_line_density(const RopeEntry& entry, Names& messages) {
  constexpr double heaviest = 10;  // kg/m
  if (entry.material.mass_per_length <= heaviest) return;
  messages.push_back("warning: rope " + entry.name + ": a mass of " +
                     rounded(entry.material.mass_per_length, 3) +
                     " kg/m is heavier than any rope: was it meant in g/m?");
}

// Cloth on most things has 0.2 to 0.8, rubber up to 4.
void tell_of_friction(const std::string& of, double friction, Names& messages) {
  constexpr double largest = 5;
  if (friction <= largest) return;
  messages.push_back("note: " + of + ": with a friction of " + rounded(friction, 4) +
                     " nothing slips; cloth has 0.2 to 0.8: was a percentage meant?");
}

// A motion that the run does not live to see.
void tell_of_late_motion(const std::string& of, double start, double duration, Names& messages) {
  if (start < duration) return;
  messages.push_back("note: " + of + ": moves from " + rounded(start, 4) + " s on, and the duration is " +
                     rounded(duration, 4) + " s: it stands");
}

// Shapes are as large as what falls on them, or a few times; a floor is a plane or a box.
void tell_of_large_ball(const ObstacleEntry& body, double cloth, Names& messages) {
  constexpr double largest = 20;  // times the cloth
  const auto* const ball = std::get_if<Sphere>(&body.obstacle.shape);
  if (!ball || ball->radius <= largest * cloth) return;
  messages.push_back("note: body " + body.name + ": a radius of " + rounded(ball->radius, 4) + " m is " +
                     rounded(ball->radius / cloth, 2) +
                     " times the size of the cloth: was it meant in cm or mm?");
}

double volume(const TriangleMesh& mesh, const std::vector<Vec3>& x) {  // m^3, negative where it is inside out
  double sum = 0;
  for (const Triangle& t : mesh.triangles)
    sum += (x[t[0]] - x[0]).dot((x[t[1]] - x[0]).cross(x[t[2]] - x[0])) / 6;
  return sum;
}

// The least way of a vertex of a triangle between two frames [m].
double common_way(const TriangleMesh& mesh, const std::vector<Vec3>& before, const std::vector<Vec3>& after) {
  double least = std::numeric_limits<double>::infinity();
  for (const Triangle& t : mesh.triangles)
    for (const int v : t) least = std::min(least, (after[v] - before[v]).norm());
  return least;
}

std::string between(const MeshFrames& frames, int k) {
  return "between its frames " + std::to_string(k + 1) + " and " + std::to_string(k + 2) + " (" +
         rounded(frames.time(k), 4) + " and " + rounded(frames.time(k + 1), 4) + " s)";
}

// Half-way between two frames, since vertices go straight, a body that turns by a quarter has half of its volume.
// rest: its volume in the first frame [m^3].
void warn_of_volume(const std::string& start, const TriangleMesh& mesh, double rest,
                    const std::vector<Vec3>& before, const std::vector<Vec3>& after, const std::string& when,
                    Names& messages) {
  constexpr double least = 0.5;
  std::vector<Vec3> middle = before;
  for (std::size_t i = 0; i < middle.size(); ++i) middle[i] += 0.5 * (after[i] - before[i]);
  const double first = volume(mesh, before) / rest, last = volume(mesh, after) / rest,
               kept = volume(mesh, middle) / rest;
  if (last < -1e-9)
    messages.push_back(start + "is turned inside out " + when +
                       ": cloth ends inside of it; was it mirrored, or are its vertices in another order?");
  else if (kept < least * std::min(first, last))
    messages.push_back(start + "keeps " + rounded(100 * std::max(kept / first, 0.0), 2) +
                       " % of its volume half-way " + when +
                       ", since its vertices go straight: does it turn too far in one frame?");
}

// All of the body jumps where it goes half of its size in a frame, and far less in the frame before.
void warn_of_frames(const std::string& name, const DeformingBody& body, double end, Names& messages) {
  const MeshFrames& frames = *body.frames;
  const TriangleMesh& mesh = body.surface->mesh();
  const std::string start = "warning: body " + name + " ";
  std::vector<Vec3> before, after;
  frames.positions_at(frames.time(0), before);
  const double rest = volume(mesh, before), size = box_of(before, mesh.triangles).diagonal().norm();
  const bool has_volume = body.surface->closed() && std::abs(rest) > 1e-9 * size * size * size;
  const std::size_t told = messages.size();
  double last_way = 0;
  for (int k = 0; k + 1 < frames.frame_count() && frames.time(k) < end && messages.size() == told; ++k) {
    frames.positions_at(frames.time(k + 1), after);
    const double way = common_way(mesh, before, after);
    if (way > 0.5 * size && way > 4 * last_way)
      messages.push_back(start + "jumps by " + rounded(way, 3) + " m, " + rounded(way / size, 2) +
                         " times its size, " + between(frames, k) +
                         ": all that is on the way is hit; is there a cut in the film?");
    if (has_volume) warn_of_volume(start, mesh, rest, before, after, between(frames, k), messages);
    last_way = way;
    before.swap(after);
  }
}

}  // namespace

void warn_of_unlikely_frames(const Scene& scene, const std::vector<MovingBody>& bodies, Names& messages) {
  for (std::size_t k = 0; k < scene.obstacles.size(); ++k)
    if (const DeformingBody* const body = deforming(bodies[k].obstacle().shape))
      warn_of_frames(scene.obstacles[k].name, *body, scene.simulation.duration, messages);
}

void tell_of_unlikely_values(const Scene& scene, double size, Names& messages) {
  for (const ClothEntry& cloth : scene.cloths) {
    tell_of_area_density(cloth, messages);
    tell_of_stretch(cloth, messages);
    tell_of_bend(cloth, messages);
    tell_of_tear(cloth, messages);
    if (cloth.self_contact) tell_of_friction("cloth " + cloth.name, cloth.self.friction, messages);
  }
  for (const RopeEntry& rope : scene.ropes) {
    tell_of_line_density(rope, messages);
    if (rope.self_contact) tell_of_friction("rope " + rope.name, rope.self.friction, messages);
  }
  for (const SoftEntry& soft : scene.softs)
    if (soft.self_contact) tell_of_friction("soft body " + soft.name, soft.self.friction, messages);
  const double duration = scene.simulation.duration;
  for (const ObstacleEntry& body : scene.obstacles) {
    tell_of_friction("body " + body.name, body.obstacle.friction.statics, messages);
    tell_of_large_ball(body, size, messages);
    if (!body.rigid && body.obstacle.motion.moves())
      tell_of_late_motion("body " + body.name, body.source.start, duration, messages);
    if (!body.frames.files.empty())
      tell_of_late_motion("body " + body.name, body.frames.start, duration, messages);
  }
  for (std::size_t part = 0; part < scene.part_count(); ++part)
    for (const PinEntry& pin : scene.pins_of(part))
      if (pin.motion && pin.motion->moves())
        tell_of_late_motion("what is pinned at " + pin.where, pin.source.start, duration, messages);
  for (const FrictionEntry& pair : scene.frictions)
    tell_of_friction(pair.between[0] + " on " + pair.between[1], pair.friction, messages);
}

}  // namespace drape::app
