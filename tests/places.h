// Where the tests find the sources, the data shared beside them, and the program.
#pragma once

#include <string>

namespace drape::test {

std::string source_dir();
std::string shared_dir();  // may not be there
std::string program();
std::string program_without_options();

}  // namespace drape::test
