#include "app/scene/load_mesh.h"

#include "mesh/obj/obj.h"

namespace drape::app {

void require_file(const std::filesystem::path& path, const std::string& where) {
  const bool in_a_file = where.find(':') != where.npos;
  if (in_a_file && !std::filesystem::exists(path))
    throw InputError(where + ": mesh: " + path.string() + ": no such file");
}

TriangleMesh load_mesh(const std::filesystem::path& path, const std::string& where,
                       const Placement& placement, MeshReport& report, Names& messages) {
  require_file(path, where);
  TriangleMesh mesh = placed(read_obj(path), placement, path.string());
  report = examine(mesh);
  add_messages(report, path.string(), messages);
  return mesh;
}

TriangleMesh placed(TriangleMesh mesh, const Placement& placement, const std::string& name) {
  for (Vec3& x : mesh.positions) {
    x = placement.rotation * (placement.scale * x) + placement.translate;
    if (!x.allFinite())
      throw InputError(name + ": scale and translate put a vertex out of the range of numbers");
  }
  return mesh;
}

void add_messages(const MeshReport& report, const std::string& name, Names& messages) {
  for (const Defect& defect : report.defects) {
    const std::string line = format(defect);
    const std::size_t colon = line.find(": ") + 2;
    if (defect.severity == Severity::refusal) throw InputError(name + ": " + line.substr(colon));
    const bool says_where = line.compare(colon, name.size() + 1, name + ":") == 0;  // what the reader noted
    messages.push_back(line.substr(0, colon) + (says_where ? "" : name + ": ") + line.substr(colon));
  }
}

}  // namespace drape::app
