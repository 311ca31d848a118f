#include "app/scene/self_contact_read.h"

namespace drape::app {

void read_self_contact(Table& table, ClothEntry& cloth) {
  table.read(
      "self_contact", cloth.self_contact,
      "whether it meets itself, and other cloths that have this: without it they pass through each other");
  table.read("thickness", cloth.self.thickness, dimension::length, Range::positive,
             "with self_contact: two layers rest at the mean of their thicknesses");
  table.read(
      "friction", cloth.self.friction, dimension::number, Range::not_negative,
      "with self_contact: Coulomb's coefficient between two layers; between two cloths it is the root of the "
      "product of both");
  if (table.has("self_contact")) return;
  for (const char* key : {"thickness", "friction"})
    if (table.has(key)) table.fail(key, "goes with self_contact = true");
}

}  // namespace drape::app
