// Scenes with cloth that tears: what is written, runs in parts, refusals, and cloth that meets itself.
#include <algorithm>
#include <catch2/catch.hpp>

#include "app/base/toml_file.h"
#include "app/recording/recording.h"
#include "app/run/run.h"
#include "app/simulation/sheets.h"
#include "mesh/base/errors.h"
#include "mesh/triangles/topology.h"
#include "tests/folder.h"
#include "tests/same_bits.h"
#include "tests/tearing.h"

using namespace drape;
using namespace drape::app;
using namespace drape::test;
using Catch::Contains;

namespace {

// A strip of quads in a folder, which hangs by its upper end and is pulled down by the lower one.
struct TearingStrip : Folder {
  static constexpr int nx = 6, nz = 13;
  TearingStrip() { write("strip.obj", quads(nx, nz, 0.02)); }

  Scene scene(const std::string& more = "") const {
    const std::string text =
        "[simulation]\nduration = \"0.6 s\"\ntime_step = \"5 ms\"\nframe_rate = \"50 Hz\"\ngravity = [0, 0, "
        "0]\n"
        "[[cloth]]\nname = \"strip\"\nmesh = \"strip.obj\"\ntear = \"30 %\"\nstretch = \"200 N/m\"\n" +
        more +
        "pins = [{ box = [[-1, -1, -1], [1, 1, 0.001]] }, { box = [[-1, -1, 0.239], [1, 1, 1]], motion = { "
        "velocity = [0, 0, 1], end = \"0.12 s\" } }]\n";
    return read_scene(parse_toml(text, "s.toml"), {}, path, "s.toml");
  }
};

std::vector<double> column(const Recording& recording, const std::string& name) {
  const Names& names = recording.steps().columns;
  const auto at = static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
  std::vector<double> values;
  for (const std::vector<double>& row : recording.steps().rows) values.push_back(row.at(at));
  return values;
}

}  // namespace

TEST_CASE("a run that tears writes the torn cloth, and earlier frames have its copies at one place",
          "[tear]") {
  const TearingStrip folder;
  for (const Frames frames : {Frames::pc2, Frames::obj}) {
    const std::filesystem::path out = folder.path / (frames == Frames::pc2 ? "pc2" : "obj");
    REQUIRE(run(folder.scene(), {out, frames, true}) == 0);
    const Recording recording(out);
    CHECK(recording.missing() == Names());
    const TriangleMesh mesh = read_obj(out / "strip.obj");
    const int start = TearingStrip::nx * TearingStrip::nz;
    REQUIRE(mesh.vertex_count() > start);
    CHECK(pieces(mesh) == 2);
    CHECK(mesh.document->texcoords.size() == static_cast<std::size_t>(start));
    CHECK(mesh.groups.size() == 2);

    const app::Json& cloth = recording.run()["cloths"].items()[0];
    const double torn = recording.run()["torn"]["edges"].number(0);
    CHECK(torn == sum(column(recording, "torn")));
    CHECK(torn == cloth["torn"].number(0));
    CHECK(cloth["particles"].number(0) == mesh.vertex_count());
    const auto count = [](const auto& list) { return static_cast<double>(list.size()); };
    const TriangleMesh before = read_obj(folder.path / "strip.obj");
    CHECK(cloth["edges"].number(0) == count(edges(before)));
    CHECK(cloth["diagonals"].number(0) == count(diagonals(before)));
    CHECK(cloth["edges_at_end"].number(0) == count(edges(mesh)));
    CHECK(count(edges(mesh)) == count(edges(before)) + torn);
    const auto& copy_of = cloth["copy_of"].items();
    REQUIRE(static_cast<int>(copy_of.size()) == mesh.vertex_count() - start);
    const std::vector<double> times = column(recording, "time"), cut = column(recording, "torn");
    const auto first = std::find_if(cut.begin(), cut.end(), [](double n) { return n > 0; }) - cut.begin();
    const double time = times[static_cast<std::size_t>(first)];
    CHECK(recording.run()["torn"]["first_time"].number(0) == Approx(time));

    REQUIRE(recording.frames() == 31);
    for (int f = 0; f < recording.frames(); ++f) {
      const std::vector<Vec3> x = recording.positions(0, f);
      REQUIRE(x.size() == mesh.positions.size());
      CHECK(recording.velocities(0, f).size() == x.size());
      CHECK(recording.strains(0, f).size() == x.size());
      CHECK(recording.touches(0, f).size() == x.size());
      bool together = true;
      for (std::size_t k = 0; k < copy_of.size(); ++k)
        together = together && x[static_cast<std::size_t>(start) + k] ==
                                   x[static_cast<std::size_t>(copy_of[k].number(0))];
      if (recording.time(f) < time - 1e-6) CHECK(together);
      if (f == recording.frames() - 1) CHECK_FALSE(together);
    }
    // Each frame that is written as OBJ has the borders of its time.
    if (frames == Frames::pc2) continue;
    CHECK(read_obj(out / "frames/strip_0001.obj").vertex_count() == start);
    CHECK(read_obj(out / "frames/strip_0031.obj").vertex_count() == mesh.vertex_count());
    CHECK(read_obj(out / "frames/strip_0031.obj").document->corners == mesh.document->corners);
  }
}

TEST_CASE("a run in two parts that tears in both has the bits of the whole, and whole recordings", "[tear]") {
  const TearingStrip folder;
  Simulation whole = make_simulation(folder.scene()), parts = make_simulation(folder.scene());
  const auto go = [&](Simulation& simulation, const std::string& out, std::optional<double> duration) {
    Run run(simulation, {.out = folder.path / out, .quiet = true, .duration = duration});
    march(run, [](const StepRow&) { return true; });
    return run.finish();
  };
  const RunRecord all = go(whole, "whole", {});
  REQUIRE(all.first_torn);
  CHECK(all.cloths[0].edges_at_end == static_cast<int>(edges(whole.cloths[0].mesh).size()));
  CHECK(all.cloths[0].diagonals_at_end == static_cast<int>(diagonals(whole.cloths[0].mesh).size()));
  const RunRecord first = go(parts, "first", *all.first_torn + 0.005), second = go(parts, "second", {});
  CHECK(first.torn > 0);
  CHECK(second.torn > 0);
  CHECK(first.torn + second.torn == all.torn);
  CHECK(same_bits(whole.state.x, parts.state.x));
  CHECK(same_bits(whole.state.v, parts.state.v));
  CHECK(second.state_hash == all.state_hash);
  for (const char* out : {"first", "second"}) CHECK(Recording(folder.path / out).missing() == Names());
  CHECK(content(folder.path / "whole/strip.obj") == content(folder.path / "second/strip.obj"));
}

TEST_CASE("the sides of a cut neither push each other away nor hold each other, and nothing passes through",
          "[tear]") {
  const TearingStrip folder;
  double fastest[2] = {0, 0};
  for (const bool meets : {false, true}) {
    Simulation strip =
        make_simulation(folder.scene(meets ? "self_contact = true\nthickness = \"2 mm\"\n" : ""));
    int torn = 0;
    while (strip.state.time < 0.6) {
      const StepReport report = strip.advance(0.005);
      REQUIRE(report.done);
      torn += report.torn;
      fastest[meets] = std::max(fastest[meets], max_speed(strip.state));
      if (meets) CHECK(Sheets(strip.cloths, strip.state.x).crossings() == 0);
    }
    CHECK(torn == TearingStrip::nx - 1);
  }
  CHECK(fastest[1] < 1.1 * fastest[0]);

  // A hole through which a ball has gone closes as the sheet springs back, and its sides meet.
  double energy[2] = {0, 0};
  for (const bool meets : {false, true}) {
    const Scene scene =
        read_scene(source_dir() + "/data/scenes/sheet-torn.toml",
                   {parse_setting("cloth.0.model=woven"),
                    parse_setting(std::string("cloth.0.self_contact=") + (meets ? "true" : "false"))});
    Simulation sheet = make_simulation(scene);
    int torn = 0, met = 0;
    while (sheet.state.time < 0.85) {
      const StepReport report = sheet.advance(0.005);
      REQUIRE(report.done);
      torn += report.torn;
      if (sheet.state.time < 0.46) continue;
      met += report.self_contacts + report.self_guarded;
      energy[meets] = std::max(energy[meets], sheet.system->elastic_energy(sheet.state.x));
      if (meets) CHECK(Sheets(sheet.cloths, sheet.state.x).crossings() == 0);
    }
    CHECK(torn > 8);
    CHECK((met > 0) == meets);
  }
  CHECK(energy[1] < 1.2 * energy[0]);
}

TEST_CASE("the step that tears tells the energy of its contacts as if nothing was torn", "[tear]") {
  std::vector<double> energies[2];
  double first = 0;  // s, when something tears
  for (const char* tear : {"0.35", "9"}) {
    const bool tears = std::string(tear) != "9";
    const Scene scene = read_scene(
        source_dir() + "/data/scenes/sheet-torn.toml",
        {parse_setting(std::string("cloth.0.tear=") + tear), parse_setting("cloth.0.self_contact=true")});
    Simulation sheet = make_simulation(scene);
    Run run(sheet, {.out = "", .quiet = true, .duration = tears ? 1.0 : first});
    for (bool over = false; !over && sheet.state.time < 1;) {
      const StepRow& row = run.step();
      REQUIRE(row.report.done);
      energies[tears].push_back(row.contact_energy);
      over = tears ? row.report.torn > 0 : sheet.state.time > first - 1e-9;
    }
    if (tears) first = sheet.state.time;
  }
  REQUIRE(first < 0.9);
  CHECK(energies[true].back() > 0);
  CHECK(energies[true] == energies[false]);
}

TEST_CASE("a limit in a scene has a unit, and one that makes no sense is refused with its line", "[tear]") {
  const Folder folder;
  folder.write("quads.obj", quads(3, 3, 0.1));
  const auto read = [&](const std::string& more) {
    return read_scene(parse_toml("[[cloth]]\nmesh = \"quads.obj\"\n" + more, "s.toml"), {}, folder.path,
                      "s.toml");
  };
  CHECK(read("tear = \"40 %\"\n").cloths[0].tear == Approx(0.4));
  CHECK(read("tear = 0.4\n").cloths[0].tear == 0.4);
  CHECK_FALSE(read("").cloths[0].tear);
  CHECK_THROWS_WITH(read("tear = 0\n"), Contains("s.toml:3") && Contains("tear"));
  CHECK_THROWS_WITH(read("tear = \"4 cm\"\n"), Contains("s.toml:3"));
  CHECK_THROWS_WITH(read("tear = 0.4\nneighbour_weighting = true\n"),
                    Contains("s.toml:3") && Contains("mass"));
}
