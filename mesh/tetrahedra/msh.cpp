// From the parts of a .msh file to a mesh: what tetrahedra have, numbered from 0, and whether they make a
// body.
#include "mesh/tetrahedra/msh.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <optional>
#include <system_error>
#include <utility>

#include "mesh/base/words.h"
#include "mesh/tetrahedra/msh_parts.h"

namespace drape {
namespace {

using internal::MshParts;
using internal::MshWords;

class MshMesh {
 public:
  MshMesh(MshParts parts, const MshWords& words) : parts_(std::move(parts)), words_(words) {}

  TetrahedralMesh make() {
    if (parts_.nodes.empty()) words_.fail_whole("holds no nodes (section $Nodes); export the whole mesh");
    if (parts_.tetrahedra.empty()) no_tetrahedra();
    sort_nodes();
    drop_equal();
    return collect();
  }

 private:
  [[noreturn]] void no_tetrahedra() const;
  void sort_nodes();
  void drop_equal();
  std::optional<std::size_t> at(long long number) const;
  TetrahedralMesh collect() const;
  std::vector<int> number_vertices(TetrahedralMesh& mesh) const;
  void add_groups(const std::vector<int>& vertex, TetrahedralMesh& mesh) const;
  std::string called(std::size_t k) const;
  void check_shapes(const TetrahedralMesh& mesh) const;

  MshParts parts_;
  const MshWords& words_;
  std::vector<std::pair<long long, std::size_t>>
      index_;  // number of a node and where it is in parts_; sorted
};

void MshMesh::no_tetrahedra() const {
  std::string found;
  for (const auto& [name, count] : parts_.passed_over)
    found += (found.empty() ? "" : ", ") + counted(count, name);
  words_.fail_whole("holds no tetrahedra" + (found.empty() ? "" : ", only " + found) +
                    "; mesh the volume (gmsh FILE -3)");
}

void MshMesh::sort_nodes() {
  for (std::size_t k = 0; k < parts_.nodes.size(); ++k) index_.emplace_back(parts_.nodes[k].number, k);
  std::sort(index_.begin(), index_.end());
  for (std::size_t k = 1; k < index_.size(); ++k)
    if (index_[k].first == index_[k - 1].first)
      words_.fail_whole("node " + std::to_string(index_[k].first) +
                        " is there twice; give every node a number of its own");
}

// Version 2 writes an element once for each of its physical groups.
void MshMesh::drop_equal() {
  std::vector<std::size_t> order(parts_.tetrahedra.size());
  for (std::size_t k = 0; k < order.size(); ++k) order[k] = k;
  const auto nodes = [&](std::size_t k) { return parts_.tetrahedra[k].nodes; };
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return std::pair(nodes(a), a) < std::pair(nodes(b), b); });
  std::vector<char> again(order.size(), 0);
  for (std::size_t k = 1; k < order.size(); ++k) again[order[k]] = nodes(order[k]) == nodes(order[k - 1]);
  std::size_t k = 0;
  std::erase_if(parts_.tetrahedra, [&](const MshParts::Element&) { return again[k++] != 0; });
}

// Where the node of this number is in the file.
std::optional<std::size_t> MshMesh::at(long long number) const {
  const auto found = std::lower_bound(index_.begin(), index_.end(), std::pair(number, std::size_t{0}));
  if (found == index_.end() || found->first != number) return std::nullopt;
  return found->second;
}

// The vertex that each node of the file becomes, or -1 for one that no tetrahedron has.
std::vector<int> MshMesh::number_vertices(TetrahedralMesh& mesh) const {
  std::vector<int> vertex(parts_.nodes.size(), -1);
  for (const MshParts::Element& element : parts_.tetrahedra)
    for (const long long node : element.nodes) {
      const std::optional<std::size_t> found = at(node);
      if (!found)
        words_.fail_at(element.place, "tetrahedron " + std::to_string(element.number) + " refers to node " +
                                          std::to_string(node) + ", which is not among the " +
                                          counted(static_cast<long>(parts_.nodes.size()), "node") +
                                          " of the file");
      vertex[*found] = 0;
    }
  for (std::size_t k = 0; k < vertex.size(); ++k) {
    if (vertex[k] < 0) continue;
    vertex[k] = mesh.vertex_count();
    mesh.positions.push_back(parts_.nodes[k].x);
  }
  return vertex;
}

TetrahedralMesh MshMesh::collect() const {
  TetrahedralMesh mesh;
  const std::vector<int> vertex = number_vertices(mesh);
  for (const MshParts::Element& element : parts_.tetrahedra) {
    Tetrahedron& t = mesh.tetrahedra.emplace_back();
    for (std::size_t k = 0; k < 4; ++k) t[k] = vertex[*at(element.nodes[k])];
  }
  add_groups(vertex, mesh);
  check_shapes(mesh);
  return mesh;
}

void MshMesh::add_groups(const std::vector<int>& vertex, TetrahedralMesh& mesh) const {
  for (const auto& [name, nodes] : parts_.groups) {
    VertexGroup group{name, {}};
    for (const long long node : nodes)
      if (const std::optional<std::size_t> found = at(node); found && vertex[*found] >= 0)
        group.vertices.push_back(vertex[*found]);
    std::sort(group.vertices.begin(), group.vertices.end());
    if (!group.vertices.empty()) mesh.groups.push_back(std::move(group));
  }
}

std::string MshMesh::called(std::size_t k) const {
  const MshParts::Element& element = parts_.tetrahedra[k];
  std::string text = "tetrahedron " + std::to_string(element.number) + " (nodes";
  for (const long long node : element.nodes) text += " " + std::to_string(node);
  return text + ")";
}

void MshMesh::check_shapes(const TetrahedralMesh& mesh) const {
  for (std::size_t k = 0; k < mesh.tetrahedra.size(); ++k) {
    double longest = 0;
    for (const int a : mesh.tetrahedra[k])
      for (const int b : mesh.tetrahedra[k])
        longest = std::max(longest, (mesh.positions[a] - mesh.positions[b]).norm());
    const double volume = volume_of(mesh, mesh.tetrahedra[k]);
    if (std::abs(volume) <= 1e-10 * longest * longest * longest)
      words_.fail_at(parts_.tetrahedra[k].place, called(k) + " is flat; mesh the body anew or leave it out");
    if (volume < 0)
      words_.fail_at(parts_.tetrahedra[k].place, called(k) + " is inverted, its volume is " +
                                                     rounded(volume, 3) + " m^3; swap two of its nodes");
  }
  const auto [one, other] = overlapping(mesh);
  if (one >= 0)
    words_.fail_at(parts_.tetrahedra[other].place, called(other) + " lies on the same side of a face as " +
                                                       called(one) + "; leave one of them out");
}

}  // namespace

TetrahedralMesh parse_msh(std::string_view text, const std::string& name) {
  MshWords words(text, name);
  MshParts parts = internal::read_parts(words);
  return MshMesh(std::move(parts), words).make();
}

TetrahedralMesh read_msh(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::exists(path, error)) throw InputError(path.string() + ": no such file");
  if (std::filesystem::is_directory(path, error))
    throw InputError(path.string() + ": is a directory; name a .msh file in it");
  std::ifstream file(path, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  if (!file) throw InputError(path.string() + ": cannot be read");
  return parse_msh(text, path.string());
}

}  // namespace drape
