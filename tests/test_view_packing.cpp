// Numbers in a page of drape view: what is packed is what is unpacked, and how large it is.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "app/view/page_blocks.h"
#include "app/view/page_template.h"
#include "app/view/track.h"
#include "page.h"

using namespace drape;
using namespace drape::app;
using namespace drape::test;

TEST_CASE("what is packed comes out within half a step", "[view]") {
  std::mt19937 random(7);
  const bool smooth = GENERATE(false, true), constant = GENERATE(false, true);
  const std::size_t vertices = GENERATE(1, 3, 50), frames = GENERATE(1, 2, 9);
  std::uniform_real_distribution<double> any(-3, 5);
  std::vector<std::vector<double>> values(frames, std::vector<double>(3 * vertices));
  for (std::size_t k = 0; k < frames; ++k)
    for (std::size_t i = 0; i < 3 * vertices; ++i)
      values[k][i] = constant && i < vertices ? 2.5 : smooth ? std::sin(0.1 * double(k * i)) : any(random);
  std::vector<ValueRange> ranges(3);
  for (std::size_t c = 0; c < 3; ++c) {
    bool known = false;
    for (const auto& frame : values) widen(ranges[c], known, frame.data() + c * vertices, vertices);
  }
  PageBlocks blocks;
  TrackWriter writer(blocks, ranges, vertices);
  for (const auto& frame : values) writer.add(frame);
  const Json track = writer.finish();
  CHECK(writer.not_finite() == 0);
  const auto result = unpacked(blocks.html(), track, vertices);
  REQUIRE(result.size() == frames);
  for (std::size_t k = 0; k < frames; ++k)
    for (std::size_t i = 0; i < 3 * vertices; ++i)
      CHECK(std::abs(result[k][i] - values[k][i]) <= 0.5 * ranges[i / vertices].step() + 1e-12);
}

TEST_CASE("chunks carry on from each other", "[view]") {
  std::mt19937 random(3);
  std::normal_distribution<double> any;
  const std::size_t vertices = 700'000;  // four frames to a chunk
  std::vector<ValueRange> range(3, ValueRange{-4, 4});
  PageBlocks blocks;
  TrackWriter writer(blocks, range, vertices);
  std::vector<double> start(3 * vertices), speed(3 * vertices), frame(3 * vertices);
  for (std::size_t i = 0; i < frame.size(); ++i)
    start[i] = std::clamp(any(random), -3., 3.), speed[i] = 0.02 * any(random);
  for (int k = 0; k < 9; ++k) {
    for (std::size_t i = 0; i < frame.size(); ++i) frame[i] = std::clamp(start[i] + k * speed[i], -4., 4.);
    writer.add(frame);
  }
  const Json track = writer.finish();
  REQUIRE(track["chunks"].items().size() == 3);
  const auto result = unpacked(blocks.html(), track, vertices);
  double worst = 0;
  for (std::size_t i = 0; i < frame.size(); ++i) worst = std::max(worst, std::abs(result[8][i] - frame[i]));
  CHECK(worst <= 0.5 * range[0].step() + 1e-12);
}

TEST_CASE("what is not finite is shown as it last was", "[view]") {
  PageBlocks blocks;
  TrackWriter writer(blocks, {ValueRange{0, 1}}, 2);
  writer.add({0.25, 1});
  writer.add({NAN, INFINITY});
  writer.add({0, 0.5});
  const Json track = writer.finish();
  CHECK(writer.not_finite() == 2);
  const auto result = unpacked(blocks.html(), track, 2);
  CHECK(result[1] == result[0]);
  CHECK(result[2][1] == Approx(0.5).margin(1e-5));
}

TEST_CASE("200 frames of 10 000 vertices stay under 20 MB", "[view]") {
  // Waves of several lengths that move, and noise as large as a millimetre: rougher than a cloth.
  std::mt19937 random(11);
  std::normal_distribution<double> noise(0, 3e-4);
  const std::size_t n = 100, vertices = n * n;
  const ValueRange range{-1, 1};
  PageBlocks blocks;
  TrackWriter positions(blocks, {range, range, range}, vertices), speed(blocks, {ValueRange{0, 4}}, vertices),
      strain(blocks, {ValueRange{-0.1, 0.1}}, vertices), contact(blocks, {ValueRange{0, 2}}, vertices);
  for (int k = 0; k < 200; ++k) {
    std::vector<double> x(3 * vertices), v(vertices), e(vertices), touch(vertices);
    for (std::size_t i = 0; i < vertices; ++i) {
      const std::size_t column = i % n, line = i / n;
      const double u = double(column) / n - 0.5, w = double(line) / n - 0.5, t = 0.01 * k;
      const double phase = 9 * u + 5 * w + 7 * t;
      x[i] = u + 0.02 * std::sin(phase) + noise(random);
      x[vertices + i] = 0.2 * std::sin(phase) + 0.05 * std::cos(40 * w - 20 * t) + noise(random);
      x[2 * vertices + i] = w + 0.02 * std::cos(phase) + noise(random);
      v[i] = std::abs(1.4 * std::cos(phase)) + noise(random) + 1e-3;
      e[i] = 0.05 * std::sin(phase) + noise(random);
      touch[i] = random() % 20 == 0 ? 2 : 0;
    }
    positions.add(x), speed.add(v), strain.add(e), contact.add(touch);
  }
  for (TrackWriter* writer : {&positions, &speed, &strain, &contact}) writer->finish();
  CHECK(blocks.html().size() + 700'000 < 20'000'000);  // with the page itself
  CHECK(page_template().size() < 900'000);
}

TEST_CASE("base64 as the standard has it", "[view]") {
  // RFC 4648, section 10.
  CHECK(base64("").empty());
  CHECK(base64("f") == "Zg==");
  CHECK(base64("fo") == "Zm8=");
  CHECK(base64("foo") == "Zm9v");
  CHECK(base64("foob") == "Zm9vYg==");
  CHECK(base64("fooba") == "Zm9vYmE=");
  CHECK(base64("foobar") == "Zm9vYmFy");
  CHECK(base64("\xff\xfe\xfd") == "//79");
}
