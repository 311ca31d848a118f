#include "app/scene/sewing_read.h"

#include "app/scene/obstacle_read.h"
#include "mesh/base/errors.h"

namespace drape::app {

std::vector<PanelEntry> read_panels(Table& cloth) {
  std::vector<PanelEntry> panels;
  for (Table& table : cloth.tables("panels", "where groups of the mesh start")) {
    PanelEntry panel;
    panel.where = table.where();
    table.read_required("group", panel.group,
                        "a group of the mesh; the middle of its box is brought to the origin");
    table.read("wrap", panel.wrap, dimension::length, Range::positive,
               "then the plane z = 0 is wrapped round the y axis with this radius, its middle in front (+z)");
    if (table.has("scale")) table.fail("scale", "belongs to the whole cloth, beside panels");
    panel.placement = read_place(table);
    table.finish();
    for (const PanelEntry& other : panels)
      if (other.group == panel.group) table.fail("group", "this panel is placed twice");
    panels.push_back(panel);
  }
  return panels;
}

std::vector<SeamEntry> read_seams(Table& cloth) {
  std::vector<SeamEntry> seams;
  for (Table& table : cloth.tables("seams", "what is sewn together")) {
    SeamEntry seam;
    seam.where = table.where();
    table.read("curves", seam.curves,
               {"two lines of the mesh, with as many vertices each", "all that the pattern declares"});
    if (table.has("curves") && seam.curves.size() != 2)
      table.fail("curves", "expected two names, such as [\"front.left\", \"back.right\"]");
    std::string direction = "opposite", then = "merge";
    table.read("direction", direction, Names{"opposite", "same"},
               "same: the first vertices of both belong together, else the first and the last; needs curves");
    if (table.has("direction") && seam.curves.empty())
      table.fail("direction",
                 "the seams of the file have their own; expected curves = [\"...\", \"...\"], too");
    seam.same_direction = direction == "same";
    table.read("close", seam.close, dimension::time, Range::not_negative, "the time that it takes");
    table.read("stiffness", seam.stiffness, dimension::spring, Range::positive,
               {"of a stitch; of one that is kept a thousand times that", "the cloth's k_s"});
    table.read(
        "then", then, Names{"merge", "keep"},
        "merge: once closed the two particles of a stitch become one, and the cloth bends across the seam; "
        "keep: stitches for good");
    seam.merge = then == "merge";
    table.finish();
    seams.push_back(seam);
  }
  return seams;
}

}  // namespace drape::app
