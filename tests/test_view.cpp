// The page of drape view: it has the run, names that look like markup, what is refused, folders that are
// damaged. tests/web opens it in a browser.
#include <catch2/catch.hpp>
#include <cmath>

#include "app/base/pc2.h"
#include "app/recording/recording.h"
#include "app/run/run.h"
#include "app/view/page_data.h"
#include "app/view/page_template.h"
#include "app/view/view.h"
#include "folder.h"
#include "mesh/obj/obj.h"
#include "page.h"

using namespace drape;
using namespace drape::app;
using namespace drape::test;
using Catch::Contains;
using Catch::EndsWith;
using Catch::StartsWith;

namespace {

namespace fs = std::filesystem;

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

struct ShortRun : Folder {
  explicit ShortRun(int n = 8) {
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

TEST_CASE("a polygon's sides are the page's lines, each once", "[view]") {
  const TriangleMesh quads = parse_obj(sheet(5), "sheet.obj");
  CHECK(polygon_sides(quads).size() == 2 * 2 * 5 * 4);
  TriangleMesh triangles = quads;
  triangles.document = nullptr;
  CHECK(polygon_sides(triangles).size() == 2 * (2 * 5 * 4 + 16));
}

TEST_CASE("a page has the run as it was recorded", "[view]") {
  const ShortRun done;
  const Recording recording(done.out());
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
  const ShortRun done;
  const std::string before = content(done.out() / "run.json");
  const std::size_t at = before.find("\"scene\": \"");
  REQUIRE(at != std::string::npos);
  done.write("out/run.json",
             before.substr(0, at + 10) + "<\\/script><b>&@@DATA@@\\u2028" + before.substr(at + 10));
  const std::string html = view_html(done.out());
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
  const ShortRun done;
  const Outcome first = done.drape("view out");
  CHECK(first.exit_code == 0);
  CHECK(first.err.empty());
  CHECK_THAT(first.out, StartsWith("wrote out/view.html (11 frames, "));
  CHECK(done.drape("view out").exit_code == 0);
  CHECK(done.drape("view out -o page.html").exit_code == 0);
  CHECK(content(done.path / "page.html") == content(done.out() / "view.html"));

  done.write("mine.html", "<p>mine");
  const Outcome refused = done.drape("view out -o mine.html");
  CHECK(refused.exit_code == 2);
  CHECK_THAT(refused.err, StartsWith("error: mine.html: is there already") && Contains("--force"));
  CHECK(content(done.path / "mine.html") == "<p>mine");
  CHECK(done.drape("view out -o mine.html --force").exit_code == 0);
  CHECK_THAT(content(done.path / "mine.html"), StartsWith("<!DOCTYPE html>"));

  const Outcome nowhere = done.drape("view out -o none/page.html");
  CHECK(nowhere.exit_code == 2);
  CHECK_THAT(nowhere.err, StartsWith("error: none/page.html: cannot write"));
  const Outcome folder = done.drape("view out -o out/bodies --force");
  CHECK(folder.exit_code == 2);
  CHECK_THAT(folder.err, Contains("is a folder"));
}

TEST_CASE("a page takes the place of no file of the run", "[view]") {
  require_viewer();
  if (!has_viewer()) return;
  const ShortRun done;
  for (const std::string file : {"run.json", "steps.csv", "bodies.csv", "sheet.obj", "sheet.pc2",
                                 "bodies/ball.obj", "fields/sheet.strain.npy"}) {
    INFO(file);
    const std::string before = content(done.out() / file);
    REQUIRE_FALSE(before.empty());
    const Outcome outcome = done.drape("view out --force -o out/" + file);
    CHECK(outcome.exit_code == 2);
    CHECK_THAT(outcome.err, StartsWith("error: out/" + file + ": is a name of the run's own files"));
    CHECK(content(done.out() / file) == before);
  }
}

TEST_CASE("an interrupted page is not there", "[view]") {
  require_viewer();
  if (!has_viewer()) return;
  const ShortRun done;
  // Many frames, as if they had been recorded: whatever is missing else is no matter.
  fs::create_directory(done.path / "long");
  done.write("long/sheet.obj", sheet(100));
  Pc2Writer cache(done.path / "long/sheet.pc2", 10000);
  std::vector<Vec3> x(10000);
  for (int k = 0; k < 1600; ++k) {
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = Vec3::Constant(std::sin(0.1 * k + double(i)));
    cache.add(x);
  }
  cache.close();
  cache.keep();
  for (const std::string signal : {"INT", "TERM"}) {
    const Outcome outcome = done.drape("view long", "timeout --preserve-status -s " + signal + " 0.5");
    CHECK(outcome.exit_code == 130);
    CHECK_THAT(outcome.err, EndsWith("interrupted: no page was written\n"));
    CHECK(outcome.out.empty());
    CHECK(done.files("long") == std::set<std::string>{"sheet.obj", "sheet.pc2"});
  }
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
  const ShortRun done;
  const fs::path out = done.out();
  std::string file;
  SECTION("no run.json") { fs::remove(out / (file = "run.json")); }
  SECTION("run.json is not JSON") { done.write("out/" + (file = "run.json"), "{\"scene\": "); }
  SECTION("no steps.csv") { fs::remove(out / (file = "steps.csv")); }
  SECTION("steps.csv cut short") {
    const std::string text = content(out / (file = "steps.csv"));
    done.write("out/steps.csv", text.substr(0, text.size() / 2));
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
  const Outcome outcome = done.drape("view out");
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
