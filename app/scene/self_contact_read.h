// How cloths, soft bodies and ropes meet each other: the keys `self_contact`, `thickness` and `friction` of
// [[cloth]],
// [[soft]] and [[rope]], and the table [[pair]] of pairs.
#pragma once

#include "app/base/table.h"
#include "app/scene/scene.h"

namespace drape::app {

// Sets cloth.self_contact and cloth.self; to be called after the fabric is read, which may have a thickness.
void read_self_contact(Table& table, ClothEntry& cloth);
void read_self_contact(Table& table, SoftEntry& soft);
void read_self_contact(Table& table, RopeEntry& rope);

FrictionEntry read_friction_pair(Table& table);
// Throws InputError when one of the two is no cloth, soft body or rope, or does not meet others, or the scene
// has the pair twice.
void check_friction_pair(const FrictionEntry& entry, const Scene& scene);

}  // namespace drape::app
