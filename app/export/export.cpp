#include "app/export/export.h"

#include "mesh/obj.h"

namespace drape {

Names export_formats() { return {"mdd", "obj", "ply", "vtk", "gltf", "usda", "csv"}; }

int export_folder(const ExportWords& words) {
  throw InputError(words.folder + ": exports are not in this build");
}

}  // namespace drape
