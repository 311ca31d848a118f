// Seams that close among cloth that meets itself: their two sides come together, and nothing passes through
// anything.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <string>

#include "mesh/distance/triangle_crossings.h"
#include "tests/garment.h"

using namespace drape;
using namespace drape::app;
using namespace drape::test;

namespace {

int crossings(const Simulation& s) {
  return crossing_count(
      crossing_contours(s.cloths[0].embedding.positions(s.state.x), s.cloths[0].mesh.triangles));
}

// The most pairs of triangles that cross in a step until this time.
int most_crossings(Simulation& s, double until, double h) {
  int most = crossings(s);
  while (s.state.time < until - 1e-9) {
    REQUIRE(s.advance(h).done);
    most = std::max(most, crossings(s));
  }
  return most;
}

// Both panels lie side by side, this far apart [m] at one end of the seam, and turned away from each other by
// this angle [deg]. One is held at its top, and swings down while the seam closes.
Simulation side_by_side(const TwoPanels& panels, const std::string& model, double apart, double angle = 0,
                        const std::string& then = "merge") {
  const Folder folder;
  folder.write("panels.obj", panels.obj());
  const double turn = angle * std::numbers::pi / 180;  // a panel turns about its middle
  const double c = std::cos(turn), d = std::sin(turn), w = panels.width, h = panels.height;
  const auto text = [](double number) { return std::to_string(number); };
  const std::string place =
      "[" + text(0.5 * (w + w * c + h * d) + apart) + ", " + text(0.5 * (h * c - h - w * d)) + ", 0]";
  return make_simulation(read_scene(
      parse_toml(
          "[[cloth]]\nmesh = \"panels.obj\"\nrest = \"uv\"\nfabric = \"cotton-poplin\"\nself_contact = true\n"
          "rotate = { axis = [1, 0, 0], angle = \"-90 deg\" }\nmodel = \"" +
              model +
              "\"\npanels = [{ group = \"front\" }, { group = \"back\", rotate = { axis = [0, 0, 1], angle = "
              "\"-" +
              text(angle) + " deg\" }, translate = " + place + " }]\n" + pinned +
              "seams = [{ curves = [\"front.right\", \"back.left\"], close = 0.2, then = \"" + then +
              "\" }]\n" + light,
          "scene.toml"),
      {}, folder.path, "scene.toml"));
}

}  // namespace

TEST_CASE("nothing passes through anything while a seam closes", "[sewing][self-contact]") {
  for (const char* model : {"noh-jung", "woven"})
    for (const int n : {7, 11, 17})
      for (const char* kind : {"quads", "one way", "alternating"})
        for (const double size : {1.0, 0.1})  // with edges of down to 3 mm
          for (const double angle : {0.0, 5.0})
            for (const double apart : {0.003, 0.04}) {
              INFO(model << ", " << n << " vertices, " << kind << ", " << apart << " m apart, turned by "
                         << angle << " deg, scaled by " << size);
              const TwoPanels panels{.nx = n,
                                     .ny = n - 2,
                                     .width = 0.5 * size,
                                     .height = 0.4 * size,
                                     .back_width = 0.5 * size,
                                     .quads = kind == std::string("quads"),
                                     .one_way = kind == std::string("one way")};
              Simulation s = side_by_side(panels, model, size * apart, angle);
              CHECK(most_crossings(s, 0.4, 0.005) == 0);
              CHECK(s.cloths[0].seams.empty());
            }
}

TEST_CASE("a seam that is kept holds where cloth meets itself", "[sewing][self-contact]") {
  for (const char* model : {"noh-jung", "woven"})
    for (const int n : {7, 11, 17})
      for (const double apart : {0.0, 0.01}) {
        INFO(model << ", " << n << " vertices, " << apart << " m apart");
        Simulation s = side_by_side({.nx = n, .ny = n - 2}, model, apart, 0, "keep");
        most_crossings(s, 0.5, 0.005);
        REQUIRE(s.cloths[0].seams.size() == 1);
        CHECK(s.cloths[0].seams[0].seam.gap(s.cloths[0].embedding, s.state.x) < 2e-6);
      }
}

TEST_CASE("a seam that begins closed is merged in the first step", "[sewing][self-contact]") {
  for (const char* model : {"noh-jung", "woven"})
    for (const int n : {7, 11, 17}) {
      const TwoPanels panels{.nx = n, .ny = n - 2};
      const double edge = panels.height / (panels.ny - 1);
      for (const double apart : {0.0, 0.005 * edge, 0.02 * edge}) {
        INFO(model << ", " << n << " vertices, " << apart / edge << " edges apart");
        Simulation s = side_by_side(panels, model, apart);
        REQUIRE(s.advance(0.005).done);
        CHECK(s.cloths[0].seams.empty() == (apart < 0.01 * edge));
        CHECK(most_crossings(s, 0.4, 0.005) == 0);
      }
    }
}

TEST_CASE("what begins closed at one end of a seam becomes one in the first step, and nothing passes there",
          "[sewing][self-contact]") {
  for (const char* model : {"noh-jung", "woven"})
    for (const int n : {7, 11, 17}) {
      INFO(model << ", " << n << " vertices");
      Simulation s = side_by_side({.nx = n, .ny = n - 2}, model, 0, 5);
      const int particles = s.state.particles();
      REQUIRE(s.advance(0.005).done);
      CHECK(s.state.particles() == particles - 1);
      CHECK(most_crossings(s, 0.4, 0.005) == 0);
      CHECK(s.cloths[0].seams.empty());
      CHECK(s.state.particles() == particles - (n - 2));
    }
}
