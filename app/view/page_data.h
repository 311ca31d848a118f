// What a page of `drape view` knows of a run: a head as JSON, and the blocks of numbers that it names.
//   head: title, missing, facts [[name, value]], warnings, notes, times [s],
//         shapes [{name, body, vertices, triangles {block, count}, edges {block, count}, positions, speed,
//         strain, contact}], planes [{name, points, normals}] of every frame or of all, steps {columns, rows,
//         block} or null
//   positions, speed, strain and contact are tracks (track.h), null where they are not known; web/src/data.js
//   reads it.
#pragma once

#include "app/base/json.h"
#include "app/recording/recording.h"
#include "app/view/page_blocks.h"

namespace drape {

struct PageData {
  Json head;
  PageBlocks blocks;
};

PageData page_data(const Recording& recording);  // throws Interrupted between frames

std::string title_of(const Recording& recording);

// The run in a table: names and values as text.
Json page_facts(const Recording& recording);

// Numbers from 0 as differences of neighbours, 2 d or -2 d - 1, in four planes of bytes, the lowest first.
std::string index_bytes(const std::vector<int>& list);

// The sides of the mesh's polygons, of its triangles where it has no document; each once, two vertices each.
std::vector<int> polygon_sides(const TriangleMesh& mesh);

}  // namespace drape
