// Draws a still by casting rays: one light with soft shadows, light from everywhere else where nothing is in
// its way (ambient occlusion), no noise, the same bits on any number of threads.
//   light = colour (key max(0, n . l) (1 - shadow) + sky (1 - occlusion) + fill max(0, n . e))
// Four samples a pixel. Each asks one ray for shadow and one for occlusion, and 8 x 8 neighbours together 64
// different ones; what they learn is averaged over those of them that lie on the same surface [Segovia et al.
// 2006, interleaved sampling]. In small pictures each asks four, and 4 x 4 share. Time: linear in the pixels.
#pragma once

#include <optional>

#include "app/picture/camera.h"
#include "app/picture/still.h"

namespace drape::drawing {

struct Look {
  std::optional<Scale> scale;  // of the parts' values
  bool edges = false;          // of the triangles, as thin lines
  double size = 1;             // m, of the scene: how far the ground is seen and occlusion reaches
  Vec3 middle = Vec3::Zero();  // m, of the scene
};

// Into the part `box` of the image, whole pixels.
void render(const Still& still, const Camera& camera, const Look& look, Image& image, const PixelBox& box);

}  // namespace drape::drawing
