// Scenes in one header: #include <drape/app.h>, after find_package(drape COMPONENTS app) and with drape::app
// linked.
//   drape::app::Simulation simulation = drape::app::make_simulation(drape::app::read_scene("scene.toml",
//   {}));
//   drape::app::run(drape::app::read_scene("scene.toml", {}), {.out = "out"});         what `drape simulate` does
// Fabrics are looked for by their name in the data folder: app/scene/fabrics.h says which one that is.
#pragma once

#include "app/pattern/pattern_read.h"
#include "app/run/run.h"
#include "app/scene/fabrics.h"
#include "app/scene/scene.h"
#include "app/simulation/simulation.h"
#include "solver/system/measure.h"
