// What is taken for granted of a compiler, and was not so: GCC 12.2 made constants other than they are
// written.
#include <catch2/catch.hpp>
#include <vector>

namespace {

template <class T, std::size_t n>
void check_constants(const std::vector<T>& made, const volatile T (&written)[n]) {
  REQUIRE(made.size() == n);
  for (std::size_t k = 0; k < n; ++k) {
    const T expected = written[k];
    INFO("number " << k << " of " << n);
    CHECK(made[k] == expected);
  }
}

}  // namespace

TEST_CASE("vectors of constants hold what is written", "[units]") {
#define DRAPE_CHECK_CONSTANTS(T, ...)           \
  {                                             \
    const volatile T written[] = {__VA_ARGS__}; \
    const std::vector<T> made = {__VA_ARGS__};  \
    check_constants<T>(made, written);          \
  }
  DRAPE_CHECK_CONSTANTS(double, 1, 0)
  DRAPE_CHECK_CONSTANTS(double, 1, 1, 0)
  DRAPE_CHECK_CONSTANTS(double, 1, 1, 0, 0)
  DRAPE_CHECK_CONSTANTS(double, 1, 1, 1, 0)
  DRAPE_CHECK_CONSTANTS(double, 2, 2, 2, 0, 0, 0, 0, 0)
  DRAPE_CHECK_CONSTANTS(double, 0, 1, 1, 1)
  DRAPE_CHECK_CONSTANTS(float, 1, 1, 1, 0)
  DRAPE_CHECK_CONSTANTS(float, 1, 1, 1, 1, 1, 1, 0, 0)
  DRAPE_CHECK_CONSTANTS(int, 1, 1, 1, 0)
  DRAPE_CHECK_CONSTANTS(int, 1, 1, 1, 1, 0, 0, 0, 0)
  DRAPE_CHECK_CONSTANTS(int, 1, 1, 1, 1, 1, 1, 0, 0)
#undef DRAPE_CHECK_CONSTANTS
}
