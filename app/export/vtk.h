// Exports VTK's XML polygons for ParaView: a .vtp file for each frame, and a .pvd file that gives each its
// time.
//   Numbers are float32 and int32, little endian, raw after the XML ("appended"). No XML library can write
//   that, since it is not XML; names are escaped here.
//   Point data of cloths: velocity [m/s], strain (0.01 = 1 %), contact (0 free, 1 slides, 2 sticks, 3 on
//   cloth, 4 stopped).
#pragma once

#include "app/export/faces.h"
#include "app/export/files.h"
#include "app/export/source.h"

namespace drape::app {

struct VtpData {
  std::vector<Vec3> positions;   // m
  std::vector<Vec3> velocities;  // for each vertex; may be empty, and so may the others below
  std::vector<double> strains;
  std::vector<Touch> touches;
  std::vector<Uv> uv;
};
std::string vtp_bytes(const VtpData& data, const Faces& faces, double time);

// The names NAME_0001.vtp and so on, NAME.vtp for a shape that does not move, and one .pvd.
Names vtk_files(const ExportSource& source);
void write_vtk(const ExportSource& source, ExportFiles& files, Names& notes);

}  // namespace drape::app
