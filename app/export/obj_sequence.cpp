#include "app/export/obj_sequence.h"

#include "app/export/sequence.h"
#include "mesh/obj/obj.h"

namespace drape::app {

Names obj_files(const ExportSource& source) { return sequence_files(source, ".obj"); }

void write_obj_sequence(const ExportSource& source, ExportFiles& files, Names&) {
  write_sequence(source, ".obj", files, [&](std::size_t s, std::size_t k) {
    return format_obj(source.shape(s).mesh, source.positions(s, k));
  });
}

}  // namespace drape::app
