#include "app/commands/triangulate_command.h"

#include <cmath>
#include <cstdio>

#include "app/base/table.h"
#include "app/pattern/pattern_read.h"
#include "app/pattern/remarks.h"
#include "mesh/obj/obj.h"

namespace drape::app {
namespace {

constexpr double kVeryDifferent = 3;  // lengths of two curves that are sewn

double read(const std::string& text, const char* option, const Dimension& dimension, Range range) {
  try {
    return quantity(parse_toml_value(text, option), dimension, range);
  } catch (const InputError& error) {
    throw InputError(std::string(option) + " " + text + ": " + error.what());
  }
}

// A bare number of an angle would be radians; everybody means degrees here.
double read_angle(const std::string& text) {
  const bool bare = text.find_first_not_of("0123456789.+-eE") == text.npos;
  return read(bare ? text + " deg" : text, "--min-angle", dimension::angle, Range::not_negative);
}

std::string gathered(const SeamReport& seam) {
  const double longer = std::max(seam.length_a, seam.length_b),
               shorter = std::min(seam.length_a, seam.length_b);
  std::string text = "seam " + seam.a + " / " + seam.b + ": " + counted(seam.pairs, "pair") + ", " +
                     in_cm(seam.length_a) + " to " + in_cm(seam.length_b);
  const double percent = 100 * (longer / shorter - 1);
  if (percent >= 0.1) text += ": gathered by " + rounded(percent, 2) + " %";
  return text;
}

void print_report(const PatternMesh& made) {
  double area = 0;
  for (const PanelReport& p : made.panels) {
    area += p.area;
    std::printf("panel %s: %s, %s, %s cm^2, smallest angle %s\n", p.name.c_str(),
                counted(p.vertices, "vertex").c_str(), counted(p.triangles, "triangle").c_str(),
                rounded(1e4 * p.area, 5).c_str(), in_deg(p.smallest_angle).c_str());
  }
  for (const SeamReport& seam : made.seams) std::printf("%s\n", gathered(seam).c_str());
  std::printf("in all: %s, %s, %s m^2\n", counted(made.mesh.vertex_count(), "vertex").c_str(),
              counted(made.mesh.triangle_count(), "triangle").c_str(), rounded(area, 5).c_str());
  std::printf("longest edge %s (allowed %s), curves within %s mm, smallest angle %s\n",
              in_cm(made.longest_edge).c_str(), in_cm(made.edge).c_str(),
              rounded(1000 * made.tolerance, 3).c_str(), in_deg(made.smallest_angle).c_str());
}

void print_remarks(const PatternMesh& made, double min_angle, const std::string& where) {
  for (const SeamReport& seam : made.seams)
    if (std::max(seam.length_a, seam.length_b) > kVeryDifferent * std::min(seam.length_a, seam.length_b))
      std::printf("warning: seam %s / %s: %s to %s: very different lengths; is this the seam you mean?\n",
                  seam.a.c_str(), seam.b.c_str(), in_cm(seam.length_a).c_str(), in_cm(seam.length_b).c_str());
  for (const std::string& line : remarks(made, min_angle, where)) std::printf("%s\n", one_line(line).c_str());
}

}  // namespace

int triangulate_file(const TriangulateWords& words) {
  TriangulateOptions options;
  if (!words.edge.empty()) options.edge = read(words.edge, "--edge", dimension::length, Range::positive);
  if (!words.tolerance.empty())
    options.tolerance = read(words.tolerance, "--tolerance", dimension::length, Range::positive);
  if (!words.min_angle.empty()) options.min_angle = read_angle(words.min_angle);
  const std::filesystem::path output(words.out);
  if (output.extension() != ".obj") throw InputError(words.out + ": expected a name that ends in .obj");
  Names notes;
  const Pattern pattern = read_pattern(words.pattern, notes);
  const PatternMesh made = triangulate(pattern, options);
  write_obj(output, made.mesh, made.mesh.positions);
  if (words.quiet) return 0;
  for (const std::string& note : notes) std::printf("note: %s\n", one_line(note).c_str());
  print_report(made);
  print_remarks(made, options.min_angle, words.pattern);
  std::printf("wrote %s\n", words.out.c_str());
  return 0;
}

}  // namespace drape::app
