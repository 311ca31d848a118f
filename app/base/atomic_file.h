// A file that appears only when it is complete: it is written under another name in the same folder and then
// renamed.
#pragma once

#include <cstdio>
#include <filesystem>
#include <string_view>

namespace drape::app {

// The functions that write or read throw InputError "out/sheet.pc2: cannot write: No space left on device;
// ...". The destructor removes a file that keep() was not called for.
class AtomicFile {
 public:
  explicit AtomicFile(std::filesystem::path path);
  ~AtomicFile();
  AtomicFile(AtomicFile&& other) noexcept;
  AtomicFile& operator=(AtomicFile&&) = delete;

  void write(const void* bytes, std::size_t count);
  void write(std::string_view text) { write(text.data(), text.size()); }
  void read(void* bytes, std::size_t count);  // what was written before
  void seek(long position);                   // bytes from the start; stands between writing and reading
  void close();                               // throws when not all bytes could be handed to the system
  void keep();                                // closes the file and gives it its name

  const std::filesystem::path& path() const { return path_; }

 private:
  [[noreturn]] void fail(int error) const;

  std::filesystem::path path_, beside_;
  std::FILE* file_ = nullptr;
  bool kept_ = false;
};

}  // namespace drape::app
