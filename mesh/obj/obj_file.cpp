// Reads a whole OBJ file from the disk into memory: the parser needs one piece of text.
#include <cerrno>
#include <cstdio>
#include <system_error>

#include "mesh/obj/obj.h"

namespace drape {
namespace {

std::string read_text(const std::filesystem::path& path) {
  const std::string name = path.string();
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) throw InputError(name + ": no such file");
  if (std::filesystem::is_directory(status))
    throw InputError(name + ": is a directory; name an OBJ file in it");
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(name.c_str(), "rb"), &std::fclose);
  if (!file) throw InputError(name + ": cannot be opened: " + std::generic_category().message(errno));
  std::string text;
  if (std::filesystem::is_regular_file(status)) text.resize(std::filesystem::file_size(path, error) + 1);
  std::size_t length = 0;
  while (true) {
    if (length == text.size()) text.resize(text.size() + text.size() / 2 + 65536);
    const std::size_t got = std::fread(text.data() + length, 1, text.size() - length, file.get());
    if (got == 0) break;
    length += got;
  }
  if (std::ferror(file.get())) throw InputError(name + ": cannot be read to its end");
  text.resize(length);
  return text;
}

}  // namespace

TriangleMesh read_obj(const std::filesystem::path& path, ObjNeed need) {
  return parse_obj(read_text(path), path.string(), need);
}

}  // namespace drape
