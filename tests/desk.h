// Where `drape compare` runs, and what it said and wrote at last.
#pragma once

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "tests/folder.h"

namespace drape::test {

using JsonValue = nlohmann::json;

inline const std::string scenes = DRAPE_SOURCE_DIR "/data/scenes/";
inline const std::string on_ball = scenes + "sheet-on-ball.toml";

inline long count(const std::string& text, const std::string& what) {
  long found = 0;
  for (std::size_t at = text.find(what); at != text.npos; at = text.find(what, at + what.size())) ++found;
  return found;
}

struct Desk : Folder {
  int run(const std::string& words, const std::string& before = "") {
    return said(drape("compare " + words, before));
  }
  int said(Outcome outcome) {
    out = std::move(outcome.out);
    err = std::move(outcome.err);
    return outcome.exit_code;
  }
  JsonValue json() const { return JsonValue::parse(content(path / "o/compare.json")); }

  std::string out, err;
};

}  // namespace drape::test
