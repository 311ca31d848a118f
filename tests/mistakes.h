// Texts with a mistake in them: each is refused in one line that begins with
// the place and says what is wrong.
#pragma once

#include <catch2/catch.hpp>
#include <string>

#include "mesh/base/errors.h"

namespace drape::test {

struct Mistake {
  std::string text, place, message;
};

// read(text) is what refuses it.
template <class Mistakes, class Read>
void check_mistakes(const Mistakes& mistakes, const Read& read) {
  for (const Mistake& mistake : mistakes) {
    INFO(mistake.text);
    CHECK_THROWS_AS(read(mistake.text), InputError);
    CHECK_THROWS_WITH(read(mistake.text), Catch::StartsWith(mistake.place) &&
                                              Catch::Contains(mistake.message) && !Catch::Contains("\n"));
  }
}

}  // namespace drape::test
