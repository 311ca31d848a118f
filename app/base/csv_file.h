// Reads a CSV file as rows of cells, each row with its place. The only file that includes the CSV library is
// csv_file.cpp.
//   Cells are separated by commas and may stand in double quotes (RFC 4180), but a row ends with its line.
//   Blanks around a cell, a byte order mark, empty lines and lines that begin with # are ignored.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace drape::app {

struct CsvRow {
  std::string where;  // "poses.csv:12"
  std::vector<std::string> cells;
};

// Both throw InputError "poses.csv:12: ..." when a quotation mark is out of place.
std::vector<CsvRow> read_csv(const std::filesystem::path& path);
std::vector<CsvRow> parse_csv(std::string_view text, const std::string& name);

}  // namespace drape::app
