// Exports all cloths and bodies as glTF 2.0 in one binary file; y is up, in metres and seconds.
//   [Khronos, glTF 2.0]
//   A shape that deforms has the positions of the first frame, a morph target (shape key) for each further
//   frame, and an animation of their weights. The animation is linear: between two frames every vertex goes
//   straight. A body that moves as a whole has a node that moves and turns. There are triangles, normals, uv.
//   Vertices have the order of the mesh. A vertex whose faces have different uv, or that lies on a hard edge
//   of a body, is doubled; the copies come after all the others.
#pragma once

#include "app/export/files.h"
#include "app/export/source.h"

namespace drape::app {

Names gltf_files(const ExportSource& source);  // NAME.glb
void write_gltf(const ExportSource& source, ExportFiles& files, Names& notes);

}  // namespace drape::app
