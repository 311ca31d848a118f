// Reads bodies of tetrahedra from Gmsh's files (.msh), versions 4.1 and 2.0 to 2.2, text and binary.
//   Taken are the nodes that tetrahedra have, in the order of the file, the tetrahedra of four nodes, and the
//   physical groups that have a name: a group has the nodes of its elements, of any dimension, that
//   tetrahedra have. Points, lines and faces serve for groups only, and equal tetrahedra count once.
//   Coordinates are taken as metres.
// Errors are InputError in one line, "FILE:LINE: what was found, what to do", or in a binary file "FILE: byte
// N: ...". Refused are files that are cut short or of another version or byte order, elements of other shapes
// or orders, nodes that are not there or there twice, coordinates that are not finite, tetrahedra that are
// inverted, flat (|V| <= 1e-10 of the cube of the longest edge) or overlap, and files without a tetrahedron.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "mesh/base/errors.h"
#include "mesh/tetrahedra/tetrahedral_mesh.h"

namespace drape {

TetrahedralMesh read_msh(const std::filesystem::path& path);

// The same from memory; `name` stands in error messages.
TetrahedralMesh parse_msh(std::string_view text, const std::string& name);

}  // namespace drape
