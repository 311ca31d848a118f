// A file that appears only when it is complete: written beside its name, then renamed.
#pragma once

#include <cstdio>
#include <filesystem>
#include <string_view>

namespace drape {

// Writing throws InputError "out/sheet.pc2: cannot write: No space left on device; ...". The destructor
// removes what was not kept.
class AtomicFile {
 public:
  explicit AtomicFile(std::filesystem::path path);
  ~AtomicFile();
  AtomicFile(AtomicFile&& other) noexcept;
  AtomicFile& operator=(AtomicFile&&) = delete;

  void write(const void* bytes, std::size_t count);
  void write(std::string_view text) { write(text.data(), text.size()); }
  void seek(long position);  // from the start
  void close();              // all bytes have left this program; throws when they have not
  void keep();               // closes and renames

  const std::filesystem::path& path() const { return path_; }

 private:
  [[noreturn]] void fail(int error) const;

  std::filesystem::path path_, beside_;
  std::FILE* file_ = nullptr;
  bool kept_ = false;
};

}  // namespace drape
