#include "app/scene/measured.h"

namespace drape::app {
namespace {

// A specimen that large is none of a laboratory: the unit was left out, or is another.
void check_size(const Table& test, const char* key, double size, double most) {
  if (size > most)
    test.fail(key, "is " + rounded(size, 4) + " m; expected up to " + rounded(100 * most, 3) +
                       " cm, such as \"10 cm\"");
}

std::optional<MeasuredDrape> read_drape(Table& table) {
  const About about("what a drape test of the fabric gave");
  const Node* const node = table.take("measured_drape", "a table", about);
  if (!node) return {};
  if (node->kind != Node::Kind::table)
    table.fail("measured_drape", "expected a table such as { coefficient = \"45 %\", nodes = 6 }");
  Table test = table.inner("measured_drape");
  MeasuredDrape measured;
  test.read_required("coefficient", measured.coefficient, dimension::share, Range::not_negative,
                     "the drape coefficient: the part of the ring round the plate that the shadow covers");
  if (measured.coefficient > 1)
    test.fail("coefficient", "a drape coefficient is at most 1; write 45 % as \"45 %\" or 0.45");
  test.read("nodes", measured.nodes, dimension::number, Range::not_negative, "how many folds were counted");
  test.read("specimen", measured.specimen, dimension::length, Range::positive, "diameter of the disc");
  if (measured.specimen < 0.2 || measured.specimen > 0.4)
    test.fail("specimen", "expected a diameter from 20 cm to 40 cm");
  test.read("plate", measured.plate, dimension::length, Range::positive,
            "diameter of the plate that the disc lies on");
  if (measured.plate < 0.05 || measured.plate > 0.3)
    test.fail("plate", "expected a diameter from 5 cm to 30 cm");
  if (measured.plate >= measured.specimen)
    test.fail("plate", "the plate is as wide as the disc; expected less than its specimen");
  test.finish();
  return measured;
}

MeasuredCantilever read_cantilever(Table& test) {
  MeasuredCantilever measured;
  test.read_required("length", measured.length, dimension::length, Range::positive,
                     "of the strip, from the clamp to its free end");
  check_size(test, "length", measured.length, 0.5);
  test.require("droop");
  measured.droop = *read_directions(test, "droop", dimension::length, true,
                                    {"how much lower than the clamp the free end hangs", ""});
  const Directions& droop = measured.droop;
  for (const std::optional<double>& one : {std::optional<double>(droop.warp), droop.weft, droop.bias})
    if (one && *one >= measured.length)
      test.fail("droop", "the free end hangs lower by less than the length of the strip");
  test.finish();
  return measured;
}

MeasuredBiasExtension read_bias_extension(Table& test) {
  MeasuredBiasExtension measured;
  test.read_required("length", measured.length, dimension::length, Range::positive, "between the clamps");
  test.read_required("width", measured.width, dimension::length, Range::positive, "of the strip");
  check_size(test, "length", measured.length, 1);
  check_size(test, "width", measured.width, 1);
  test.read_required("load", measured.load, dimension::sheet_force, Range::positive, "force per width");
  test.read_required("extension", measured.extension, dimension::share, Range::positive,
                     "how much longer the strip becomes, over its length");
  if (measured.extension > 0.5) test.fail("extension", "expected at most 50 %");
  test.finish();
  return measured;
}

MeasuredFrame read_frame(Table& test) {
  MeasuredFrame measured;
  test.read_required("side", measured.side, dimension::length, Range::positive, "of the square");
  check_size(test, "side", measured.side, 1);
  test.read_required("shear", measured.shear, dimension::angle, Range::positive,
                     "by which the right angles of the frame have changed");
  if (measured.shear > 0.8) test.fail("shear", "expected at most 45 degrees; write 5 degrees as \"5 deg\"");
  test.read_required("force", measured.force, dimension::force, Range::positive,
                     "that pulls two opposite corners apart");
  test.finish();
  return measured;
}

}  // namespace

MeasuredTests read_measured(Table& file) {
  MeasuredTests measured;
  measured.drape = read_drape(file);
  for (Table& test : file.tables("measured_cantilever", "what strips that hang from a clamp gave"))
    measured.cantilevers.push_back(read_cantilever(test));
  for (Table& test : file.tables("measured_bias_extension", "what strips cut at 45 degrees gave"))
    measured.bias_extensions.push_back(read_bias_extension(test));
  for (Table& test : file.tables("measured_picture_frame", "what a hinged frame gave"))
    measured.frames.push_back(read_frame(test));
  return measured;
}

}  // namespace drape::app
