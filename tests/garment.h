// A tube of cloth that is still two flat panels: what the tests of patterns and seams sew.
#pragma once

#include <algorithm>
#include <string>

#include "app/base/toml_file.h"
#include "app/simulation/simulation.h"
#include "tests/folder.h"

namespace drape::test {

using namespace app;

// Two panels of width x height [m], nx x ny vertices, side by side in the plane z = 0, with the lines
// front.left, front.right, front.top and so on, each going round the outline counter-clockwise.
struct TwoPanels {
  int nx = 11, ny = 9;
  double width = 0.5, height = 0.4, back_width = 0.5;
  bool quads = false;
  bool one_way = false;  // all diagonals of triangles run the same way

  int vertex(int panel, int i, int j) const { return panel * nx * ny + j * nx + i; }

  std::string obj() const {
    std::string text = "# seam front.left back.right\n# seam front.right back.left\n", faces, lines;
    for (int p = 0; p < 2; ++p) {
      const std::string name = p == 0 ? "front" : "back";
      for (int j = 0; j < ny; ++j)
        for (int i = 0; i < nx; ++i) {
          const std::string x = std::to_string(p * 1.0 + (p == 0 ? width : back_width) * i / (nx - 1)),
                            y = std::to_string(height * j / (ny - 1));
          text += "v " + x + " " + y + " 0\nvt " + x + " " + y + "\n";
        }
      faces += "g " + name + "\n";
      for (int j = 0; j + 1 < ny; ++j)
        for (int i = 0; i + 1 < nx; ++i) {
          const int a = vertex(p, i, j), b = a + 1, c = b + nx, d = a + nx;
          if (quads)
            faces += face({a, b, c, d});
          else if (one_way || (i + j) % 2 == 0)
            faces += face({a, b, c}) + face({a, c, d});
          else
            faces += face({a, b, d}) + face({b, c, d});
        }
      lines += "g " + name + ".left\nl";
      for (int j = ny - 1; j >= 0; --j) lines += " " + std::to_string(vertex(p, 0, j) + 1);
      lines += "\ng " + name + ".right\nl";
      for (int j = 0; j < ny; ++j) lines += " " + std::to_string(vertex(p, nx - 1, j) + 1);
      lines += "\ng " + name + ".top\nl";
      for (int i = nx - 1; i >= 0; --i) lines += " " + std::to_string(vertex(p, i, ny - 1) + 1);
      lines += "\n";
    }
    return text + faces + lines;
  }

  static std::string face(const std::vector<int>& vertices) {
    std::string line = "f";
    for (int v : vertices) line += " " + std::to_string(v + 1) + "/" + std::to_string(v + 1);
    return line + "\n";
  }
};

// A cloth of it, wrapped to a tube with two gaps of 4 cm.
inline const std::string tube_cloth =
    "[[cloth]]\nmesh = \"tube.obj\"\nrest = \"uv\"\nfabric = \"cotton-poplin\"\n"
    "panels = [{ group = \"front\", wrap = \"16 cm\", translate = [0, 0, 0.02] },\n"
    "  { group = \"back\", wrap = \"16 cm\", rotate = { axis = [0, 1, 0], angle = \"180 deg\" }, "
    "translate = [0, 0, -0.02] }]\n";

// A folder with the mesh, and what becomes of it.
struct Tailor : Folder {
  TwoPanels panels;
  explicit Tailor(TwoPanels p = {}) : panels(p) { write("tube.obj", panels.obj()); }

  Scene scene(const std::string& more, const std::string& before = "") const {
    return read_scene(parse_toml(tube_cloth + more + before, "scene.toml"), {}, path, "scene.toml");
  }
  Simulation simulation(const std::string& more, const std::string& before = "") const {
    return make_simulation(scene(more, before));
  }
  // The widest gap between the sides that are sewn [m].
  double gap(const Simulation& s) const {
    const std::vector<Vec3> x = s.cloths[0].embedding.positions(s.state.x);
    double widest = 0;
    for (int j = 0; j < panels.ny; ++j)
      for (int p : {0, 1}) {
        const int left = panels.vertex(p, 0, j), right = panels.vertex(1 - p, panels.nx - 1, j);
        widest = std::max(widest, (x[left] - x[right]).norm());
      }
    return widest;
  }
};

inline const std::string pinned = "pins = [{ group = \"front.top\" }]\n";
inline const std::string light = "[simulation]\ntime_step = 0.01\n";

}  // namespace drape::test
