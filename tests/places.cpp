#include "tests/places.h"

namespace drape::test {

// Defined for this file alone: what is compiled elsewhere is the same in every folder.
std::string source_dir() { return DRAPE_SOURCE_DIR; }
std::string shared_dir() { return DRAPE_SHARED_DIR; }
std::string program() { return DRAPE_PROGRAM; }
std::string program_without_options() { return DRAPE_WITHOUT_OPTIONS; }

}  // namespace drape::test
