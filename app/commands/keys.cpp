#include "app/commands/keys.h"

#include <algorithm>
#include <array>
#include <cstdio>

#include "app/pattern/pattern_read.h"
#include "app/scene/fabrics.h"
#include "app/scene/scene.h"
#include "app/scene/shape_table.h"
#include "mesh/base/errors.h"

namespace drape::app {
namespace {

// Before and after the tables of all built-in shapes.
constexpr std::string_view before_shapes = R"(
[simulation]

[air]

[[cloth]]
mesh   = "sheet.obj"
rotate = { axis = [0, 1, 0], angle = 0 }
panels = [{ group = "front" }]
seams  = [{}]
pins   = [{ group = "collar", motion = { keyframes = [{ time = 0 }] } }]

[[cloth]]
mesh      = "flag.obj"
model     = "woven"
warp      = [1, 0, 0]
stretch   = { warp = 500 }
bend      = { warp = 1e-5 }
viscosity = {}

[[cloth]]
mesh = "laboratory.obj"
kes  = {}
fast = {}

[[soft]]
particles    = [2, 2, 2]
spacing      = 0.1
self_contact = true

[[pair]]
between  = ["soft", "soft"]
friction = 0.3

[[soft]]
mesh    = "body.obj"
spacing = 0.1

[[rope]]
points          = [[0, 0, 0], [1, 0, 0]]
mass_per_length = 0.1
pins            = [{ end = "first" }]
anchors         = [{ end = "last", body = "ground" }]
joins           = [{ end = "first", to = "soft" }]

[[rope]]
mesh            = "lines.obj"
mass_per_length = 0.1

[[obstacle]]
name     = "ground"
shape    = "plane"
friction = { static = 0.3, kinetic = 0.3 }
motion   = { spin = { axis = [0, 1, 0], rate = 1 } }
)";

constexpr std::string_view after_shapes = R"(
[[obstacle]]
shape  = "mesh"
mesh   = "body.obj"
frames = "body_%d.obj"

[[obstacle]]
shape = "level-set"
mesh  = "body.obj"

[[obstacle]]
shape  = "sphere"
radius = 1
mass   = 1
)";

// A scene has the tables that a cloth has, too.
constexpr std::string_view fabric_of_every_kind = R"(
area_density   = 0.15
measured_drape = { coefficient = 0.5 }
measured_cantilever = { length = 0.1, droop = 0.05 }
measured_bias_extension = { length = 0.1, width = 0.05, load = "5 gf/cm", extension = 0.1 }
measured_picture_frame = { side = 0.1, shear = 0.1, force = 0.1 }
)";

constexpr std::string_view pattern_of_every_kind = R"(
unit = "1 cm"

[[panel]]
name    = "front"
outline = [[0, 0], [9, 0], { bezier = [[9, 5]] }, [9, 9]]
holes   = [{ outline = [[4, 2], [5, 2], [5, 3]] }]
line    = [{ points = [[6, 2], [6, 3]] }]

[[seam]]
curves = ["front.a", "front.b"]
)";

struct File {
  const char* name;
  KeyNotes keys;
};

std::array<File, 3> files() {
  return {{{"scene", scene_keys()}, {"fabric", fabric_keys()}, {"pattern", pattern_keys()}}};
}

std::string title(const KeySection& section, const std::string& file) {
  return section.table.empty() ? "the " + file + " file" : section.table;
}

void print_plain(const KeySection& section, const std::string& file) {
  std::printf("%s%s\n", title(section, file).c_str(),
              section.kind.empty() ? ":" : (", " + section.kind + ":").c_str());
  for (const KeyNote& note : section.keys) {
    std::string value = note.kind;
    if (!note.unit.empty()) value += " [" + note.unit + "]";
    value += note.otherwise.empty() ? "; required" : "; default: " + note.otherwise;
    std::printf("  %-28s %s\n%31s%s\n", note.key.c_str(), value.c_str(), "", note.text.c_str());
  }
}

void print_markdown(const KeySection& section) {
  if (!section.kind.empty()) std::printf("\nFurther, %s:\n\n", section.kind.c_str());
  std::printf("| key | value | unit | default | meaning |\n| --- | --- | --- | --- | --- |\n");
  for (const KeyNote& note : section.keys)
    std::printf("| `%s` | %s | %s | %s | %s |\n", note.key.c_str(), note.kind.c_str(), note.unit.c_str(),
                note.otherwise.empty() ? "**required**" : note.otherwise.c_str(), note.text.c_str());
}

std::string toml(double value) { return shortest(value); }
std::string toml(const Vec3& v) {
  return "[" + shortest(v[0]) + ", " + shortest(v[1]) + ", " + shortest(v[2]) + "]";
}
std::string toml(const Mat3&) { return "{ axis = [0, 1, 0], angle = 0 }"; }

}  // namespace

std::string scene_of_every_kind() {
  std::string text(before_shapes);
  for_each_built_in([&]<class Kind>(const Kind& standard) {
    text += "\n[[obstacle]]\nshape = \"" + std::string(name(standard)) + "\"\n";
    for_each_field<Kind>([&](const auto& field) {
      if (field.required) text += std::string(field.key()) + " = " + toml(standard.*field.member) + "\n";
    });
  });
  return text.append(after_shapes);
}

KeyNotes scene_keys() {
  KeyNotes notes;
  read_scene(parse_toml(scene_of_every_kind(), "a scene of every kind"), {}, {}, "every kind", &notes);
  return notes;
}

KeyNotes fabric_keys() {
  KeyNotes notes;
  read_fabric_file(parse_toml(fabric_of_every_kind, "a fabric of every kind"), "every kind", &notes);
  return notes;
}

KeyNotes pattern_keys() {
  KeyNotes notes;
  parse_toml_pattern(pattern_of_every_kind, "a pattern of every kind", &notes);
  return notes;
}

int print_keys(const KeysWords& words) {
  Names known;
  bool found = false;
  for (const File& file : files()) {
    known.push_back(file.name);
    for (const KeySection& section : file.keys.sections()) {
      if (!section.table.empty()) known.push_back(section.table);
      if (!words.table.empty() && words.table != file.name && words.table != section.table) continue;
      found = true;
      if (words.markdown)
        print_markdown(section);
      else
        print_plain(section, file.name);
    }
  }
  std::sort(known.begin(), known.end());
  known.erase(std::unique(known.begin(), known.end()), known.end());
  if (!found) throw InputError("there is no table '" + words.table + "'; " + suggestion(words.table, known));
  return 0;
}

}  // namespace drape::app
