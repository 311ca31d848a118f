#include "app/scene/self_contact_read.h"

#include <algorithm>

#include "mesh/base/errors.h"

namespace drape::app {
namespace {

void read_switch(Table& table, bool& self_contact, SelfContactOptions& self) {
  table.read("self_contact", self_contact,
             "whether it meets itself, and other cloths and soft bodies that have this: without it they pass "
             "through each other");
  table.read(
      "friction", self.friction, dimension::number, Range::not_negative,
      "with self_contact: Coulomb's coefficient between two layers; between two cloths it is the root of the "
      "product of both, unless [[pair]] says otherwise");
}

void read_layer(Table& table, SelfContactOptions& self) {
  const Node* const node = table.take(
      "layer", "a whole number ≥ 0, or a table of them by group",
      {"with self_contact: what is worn over what, from the inside out. Of two layers that cross at the "
       "start the higher one comes out on the side where the normals of the lower one point; by group: "
       "{ shirt = 1, pocket = 2 }",
       "no order: the lighter side gives way"});
  if (!node) return;
  const auto number = [](const Node& one) {
    if (one.kind != Node::Kind::integer || one.integer < 0 || one.integer > 1000)
      throw InputError("expected a whole number from 0 to 1000");
    return static_cast<int>(one.integer);
  };
  if (node->kind != Node::Kind::table) {
    try {
      self.layer = number(*node);
    } catch (const InputError& error) {
      table.fail("layer", error.what());
    }
    return;
  }
  const Table groups = table.inner("layer");
  if (node->members.empty()) table.fail("layer", "names no group; expected { pocket = 2 }");
  for (const auto& [name, value] : node->members) {
    try {
      self.group_layers.push_back({name, number(value)});
    } catch (const InputError& error) {
      groups.fail(name, error.what());
    }
  }
}

void require_switch(const Table& table) {
  if (table.has("self_contact")) return;
  for (const char* key : {"thickness", "friction", "layer"})
    if (table.has(key)) table.fail(key, "goes with self_contact = true");
}

}  // namespace

void read_self_contact(Table& table, ClothEntry& cloth) {
  read_switch(table, cloth.self_contact, cloth.self);
  read_layer(table, cloth.self);
  cloth.self.thickness = cloth.fabric_record.thickness.value_or(cloth.self.thickness);
  require_switch(table);
}

void read_self_contact(Table& table, SoftEntry& soft) {
  read_switch(table, soft.self_contact, soft.self);
  table.read("thickness", soft.self.thickness, dimension::length, Range::positive,
             "with self_contact: what lies on it rests at the mean of both thicknesses");
  require_switch(table);
}

void read_self_contact(Table& table, RopeEntry& rope) {
  table.read(
      "self_contact", rope.self_contact,
      "whether it meets itself, and cloths, soft bodies and other ropes that have this: without it they "
      "pass through each other");
  table.read("friction", rope.self.friction, dimension::number, Range::not_negative,
             "with self_contact: Coulomb's coefficient; between two things it is the root of the product of "
             "both, unless [[pair]] says otherwise. On bodies theirs counts");
  require_switch(table);
}

FrictionEntry read_friction_pair(Table& table) {
  FrictionEntry entry;
  entry.where = table.where();
  Names between;
  table.read_required("between", between, "names of two cloths, soft bodies or ropes, or of one and itself");
  if (between.size() != 2) table.fail("between", "expected two names, such as [\"shirt\", \"coat\"]");
  std::copy(between.begin(), between.end(), entry.between.begin());
  table.read_required("friction", entry.friction, dimension::number, Range::not_negative,
                      "Coulomb's coefficient between the two, instead of that of both");
  table.finish();
  return entry;
}

void check_friction_pair(const FrictionEntry& entry, const Scene& scene) {
  Names names, meeting;
  const auto add = [&](const auto& part) {
    names.push_back(part.name);
    if (part.self_contact) meeting.push_back(part.name);
  };
  for (const ClothEntry& cloth : scene.cloths) add(cloth);
  for (const SoftEntry& soft : scene.softs) add(soft);
  for (const RopeEntry& rope : scene.ropes) add(rope);
  const auto same = [&](const FrictionEntry& other) {
    return std::is_permutation(other.between.begin(), other.between.end(), entry.between.begin());
  };
  if (const auto first = std::find_if(scene.frictions.begin(), scene.frictions.end(), same);
      first->where != entry.where)
    throw InputError(entry.where + ": between: " + first->where +
                     " has the same pair; leave one of them out");
  for (const std::string& name : entry.between) {
    const std::string start = entry.where + ": between: ";
    if (std::find(names.begin(), names.end(), name) == names.end())
      throw InputError(start + "there is no cloth, soft body or rope '" + one_line(name) + "'; " +
                       suggestion(name, names));
    if (std::find(meeting.begin(), meeting.end(), name) == meeting.end())
      throw InputError(start + one_line(name) + " passes through others; set its self_contact = true");
  }
}

}  // namespace drape::app
