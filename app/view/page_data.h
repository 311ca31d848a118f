// The data of a page of `drape view`: a head in JSON, and the blocks of numbers that the head refers to.
//   head: title, missing, facts [[name, value]], warnings, notes, times [s],
//         shapes [{name, body, vertices, triangles {block, count}, edges {block, count}, positions, speed,
//         strain, contact}], planes [{name, points, normals}] of every frame or of all, steps {columns, rows,
//         block} or null
//   positions, speed, strain and contact are tracks (track.h), or null where they are not known. The script
//   web/src/data.js reads them.
#pragma once

#include "app/base/json.h"
#include "app/recording/recording.h"
#include "app/view/page_blocks.h"

namespace drape::app {

struct PageData {
  Json head;
  PageBlocks blocks;
};

PageData page_data(const Recording& recording);  // throws Interrupted between frames

std::string title_of(const Recording& recording);

// Facts about the run as a table: names and values as text.
Json page_facts(const Recording& recording);

// Numbers from 0 up, each stored as the difference d to the number before it, written as 2 d or -2 d - 1, in
// four planes of bytes, the lowest byte first.
std::string index_bytes(const std::vector<int>& list);

// The sides of the mesh's polygons (of its triangles when it has no document): each side once, as two
// vertices.
std::vector<int> polygon_sides(const TriangleMesh& mesh);

}  // namespace drape::app
