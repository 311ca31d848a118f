#include "app/base/csv_file.h"

#include <csv.h>

#include <algorithm>
#include <new>

#include "app/base/text_file.h"
#include "mesh/base/errors.h"

namespace drape::app {
namespace {

class Parser {
 public:
  Parser() {
    if (csv_init(&parser_, CSV_STRICT | CSV_STRICT_FINI) != 0) throw std::bad_alloc();
  }
  Parser(const Parser&) = delete;
  Parser& operator=(const Parser&) = delete;
  ~Parser() { csv_free(&parser_); }

  // Each line on its own: the library counts no lines, and goes on for as many as
  // a quotation mark stays open.
  CsvRow row(std::string_view line, std::string where) {
    CsvRow row{std::move(where), {}};
    const bool read =
        csv_parse(&parser_, line.data(), line.size(), add, nullptr, &row.cells) == line.size() &&
        csv_fini(&parser_, add, nullptr, &row.cells) == 0;
    if (!read && csv_error(&parser_) == CSV_ENOMEM) throw std::bad_alloc();
    if (!read) throw InputError(row.where + ": a quotation mark is out of place");
    return row;
  }

 private:
  static void add(void* text, std::size_t length, void* cells) {
    static_cast<std::vector<std::string>*>(cells)->emplace_back(static_cast<const char*>(text), length);
  }

  csv_parser parser_{};
};

}  // namespace

std::vector<CsvRow> parse_csv(std::string_view text, const std::string& name) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  Parser parser;
  std::vector<CsvRow> rows;
  for (int number = 1; !text.empty(); ++number) {
    std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(line.size() + 1, text.size()));
    if (line.ends_with('\r')) line.remove_suffix(1);
    const std::size_t first = line.find_first_not_of(" \t");
    if (first == line.npos || line[first] == '#') continue;
    rows.push_back(parser.row(line, name + ":" + std::to_string(number)));
  }
  return rows;
}

std::vector<CsvRow> read_csv(const std::filesystem::path& path) {
  return parse_csv(read_text(path, "CSV"), path.string());
}

}  // namespace drape::app
