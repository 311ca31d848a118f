#include "app/sewing_read.h"

#include "app/obstacle_read.h"
#include "mesh/obj.h"

namespace drape {

std::vector<PanelEntry> read_panels(Table& cloth) {
  std::vector<PanelEntry> panels;
  for (Table& table : cloth.tables("panels")) {
    PanelEntry panel;
    panel.where = table.where();
    table.read_required("group", panel.group);
    table.read("wrap", panel.wrap, dimension::length, Range::positive);
    if (table.has("scale")) table.fail("scale", "belongs to the whole cloth, beside panels");
    panel.placement = read_placement(table);
    table.finish();
    for (const PanelEntry& other : panels)
      if (other.group == panel.group) table.fail("group", "this panel is placed twice");
    panels.push_back(panel);
  }
  return panels;
}

std::vector<SeamEntry> read_seams(Table& cloth) {
  std::vector<SeamEntry> seams;
  for (Table& table : cloth.tables("seams")) {
    SeamEntry seam;
    seam.where = table.where();
    table.read("curves", seam.curves);
    if (table.has("curves") && seam.curves.size() != 2)
      table.fail("curves", "expected two names, such as [\"front.left\", \"back.right\"]");
    std::string direction = "opposite", then = "merge";
    table.read("direction", direction, Names{"opposite", "same"});
    if (table.has("direction") && seam.curves.empty())
      table.fail("direction",
                 "the seams of the file have their own; expected curves = [\"...\", \"...\"], too");
    seam.same_direction = direction == "same";
    table.read("close", seam.close, dimension::time, Range::not_negative);
    table.read("stiffness", seam.stiffness, dimension::spring, Range::positive);
    table.read("then", then, Names{"merge", "keep"});
    seam.merge = then == "merge";
    table.finish();
    seams.push_back(seam);
  }
  return seams;
}

}  // namespace drape
