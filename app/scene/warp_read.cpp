#include "app/scene/warp_read.h"

#include <cctype>
#include <cmath>

#include "mesh/base/errors.h"

namespace drape::app {
namespace {

// [x, y, z] in the rest shape; or an angle, counterclockwise from v of the texture coordinates, u to the right.
// or_word: what else may stand there, for the message.
Vec3 direction(const Node& node, bool rest_is_flat, const std::string& or_word = {}) {
  if (node.kind == Node::Kind::array) {
    const Vec3 warp = vector(node, dimension::number);
    if (warp.isZero()) throw InputError("a direction is not [0, 0, 0]");
    return warp;
  }
  const bool word = node.kind == Node::Kind::text && !node.text.empty() &&
                    std::isalpha(static_cast<unsigned char>(node.text.front()));
  if (word || node.kind == Node::Kind::table || node.kind == Node::Kind::boolean)
    throw InputError("expected " + or_word + "a direction [x, y, z], or an angle such as \"30 deg\"");
  const double angle = quantity(node, dimension::angle, Range::any);
  if (!rest_is_flat)
    throw InputError(
        "an angle counts from v of the texture coordinates, and goes with rest = \"uv\"; expected a "
        "direction [x, y, z] in the mesh");
  return {-std::sin(angle), std::cos(angle), 0};
}

bool is_down(const Node& node) { return node.kind == Node::Kind::text && node.text == "down"; }

void read_groups(const Table& table, const Node& node, ClothEntry& cloth) {
  const Table groups = table.inner("warp");
  if (node.members.empty()) table.fail("warp", "names no group; expected { front = \"30 deg\" }");
  for (const auto& [name, value] : node.members) {
    try {
      cloth.group_warps.push_back({name, direction(value, cloth.rest_is_flat)});
    } catch (const InputError& error) {
      groups.fail(name, error.what());
    }
  }
}

}  // namespace

// A scene that names a fabric need not say where the warp runs, nor one that leaves the model to the program.
void read_warp(Table& table, ClothEntry& cloth) {
  if (cloth.rest_is_flat) cloth.warp = Vec3(0, 1, 0);
  const Node* const node =
      table.take("warp", "[x, y, z], \"down\", an angle, or a table of directions and angles by group",
                 {"of model = \"woven\": the direction of the warp in the rest shape, as the file has it; "
                  "\"down\": down the "
                  "cloth, along y of a mesh that stands and along z of one that lies (a note of the run says "
                  "which); an angle "
                  "counts from v of the texture coordinates, counterclockwise; by group: { front = \"30 "
                  "deg\", yoke = [1, 0, 0] }",
                  "v of the texture coordinates, with rest = \"uv\": the grain of each panel of a pattern; "
                  "\"down\" with `fabric` or without `model`"});
  const bool chosen = !table.has("model") || !cloth.fabric_name.empty();
  const bool down = node ? is_down(*node) : chosen && !cloth.warp;
  cloth.warp_is_down = down && cloth.model == "woven";
  if (!node || down) return;
  take_with_woven(table, cloth, "warp");
  if (node->kind == Node::Kind::table) return read_groups(table, *node, cloth);
  try {
    cloth.warp = direction(*node, cloth.rest_is_flat, "\"down\", ");
  } catch (const InputError& error) {
    table.fail("warp", error.what());
  }
}

void take_with_woven(const Table& table, ClothEntry& cloth, const char* key) {
  if (cloth.model == "woven") return;
  if (!table.has("model")) table.fail(key, "goes with model = \"woven\"");
  cloth.idle_keys.emplace_back(key);
}

}  // namespace drape::app
