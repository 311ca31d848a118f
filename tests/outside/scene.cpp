// From a scene to a simulation, a sewn one and its run, by the installed package. Arguments: the scene, its
// state hash after `drape simulate`, a folder for the output. Exit code 0: the same bits came out.
#include <drape/app.h>
#include <drape/drape.h>

#include <cstdio>
#include <string>

int main(int count, char** words) {
  if (count != 4) return 2;
  drape::app::set_data_folder(DRAPE_DATA);
  const drape::app::Scene scene = drape::app::read_scene(words[1], {});
  drape::app::Simulation simulation = drape::app::make_simulation(scene);
  const long steps = static_cast<long>(scene.simulation.duration / scene.simulation.time_step + 0.5);
  for (long step = 1; step <= steps; ++step) {
    if (!simulation.advance(scene.simulation.time_step).done) return 1;
    simulation.state.time = static_cast<double>(step) * scene.simulation.time_step;
  }
  const std::string hash = drape::state_hash(simulation.state);
  std::printf("%s: %d particles, %zu open seams, state %s, expected %s\n", words[1],
              simulation.state.particles(), simulation.cloths[0].seams.size(), hash.c_str(), words[2]);
  if (hash != words[2]) return 1;
  return drape::app::run(scene, {.out = words[3], .frames = drape::app::Frames::none, .quiet = true});
}
