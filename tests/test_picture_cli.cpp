// `drape picture` as people run it: output folders and meshes to PNG files, and what it refuses.
#include <algorithm>

#include "app/picture/colours.h"
#include "mesh/base/errors.h"
#include "tests/png_read.h"
#include "tests/workshop.h"

using namespace drape;
using namespace drape::app;
using namespace drape::app::drawing;
using namespace drape::test;
using Catch::Contains;
using Catch::StartsWith;

namespace {

// A sheet has fallen on a ball: 9 frames.
struct ShortRun : Workshop {
  ShortRun() { REQUIRE(drape("simulate s.toml --out o --quiet").exit_code == 0); }
  Image read(const std::string& name) const { return read_png(content(path / name)); }
};

bool empty(const Pixel& p) { return p == background; }

}  // namespace

TEST_CASE("a run is drawn at the size that was asked, and again only when told so", "[picture]") {
  const ShortRun shop;
  const Outcome drawn = shop.drape("picture o");
  CHECK(drawn.exit_code == 0);
  CHECK(drawn.out == "wrote o/picture.png\n");
  CHECK(shop.read("o/picture.png").width == 1280);
  CHECK(shop.read("o/picture.png").height == 960);
  const std::string before = content(shop.path / "o/picture.png");
  const Outcome again = shop.drape("picture o --size 64x48");
  CHECK(again.exit_code == 2);
  CHECK_THAT(again.err, StartsWith("error: o/picture.png: is there already; --force"));
  CHECK(content(shop.path / "o/picture.png") == before);
  CHECK(shop.drape("picture o --size 64x48 --force").exit_code == 0);
  CHECK(shop.read("o/picture.png").width == 64);
}

TEST_CASE("frames of a sequence are seen by the same camera", "[picture]") {
  const ShortRun shop;
  const Outcome drawn = shop.drape("picture o --frame all --view front --size 160x120 -o p.png");
  CHECK(drawn.exit_code == 0);
  const auto frames = shop.json("o/run.json")["frame_times"].size();
  REQUIRE(frames > 4);
  CHECK_THAT(drawn.out, StartsWith("wrote p_0001.png to p_000") && Contains("(" + std::to_string(frames)));
  CHECK(shop.drape("picture o --frame 2,2 --size 160x120 -o twice.png").out == "wrote twice_0002.png\n");
  // The ball stands; below the sheet's reach its outline is the same in all of them.
  std::vector<int> lowest;
  Image first(1, 1, {});
  for (std::size_t k = 1; k <= frames; ++k) {
    const Image image = shop.read("p_000" + std::to_string(k) + ".png");
    int row = image.height - 1, left = 0;
    const auto filled = [&](int y) {
      for (left = 0; left < image.width; ++left)
        if (!empty(image.at(left, y))) return true;
      return false;
    };
    while (row > 0 && !filled(row)) --row;
    lowest.push_back(1000 * row + left);
    if (k == 1) first = image;
    if (k == frames) CHECK(image.pixels != first.pixels);
  }
  CHECK(std::count(lowest.begin(), lowest.end(), lowest[0]) == static_cast<long>(frames));
}

TEST_CASE("named frames become a sheet, with their times under them", "[picture]") {
  const ShortRun shop;
  CHECK(shop.drape("picture o --grid --frame 1,3,last --size 600x200 -o sheet.png").exit_code == 0);
  const Image sheet = shop.read("sheet.png");
  CHECK(sheet.width == 600);
  // Under every third there are letters: dark pixels in the lowest lines, nowhere else there.
  for (int third = 0; third < 3; ++third) {
    int dark = 0, at_side = 0;
    for (int y = 180; y < 200; ++y)
      for (int x = 0; x < 200; ++x) {
        const bool is_dark = sheet.at(200 * third + x, y)[0] < 120;
        dark += is_dark;
        at_side += is_dark && std::abs(x - 100) > 40;
      }
    CHECK(dark > 10);
    CHECK(at_side == 0);
  }
  CHECK(shop.drape("picture o o sheet.obj --size 300x100 -o side.png").exit_code == 0);
  CHECK(shop.read("side.png").width == 300);
  CHECK(shop.drape("picture o --grid --size 300x200 -o grid.png").exit_code == 0);
}

TEST_CASE("colours come with a legend whose ends are those of the map", "[picture]") {
  const ShortRun shop;
  for (const std::string field : {"strain", "speed", "contact"}) {
    INFO(field);
    CHECK(shop.drape("picture o --color " + field + " --size 640x480 --frame 6 -o " + field + ".png")
              .exit_code == 0);
    const Image image = shop.read(field + ".png");
    const auto has = [&](const Pixel& p) {
      return std::count(image.pixels.begin() + 640 * 420, image.pixels.end(), p) > 3;
    };
    const Scale scale{*field_named(field), field == "strain" ? -1.0 : 0.0, field == "contact" ? 2.0 : 1.0};
    CHECK(has(colour_of(scale, scale.low + 0.002)));
    CHECK(has(colour_of(scale, scale.high - 0.002)));
    CHECK(has(ink));
  }
  CHECK(shop.drape("picture o --size 640x480 --frame 6 -o plain.png").exit_code == 0);
  const Image plain = shop.read("plain.png");
  CHECK(std::count(plain.pixels.begin(), plain.pixels.end(), ink) == 0);
}

TEST_CASE("triangles that cross are red, in a run and in a mesh", "[picture]") {
  const ShortRun shop;
  const Pixel red = colour_of({Field::crossing, 0, 1}, 1);
  const auto reds = [&](const std::string& input) {
    CHECK(shop.drape("picture " + input + " --color crossing --size 320x240 --force -o c.png").exit_code ==
          0);
    const Image image = shop.read("c.png");
    long above = 0;  // the legend has the same colour
    for (int y = 0; y < 180; ++y)
      for (int x = 0; x < 320; ++x) {
        const Pixel p = image.at(x, y);
        above += p[0] > 90 && p[0] > 2.5 * p[1];
      }
    CHECK(std::count(image.pixels.begin() + 320 * 180, image.pixels.end(), red) > 3);
    return above;
  };
  CHECK(reds("o") == 0);
  CHECK(reds("sheet.obj") == 0);
  TriangleMesh two = grid(13, 13, 1, 1);
  const int vertices = two.vertex_count(), triangles = two.triangle_count();
  for (int v = 0; v < vertices; ++v) {
    const Vec3 x = two.positions[v];
    two.positions.emplace_back(x.x() + 0.011, 0.4 * (x.z() + 0.013), x.z());
  }
  for (int t = 0; t < triangles; ++t) {
    const Triangle c = two.triangles[t];
    two.triangles.push_back({c[0] + vertices, c[1] + vertices, c[2] + vertices});
  }
  write_obj(shop.path / "two.obj", two, two.positions);
  CHECK(reds("two.obj") > 50);
}

TEST_CASE("a mesh is drawn as a cloth, what comes with it as a body", "[picture]") {
  const Workshop shop;
  CHECK(shop.drape("picture sheet.obj --with ball.obj --view top --size 100x100").out == "wrote sheet.png\n");
  const Image image = read_png(content(shop.path / "sheet.png"));
  CHECK(image.at(50, 50)[2] > image.at(50, 50)[0] + 25);  // the sheet hides the ball
  CHECK(shop.drape("picture sheet.obj --with ball.obj --view 0,-90 --size 100x100 --force").exit_code == 0);
  const Pixel below = read_png(content(shop.path / "sheet.png")).at(50, 50);
  CHECK(std::abs(below[2] - below[0]) < 15);
}

TEST_CASE("of a damaged run what is there is drawn, and what is missing is said", "[picture]") {
  const ShortRun shop;
  std::filesystem::remove(shop.path / "o/sheet.pc2");
  const Outcome last = shop.drape("picture o --size 64x48 -o last.png");
  CHECK(last.exit_code == 0);
  CHECK_THAT(last.err, StartsWith("warning: ") && Contains("sheet.pc2"));
  CHECK(shop.read("last.png").width == 64);
}

TEST_CASE("what cannot be drawn is refused in one line and leaves nothing", "[picture]") {
  const ShortRun shop;
  shop.write("empty.obj", "v 0 0 0\n");
  const auto before = shop.files();
  struct Refusal {
    const char *words, *message;
  };
  for (const auto& [words, message] : {
           Refusal{"nowhere", "nowhere: no such file or folder"},
           Refusal{"bodies.csv", "bodies.csv: no such file or folder"},
           Refusal{"empty.obj", "empty.obj"},
           Refusal{"o --frame 0", "--frame 0: o has"},
           Refusal{"o --frame 100", "numbers 1 to "},
           Refusal{"o --frame 1,", "neither a number"},
           Refusal{"o --frame first", "neither a number"},
           Refusal{"sheet.obj --frame 2", "has 1 frame, number 1"},
           Refusal{"o --view frnt", "did you mean 'front'"},
           Refusal{"o --view 30", "there is no such view"},
           Refusal{"o --view 30,x", "'x' is not a number"},
           Refusal{"o --view 30,91", "-90 to 90"},
           Refusal{"o --view nan,1", "not a number"},
           Refusal{"o --color strian", "did you mean 'strain'"},
           Refusal{"sheet.obj --color strain", "a mesh has no strain"},
           Refusal{"o --size 1280", "such as 1280x960"},
           Refusal{"o --size 15x100", "16 to 8192"},
           Refusal{"o --size 100x8193", "16 to 8192"},
           Refusal{"o --size 100x100x", "such as 1280x960"},
           Refusal{"o --size 64x48 --color speed", "too small for the legend"},
           Refusal{"o --size 32x32 --grid", "do not fit"},
           Refusal{"o --with nothing.obj", "nothing.obj"},
           Refusal{"o -o p.jpg", "ends in .png"},
           Refusal{"o -o no/where/p.png", "no/where/p.png: cannot write"},
           Refusal{"o --force -o o/frames/p.png", "o/frames/p.png: is a name of the run's own files"},
           Refusal{"o sheet.obj --force -o o/bodies/p.png", "is a name of the run's own files"},
           Refusal{"", "OUT"},
       }) {
    INFO(words);
    const std::string out = std::string(words).find("-o") == std::string::npos ? " -o p.png" : "";
    const Outcome refused = shop.drape("picture " + std::string(words) + out);
    CHECK(refused.exit_code == 2);
    CHECK_THAT(refused.err, StartsWith("error: ") && Contains(message));
    CHECK(lines_of(refused.err) == 1);
    CHECK(shop.files() == before);
  }
  shop.write("p_0003.png", "mine");
  const Outcome refused = shop.drape("picture o --frame all --size 64x48 -o p.png");
  CHECK(refused.exit_code == 2);
  CHECK_THAT(refused.err, Contains("p_0003.png: is there already"));
  CHECK_FALSE(std::filesystem::exists(shop.path / "p_0001.png"));
}

TEST_CASE("interrupted pictures are whole or not there", "[picture]") {
  const ShortRun shop;
  for (const std::string signal : {"INT", "TERM"}) {
    INFO(signal);
    const Outcome outcome = shop.drape("picture o --frame all --size 4000x4000 --force -o p.png",
                                       "timeout --preserve-status -s " + signal + " 1");
    CHECK(outcome.exit_code == 130);
    CHECK_THAT(outcome.err, StartsWith("interrupted: "));
    CHECK(outcome.out.empty());
    for (const std::string& name : shop.files()) {
      CHECK_THAT(name, !Catch::EndsWith(".part"));
      if (name.ends_with(".png")) CHECK(shop.read(name).width == 4000);
    }
    CHECK_FALSE(std::filesystem::exists(shop.path / "p_0008.png"));
  }
}

TEST_CASE("triangles that a rope passes through are red, and so is the rope there", "[picture][rope]") {
  const Workshop shop;
  const auto scene = [&](double end) {
    return "[simulation]\nduration = 0.01\ngravity = [0, 0, 0]\n" + shop.cloth +
           "[[rope]]\npoints = [[0.03, 0.9, 0.02], [0.03, " + std::to_string(end) +
           ", 0.02]]\nsegments = 4\nmass_per_length = 0.1\nradius = \"1 cm\"\n";
  };
  const Pixel red = colour_of({Field::crossing, 0, 1}, 1);
  // Red pixels of the cloth's plane and of what is above it, in a view from the side and one from below.
  const auto reds = [&](double end, const std::string& view) {
    shop.write("r.toml", scene(end));
    CHECK(shop.drape("simulate r.toml --out r --quiet").exit_code == 0);
    CHECK(shop.drape("picture r --color crossing --size 320x240 --view=" + view + " --force -o c.png")
              .exit_code == 0);
    const Image image = read_png(content(shop.path / "c.png"));
    long found = 0;
    for (int y = 0; y < 180; ++y)  // the legend below has the same colour
      for (int x = 0; x < 320; ++x) {
        const Pixel p = image.at(x, y);
        found += p[0] > 90 && p[0] > 2.5 * p[1];
      }
    CHECK(std::count(image.pixels.begin(), image.pixels.end(), red) > 3);
    return found;
  };
  CHECK(reds(0.4, "0,-60") == 0);
  CHECK(reds(0.1, "0,-60") > 20);
  CHECK(reds(0.1, "0,0") > 20);
}
