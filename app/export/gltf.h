// glTF 2.0 in one binary file: all cloths and bodies, y up, metres, seconds.          [Khronos, glTF 2.0]
//   What deforms: the first frame, a morph target (shape key) for each frame after it, and an animation of
//   their weights, linear: between two frames every vertex goes straight. A body that moves as a whole: its
//   node is moved and turned. Triangles, normals, uv.
//   Vertices are in the mesh's order. One whose faces have different uv, or of a body one at a hard edge, is
//   doubled, after all the others.
#pragma once

#include "app/export/files.h"
#include "app/export/source.h"

namespace drape {

Names gltf_files(const ExportSource& source);  // NAME.glb
void write_gltf(const ExportSource& source, ExportFiles& files, Names& notes);

}  // namespace drape
