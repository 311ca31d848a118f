// A run of every kind of shape, to be exported. Needs places.h's program().
#pragma once

#include <catch2/catch.hpp>
#include <filesystem>
#include <string>
#include <string_view>

#include "app/base/words.h"
#include "tests/folder.h"

namespace drape::test {

using namespace app;

// Quads with uv; the names are as bad as names may be. A ball moves and turns, a box stands, a mesh deforms.
inline constexpr const char* exported_scene = R"(
[simulation]
duration = "0.2 s"
frame_rate = "25 Hz"
[[cloth]]
name = 'a & "b" <c> é'
mesh = "sheet.obj"
fabric = "cotton-poplin"
[[obstacle]]
name = "ball"
shape = "sphere"
radius = 0.2
centre = [0, -0.21, 0]
friction = 0.5
motion = { spin = { axis = [0, 1, 0], rate = "9 rad/s" }, velocity = [0.1, 0, 0] }
[[obstacle]]
name = "box"
shape = "box"
size = [0.1, 0.1, 0.1]
centre = [1, 0, 0]
[[obstacle]]
name = "wall"
shape = "mesh"
mesh = "wall_1.obj"
frames = "wall_%d.obj"
frame_rate = "10 Hz"
)";
inline const std::string exported_cloth = "a & \"b\" <c> é";

struct Exported : Folder {
  Exported() {
    std::string text;
    for (int j = 0; j < 4; ++j)
      for (int i = 0; i < 4; ++i)
        text += "v " + shortest(0.1 * i - 0.15) + " 0 " + shortest(0.1 * j - 0.15) + "\nvt " +
                shortest(i / 3.0) + " " + shortest(j / 3.0) + "\n";
    for (int j = 0; j < 3; ++j)
      for (int i = 0; i < 3; ++i) {
        text += "f";
        for (const int v : {4 * j + i + 1, 4 * j + i + 5, 4 * j + i + 6, 4 * j + i + 2})
          text += " " + std::to_string(v) + "/" + std::to_string(v);
        text += "\n";
      }
    write("sheet.obj", text);
    for (int k = 1; k < 4; ++k)
      write("wall_" + std::to_string(k) + ".obj", "v -2 0 0\nv -2 1 0\nv -2 0 1\nv -3 0 " +
                                                      std::to_string(k) +
                                                      "\nf 1 2 3\nf 1 3 4\nf 1 4 2\nf 2 4 3\n");
    write("scene.toml", exported_scene);
    const Outcome run = drape("simulate scene.toml --out run --quiet");
    INFO(run.err);
    REQUIRE(run.exit_code == 0);
  }
  // Into a folder of the format's name.
  Outcome exported(std::string_view run, std::string_view format, std::string_view words = "",
                   const std::string& before = "") const {
    std::string line("export ");
    for (const std::string_view word : {run, std::string_view(" --to "), format, std::string_view(" -o "),
                                        format, std::string_view(" "), words})
      line += word;
    return drape(line, before);
  }
  std::string file(const std::string& name) const {
    INFO(name);
    REQUIRE(std::filesystem::exists(path / name));
    return content(path / name);
  }
  void refused(const std::string& words, const std::string& message) const {
    INFO(words);
    const Outcome outcome = drape("export " + words);
    CHECK(outcome.exit_code == 2);
    CHECK_THAT(outcome.err, Catch::Contains(message));
    CHECK(outcome.out.empty());
  }
};

}  // namespace drape::test
