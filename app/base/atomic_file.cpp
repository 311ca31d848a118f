#include "app/base/atomic_file.h"

#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

#include "mesh/base/errors.h"

namespace drape::app {

AtomicFile::AtomicFile(std::filesystem::path path) : path_(std::move(path)) {
  beside_ = path_;
  beside_.replace_filename("." + path_.filename().string() + "." + std::to_string(getpid()) + ".part");
  errno = 0;
  if (std::filesystem::is_directory(path_)) fail(EISDIR);
  file_ = std::fopen(beside_.c_str(), "w+b");
  if (!file_) fail(errno);
}

AtomicFile::AtomicFile(AtomicFile&& other) noexcept
    : path_(std::move(other.path_)),
      beside_(std::move(other.beside_)),
      file_(std::exchange(other.file_, nullptr)),
      kept_(std::exchange(other.kept_, true)) {}

AtomicFile::~AtomicFile() {
  if (file_) std::fclose(file_);
  std::error_code ignored;
  if (!kept_) std::filesystem::remove(beside_, ignored);
}

void AtomicFile::fail(int error) const {
  throw InputError(path_.string() +
                   ": cannot write: " + std::generic_category().message(error ? error : EIO) +
                   "; nothing incomplete is left under this name");
}

void AtomicFile::write(const void* bytes, std::size_t count) {
  errno = 0;
  if (std::fwrite(bytes, 1, count, file_) != count) fail(errno);
}

void AtomicFile::read(void* bytes, std::size_t count) {
  errno = 0;
  if (std::fread(bytes, 1, count, file_) != count) fail(errno);
}

void AtomicFile::seek(long position) {
  errno = 0;
  if (std::fseek(file_, position, SEEK_SET) != 0) fail(errno);
}

void AtomicFile::close() {
  if (!file_) return;
  errno = 0;
  const bool flushed = std::fflush(file_) == 0;
  const int error = errno;
  const bool closed = std::fclose(std::exchange(file_, nullptr)) == 0;
  if (!flushed || !closed) fail(flushed ? errno : error);
}

void AtomicFile::keep() {
  close();
  std::error_code error;
  std::filesystem::rename(beside_, path_, error);
  if (error) fail(error.value());
  kept_ = true;
}

}  // namespace drape::app
