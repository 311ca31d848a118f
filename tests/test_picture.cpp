// Laws of pictures: what is where on them, what hides what, which colours; as drawn in memory.
//   a ball that a square picture frames is a disc that touches the frame
#include <Eigen/Geometry>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "app/picture/normals.h"
#include "app/picture/render.h"
#include "app/picture/sheet.h"
#include "mesh/base/errors.h"
#include "mesh/base/threads.h"
#include "mesh/triangles/generate.h"
#include "tests/folder.h"
#include "tests/png_read.h"
#include "tests/tables.h"

using namespace drape;
using namespace drape::app;
using namespace drape::app::drawing;
using namespace drape::test;

namespace {

TriangleMesh moved(TriangleMesh mesh, const Vec3& by) {
  for (Vec3& p : mesh.positions) p += by;
  return mesh;
}

// A still of meshes that live as long as it does.
struct Scene {
  std::vector<TriangleMesh> meshes;
  Still still;

  void add(TriangleMesh mesh, bool body, std::vector<double> values = {}) {
    meshes.reserve(8);
    meshes.push_back(std::move(mesh));
    still.parts.push_back(
        {body, 0, meshes.back().positions, &meshes.back().triangles, nullptr, {}, {}, std::move(values)});
  }
  // Of everything in it.
  Image draw(const View& view, int width, int height, const Look& look = {}) const {
    Framing framing(view, {0, 0, double(width), double(height)});
    for (const StillPart& part : still.parts)
      for (const Vec3& p : part.positions) framing.add(p);
    Image image(width, height, background);
    render(still, framing.camera(), look, image, {0, 0, double(width), double(height)});
    return image;
  }
};

bool empty(const Pixel& p) { return p == background; }
bool bluish(const Pixel& p) { return p[2] > p[0] + 25; }
bool greyish(const Pixel& p) { return !empty(p) && std::abs(p[2] - p[0]) < 15; }

template <class Is>
Eigen::Vector2d middle_of(const Image& image, const Is& is) {
  Eigen::Vector2d sum(0, 0);
  int count = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      if (is(image.at(x, y))) sum += Eigen::Vector2d(x, y), ++count;
  REQUIRE(count > 0);
  return sum / count;
}

double brightness(const Pixel& p) { return light(p).sum(); }

}  // namespace

TEST_CASE("a PNG file has the pixels that were drawn, with few colours and with many", "[picture]") {
  for (int colours : {1, 2, 256, 257, 5000}) {
    Image image(97, 61, {});
    for (std::size_t k = 0; k < image.pixels.size(); ++k) {
      const auto c = static_cast<unsigned>(k) % static_cast<unsigned>(colours);
      image.pixels[k] = {static_cast<std::uint8_t>(c * 7 % 256), static_cast<std::uint8_t>(c / 256),
                         static_cast<std::uint8_t>(c % 256)};
    }
    const Image again = read_png(png(image));
    INFO(colours << " colours");
    CHECK(again.width == 97);
    CHECK(again.height == 61);
    CHECK(again.pixels == image.pixels);
  }
}

TEST_CASE("a ball is a disc of the right size in the middle, on an even background", "[picture]") {
  Scene scene;
  scene.add(sphere(5, 0.3), false);
  for (const View& view : {View{0, 0}, View{30, 20}, View{-120, -50}, View{0, 90}}) {
    const Image image = scene.draw(view, 201, 201);
    int covered = 0, lopsided = 0;
    for (int y = 0; y < 201; ++y)
      for (int x = 0; x < 201; ++x) {
        const double r = std::hypot(x - 100, y - 100);
        if (r < 99) CHECK_FALSE(empty(image.at(x, y)));
        if (r > 102) CHECK(empty(image.at(x, y)));
        covered += !empty(image.at(x, y));
        lopsided += empty(image.at(x, y)) != empty(image.at(200 - x, y));
        lopsided += empty(image.at(x, y)) != empty(image.at(x, 200 - y));
      }
    CHECK(covered == Approx(std::numbers::pi * 100.5 * 100.5).epsilon(0.02));
    CHECK(lopsided < 2 * 0.5 * 2 * std::numbers::pi * 100);  // a pixel at half of the outline
  }
}

TEST_CASE("what is in front hides what is behind, from either side", "[picture]") {
  Scene scene;
  scene.add(sphere(3, 0.2), true);
  TriangleMesh sheet = grid(5, 5, 1, 1);
  for (Vec3& p : sheet.positions) p = {p.x(), -p.z(), 0.4};  // upright, normals to +z
  scene.add(sheet, false);
  CHECK(bluish(scene.draw({0, 0}, 100, 100).at(50, 50)));
  const Image back = scene.draw({180, 0}, 100, 100);
  CHECK(greyish(back.at(50, 50)));
  CHECK(bluish(back.at(10, 50)));
}

TEST_CASE("views: y is up, front looks along -z, the azimuth turns the eye towards +x", "[picture]") {
  struct Seen {
    const char* view;
    Vec3 at;          // of the cloth, from the body
    int right, down;  // where it is then
  };
  for (const Seen& seen :
       {Seen{"front", {1, 0, 0}, 1, 0}, Seen{"front", {0, 1, 0}, 0, -1}, Seen{"back", {1, 0, 0}, -1, 0},
        Seen{"right", {0, 0, 1}, -1, 0}, Seen{"side", {0, 0, 1}, -1, 0}, Seen{"left", {0, 0, 1}, 1, 0},
        Seen{"left", {0, 1, 0}, 0, -1}, Seen{"top", {1, 0, 0}, 1, 0}, Seen{"top", {0, 0, 1}, 0, 1},
        Seen{"90,0", {0, 0, 1}, -1, 0}}) {
    Scene scene;
    scene.add(sphere(3, 0.1), true);
    scene.add(moved(sphere(3, 0.1), 0.5 * seen.at), false);
    const Image image = scene.draw(view_named(seen.view), 120, 120);
    const Eigen::Vector2d apart = middle_of(image, bluish) - middle_of(image, greyish);
    INFO(seen.view << " " << seen.at.transpose() << ": " << apart.transpose());
    CHECK(std::abs(apart.x() - 70 * seen.right) < (seen.right == 0 ? 4 : 35));
    CHECK(std::abs(apart.y() - 70 * seen.down) < (seen.down == 0 ? 4 : 35));
  }
  // Nearer is in front: from +z the cloth at +z hides the body.
  Scene scene;
  scene.add(sphere(3, 0.1), true);
  scene.add(moved(sphere(3, 0.1), {0, 0, 0.5}), false);
  CHECK(bluish(scene.draw(view_named("front"), 60, 60).at(30, 30)));
  CHECK(greyish(scene.draw(view_named("back"), 60, 60).at(30, 30)));
}

TEST_CASE("a picture has the same bits on any number of threads", "[picture]") {
  Scene scene;
  scene.add(sphere(4, 0.3), true);
  scene.add(moved(grid(20, 20, 1, 1), {0, 0.3, 0}), false);
  scene.still.planes.push_back({"floor", {0, -0.3, 0}, {0, 1, 0}});
  const ThreadsRestored restored;
  std::vector<Image> images;
  images.reserve(3);
  for (int t : {1, 2, 7}) {
    set_threads(t);
    images.push_back(scene.draw({30, 20}, 300, 200));
  }
  CHECK(images[1].pixels == images[0].pixels);
  CHECK(images[2].pixels == images[0].pixels);
}

TEST_CASE("colours follow the values of the vertices, times the light that falls there", "[picture]") {
  for (Field field : {Field::strain, Field::speed}) {
    const Scale scale{field, field == Field::strain ? -0.1 : 0, 0.1};
    const TriangleMesh sheet = grid(21, 21, 1, 1);
    std::vector<double> values;
    values.reserve(sheet.positions.size());
    for (const Vec3& p : sheet.positions)
      values.push_back(scale.low + (p.x() + 0.5) * (scale.high - scale.low));
    Scene scene;
    scene.add(sheet, false, values);
    Look look;
    look.scale = scale;
    const Image image = scene.draw(view_named("top"), 210, 210, look);
    double most = 0, least = 1e9;
    for (int x = 5; x < 205; x += 5) {
      const Light expected = light(colour_of(scale, scale.low + (x + 0.5) / 210 * (scale.high - scale.low)));
      const Light seen = light(image.at(x, 105));
      const double falls = (seen * expected).sum() / expected.square().sum();
      INFO("pixel " << x << ": " << seen.transpose() << ", of " << expected.transpose());
      CHECK((seen - static_cast<float>(falls) * expected).abs().maxCoeff() < 0.03);
      most = std::max(most, falls), least = std::min(least, falls);
    }
    CHECK(least > 0.7);
    CHECK(most / least < 1.1);  // a flat sheet: the same light everywhere
  }
}

TEST_CASE("contact has the colour of the nearest vertex and none between", "[picture]") {
  const TriangleMesh sheet = grid(3, 3, 1, 1);
  std::vector<double> values;
  values.reserve(sheet.positions.size());
  for (const Vec3& p : sheet.positions) values.push_back(p.x() < -0.1 ? 0 : p.x() > 0.1 ? 2 : 1);
  Scene scene;
  scene.add(sheet, false, values);
  Look look;
  look.scale = Scale{Field::contact, 0, 2};
  const Image image = scene.draw(view_named("top"), 200, 200, look);
  for (int x = 3; x < 197; ++x) {
    if (std::abs(x - 50) < 3 || std::abs(x - 150) < 3) continue;
    const Light expected = light(colour_of(*look.scale, x < 50 ? 0 : x < 150 ? 1 : 2));
    const Light seen = light(image.at(x, 102));
    INFO("pixel " << x);
    CHECK((seen / seen.maxCoeff() - expected / expected.maxCoeff()).abs().maxCoeff() < 0.05);
  }
}

TEST_CASE("a body throws a shadow on the ground, which ends in the background", "[picture]") {
  Scene scene;
  scene.add(moved(sphere(4, 0.2), {0, 0.25, 0}), true);
  Framing framing({0, 60}, {100, 100, 100, 100});
  for (const Vec3& p : scene.still.parts[0].positions) framing.add(p);
  const Camera camera = framing.camera();
  Image bare(300, 300, background), image = bare;
  render(scene.still, camera, {}, bare, {0, 0, 300, 300});
  scene.still.planes.push_back({"floor", {0, 0, 0}, {0, 1, 0}});
  Look look;
  look.size = 0.7, look.middle = {0, 0.25, 0};
  render(scene.still, camera, look, image, {0, 0, 300, 300});
  double darkest = 3, lightest = 0;
  for (int y = 0; y < 300; ++y)
    for (int x = 0; x < 300; ++x)
      if (empty(bare.at(x, y))) {
        darkest = std::min(darkest, brightness(image.at(x, y)));
        lightest = std::max(lightest, brightness(image.at(x, y)));
      }
  CHECK(darkest < 0.65 * lightest);
  int changed = 0, covered = 0;  // the ground is behind the ball, and only takes some light from below it
  for (std::size_t k = 0; k < bare.pixels.size(); ++k) {
    if (empty(bare.pixels[k])) continue;
    ++covered;
    changed += std::abs(brightness(image.pixels[k]) - brightness(bare.pixels[k])) > 0.1;
  }
  CHECK(changed < 0.3 * covered);
  for (int k = 0; k < 300; ++k)
    for (const Pixel& p : {image.at(k, 0), image.at(k, 299), image.at(0, k), image.at(299, k)})
      CHECK(empty(p));
  // From below the ground is not there, or it would hide everything.
  Framing below({0, -30}, {0, 0, 60, 60});
  for (const Vec3& p : scene.still.parts[0].positions) below.add(p);
  Image from_below(60, 60, background);
  render(scene.still, below.camera(), look, from_below, {0, 0, 60, 60});
  CHECK(greyish(from_below.at(30, 30)));
}

TEST_CASE("a wall in front of a body hides it, one behind does not", "[picture]") {
  for (double at : {0.5, -0.5}) {
    Scene scene;
    scene.add(sphere(3, 0.2), false);
    scene.still.planes.push_back({"wall", {0, 0, at}, {0, 0, 1}});
    const Pixel middle = scene.draw({0, 0}, 80, 80).at(40, 40);
    CHECK(bluish(middle) == (at < 0));
  }
}

TEST_CASE("the maps of colours go the usual way", "[picture]") {
  const Scale strain{Field::strain, -0.1, 0.1}, speed{Field::speed, 0, 2};
  const Pixel shorter = colour_of(strain, -0.08), none = colour_of(strain, 0),
              longer = colour_of(strain, 0.08);
  CHECK(shorter[2] > shorter[0] + 80);
  CHECK(longer[0] > longer[2] + 80);
  CHECK(*std::min_element(none.begin(), none.end()) > 240);
  CHECK(colour_of(strain, 7) == colour_of(strain, 0.1));
  // Compression and extension are as far from white as each other, and blue against red, which a red-green
  // blind eye tells apart, too.
  double paler = 3;
  for (double s = 0.02; s < 0.101; s += 0.02) {
    const Pixel less = colour_of(strain, -s), more = colour_of(strain, s);
    CHECK(std::abs(brightness(less) - brightness(more)) < 0.12);  // of 3
    CHECK(less[2] - less[0] > more[2] - more[0] + 40);
    CHECK(brightness(more) < paler);
    paler = brightness(more);
  }
  CHECK(colour_of(strain, std::nan("")) != none);
  double before = 0;  // faster is lighter
  for (double v = 0; v <= 2; v += 0.25) {
    CHECK(brightness(colour_of(speed, v)) > before);
    before = brightness(colour_of(speed, v));
  }
}

TEST_CASE("edges of triangles are darker lines", "[picture]") {
  Scene scene;
  scene.add(grid(6, 6, 1, 1), false);
  Look with;
  with.edges = true;
  const Image plain = scene.draw({0, 90}, 200, 200), lined = scene.draw({0, 90}, 200, 200, with);
  int darker = 0, lighter = 0;
  for (std::size_t k = 0; k < plain.pixels.size(); ++k) {
    darker += brightness(lined.pixels[k]) < brightness(plain.pixels[k]);
    lighter += brightness(lined.pixels[k]) > brightness(plain.pixels[k]);
  }
  CHECK(darker > 200 * 10);  // ten lines across the picture and the diagonals
  CHECK(darker < 200 * 200 / 2);
  CHECK(lighter == 0);
}

TEST_CASE("normals are round on a ball, flat on a box, and pass over a seam of the texture", "[picture]") {
  const TriangleMesh ball = sphere(4, 2);
  const auto of_ball = corner_normals(ball.positions, ball.triangles, 40);
  for (std::size_t t = 0; t < of_ball.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k)
      CHECK(of_ball[t][k].cast<double>().dot(ball.positions[ball.triangles[t][k]] / 2) > 0.9999);

  const TriangleMesh cube = box({1, 2, 3});
  const auto of_cube = corner_normals(cube.positions, cube.triangles, 40);
  for (const CornerNormals& normals : of_cube)
    for (const auto& n : normals) {
      CHECK((n - normals[0]).norm() < 1e-6);
      CHECK(n.cwiseAbs().maxCoeff() == Approx(1));
    }

  const std::vector<Vec3> roof = {{0, 0, 0}, {0, 0, 1}, {1, -0.3, 0}, {-1, -0.3, 0}, {0, 0, 0}, {0, 0, 1}};
  const auto of_roof = corner_normals(roof, {{0, 1, 2}, {5, 4, 3}}, 40);
  CHECK((of_roof[0][0] - Eigen::Vector3f(0, 1, 0)).norm() < 1e-6F);
  CHECK((of_roof[1][1] - Eigen::Vector3f(0, 1, 0)).norm() < 1e-6F);
  const auto none = corner_normals({{0, 0, 0}, {0, 0, 0}, {1, 0, 0}}, {{0, 1, 2}}, 40);  // without an area
  CHECK(none[0][0].norm() == 0);
}

TEST_CASE("steps of a legend are round and about as many as asked", "[picture]") {
  for (double range = 1e-6; range < 1e6; range *= 1.37) {
    const double step = round_step(range, 4),
                 digit = step / std::pow(10, std::floor(std::log10(step) + 1e-9));
    INFO(range << " by " << step);
    CHECK((digit == Approx(1) || digit == Approx(2) || digit == Approx(5)));
    CHECK(range / step > 1.5);
    CHECK(range / step < 4.001);
  }
}

TEST_CASE("pixels are sRGB and come back from light as they were", "[picture]") {
  for (int v = 0; v < 256; ++v) {
    const auto c = static_cast<std::uint8_t>(v);
    CHECK(pixel(light({c, c, c})) == Pixel{c, c, c});
  }
  CHECK(light({188, 188, 188})[0] == Approx(0.5).margin(0.005));
}
