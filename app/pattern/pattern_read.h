// Sewing patterns from files: SVG drawings and TOML. What may stand in them: docs/patterns.md.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "app/base/key_notes.h"
#include "app/base/words.h"
#include "mesh/pattern/pattern.h"

namespace drape {

// By what is in the file, not by its name: a text that begins with '<' is a drawing. `notes`: what was passed
// over. Throws InputError.
Pattern read_pattern(const std::filesystem::path& path, Names& notes);

Pattern parse_svg_pattern(std::string_view text, const std::string& name, Names& notes);
// key_notes: where to note what is said of the keys.
Pattern parse_toml_pattern(std::string_view text, const std::string& name, KeyNotes* key_notes = nullptr);

// A seam as "front.left=back.right", or "front.left:back.right" for curves that run the same way.
Seam parse_seam(std::string_view text, const std::string& where);

// Joins the ends of a loop that are closer than rounding, closes it with a straight line if asked, and gives
// its segments the names; `given` may be empty.
void finish_loop(Chain& chain, bool close);
void name_segments(Chain& chain, const Names& given, bool loop);

}  // namespace drape
