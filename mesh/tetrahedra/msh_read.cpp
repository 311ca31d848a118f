// The sections of Gmsh's files; see msh.h.        [Geuzaine & Remacle 2009; Gmsh's reference manual, "MSH file format" and "(Legacy)"]
#include <algorithm>
#include <iterator>
#include <map>
#include <utility>

#include "mesh/tetrahedra/msh_parts.h"

namespace drape::internal {
namespace {

using Physical = std::pair<int, long long>;  // dimension and number of a physical group

struct ElementKind {
  int type, nodes, dimension;
  const char* name;
};
constexpr ElementKind kinds[] = {
    {1, 2, 1, "line"},         {2, 3, 2, "triangle"},      {3, 4, 2, "quadrangle"},
    {4, 4, 3, "tetrahedron"},  {5, 8, 3, "hexahedron"},    {6, 6, 3, "prism"},
    {7, 5, 3, "pyramid"},      {8, 3, 1, "line"},          {9, 6, 2, "triangle"},
    {10, 9, 2, "quadrangle"},  {11, 10, 3, "tetrahedron"}, {12, 27, 3, "hexahedron"},
    {13, 18, 3, "prism"},      {14, 14, 3, "pyramid"},     {15, 1, 0, "point"},
    {16, 8, 2, "quadrangle"},  {17, 20, 3, "hexahedron"},  {18, 15, 3, "prism"},
    {19, 13, 3, "pyramid"},    {20, 9, 2, "triangle"},     {21, 10, 2, "triangle"},
    {23, 15, 2, "triangle"},   {26, 4, 1, "line"},         {27, 5, 1, "line"},
    {28, 6, 1, "line"},        {29, 20, 3, "tetrahedron"}, {30, 35, 3, "tetrahedron"},
    {31, 56, 3, "tetrahedron"}};

class MshReader {
 public:
  explicit MshReader(MshWords& words) : words_(words) {}

  MshParts read();

 private:
  void read_format();
  void read_section(const std::string& section);
  void read_physical_names();
  void read_entities();
  void read_nodes_2();
  void read_nodes_4();
  void read_elements_2();
  void read_elements_4();
  const ElementKind& read_kind();
  void read_nodes_of(const ElementKind& kind, long long element, const std::vector<long long>& physical);
  Vec3 read_place(long long node);

  MshWords& words_;
  bool version_4_ = false;
  MshParts parts_;
  std::map<Physical, std::string> group_names_;
  std::map<std::pair<int, long long>, std::vector<long long>>
      physicals_of_;  // by dimension and number of an entity
};

MshParts MshReader::read() {
  read_format();
  while (!words_.at_end()) {
    const std::string word(words_.word("a section"));
    if (word[0] != '$')
      words_.fail("a section such as $Nodes should stand here, but '" + MshWords::short_of(word) + "' does");
    const std::string section = word.substr(1), end = "$End" + section;
    words_.end_line();
    read_section(section);
    if (words_.word(end) != end)
      words_.fail(end + " should stand here; the counts of the section do not fit what it holds");
  }
  return std::move(parts_);
}

void MshReader::read_format() {
  if (words_.at_end()) words_.fail_whole("the file is empty");
  if (words_.word("$MeshFormat") != "$MeshFormat")
    words_.fail(
        "does not begin with $MeshFormat: this is no mesh of Gmsh, or one of version 1; export it as .msh, "
        "version 4.1 or 2.2");
  const std::string version(words_.word("the version"));
  version_4_ = version == "4.1";
  if (!version_4_ && version != "2" && version != "2.0" && version != "2.1" && version != "2.2")
    words_.fail("version " + MshWords::short_of(version) +
                " of the format; only 4.1 and 2.0 to 2.2 are read (gmsh FILE -save -format msh41)");
  const bool binary = words_.whole("the kind of file") != 0;
  const long long bytes = words_.whole("the size of a number");
  if (binary && bytes != 8) words_.fail("numbers of " + std::to_string(bytes) + " bytes; only 8 are read");
  words_.end_line();
  words_.binary = binary;
  if (binary && words_.integer("the number 1") != 1)
    words_.fail("the bytes of numbers stand in the order of another kind of machine; save the mesh as text");
  if (words_.word("$EndMeshFormat") != "$EndMeshFormat") words_.fail("$EndMeshFormat should stand here");
}

void MshReader::read_section(const std::string& section) {
  if (section == "PhysicalNames") return read_physical_names();
  if (section == "Entities" && version_4_) return read_entities();
  if (section == "Nodes") return version_4_ ? read_nodes_4() : read_nodes_2();
  if (section == "Elements") return version_4_ ? read_elements_4() : read_elements_2();
  if (section == "PartitionedEntities") words_.fail("the mesh is partitioned; save it as one piece");
  words_.skip_to("$End" + section);
}

void MshReader::read_physical_names() {  // words in binary files, too
  for (long long left = words_.whole("the number of names"); left > 0; --left) {
    const auto dimension = static_cast<int>(words_.whole("the dimension of a group"));
    const long long number = words_.whole("the number of a group");
    group_names_[{dimension, number}] = words_.quoted("the name of a group in quotes");
  }
}

// Of an entity only its physical groups are kept.
void MshReader::read_entities() {
  std::array<long long, 4> counts;
  for (long long& count : counts) count = words_.size("the number of entities");
  for (int dimension = 0; dimension < 4; ++dimension) {
    for (long long left = counts[dimension]; left > 0; --left) {
      const long long number = words_.integer("the number of an entity");
      for (int k = 0; k < (dimension == 0 ? 3 : 6); ++k) words_.real("the box of an entity");
      std::vector<long long>& physical = physicals_of_[{dimension, number}];
      for (long long n = words_.size("the number of physical groups"); n > 0; --n)
        physical.push_back(words_.integer("a physical group"));
      if (dimension == 0) continue;
      for (long long n = words_.size("the number of borders"); n > 0; --n) words_.integer("a border");
    }
  }
}

Vec3 MshReader::read_place(long long node) {
  Vec3 x;
  for (int k = 0; k < 3; ++k)
    x[k] = words_.real("coordinate " + std::string(1, "xyz"[k]) + " of node " + std::to_string(node));
  return x;
}

void MshReader::read_nodes_2() {
  const long long count = words_.whole("the number of nodes");
  words_.end_line();
  for (long long k = 0; k < count; ++k) {
    const long long number = words_.integer("the number of a node");
    parts_.nodes.push_back({number, read_place(number)});
  }
}

void MshReader::read_nodes_4() {
  const long long blocks = words_.size("the number of blocks");
  for (const char* what : {"the number of nodes", "the lowest node", "the highest node"}) words_.size(what);
  for (long long block = 0; block < blocks; ++block) {
    const long long dimension = words_.integer("the dimension of a block");
    words_.integer("the entity of a block");
    const bool parametric = words_.integer("whether nodes have parameters") != 0;
    const long long count = words_.size("the number of nodes in a block");
    const std::size_t first = parts_.nodes.size();
    for (long long k = 0; k < count; ++k)
      parts_.nodes.push_back({words_.size("the number of a node"), Vec3::Zero()});
    for (std::size_t k = first; k < parts_.nodes.size(); ++k) {
      parts_.nodes[k].x = read_place(parts_.nodes[k].number);
      for (long long p = 0; parametric && p < dimension; ++p) words_.real("a parameter of a node");
    }
  }
}

const ElementKind& MshReader::read_kind() {
  const long long type = words_.integer("the type of an element");
  const auto same = [&](const ElementKind& kind) { return kind.type == type; };
  const auto kind = std::find_if(std::begin(kinds), std::end(kinds), same);
  if (kind == std::end(kinds))
    words_.fail("element type " + std::to_string(type) +
                " is not known; only tetrahedra of four nodes (type 4) are simulated");
  if (kind->dimension == 3 && kind->type != 4)
    words_.fail("a " + std::string(kind->name) + " of " + std::to_string(kind->nodes) + " nodes (type " +
                std::to_string(type) + "): only tetrahedra of four nodes are simulated" +
                (kind->name == std::string("tetrahedron")
                     ? "; save the mesh in first order (gmsh FILE -order 1 -save)"
                     : "; mesh the body with tetrahedra"));
  return *kind;
}

void MshReader::read_nodes_of(const ElementKind& kind, long long element,
                              const std::vector<long long>& physical) {
  const std::size_t place = words_.place();
  std::vector<long long> nodes;
  for (int k = 0; k < kind.nodes; ++k)
    nodes.push_back(version_4_ ? words_.size("a node of element " + std::to_string(element))
                               : words_.integer("a node of element " + std::to_string(element)));
  if (kind.type == 4)
    parts_.tetrahedra.push_back({element, {nodes[0], nodes[1], nodes[2], nodes[3]}, place});
  else
    ++parts_.passed_over[kind.name];
  for (const long long number : physical)
    if (const auto name = group_names_.find({kind.dimension, number}); name != group_names_.end())
      parts_.groups[name->second].insert(nodes.begin(), nodes.end());
}

void MshReader::read_elements_2() {
  long long left = words_.whole("the number of elements");
  words_.end_line();
  while (left > 0) {
    // A text names type and tags for every element, after its number; a binary file for a block of them,
    // before it.
    long long number = words_.binary ? 0 : words_.integer("the number of an element");
    const ElementKind& kind = read_kind();
    const long long count = words_.binary ? words_.integer("the number of elements in a block") : 1;
    const long long tags = words_.integer("the number of tags");
    for (long long k = 0; k < count; ++k, --left) {
      if (words_.binary) number = words_.integer("the number of an element");
      std::vector<long long> physical;
      for (long long t = 0; t < tags; ++t) {
        const long long tag = words_.integer("a tag of element " + std::to_string(number));
        if (t == 0) physical.push_back(tag);
      }
      read_nodes_of(kind, number, physical);
    }
  }
}

void MshReader::read_elements_4() {
  const long long blocks = words_.size("the number of blocks");
  for (const char* what : {"the number of elements", "the lowest element", "the highest element"})
    words_.size(what);
  for (long long block = 0; block < blocks; ++block) {
    const auto dimension = static_cast<int>(words_.integer("the dimension of a block"));
    const long long entity = words_.integer("the entity of a block");
    const ElementKind& kind = read_kind();
    const std::vector<long long>& physical = physicals_of_[{dimension, entity}];
    for (long long left = words_.size("the number of elements in a block"); left > 0; --left) {
      const long long number = words_.size("the number of an element");
      read_nodes_of(kind, number, physical);
    }
  }
}

}  // namespace

MshParts read_parts(MshWords& words) { return MshReader(words).read(); }

}  // namespace drape::internal
