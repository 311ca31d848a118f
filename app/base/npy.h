// Arrays in NumPy's file format, which numpy.load reads, also with mmap_mode.       [NEP 1, version 1.0]
//   "\x93NUMPY", 1, 0, uint16 length, {'descr': '<f4', 'fortran_order': False, 'shape': (frames, n, 3), }
//   blanks and a line end up to 128 bytes, then the numbers in C order, little endian.
// The numbers are float32 ('<f4'), int32 ('<i4') or bytes ('|u1'). The first axis counts frames (of triangles
// it counts triangles); they are written and read one at a time.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <vector>

#include "app/base/atomic_file.h"

namespace drape::app {

class NpyWriter {
 public:
  enum class Kind { float32, int32, byte };
  // frame_shape is the shape of one frame: {n} or {n, 3}.
  NpyWriter(std::filesystem::path path, Kind kind, std::vector<int> frame_shape);

  void add(const std::vector<float>& frame);
  void add(const std::vector<std::int32_t>& frame);
  void add(const std::vector<std::uint8_t>& frame);
  // Writes the number of frames into the header. All frames become as long along their first axis as the
  // last: what was not there yet has the numbers of its original (app/base/padded_frames.h).
  void close(const std::vector<int>& copy_of = {});
  void keep() { file_.keep(); }

 private:
  void write_header();
  int width() const;  // numbers in each place along the first axis
  template <class Numbers>
  void add_words(const Numbers& frame);

  AtomicFile file_;
  Kind kind_;
  std::vector<int> frame_shape_;
  std::vector<int> lengths_;  // of the frames, along their first axis
  std::vector<unsigned char> bytes_;
};

// Throws InputError when the file is not such an array, or was cut short.
class NpyReader {
 public:
  explicit NpyReader(const std::filesystem::path& path);

  int frames() const { return frames_; }
  const std::vector<int>& frame_shape() const { return frame_shape_; }
  // The numbers of frame k, from 0; bytes and whole numbers come as numbers too (whole ones are exact up to
  // 2^24).
  std::vector<float> frame(int k);

 private:
  [[noreturn]] void fail(const std::string& what) const;

  std::filesystem::path path_;
  std::ifstream file_;
  NpyWriter::Kind kind_ = NpyWriter::Kind::float32;
  int frames_ = 0;
  std::vector<int> frame_shape_;
  // How many numbers a frame has; how many bytes stand before the first one.
  std::size_t count_ = 1, start_ = 0;
};

}  // namespace drape::app
