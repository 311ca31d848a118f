#include "app/recording/body_files.h"

#include <algorithm>
#include <cstdio>
#include <set>
#include <utility>

#include "app/recording/run_files.h"
#include "app/recording/scene_record.h"
#include "app/simulation/body_mesh.h"
#include "mesh/obj/obj.h"

namespace drape::app {
namespace {

namespace fs = std::filesystem;

// What no file system and no spreadsheet stumbles over; letters of other alphabets stay.
std::string file_name(std::string name) {
  const std::string extension = name.size() > 4 ? name.substr(name.size() - 4) : "";
  if (extension == ".obj" || extension == ".OBJ") name.resize(name.size() - 4);
  for (char& c : name) {
    const auto byte = static_cast<unsigned char>(c);
    const bool plain = (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z');
    if (!plain && byte < 128 && c != '-' && c != '.' && c != '_') c = '_';
  }
  if (name.empty()) return "body";
  if (name.front() == '.') name.front() = '_';
  return name;
}

bool moves_or_reacts(const MovingBody& body) { return body.obstacle().motion.moves() || body.reacting(); }

bool deforms(const MovingBody& body) { return deforming(body.obstacle().shape) != nullptr; }

// None where a run has failed and left it at no place.
bool has_shape(const MovingBody& body) {
  const bool somewhere = body.pose().rotation.allFinite() && body.pose().translation.allFinite();
  return somewhere && mesh_of(body.obstacle().shape).vertex_count() > 0;
}

Names file_names(const Simulation& simulation) {
  Names bodies, cloths;
  for (const Body& body : simulation.bodies) bodies.push_back(body.name);
  for (const Cloth& cloth : simulation.cloths) cloths.push_back(cloth.name);
  return body_file_names(bodies, cloths);
}

// Ready to be kept, so that many files may become visible together.
AtomicFile written(const fs::path& path, const TriangleMesh& mesh) {
  AtomicFile file(path);
  file.write(format_obj(mesh, mesh.positions));
  file.close();
  return file;
}

}  // namespace

fs::path frame_path(const fs::path& folder, const std::string& name, int frame) {
  return folder / "frames" / numbered(name, static_cast<std::size_t>(frame), ".obj");
}

Names body_file_names(const Names& bodies, const Names& cloths) {
  std::set<std::string> taken(cloths.begin(), cloths.end());
  Names names;
  for (const std::string& body : bodies) {
    const std::string plain = file_name(body);
    std::string name = plain;
    for (int number = 2; !taken.insert(name).second; ++number) name = plain + "_" + std::to_string(number);
    names.push_back(name);
  }
  return names;
}

std::vector<BodyRecord> body_records(const Simulation& simulation) {
  const Names names = file_names(simulation);
  std::vector<BodyRecord> records;
  for (std::size_t k = 0; k < simulation.bodies.size(); ++k) {
    const MovingBody& body = simulation.constraints->bodies()[k];
    BodyRecord record{simulation.bodies[k].name,
                      has_shape(body) ? "bodies/" + names[k] + ".obj" : "",
                      std::string(name(body.obstacle().shape)),
                      body.obstacle().motion.moves(),
                      deforms(body),
                      body.pose(),
                      {},
                      contact_json(body.obstacle()),
                      {}};
    if (const auto* const plane = std::get_if<Plane>(&body.obstacle().shape)) record.plane = *plane;
    if (const ReactingBody* const r = body.reacting())
      record.reacting = {body.obstacle().rigid->mass, r->centre(), r->velocity(), r->spin(), r->momentum()};
    records.push_back(record);
  }
  return records;
}

BodyFiles::BodyFiles(fs::path folder, const Simulation& simulation, Frames frames)
    : folder_(std::move(folder)), simulation_(simulation), frames_(frames) {
  const Names names = file_names(simulation);
  for (std::size_t k = 0; k < names.size(); ++k) {
    entries_.push_back({names[k], moves_or_reacts(body(k)), deforms(body(k)), has_shape(body(k))});
    any_moves_ = any_moves_ || entries_.back().moves;
  }
}

void BodyFiles::open() {
  if (frames_ == Frames::pc2)
    for (std::size_t k = 0; k < entries_.size(); ++k)
      if (entries_[k].deforms)
        entries_[k].cache.emplace(cache_path(entries_[k]), mesh_of(body(k).obstacle().shape).vertex_count());
  if (!has_poses()) return;
  poses_.emplace(folder_ / "bodies.csv");
  poses_->write("frame,time,body,x,y,z,qw,qx,qy,qz\n");
}

fs::path BodyFiles::shape_path(const Entry& entry) const {
  return folder_ / "bodies" / (entry.name + ".obj");
}

fs::path BodyFiles::cache_path(const Entry& entry) const {
  return folder_ / "bodies" / (entry.name + ".pc2");
}

void BodyFiles::add_pose(int number, double time, std::size_t k) {
  const Pose& pose = body(k).pose();
  Eigen::Quaterniond q(pose.rotation);
  q.normalize();
  if (q.dot(entries_[k].turn_before) < 0) q.coeffs() *= -1;
  entries_[k].turn_before = q;
  const Vec3& t = pose.translation;
  char numbers[320];
  std::snprintf(numbers, sizeof numbers, ",%.10g,%.10g,%.10g,%.10g,%.10g,%.10g,%.10g\n", t[0], t[1], t[2],
                q.w(), q.x(), q.y(), q.z());
  char start[64];
  std::snprintf(start, sizeof start, "%d,%.10g,", number, time);
  poses_->write(start + entries_[k].name + numbers);
}

void BodyFiles::frame(int number, double time) {
  for (std::size_t k = 0; k < entries_.size(); ++k) {
    if (poses_ && entries_[k].moves) add_pose(number, time, k);
    if (entries_[k].cache) entries_[k].cache->add(present_mesh(body(k), time).positions);
    if (frames_ == Frames::obj && has_frames(entries_[k]))
      written(frame_path(folder_, entries_[k].name, number), present_mesh(body(k), time)).keep();
  }
}

void BodyFiles::finish(double time, std::vector<AtomicFile>& files) {
  for (std::size_t k = 0; k < entries_.size(); ++k)
    if (entries_[k].has_shape && has_shape(body(k)))
      files.push_back(written(shape_path(entries_[k]), present_mesh(body(k), time)));
  for (Entry& entry : entries_)
    if (entry.cache) {
      entry.cache->close();
      files.push_back(entry.cache->take_file());
    }
  if (!poses_) return;
  poses_->close();
  files.push_back(std::move(*poses_));
}

std::vector<fs::path> BodyFiles::results() const {
  std::vector<fs::path> paths;
  for (const Entry& entry : entries_) {
    if (entry.has_shape) paths.push_back(shape_path(entry));
    if (entry.deforms) paths.push_back(cache_path(entry));
  }
  paths.push_back(folder_ / "bodies.csv");
  return paths;
}

std::vector<fs::path> BodyFiles::not_written() const {
  std::vector<fs::path> paths;
  for (const Entry& entry : entries_)
    if (!entry.deforms || frames_ != Frames::pc2) paths.push_back(cache_path(entry));
  if (!has_poses()) paths.push_back(folder_ / "bodies.csv");
  return paths;
}

Names BodyFiles::frame_names() const {
  Names names;
  for (const Entry& entry : entries_)
    if (has_frames(entry)) names.push_back(entry.name);
  return names;
}

int BodyFiles::shapes() const {
  return static_cast<int>(
      std::count_if(entries_.begin(), entries_.end(), [](const Entry& entry) { return entry.has_shape; }));
}

}  // namespace drape::app
