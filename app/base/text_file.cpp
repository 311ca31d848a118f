#include "app/base/text_file.h"

#include <fstream>
#include <sstream>

#include "mesh/base/errors.h"

namespace drape::app {

std::string read_text(const std::filesystem::path& path, const std::string& kind) {
  const std::string name = path.string();
  const auto status = std::filesystem::status(path);
  if (!std::filesystem::exists(status)) throw InputError(name + ": no such file");
  if (std::filesystem::is_directory(status))
    throw InputError(name + ": is a directory; a " + kind + " file is expected");
  std::ifstream file(path, std::ios::binary);
  if (!file) throw InputError(name + ": cannot be opened");
  std::ostringstream text;
  text << file.rdbuf();
  if (file.bad()) throw InputError(name + ": cannot be read to its end");
  std::string content = text.str();
  if (content.empty()) throw InputError(name + ": the file is empty");
  if (content.find('\0') != content.npos)
    throw InputError(name + ": is binary; a " + kind + " text is expected");
  return content;
}

std::string lower_extension(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  for (char& c : extension)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return extension;
}

}  // namespace drape::app
