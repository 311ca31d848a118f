// VTK's XML polygons for ParaView: a .vtp file a frame and a .pvd file that gives each its time.
//   Numbers are float32 and int32, little endian, raw behind the XML ("appended"). That is not XML that a
//   library of XML could write; names are escaped here.
//   Point data of cloths: velocity [m/s], strain (0.01 = 1 %), contact (0 free, 1 slides, 2 sticks).
#pragma once

#include "app/export/faces.h"
#include "app/export/files.h"
#include "app/export/source.h"

namespace drape {

struct VtpData {
  std::vector<Vec3> positions;   // m
  std::vector<Vec3> velocities;  // of each vertex or empty, as all that follow
  std::vector<double> strains;
  std::vector<Touch> touches;
  std::vector<Uv> uv;
};
std::string vtp_bytes(const VtpData& data, const Faces& faces, double time);

// NAME_0001.vtp and on, NAME.vtp of what stands, and one .pvd.
Names vtk_files(const ExportSource& source);
void write_vtk(const ExportSource& source, ExportFiles& files, Names& notes);

}  // namespace drape
