#include "app/pattern/pattern_read.h"

#include "app/base/text_file.h"
#include "mesh/base/errors.h"

namespace drape::app {

Pattern read_pattern(const std::filesystem::path& path, Names& notes) {
  const std::string text = read_text(path, "SVG or TOML");
  const std::size_t first = text.find_first_not_of(" \t\r\n\xEF\xBB\xBF");
  const std::string extension = lower_extension(path);
  const bool known = extension == ".svg" || extension == ".toml";
  if (!known && (first == text.npos || text[first] != '<'))
    throw InputError(path.string() +
                     ": a pattern is an SVG drawing (.svg) or a table of panels (.toml); "
                     "other programs for patterns export SVG");
  const bool svg = (first != text.npos && text[first] == '<') || path.extension() == ".svg";
  return svg ? parse_svg_pattern(text, path.string(), notes) : parse_toml_pattern(text, path.string());
}

Seam parse_seam(std::string_view text, const std::string& where) {
  const std::size_t sign = text.find_first_of("=:");
  const bool good = sign != text.npos && sign > 0 && sign + 1 < text.size() &&
                    text.find_first_of("=:", sign + 1) == text.npos;
  if (!good)
    throw InputError(where + ": '" + std::string(text) +
                     "' is not a seam; expected PANEL.SIDE=PANEL.SIDE, or with ':' for the same way");
  return {std::string(text.substr(0, sign)), std::string(text.substr(sign + 1)), text[sign] == ':', where};
}

void finish_loop(Chain& chain, bool close) {
  std::vector<Segment>& segments = chain.segments;
  if (segments.empty()) return;
  Segment& last = segments.back();
  const Vec2 start = segments.front().start;
  double size = 0;
  for (const Segment& s : segments) size = std::max(size, (s.start - start).norm());
  size = std::max(size, (last.end - start).norm());
  if ((last.end - start).norm() <= 1e-6 * size) {
    last.end = start;
    if (last.kind == Segment::Kind::line && last.start == start) segments.pop_back();
  } else if (close) {
    segments.push_back(line_segment(last.end, start));
  }
}

void name_segments(Chain& chain, const Names& given, bool loop) {
  chain.names.assign(chain.segments.size(), "");
  if (given.empty()) return;
  if (given.size() != chain.segments.size())
    throw InputError(chain.where + ": " + counted(static_cast<long>(given.size()), "side name") + " for " +
                     counted(static_cast<long>(chain.segments.size()), "segment") +
                     (loop ? " (with the one that closes the outline)" : "") +
                     "; give one for each, '-' for none");
  for (std::size_t i = 0; i < given.size(); ++i) {
    if (given[i].empty() || given[i].find_first_of(" \t\r\n=:#\"") != std::string::npos)
      throw InputError(chain.where + ": the side name '" + given[i] + "' must be one word without = : #");
    if (given[i] != "-") chain.names[i] = given[i];
  }
}

}  // namespace drape::app
