// Point cache for Blender's Mesh Cache modifier, all little endian:
//   char[12] "POINTCACHE2\0", int32 version 1, int32 points, float32 start frame 0, float32 sample rate 1,
//   int32 samples, then for each sample the float32 x y z of every point [m].
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "app/base/atomic_file.h"
#include "mesh/base/vectors.h"

namespace drape {

class Pc2Writer {
 public:
  Pc2Writer(std::filesystem::path path, int points);

  void add(const std::vector<Vec3>& positions);  // a sample [m]
  void close();                                  // writes the number of samples into the header
  void keep() { file_.keep(); }
  AtomicFile take_file() { return std::move(file_); }  // closed, to be kept with others
  const std::filesystem::path& path() const { return file_.path(); }

 private:
  AtomicFile file_;
  int points_, samples_ = 0;
  std::vector<unsigned char> bytes_;
};

// Reads one sample after the other, or any. Throws InputError when the file is no point cache, ends early or
// holds a number that is not finite.
class Pc2Reader {
 public:
  enum class Damaged { refused, read };  // read: the whole samples that are there
  explicit Pc2Reader(const std::filesystem::path& path, Damaged damaged = Damaged::refused);

  int points() const { return points_; }
  int samples() const { return samples_; }
  double spacing() const { return spacing_; }            // frames from one sample to the next
  void read(std::vector<Vec3>& positions);               // m; there must be a sample left
  void seek(int sample);                                 // the next one to be read
  const std::string& damage() const { return damage_; }  // what is not as its header tells; empty: nothing

 private:
  [[noreturn]] void fail(const std::string& what) const;

  std::filesystem::path path_;
  std::ifstream file_;
  int points_ = 0, samples_ = 0, next_ = 0;
  double spacing_ = 1;
  std::vector<unsigned char> bytes_;
  std::string damage_;
};

}  // namespace drape
