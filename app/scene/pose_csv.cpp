#include "app/scene/pose_csv.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "app/base/units.h"
#include "app/base/words.h"
#include "mesh/base/errors.h"

namespace drape::app {
namespace {

constexpr double not_unit = 1e-2;  // of the length of a quaternion: more than the rounding of printed digits

struct Known {
  const char* name;
  const Dimension* dimension;
};
constexpr std::array<Known, 11> known_columns{{{"time", &dimension::time},
                                               {"x", &dimension::length},
                                               {"y", &dimension::length},
                                               {"z", &dimension::length},
                                               {"qw", &dimension::number},
                                               {"qx", &dimension::number},
                                               {"qy", &dimension::number},
                                               {"qz", &dimension::number},
                                               {"rx", &dimension::angle},
                                               {"ry", &dimension::angle},
                                               {"rz", &dimension::angle}}};

Names known_names() {
  Names names;
  for (const Known& known : known_columns) names.emplace_back(known.name);
  return names;
}

struct Column {
  std::string name;
  double unit;    // in SI units
  bool has_unit;  // whether the header names it
};

Column read_column(const std::string& cell) {
  const std::size_t bracket = cell.find('[');
  std::string name = cell.substr(0, bracket), unit;
  name.erase(name.find_last_not_of(' ') + 1);
  if (bracket != cell.npos) {
    if (cell.back() != ']') throw InputError("column '" + cell + "': a unit stands in [ ], as in x [mm]");
    unit = cell.substr(bracket + 1, cell.size() - bracket - 2);
  }
  const auto known = std::find_if(known_columns.begin(), known_columns.end(),
                                  [&](const Known& column) { return name == column.name; });
  if (known == known_columns.end())
    throw InputError("unknown column '" + name + "'; " + suggestion(name, known_names()) +
                     ", separated by commas");
  try {
    return {name, parse_quantity("1 " + unit, *known->dimension), bracket != cell.npos};
  } catch (const InputError& error) {
    throw InputError("column '" + cell + "': " + error.what());
  }
}

double number(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
    throw InputError("expected a finite number");
  return value;
}

class PoseTable {
 public:
  explicit PoseTable(const CsvRow& header) {
    for (const std::string& cell : header.cells) {
      Column column = read_column(cell);
      if (find(column.name) < columns_.size())
        throw InputError("there are two columns '" + column.name + "'");
      columns_.push_back(std::move(column));
    }
    if (!has({"time"}) || !has({"x", "y", "z"}))
      throw InputError(
          "expected a header with the columns time, x, y, z and, where it turns, qw, qx, qy, qz or rx, ry, "
          "rz");
    if (has({"qw", "qx", "qy", "qz"}) && turns_by_vector())
      throw InputError("the rotation is given twice, by qw, qx, qy, qz and by rx, ry, rz; leave one out");
  }

  Keyframe keyframe(const CsvRow& row, const Vec3& rotation_before) const {
    if (row.cells.size() != columns_.size())
      throw InputError("has " + counted(static_cast<long>(row.cells.size()), "cell") + ", the header has " +
                       std::to_string(columns_.size()));
    Keyframe keyframe{at(row, "time"), {at(row, "x"), at(row, "y"), at(row, "z")}};
    if (turns_by_vector()) {
      keyframe.rotation = Vec3(at(row, "rx"), at(row, "ry"), at(row, "rz"));
      check_turn(keyframe.rotation);
    }
    if (find("qw") < columns_.size()) keyframe.rotation = unwrapped(quaternion(row), rotation_before);
    return keyframe;
  }

 private:
  std::size_t find(const std::string& name) const {
    const auto found = std::find_if(columns_.begin(), columns_.end(),
                                    [&](const Column& column) { return column.name == name; });
    return static_cast<std::size_t>(found - columns_.begin());
  }

  // All of them or, else false, none.
  bool has(const Names& names) const {
    const auto count = std::count_if(names.begin(), names.end(),
                                     [&](const std::string& name) { return find(name) < columns_.size(); });
    if (count != 0 && count != static_cast<long>(names.size()))
      throw InputError("of the columns " + listed(names) + " some are missing");
    return count != 0;
  }

  bool turns_by_vector() const { return has({"rx", "ry", "rz"}); }

  // Degrees are what most programs write.
  void check_turn(const Vec3& rotation) const {
    constexpr double turn = 6.2832;  // rad
    if (rotation.norm() <= turn || columns_[find("rx")].has_unit) return;
    throw InputError(
        "rx, ry, rz turn by " + rounded(rotation.norm(), 4) +
        " rad, which is more than a whole turn; name the unit in the header, as in rx [deg] or rx [rad]");
  }

  double at(const CsvRow& row, const std::string& name) const {
    const std::size_t k = find(name);
    try {
      return columns_[k].unit * number(row.cells[k]);
    } catch (const InputError& error) {
      throw InputError(name + " = \"" + one_line(row.cells[k]) + "\": " + error.what());
    }
  }

  Eigen::Quaterniond quaternion(const CsvRow& row) const {
    const Eigen::Quaterniond q(at(row, "qw"), at(row, "qx"), at(row, "qy"), at(row, "qz"));
    if (!(std::abs(q.norm() - 1) < not_unit))
      throw InputError("qw, qx, qy, qz is no rotation: the length of a unit quaternion is 1, not " +
                       rounded(q.norm(), 4));
    return q.normalized();
  }

  std::vector<Column> columns_;
};

}  // namespace

std::vector<Keyframe> poses_of(const std::vector<CsvRow>& rows, const std::string& name) {
  std::vector<Keyframe> poses;
  std::size_t k = 0;
  try {
    if (rows.size() < 2) throw InputError("expected a header line and at least one pose");
    const PoseTable table(rows[0]);
    for (k = 1; k < rows.size(); ++k) {
      poses.push_back(table.keyframe(rows[k], poses.empty() ? Vec3::Zero() : poses.back().rotation));
      if (k > 1) check_order(poses[k - 2], poses[k - 1]);
    }
  } catch (const InputError& error) {
    throw InputError((rows.empty() ? name : rows[k].where) + ": " + error.what());
  }
  return poses;
}

std::vector<Keyframe> read_poses(const std::filesystem::path& path) {
  return poses_of(read_csv(path), path.string());
}

}  // namespace drape::app
