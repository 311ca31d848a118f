// Wavefront OBJ writer: writes the document that the mesh came from, at new positions. See obj.h.
//   Order: statements from before the first vertex, v, vt, vn, faces with the other statements between them.
//   Numbers: the shortest text that reads back as the same double; for normals, as the same float.
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <system_error>

#include "mesh/obj/obj.h"
#include "mesh/triangles/normals.h"

namespace drape {

namespace {

template <class T>
void append_number(std::string& text, T number) {
  char digits[32];
  const auto end = std::to_chars(digits, digits + sizeof digits, number).ptr;
  text.append(digits, end);
}

template <class T>
void append_vector(std::string& text, const char* keyword, const Vec3& x) {
  text += keyword;
  for (int k = 0; k < 3; ++k) {
    text += ' ';
    append_number(text, static_cast<T>(x[k]));
  }
}

struct Normals {
  std::vector<Vec3> entries;         // as many as the document has, then the added ones
  std::vector<int> entry_of_corner;  // -1: none
};

// Adds up the normals of the corners which share a vn entry, vertex by vertex; see format_obj in obj.h.
class NormalBuilder {
 public:
  NormalBuilder(const ObjDocument& document, const TriangleMesh& mesh, const std::vector<Vec3>& positions)
      : document_(document), rest_(mesh.positions), positions_(positions) {}

  Normals build() {
    normals_.entries = document_.normals;
    normals_.entry_of_corner.assign(document_.corners.size(), -1);
    sort_corners();
    for (std::size_t vn = 0; vn < document_.normals.size(); ++vn) fill_entry(static_cast<int>(vn));
    return std::move(normals_);
  }

 private:
  // Sorts corners_ by vn, then by vertex, and fills face_ for every corner.
  void sort_corners() {
    const std::vector<ObjCorner>& corners = document_.corners;
    face_.resize(corners.size());
    for (std::size_t f = 0; f < document_.face_count(); ++f) {
      for (std::size_t k = document_.face_start[f]; k < document_.face_start[f + 1]; ++k)
        face_[k] = static_cast<int>(f);
    }
    start_.assign(document_.normals.size() + 1, 0);
    for (const ObjCorner& c : corners) {
      if (c.vn >= 0) ++start_[c.vn + 1];
    }
    for (std::size_t i = 1; i < start_.size(); ++i) start_[i] += start_[i - 1];
    corners_.resize(start_.back());
    std::vector<std::size_t> next(start_.begin(), start_.end() - 1);
    for (std::size_t k = 0; k < corners.size(); ++k) {
      if (corners[k].vn >= 0) corners_[next[corners[k].vn]++] = k;
    }
    for (std::size_t vn = 0; vn + 1 < start_.size(); ++vn) {
      const auto by_vertex = [&](std::size_t i, std::size_t j) {
        return corners[i].v != corners[j].v ? corners[i].v < corners[j].v : i < j;
      };
      std::sort(corners_.data() + start_[vn], corners_.data() + start_[vn + 1], by_vertex);
    }
  }

  Vec3 face_normal(std::size_t corner, const std::vector<Vec3>& positions) {
    const std::size_t begin = document_.face_start[face_[corner]],
                      end = document_.face_start[face_[corner] + 1];
    polygon_.clear();
    for (std::size_t k = begin; k < end; ++k) polygon_.push_back(document_.corners[k].v);
    return newell_normal(positions, polygon_.data(), static_cast<int>(polygon_.size()));
  }

  // Fills one entry, run by run: a run has the corners of this entry at one vertex.
  void fill_entry(int vn) {
    constexpr double kAgree = 1 - 1e-6;  // cosine: normals this close may go on sharing an entry
    const Vec3& as_read = document_.normals[vn];
    bool first = true;
    for (std::size_t i = start_[vn], j = i; i < start_[vn + 1]; i = j) {
      Vec3 now = Vec3::Zero(), then = Vec3::Zero();
      for (; j < start_[vn + 1] && document_.corners[corners_[j]].v == document_.corners[corners_[i]].v;
           ++j) {
        now += face_normal(corners_[j], positions_);
        then += face_normal(corners_[j], rest_);
      }
      // A file may hold normals that point against the winding of its faces; the new normals do so, too.
      Vec3 n = now.stableNormalized() * (then.dot(as_read) < 0 ? -1 : 1);
      if (now.isZero()) n = as_read;
      int entry = vn;
      if (first) {
        normals_.entries[vn] = n;
      } else if (!(n.dot(normals_.entries[vn]) >= kAgree)) {
        entry = static_cast<int>(normals_.entries.size());
        normals_.entries.push_back(n);
      }
      first = false;
      for (std::size_t k = i; k < j; ++k) normals_.entry_of_corner[corners_[k]] = entry;
    }
  }

  const ObjDocument& document_;
  const std::vector<Vec3>&rest_, &positions_;
  std::vector<int> face_, polygon_;
  std::vector<std::size_t> start_, corners_;
  Normals normals_;
};

void append_corner(std::string& text, const ObjCorner& corner, int vn) {
  text += ' ';
  append_number(text, corner.v + 1);
  if (corner.vt < 0 && vn < 0) return;
  text += '/';
  if (corner.vt >= 0) append_number(text, corner.vt + 1);
  if (vn < 0) return;
  text += '/';
  append_number(text, vn + 1);
}

void append_positions(std::string& text, const std::vector<Vec3>& positions, const TextList* extras) {
  for (std::size_t i = 0; i < positions.size(); ++i) {
    append_vector<double>(text, "v", positions[i]);
    if (extras && !extras->empty() && !(*extras)[i].empty()) (text += ' ') += (*extras)[i];
    text += '\n';
  }
}

std::string format_document(const ObjDocument& document, const TriangleMesh& mesh,
                            const std::vector<Vec3>& positions) {
  std::string text;
  text.reserve(positions.size() * 64 + document.corners.size() * 9);
  std::size_t next = 0;
  const std::vector<ObjStatement>& statements = document.statements;
  for (; next < statements.size() && statements[next].before_vertices && statements[next].before_face == 0;
       ++next) {
    (text += statements[next].text) += '\n';
  }
  append_positions(text, positions, &document.vertex_extras);
  for (std::size_t i = 0; i < document.texcoords.size(); ++i)
    ((text += "vt ") += document.texcoords[i]) += '\n';
  const Normals normals = NormalBuilder(document, mesh, positions).build();
  for (const Vec3& n : normals.entries) {
    append_vector<float>(text, "vn", n);
    text += '\n';
  }
  for (std::size_t f = 0; f <= document.face_count(); ++f) {
    for (; next < statements.size() && statements[next].before_face == f; ++next)
      (text += statements[next].text) += '\n';
    if (f == document.face_count()) break;
    text += 'f';
    for (std::size_t k = document.face_start[f]; k < document.face_start[f + 1]; ++k) {
      append_corner(text, document.corners[k], normals.entry_of_corner[k]);
    }
    text += '\n';
  }
  return text;
}

[[noreturn]] void fail(const std::filesystem::path& path, const std::string& what, int error) {
  throw InputError(path.string() + ": " + what +
                   (error ? ": " + std::generic_category().message(error) : ""));
}

// Writes the text and returns the errno of the first failure, or 0 when all of the text is in the file.
int write_text(const std::filesystem::path& path, const std::string& text) {
  errno = 0;
  std::FILE* const file = std::fopen(path.c_str(), "wb");
  if (!file) return errno ? errno : EIO;
  int error = 0;
  const auto note = [&](bool good) {
    if (!good && error == 0) error = errno ? errno : EIO;
  };
  note(std::fwrite(text.data(), 1, text.size(), file) == text.size());
  note(std::fflush(file) == 0);
  note(std::fclose(file) == 0);
  return error;
}

}  // namespace

std::string format_obj(const TriangleMesh& mesh, const std::vector<Vec3>& positions) {
  if (positions.size() != mesh.positions.size()) {
    throw InputError("mesh of " + std::to_string(mesh.positions.size()) +
                     " vertices cannot be written with " + std::to_string(positions.size()) + " positions");
  }
  for (std::size_t i = 0; i < positions.size(); ++i) {
    if (!positions[i].allFinite())
      throw InputError("position of vertex " + std::to_string(i) + " is not finite");
  }
  if (mesh.document) return format_document(*mesh.document, mesh, positions);
  std::string text;
  append_positions(text, positions, nullptr);
  for (const Triangle& t : mesh.triangles) {
    text += 'f';
    for (const int v : t) append_corner(text, {v}, -1);
    text += '\n';
  }
  return text;
}

void write_obj(const std::filesystem::path& path, const TriangleMesh& mesh,
               const std::vector<Vec3>& positions) {
  std::string text;
  try {
    text = format_obj(mesh, positions);
  } catch (const InputError& error) {
    fail(path, std::string("not written: ") + error.what(), 0);
  }
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  if (std::filesystem::is_directory(status)) fail(path, "is a directory; name a file in it", 0);
  if (std::filesystem::exists(status) &&
      !std::filesystem::is_regular_file(status)) {  // a pipe or a device: nothing to rename
    if (const int failed = write_text(path, text)) fail(path, "cannot be written", failed);
    return;
  }
  std::filesystem::path part = path;
  part += ".part" + std::to_string(::getpid());
  if (const int failed = write_text(part, text)) {
    std::filesystem::remove(part, error);
    fail(path, "cannot be written", failed);
  }
  std::filesystem::rename(part, path, error);
  if (error) {
    const int failed = error.value();
    std::filesystem::remove(part, error);
    fail(path, "cannot be written", failed);
  }
}

}  // namespace drape
