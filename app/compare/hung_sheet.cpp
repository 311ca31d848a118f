#include "app/compare/hung_sheet.h"

#include <cmath>

#include "mesh/triangles/generate.h"
#include "solver/forces/noh_jung.h"

namespace drape::app {

Scene hung_sheet_scene(const std::vector<Setting>& settings) {
  const std::string where = "the hung sheet";
  Node root = Node::of_table(where), cloth = root;
  cloth.members["name"] = Node::of_text("sheet", where);
  cloth.members["mesh"] = Node::of_text("sheet.obj", where);  // never read
  cloth.members["area_density"] = Node::of_number(0.2, where);
  cloth.members["stretch"] = Node::of_number(2000, where);
  cloth.members["bend"] = Node::of_number(1e-5, where);
  root.members["cloth"] = Node::of_list({cloth}, where);
  return read_scene(root, settings, ".", "hung sheet, 1 m x 1 m");
}

int sheet_side(int vertices) {
  return static_cast<int>(std::lround(std::sqrt(static_cast<double>(vertices))));
}

Simulation make_hung_sheet(const Scene& scene, int side) {
  const ClothEntry& entry = scene.cloths.front();
  Simulation simulation;
  Cloth cloth;
  cloth.name = entry.name;
  cloth.mesh = grid(side, side, 1, 1);
  cloth.end_particle = cloth.mesh.vertex_count();
  cloth.embedding = Embedding::each(0, cloth.mesh.vertex_count());
  for (const StretchConnection& s : noh_jung_connections(cloth.mesh, cloth.mesh, entry.fabric).stretch)
    cloth.edges.push_back({s.i, s.j, s.L});
  simulation.system = std::make_unique<System>(masses(cloth.mesh, entry.fabric));
  simulation.system->add(noh_jung(cloth.mesh, entry.fabric));
  simulation.system->add(Gravity{scene.simulation.gravity});
  simulation.constraints = std::make_unique<Constraints>(scene.simulation.contact);
  simulation.constraints->pin({0, side - 1});
  simulation.state = at_rest(cloth.mesh);
  simulation.cloths.push_back(std::move(cloth));
  return simulation;
}

}  // namespace drape::app
