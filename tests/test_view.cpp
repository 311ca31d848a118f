// The page of drape view: what is packed is what is unpacked, sizes, names that look like markup, what is
// refused, folders that are damaged. tests/web opens it in a browser.
#include <zlib.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "app/recording.h"
#include "app/run.h"
#include "app/view/page_blocks.h"
#include "app/view/page_data.h"
#include "app/view/page_template.h"
#include "app/view/track.h"
#include "app/view/view.h"
#include "folder.h"
#include "mesh/obj.h"

using namespace drape;
using namespace drape::test;
using Catch::Contains;
using Catch::EndsWith;
using Catch::StartsWith;

namespace {

namespace fs = std::filesystem;

std::string from_base64(const std::string& text) {
  const std::string letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  unsigned bits = 0;
  int count = 0;
  for (const char c : text) {
    if (c == '=') break;
    bits = bits << 6 | static_cast<unsigned>(letters.find(c));
    if ((count += 6) >= 8) bytes += static_cast<char>(bits >> (count -= 8) & 255);
  }
  return bytes;
}

// The bytes of block `id` of a page.
std::string block(const std::string& html, long id) {
  const std::string open = "id=\"drape-block-" + std::to_string(id) + "\">";
  const std::size_t begin = html.find(open);
  REQUIRE(begin != std::string::npos);
  const std::size_t start = begin + open.size();
  const std::string packed = from_base64(html.substr(start, html.find('<', start) - start));
  std::string bytes(64'000'000, '\0');
  uLongf size = bytes.size();
  REQUIRE(uncompress(reinterpret_cast<Bytef*>(bytes.data()), &size,
                     reinterpret_cast<const Bytef*>(packed.data()), packed.size()) == Z_OK);
  bytes.resize(size);
  return bytes;
}

std::uint16_t unfolded(unsigned z) { return static_cast<std::uint16_t>(z & 1 ? ~(z >> 1) : z >> 1); }

// Written from track.h's words, not from its code: all values, frame by frame.
std::vector<std::vector<double>> unpacked(const std::string& html, const Json& track, std::size_t vertices) {
  const std::size_t row = vertices * track["min"].items().size();
  std::vector<std::vector<std::uint16_t>> q;
  for (const Json& chunk : track["chunks"].items()) {
    const std::string bytes = block(html, static_cast<long>(chunk["block"].number(-1)));
    const auto count = static_cast<std::size_t>(chunk["frames"].number(0));
    REQUIRE(bytes.size() == 2 * count * row);
    for (std::size_t k = 0; k < count; ++k) {
      std::vector<std::uint16_t> frame(row);
      std::uint16_t change = 0;
      for (std::size_t i = 0; i < row; ++i) {
        const auto byte = [&](std::size_t at) { return static_cast<unsigned char>(bytes[at]); };
        const std::uint16_t rest = unfolded(byte(k * row + i) | unsigned{byte((count + k) * row + i)} << 8);
        const bool sums = std::get<bool>(chunk["neighbours"].value) && i % vertices != 0;
        change = static_cast<std::uint16_t>(sums ? change + rest : rest);
        int expected = 0;
        if (!q.empty()) expected = q.back()[i];
        if (q.size() > 1 && chunk["order"].number(0) == 2) expected += q.back()[i] - q[q.size() - 2][i];
        frame[i] = static_cast<std::uint16_t>(expected + change);
      }
      q.push_back(frame);
    }
  }
  std::vector<std::vector<double>> values;
  for (const auto& frame : q) {
    values.emplace_back(row);
    for (std::size_t i = 0; i < row; ++i)
      values.back()[i] = track["min"].items()[i / vertices].number(NAN) +
                         track["step"].items()[i / vertices].number(NAN) * frame[i];
  }
  return values;
}

constexpr const char* scene = R"(
[simulation]
duration = "0.2 s"
frame_rate = "50 Hz"
tolerance = 1e-4
[[cloth]]
mesh = "sheet.obj"
translate = [0, 0.22, 0]
[[obstacle]]
name = "ball"
shape = "sphere"
radius = "0.2 m"
motion = { velocity = [0.1, 0, 0] }
[[obstacle]]
name = "floor"
shape = "plane"
point = [0, -0.2, 0]
)";

// n x n vertices, 1 m x 1 m.
std::string sheet(int n) {
  std::string text;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      text += "v " + std::to_string(double(i) / (n - 1) - 0.5) + " 0 " +
              std::to_string(double(j) / (n - 1) - 0.5) + "\n";
  for (int i = 0; i + 1 < n; ++i)
    for (int j = 0; j + 1 < n; ++j) {
      const int v = n * i + j + 1;
      text += "f " + std::to_string(v) + " " + std::to_string(v + 1) + " " + std::to_string(v + n + 1) + " " +
              std::to_string(v + n) + "\n";
    }
  return text;
}

struct Run : Folder {
  explicit Run(int n = 8) {
    write("sheet.obj", sheet(n));
    write("scene.toml", scene);
    REQUIRE(run(read_scene(path / "scene.toml", {}), {path / "out", Frames::pc2, true}) == 0);
  }
  fs::path out() const { return path / "out"; }
};

void require_viewer() {
  if (has_viewer()) return;
  WARN("not tested, for the page is not in this build: " + missing_viewer());
}

}  // namespace

TEST_CASE("what is packed comes out within half a step", "[view]") {
  std::mt19937 random(7);
  const bool smooth = GENERATE(false, true), constant = GENERATE(false, true);
  const std::size_t vertices = GENERATE(1, 3, 50), frames = GENERATE(1, 2, 9);
  std::uniform_real_distribution<double> any(-3, 5);
  std::vector<std::vector<double>> values(frames, std::vector<double>(3 * vertices));
  for (std::size_t k = 0; k < frames; ++k)
    for (std::size_t i = 0; i < 3 * vertices; ++i)
      values[k][i] = constant && i < vertices ? 2.5 : smooth ? std::sin(0.1 * double(k * i)) : any(random);
  std::vector<Range> ranges(3);
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
  std::vector<Range> range(3, Range{-4, 4});
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
  TrackWriter writer(blocks, {Range{0, 1}}, 2);
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
  const Range range{-1, 1};
  PageBlocks blocks;
  TrackWriter positions(blocks, {range, range, range}, vertices), speed(blocks, {Range{0, 4}}, vertices),
      strain(blocks, {Range{-0.1, 0.1}}, vertices), contact(blocks, {Range{0, 2}}, vertices);
  for (int k = 0; k < 200; ++k) {
    std::vector<double> x(3 * vertices), v(vertices), e(vertices), touch(vertices);
    for (std::size_t i = 0; i < vertices; ++i) {
      const double u = double(i % n) / n - 0.5, w = double(i / n) / n - 0.5, t = 0.01 * k;
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
  CHECK(base64("") == "");
  CHECK(base64("f") == "Zg==");
  CHECK(base64("fo") == "Zm8=");
  CHECK(base64("foo") == "Zm9v");
  CHECK(base64("foob") == "Zm9vYg==");
  CHECK(base64("fooba") == "Zm9vYmE=");
  CHECK(base64("foobar") == "Zm9vYmFy");
  CHECK(base64("\xff\xfe\xfd") == "//79");
}

TEST_CASE("a polygon's sides are the page's lines, each once", "[view]") {
  const TriangleMesh quads = parse_obj(sheet(5), "sheet.obj");
  CHECK(polygon_sides(quads).size() == 2 * 2 * 5 * 4);
  TriangleMesh triangles = quads;
  triangles.document = nullptr;
  CHECK(polygon_sides(triangles).size() == 2 * (2 * 5 * 4 + 16));
}

TEST_CASE("a page has the run as it was recorded", "[view]") {
  const Run run;
  const Recording recording(run.out());
  const PageData page = page_data(recording);
  const std::string html = page.blocks.html();
  CHECK(page.head["title"].text() == "scene");
  CHECK(page.head["missing"].items().empty());
  REQUIRE(page.head["times"].items().size() == 11);
  REQUIRE(page.head["shapes"].items().size() == 2);
  for (std::size_t s = 0; s < 2; ++s) {
    const Json& shape = page.head["shapes"].items()[s];
    const auto vertices = static_cast<std::size_t>(shape["vertices"].number(0));
    const auto frames = unpacked(html, shape["positions"], vertices);
    REQUIRE(frames.size() == 11);
    for (int k = 0; k < 11; ++k) {
      const std::vector<Vec3> expected = recording.positions(s, k);
      REQUIRE(expected.size() == vertices);
      for (std::size_t i = 0; i < vertices; ++i)
        for (std::size_t c = 0; c < 3; ++c)
          CHECK(std::abs(frames[std::size_t(k)][c * vertices + i] - expected[i][int(c)]) <=
                0.5 * shape["positions"]["step"].items()[c].number(0) + 1e-9);
    }
  }
  const Json& cloth = page.head["shapes"].items()[0];
  const auto speed = unpacked(html, cloth["speed"], 64), contact = unpacked(html, cloth["contact"], 64);
  for (std::size_t i = 0; i < 64; ++i) {
    CHECK(speed[10][i] ==
          Approx(recording.velocities(0, 10)[i].norm()).margin(cloth["speed"]["step"].items()[0].number(0)));
    CHECK(contact[10][i] == Approx(double(recording.touches(0, 10)[i])).margin(1e-4));
  }
  CHECK(page.head["planes"].items().size() == 1);
  CHECK(page.head["planes"].items()[0]["points"].items().size() == 1);
  CHECK(page.head["steps"]["rows"].number(0) == 20);
}

TEST_CASE("a page needs nothing from outside, and names in it are text", "[view]") {
  require_viewer();
  if (!has_viewer()) return;
  const Run run;
  const std::string before = content(run.out() / "run.json");
  const std::size_t at = before.find("\"scene\": \"");
  REQUIRE(at != std::string::npos);
  run.write("out/run.json",
            before.substr(0, at + 10) + "<\\/script><b>&@@DATA@@\\u2028" + before.substr(at + 10));
  const std::string html = view_html(run.out());
  CHECK_THAT(html, StartsWith("<!DOCTYPE html>"));
  CHECK_THAT(html, EndsWith("</html>\n"));
  CHECK(html.find("</script><b>") == std::string::npos);
  CHECK_THAT(html, Contains("\\u003c/script>\\u003cb>&@@DATA@@"));
  CHECK(html.find("@@TITLE@@") == std::string::npos);
  for (const char* outside : {"src=\"http", "href=", "@import", "url(http", "<link"})
    CHECK(html.find(outside) == std::string::npos);
  CHECK_THAT(html, Contains("default-src 'none'"));
}

TEST_CASE("drape view writes a page, and a page again", "[view]") {
  require_viewer();
  if (!has_viewer()) return;
  const Run run;
  const Outcome first = run.drape("view out");
  CHECK(first.exit_code == 0);
  CHECK(first.err.empty());
  CHECK_THAT(first.out, StartsWith("wrote out/view.html (11 frames, "));
  CHECK(run.drape("view out").exit_code == 0);
  CHECK(run.drape("view out -o page.html").exit_code == 0);
  CHECK(content(run.path / "page.html") == content(run.out() / "view.html"));

  run.write("mine.html", "<p>mine");
  const Outcome refused = run.drape("view out -o mine.html");
  CHECK(refused.exit_code == 2);
  CHECK_THAT(refused.err, StartsWith("error: mine.html: is there already") && Contains("--force"));
  CHECK(content(run.path / "mine.html") == "<p>mine");
  CHECK(run.drape("view out -o mine.html --force").exit_code == 0);
  CHECK_THAT(content(run.path / "mine.html"), StartsWith("<!DOCTYPE html>"));

  const Outcome nowhere = run.drape("view out -o none/page.html");
  CHECK(nowhere.exit_code == 2);
  CHECK_THAT(nowhere.err, StartsWith("error: none/page.html: cannot write"));
  const Outcome folder = run.drape("view out -o out/bodies --force");
  CHECK(folder.exit_code == 2);
  CHECK_THAT(folder.err, Contains("is a folder"));
}

TEST_CASE("nothing to show", "[view]") {
  require_viewer();
  if (!has_viewer()) return;
  const Folder folder;
  fs::create_directory(folder.path / "empty");
  for (const char* name : {"none", "empty"}) {
    const Outcome outcome = folder.drape(std::string("view ") + name);
    CHECK(outcome.exit_code == 2);
    CHECK_THAT(outcome.err, StartsWith("error: " + std::string(name)));
    CHECK(std::count(outcome.err.begin(), outcome.err.end(), '\n') == 1);
    CHECK(outcome.out.empty());
  }
  CHECK(folder.files() == std::set<std::string>{"empty"});
}

TEST_CASE("a damaged folder is shown, and what is missing is said", "[view]") {
  const Run run;
  const fs::path out = run.out();
  std::string file;
  SECTION("no run.json") { fs::remove(out / (file = "run.json")); }
  SECTION("run.json is not JSON") { run.write("out/" + (file = "run.json"), "{\"scene\": "); }
  SECTION("no steps.csv") { fs::remove(out / (file = "steps.csv")); }
  SECTION("steps.csv cut short") {
    const std::string text = content(out / (file = "steps.csv"));
    run.write("out/steps.csv", text.substr(0, text.size() / 2));
  }
  SECTION("frames cut short") { fs::resize_file(out / (file = "sheet.pc2"), 32 + 12 * 64 * 4 + 7); }
  SECTION("no frames") { fs::remove(out / (file = "sheet.pc2")); }
  SECTION("fields cut short") { fs::resize_file(out / "fields" / (file = "sheet.strain.npy"), 200); }
  SECTION("no body") { fs::remove(out / "bodies" / (file = "ball.obj")); }

  const Recording recording(out);
  REQUIRE_FALSE(recording.missing().empty());
  const PageData page = page_data(recording);
  CHECK(page.head["missing"].items().size() == recording.missing().size());
  REQUIRE_FALSE(page.head["shapes"].items().empty());
  const Json& cloth = page.head["shapes"].items()[0];
  CHECK(unpacked(page.blocks.html(), cloth["positions"], 64).size() == std::size_t(recording.frames()));
  if (file == "sheet.strain.npy") CHECK(cloth["strain"].is_null());
  if (file == "steps.csv" && !fs::exists(out / file)) CHECK(page.head["steps"].is_null());

  if (!has_viewer()) return;
  const Outcome outcome = run.drape("view out");
  CHECK(outcome.exit_code == 0);
  CHECK_THAT(outcome.err, StartsWith("warning: ") && Contains(file));
  CHECK_THAT(content(out / "view.html"), Contains(file));
}

TEST_CASE("a build without the viewer says so", "[view]") {
  if (has_viewer()) {
    CHECK(missing_viewer().empty());
    return;
  }
  CHECK_THAT(missing_viewer(), StartsWith("the viewer is not in this build: "));
  CHECK_THROWS_WITH(view_html("none"), missing_viewer());
}
