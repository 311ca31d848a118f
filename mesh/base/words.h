// Helpers for messages: lists of names, the nearest known name, counts, numbers as text.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace drape {

using Names = std::vector<std::string>;

std::string listed(const Names& names);  // "a, b, c"; "(none)"

// The known name with the fewest changed letters if it is near enough to be a slip of the pen, else an empty
// text.
std::string nearest(std::string_view word, const Names& known);

// A hint in one line: "did you mean 'bend'? known are: ...".
std::string suggestion(std::string_view word, const Names& known);

std::string counted(long count, std::string_view noun);  // "1 vertex", "3 vertices", "2 cloths"

std::string shortest(double value);             // as few digits as give the same number again
std::string rounded(double value, int digits);  // %.{digits}g, but with all digits of numbers below 10000
std::string one_line(std::string text);         // line ends and other control characters become blanks

}  // namespace drape
