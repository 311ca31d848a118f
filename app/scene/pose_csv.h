// Reads the poses of a body from a CSV file: a header line, then a line for each time.
//   time, x, y, z       [s], [m]; a name may be followed by its unit: "time [ms]", "x [mm]", "rx [deg]"
//   qw, qx, qy, qz      optional: the rotation as a unit quaternion; between two lines it turns the short way
//   rx, ry, rz          or as a rotation vector, axis times angle [rad], which keeps count of whole turns
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/base/csv_file.h"
#include "constraints/motion.h"

namespace drape::app {

// Both throw InputError "poses.csv:12: ...".
std::vector<Keyframe> read_poses(const std::filesystem::path& path);
std::vector<Keyframe> poses_of(const std::vector<CsvRow>& rows, const std::string& name);

}  // namespace drape::app
