// A point cache for Blender's Mesh Cache modifier, all little endian:
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

namespace drape::app {

class Pc2Writer {
 public:
  Pc2Writer(std::filesystem::path path, int points);

  // Adds a sample: the positions of all points [m]. There may be more from sample to sample, copies of
  // points.
  void add(const std::vector<Vec3>& positions);
  // Writes the number of samples into the header. All samples get all points: copy k, which is a copy of
  // point copy_of[k], is where its original is as long as it is not there.
  void close(const std::vector<int>& copy_of = {});
  void keep() { file_.keep(); }
  // Hands over the closed file, to be kept together with others.
  AtomicFile take_file() { return std::move(file_); }
  const std::filesystem::path& path() const { return file_.path(); }
  int points() const { return points_; }  // that there were at first

 private:
  void write_number(long place, int number);

  AtomicFile file_;
  int points_;                       // that there were at first
  std::vector<int> points_of_each_;  // of the samples
  std::vector<unsigned char> bytes_;
};

// Reads a point cache one sample after the other, or from any sample on. Throws InputError when the file is
// not a point cache, ends early or holds a number that is not finite.
class Pc2Reader {
 public:
  enum class Damaged { refused, read };  // read: the complete samples of a damaged file are read
  explicit Pc2Reader(const std::filesystem::path& path, Damaged damaged = Damaged::refused);

  int points() const { return points_; }
  int samples() const { return samples_; }
  double spacing() const { return spacing_; }  // frames between one sample and the next
  void read(std::vector<Vec3>& positions);     // the next sample, m; there must be one
  void seek(int sample);                       // makes this sample the next one to be read
  // How the file differs from what its header says; empty when it does not.
  const std::string& damage() const { return damage_; }

 private:
  [[noreturn]] void fail(const std::string& what) const;

  std::filesystem::path path_;
  std::ifstream file_;
  int points_ = 0, samples_ = 0, next_ = 0;
  double spacing_ = 1;
  std::vector<unsigned char> bytes_;
  std::string damage_;
};

}  // namespace drape::app
