#include "app/recording/frame_fields.h"

#include <algorithm>

#include "app/recording/touch.h"
#include "mesh/obj/obj.h"

namespace drape::app {
namespace {

int main_particle(const Embedding& embedding, int vertex) {
  const auto shares = embedding.shares(vertex);
  return std::max_element(shares.begin(), shares.end(),
                          [](const auto& a, const auto& b) { return a.weight < b.weight; })
      ->particle;
}

}  // namespace

std::vector<int> copies_since(const Cloth& cloth, int vertices) {
  if (!cloth.tearing) return {};
  const std::vector<int>& all = cloth.tearing->copy_of;
  return {all.end() - (cloth.mesh.vertex_count() - vertices), all.end()};
}

bool has_polygons(const TriangleMesh& mesh) {
  if (!mesh.document) return false;
  const auto& start = mesh.document->face_start;
  for (std::size_t f = 0; f < mesh.document->face_count(); ++f)
    if (start[f + 1] - start[f] > 3) return true;
  return false;
}

std::filesystem::path field_path(const std::filesystem::path& folder, const std::string& name,
                                 const std::string& field) {
  return folder / "fields" / (name + "." + field + ".npy");
}

FrameFields::FrameFields(const std::filesystem::path& folder, const Cloth& cloth)
    : velocity_(field_path(folder, cloth.name, "velocity"), NpyWriter::Kind::float32,
                {cloth.mesh.vertex_count(), 3}),
      strain_(field_path(folder, cloth.name, "strain"), NpyWriter::Kind::float32,
              {cloth.mesh.vertex_count()}),
      contact_(field_path(folder, cloth.name, "contact"), NpyWriter::Kind::byte, {cloth.mesh.vertex_count()}),
      vertices_(cloth.mesh.vertex_count()) {
  if (!has_polygons(cloth.mesh)) return;
  triangles_.emplace(field_path(folder, cloth.name, "triangles"), NpyWriter::Kind::int32,
                     std::vector<int>{3});
}

void FrameFields::mark_touches(const Constraints& constraints, int particles) {
  particle_contact_.assign(static_cast<std::size_t>(particles), 0);
  const auto mark = [&](int particle, Touch touch) {
    particle_contact_[particle] = static_cast<std::uint8_t>(touch);
  };
  for (const SelfContact& contact : constraints.self().pushed())
    for (std::size_t k = 0; k < 4; ++k)
      if (contact.before > 0 && contact.weights[k] != 0)
        mark(contact.particles[k], contact.body < 0       ? Touch::cloth
                                   : contact.is_sliding() ? Touch::slides
                                                          : Touch::sticks);
  for (const Contact& contact : constraints.contacts())
    if (contact.active()) mark(contact.particle, contact.grip == Grip::stick ? Touch::sticks : Touch::slides);
  for (int i = 0; i < particles; ++i)
    if (constraints.self().is_stopped(i)) mark(i, Touch::stopped);
}

void FrameFields::add(const Cloth& cloth, const State& state, const Constraints& constraints) {
  particle_strains(cloth, state.x, particle_strain_);
  mark_touches(constraints, state.particles());

  const int vertices = cloth.embedding.vertices();
  std::vector<float> velocity, strain;
  std::vector<std::uint8_t> contact;
  for (const Vec3& v : cloth.embedding.positions(state.v))
    for (const double component : v) velocity.push_back(static_cast<float>(component));
  for (int vertex = 0; vertex < vertices; ++vertex) {
    const auto particle = static_cast<std::size_t>(main_particle(cloth.embedding, vertex));
    strain.push_back(static_cast<float>(particle_strain_[particle]));
    contact.push_back(particle_contact_[particle]);
  }
  velocity_.add(velocity);
  strain_.add(strain);
  contact_.add(contact);
}

void FrameFields::close(const Cloth& cloth) {
  const std::vector<int> copy_of = copies_since(cloth, vertices_);
  velocity_.close(copy_of);
  strain_.close(copy_of);
  contact_.close(copy_of);
  if (!triangles_) return;
  for (const Triangle& t : cloth.mesh.triangles)
    triangles_->add(std::vector<std::int32_t>(t.begin(), t.end()));
  triangles_->close();
}

void FrameFields::keep() {
  velocity_.keep();
  strain_.keep();
  contact_.keep();
  if (triangles_) triangles_->keep();
}

}  // namespace drape::app
