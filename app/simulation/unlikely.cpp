#include "app/simulation/unlikely.h"

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

}  // namespace

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
