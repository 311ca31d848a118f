// What a scene may say of a garment: patterns, panels, seams; mistakes in it, and what the user is told.
#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "mesh/base/errors.h"
#include "tests/garment.h"
#include "tests/mistakes.h"

using namespace drape;
using namespace drape::app;
using namespace drape::test;
using Catch::Contains;

TEST_CASE("a panel that is wrapped keeps its lengths along and round the cylinder", "[sewing]") {
  const Tailor tailor;
  const Simulation s = tailor.simulation("");
  const std::vector<Vec3>& x = s.cloths[0].mesh.positions;
  for (int p : {0, 1})
    for (int j = 0; j < tailor.panels.ny; ++j)
      for (int i = 0; i < tailor.panels.nx; ++i) {
        Vec3 on = x[tailor.panels.vertex(p, i, j)];
        on.z() -= p == 0 ? 0.02 : -0.02;
        CHECK(std::hypot(on.x(), on.z()) == Approx(0.16));
        CHECK(on.z() * (p == 0 ? 1 : -1) > -0.01);  // in front, or behind
        CHECK(on.y() == Approx(0.4 * j / (tailor.panels.ny - 1) - 0.2));
        if (i == 0) continue;
        const Vec3& before = x[tailor.panels.vertex(p, i - 1, j)];
        const double chord = 2 * 0.16 * std::sin(0.5 * 0.05 / 0.16);
        CHECK((x[tailor.panels.vertex(p, i, j)] - before).norm() == Approx(chord).epsilon(1e-5));
      }
}

TEST_CASE("a pattern named by the scene is the mesh that triangulate writes", "[sewing]") {
  const Folder folder;
  folder.write(
      "p.toml",
      "unit = \"1 cm\"\n[[panel]]\nname = \"a\"\noutline = [[0, 0], [30, 0], { bezier = [[33, 20]] }, "
      "[28, 40], [2, 40]]\nsides = [\"hem\", \"right\", \"waist\", \"left\"]\n");
  REQUIRE(folder.drape("triangulate p.toml -o p.obj --edge 3cm --quiet").exit_code == 0);
  const auto made = [&](const std::string& text) {
    return make_simulation(
        read_scene(parse_toml("[[cloth]]\nname = \"c\"\n" + text, "s.toml"), {}, folder.path, "s.toml"));
  };
  const Simulation drawn = made("mesh = \"p.toml\"\nedge = \"3 cm\"\npins = [{ group = \"a.waist\" }]\n");
  const Simulation cut = made("mesh = \"p.obj\"\nrest = \"uv\"\npins = [{ group = \"a.waist\" }]\n");
  CHECK(drawn.state.x == cut.state.x);
  CHECK(drawn.cloths[0].mesh.triangles == cut.cloths[0].mesh.triangles);
  CHECK(drawn.constraints->pinned() == cut.constraints->pinned());
  CHECK(drawn.system->masses() == cut.system->masses());
  CHECK(drawn.system->elastic_energy(drawn.state.x) < 1e-20);
  CHECK_THROWS_WITH(made("mesh = \"p.obj\"\nedge = \"3 cm\"\n"), Contains("s.toml:4") && Contains("pattern"));
}

TEST_CASE("a pattern that is scaled rests scaled", "[sewing]") {
  const Tailor tailor;
  const Simulation plain = tailor.simulation(""), twice = tailor.simulation("scale = 2\n");
  REQUIRE(plain.cloths[0].edges.size() == twice.cloths[0].edges.size());
  for (std::size_t k = 0; k < plain.cloths[0].edges.size(); ++k)
    CHECK(twice.cloths[0].edges[k].L == Approx(2 * plain.cloths[0].edges[k].L));
}

TEST_CASE("what rests is not settled while its seams are closing", "[sewing]") {
  const Tailor tailor;
  tailor.write("s.toml", tube_cloth +
                             "seams = [{ close = \"1.5 s\" }]\npins = [{ group = \"front\" }, { group = "
                             "\"back\" }]\n[simulation]\nstop_when_settled = true\nduration = 3\n");
  const Outcome run = tailor.drape("simulate s.toml --out o --frames none --quiet");
  REQUIRE(run.exit_code == 0);
  CHECK(content(tailor.path / "o/run.json").find("has not closed") != std::string::npos);
}

TEST_CASE("a run that ends before its seams close says so", "[sewing]") {
  const Tailor tailor;
  tailor.write("s.toml", tube_cloth + "seams = [{ close = \"0.5 s\" }]\n" + pinned +
                             "[simulation]\nduration = \"50 ms\"\n");
  REQUIRE(tailor.drape("simulate s.toml --out o --frames none --quiet").exit_code == 0);
  CHECK(content(tailor.path / "o/run.json").find("closes at 0.5 s, after the end of the run") !=
        std::string::npos);
}

TEST_CASE("seams make no scene unstable", "[sewing]") {
  const Tailor tailor;
  tailor.write("s.toml", tube_cloth + "seams = [{ close = \"0.1 s\" }]\n" + pinned +
                             "[simulation]\ngravity = [0, 0, 0]\n");  // they are all that gives energy
  const Outcome run =
      tailor.drape("stability s.toml --time 0.2s --shake 0 --integrators implicit-euler --out st --quiet");
  REQUIRE(run.exit_code == 0);
  const auto table = nlohmann::json::parse(content(tailor.path / "st/stability.json"));
  CHECK(table["rows"][0]["limited"] == false);
}

TEST_CASE("mistakes in a garment say where they are", "[sewing]") {
  const Tailor tailor;
  const std::vector<Mistake> mistakes = {
      {"seams = [{ curves = [\"front.left\"] }]\n", "scene.toml:7:", "expected two names"},
      {"seams = [{ curves = [\"front.left\", \"back.lift\"] }]\n", "scene.toml:7:", "did you mean"},
      {"seams = [{ curves = [\"front.left\", \"back.top\"] }]\n", "scene.toml:7:", "9 and 11 vertices"},
      {"seams = [{ direction = \"same\" }]\n", "scene.toml:7:", "expected curves"},
      {"seams = [{ close = \"3 m\" }]\n", "scene.toml:7:", "close"},
      {"seams = [{ then = \"glue\" }]\n", "scene.toml:7:", "merge"},
      {"seams = [{ stiffness = -1 }]\n", "scene.toml:7:", "stiffness"},
      {"seams = [{ curves = [\"front.top\", \"front.top\"] }]\n", "scene.toml:7:", "to itself"},
      {"seams = [{}, { curves = [\"back.right\", \"front.left\"] }]\n", "scene.toml:7:", "sewn twice"},
      {"seams = [{}]\nmodel = \"choi-ko\"\n", "scene.toml:8:", "noh-jung"},
  };
  check_mistakes(mistakes, [&](const std::string& text) { return tailor.simulation(text); });
  const auto with_cloth = [&](const std::string& keys, const std::string& obj) {
    tailor.write("other.obj", obj);
    return [&, keys] {
      return make_simulation(read_scene(parse_toml("[[cloth]]\nmesh = \"other.obj\"\n" + keys, "scene.toml"),
                                        {}, tailor.path, "scene.toml"));
    };
  };
  const std::string lines = tailor.panels.obj();
  CHECK_THROWS_WITH(with_cloth("panels = [{ group = \"front.left\" }]\n", lines)(),
                    Contains("a line of the mesh"));
  CHECK_THAT(with_cloth("panels = [{ group = \"front\", wrap = 0.05 }]\n", lines)().messages.front(),
             Contains("more than once round"));
  CHECK_THAT(with_cloth("rest = \"uv\"\nuv_scale = 3\n", lines)().messages.front(),
             Contains("another uv_scale") && Contains("with 1 m"));
  const std::string plain = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  CHECK_THROWS_WITH(with_cloth("rest = \"uv\"\n", plain)(), Contains("no texture coordinates"));
  CHECK_THROWS_WITH(with_cloth("rest = \"uv\"\n", "vt 0 0\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1/1 2/1 3/1\n")(),
                    Contains("face 1") && Contains("no area"));
  CHECK_THROWS_WITH(with_cloth("uv_scale = 2\n", plain)(), Contains("uv_scale"));
  CHECK_THROWS_WITH(with_cloth("seams = [{}]\n", plain)(), Contains("declares none"));
  CHECK_THROWS_WITH(with_cloth("seams = [{ curves = [\"a\", \"b\"] }]\n", plain)(),
                    Contains("it has no lines"));
  CHECK_THROWS_WITH(with_cloth("panels = [{ group = \"front\" }]\n", plain)(), Contains("no such group"));
  CHECK_THROWS_WITH(with_cloth("panels = [{ group = \"a\" }, { group = \"b\" }]\n",
                               "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\ng a\nf 1 2 3\ng b\nf 2 4 3\n")(),
                    Contains("vertex 1") && Contains("'a', too"));
}

TEST_CASE("what is gathered is said", "[sewing]") {
  TwoPanels narrow{.back_width = 0.5};
  std::string text = narrow.obj();
  // The back's sides are half as long again: the file says so in uv only.
  const Tailor tailor(narrow);
  const auto about_seams = [&] {
    Names lines = tailor.simulation("seams = [{ close = 1 }]\n").messages;
    std::erase_if(lines, [](const std::string& line) { return line.find("seam") == line.npos; });
    return lines;
  };
  CHECK(about_seams().empty());
  TwoPanels tall = narrow;
  tall.height = 0.6;
  std::string other = tall.obj();
  const std::size_t back = static_cast<std::size_t>(narrow.nx * narrow.ny);
  std::string mixed;
  std::istringstream one(text), two(other);
  std::string a, b;
  for (std::size_t v = 0; std::getline(one, a) && std::getline(two, b);) {
    const bool point = a.starts_with("v ") || a.starts_with("vt ");
    mixed += (point && v / 2 >= back ? b : a) + "\n";
    v += point;
  }
  tailor.write("tube.obj", mixed);
  const Names gathered = about_seams();
  REQUIRE(gathered.size() == 2);
  CHECK_THAT(gathered[0], Contains("front.left / back.right") && Contains("gathered by 50 %"));
}
