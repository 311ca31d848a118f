// Reads sewing patterns from files: SVG drawings and TOML. docs/patterns.md says what may stand in them.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "app/base/key_notes.h"
#include "app/base/words.h"
#include "mesh/pattern/pattern.h"

namespace drape::app {

// A file is read as a drawing when its text begins with '<' or its name ends in ".svg", else as TOML. `notes`
// receives what was ignored. Throws InputError.
Pattern read_pattern(const std::filesystem::path& path, Names& notes);

Pattern parse_svg_pattern(std::string_view text, const std::string& name, Names& notes);
// key_notes: receives what is said of the keys; may be null.
Pattern parse_toml_pattern(std::string_view text, const std::string& name, KeyNotes* key_notes = nullptr);

// A seam as "front.left=back.right", or "front.left:back.right" for curves that run the same way.
Seam parse_seam(std::string_view text, const std::string& where);

// finish_loop joins the two ends of a loop when they differ by rounding only; if they do not meet and
// `close` is set, it adds a straight line. name_segments gives the segments their names; `given` may be
// empty. Throws InputError.
void finish_loop(Chain& chain, bool close);
void name_segments(Chain& chain, const Names& given, bool loop);

}  // namespace drape::app
