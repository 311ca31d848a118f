// Draws a still by casting rays. There is one light with soft shadows, and light from all other directions
// where nothing is in its way (ambient occlusion). There is no noise, and the bits are the same on any number
// of threads.
//   light = colour (key max(0, n . l) (1 - shadow) + sky (1 - occlusion) + fill max(0, n . e))
// Each pixel has four samples. Each sample casts one ray for shadow and one for occlusion, and 8 x 8
// neighbours together cast 64 different ones; the results are averaged over those neighbours that lie on the
// same surface [Segovia et al. 2006, interleaved sampling]. In small pictures each sample casts four rays,
// and 4 x 4 neighbours share. The time is linear in the number of pixels.
#pragma once

#include <optional>

#include "app/picture/camera.h"
#include "app/picture/still.h"

namespace drape::app::drawing {

struct Look {
  std::optional<Scale> scale;  // for the values of the parts
  bool edges = false;          // whether the triangles' edges are drawn, as thin lines
  double size = 1;             // m, of the scene: how far the ground is seen and occlusion reaches
  Vec3 middle = Vec3::Zero();  // m, of the scene
};

// Draws into the part `box` of the image, which covers whole pixels.
void render(const Still& still, const Camera& camera, const Look& look, Image& image, const PixelBox& box);

}  // namespace drape::app::drawing
