// Where the program runs as people run it, and what it leaves there.
#pragma once

#include <algorithm>
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "mesh/obj/obj.h"
#include "mesh/triangles/generate.h"
#include "tests/folder.h"

namespace drape::test {

using Json = nlohmann::json;

// A folder with a sheet of 13 x 13 vertices over a ball, in which the program runs.
struct Workshop : Folder {
  Workshop() {
    TriangleMesh sheet = grid(13, 13, 1, 1);
    for (Vec3& x : sheet.positions) x[1] = 0.35;
    write_obj(path / "sheet.obj", sheet, sheet.positions);
    const TriangleMesh ball = sphere(2, 0.3);
    write_obj(path / "ball.obj", ball, ball.positions);
    write("s.toml", cloth + "[simulation]\nduration = 0.3\n[[obstacle]]\nshape = \"sphere\"\nradius = 0.3\n");
    write("hung.toml", cloth + "pins = [{ vertices = [0, 12] }]\n[simulation]\nduration = 0.3\n");
  }
  Json json(const std::string& name) const { return Json::parse(content(path / name)); }

  const std::string cloth = "[[cloth]]\nmesh = \"sheet.obj\"\nfabric = \"cotton-poplin\"\n";  // three lines
};

inline long lines_of(const std::string& text) { return std::count(text.begin(), text.end(), '\n'); }

inline const std::set<std::string> without_bodies = {"fields", "run.json", "sheet.obj", "sheet.pc2",
                                                     "steps.csv"};
inline const std::set<std::string> usual_files = {"bodies",    "fields",    "run.json",
                                                  "sheet.obj", "sheet.pc2", "steps.csv"};

}  // namespace drape::test
