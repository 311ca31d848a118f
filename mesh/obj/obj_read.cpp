// Wavefront OBJ reader. mesh/README.md says, with numbers, why it is not tinyobjloader. The text is read
// once. Faces may refer to vertices that come later, so such references are remembered with their line and
// checked at the end. Faces are cut into triangles last, when every position is known.
#include <algorithm>
#include <cstdint>
#include <limits>
#include <system_error>

#include "mesh/obj/obj.h"
#include "mesh/obj/obj_notes.h"
#include "mesh/obj/obj_scan.h"
#include "mesh/triangles/polygon.h"

namespace drape {

using namespace internal;

namespace {

using obj::next_word;
using obj::Number;

constexpr int kMany = std::numeric_limits<int>::max() - 1;  // vertices, and whatever else is counted

std::string quoted(std::string_view word) {
  return "'" + std::string(word.substr(0, 40)) + (word.size() > 40 ? "...'" : "'");
}

class ObjReader {
 public:
  ObjReader(std::string_view text, const std::string& name, ObjNeed need)
      : scanner_(text), name_(name), need_(need) {}

  TriangleMesh read();

 private:
  // A reference beyond what had been read when it was found; it is checked at the end.
  struct Ahead {
    std::size_t corner;
    int line;
  };
  struct Element {  // an 'l' or 'p' line
    std::size_t statement;
    int highest_v, highest_vt;
    int line;
  };
  enum Kind { kVertex, kTexcoord, kNormal };

  [[noreturn]] void fail(const std::string& what) const { fail_at(scanner_.line(), what); }
  [[noreturn]] void fail_at(int line, const std::string& what) const {
    throw InputError(name_ + ":" + std::to_string(line) + ": " + what);
  }
  void read_line(std::string_view line);
  void read_vertex(std::string_view rest);
  void read_normal(std::string_view rest);
  void read_face(std::string_view rest);
  ObjCorner read_corner(std::string_view word, bool& ahead);
  long long read_index(std::string_view digits, std::string_view word, Kind kind) const;
  void read_element(std::string_view keyword, std::string_view line);
  void keep(std::string_view line);
  bool is_relative_curve(std::string_view keyword, std::string_view rest) const;

  void check_references();
  void drop_broken_elements();
  void cut_faces();

  obj::LineScanner scanner_;
  std::string name_;
  ObjNeed need_;
  TriangleMesh mesh_;
  ObjDocument document_;
  std::vector<Ahead> ahead_;
  std::vector<Element> elements_;
  std::vector<int> face_lines_;  // {face, line} pairs, only of faces with more than three corners
  obj::Groups groups_;
  obj::Warnings warnings_;
};

TriangleMesh ObjReader::read() {
  document_.face_start.push_back(0);
  std::string_view line;
  while (scanner_.next(line)) {
    if (!line.empty()) read_line(line);
  }
  if (mesh_.positions.empty()) throw InputError(name_ + ": no vertices ('v' lines): is this an OBJ file?");
  check_references();
  if (document_.face_count() == 0 && (need_ == ObjNeed::faces || elements_.empty())) {
    const std::string skipped = warnings_.first("corners", name_);
    throw InputError(name_ +
                     (need_ == ObjNeed::faces
                          ? ": no faces of three corners or more ('f' lines): there is no surface to simulate"
                          : ": neither faces ('f' lines) nor lines ('l' lines)") +
                     (skipped.empty() ? "" : " (" + skipped + ")"));
  }
  drop_broken_elements();
  cut_faces();
  document_.warnings = warnings_.lines(name_);
  mesh_.document = std::make_shared<const ObjDocument>(std::move(document_));
  mesh_.groups = groups_.collect(*mesh_.document, polylines(mesh_), mesh_.vertex_count());
  return std::move(mesh_);
}

void ObjReader::read_line(std::string_view line) {
  std::string_view rest = line;
  const std::string_view keyword = next_word(rest);
  if (keyword == "v") {
    read_vertex(rest);
  } else if (keyword == "f" || keyword == "fo") {
    read_face(rest);
  } else if (keyword == "vt") {
    document_.texcoords.push_back(obj::trim(rest));
  } else if (keyword == "vn") {
    read_normal(rest);
  } else if (keyword == "g" || keyword == "o") {
    groups_.read(keyword, rest.substr(0, obj::comment_start(rest)), document_.face_count());
    keep(line);
  } else if (keyword == "l" || keyword == "p") {
    read_element(keyword, rest.substr(0, obj::comment_start(rest)));
  } else if (is_relative_curve(keyword, rest)) {
    warnings_.add(scanner_.line(), "curve",
                  "'" + std::string(keyword) + "' counts vertices from the end: it is left out");
  } else {
    keep(line);
  }
}

void ObjReader::keep(std::string_view line) {
  document_.statements.push_back({document_.face_count(), std::string(line), mesh_.positions.empty()});
}

void ObjReader::read_vertex(std::string_view rest) {
  Vec3 x;
  for (int k = 0; k < 3; ++k) {
    const std::string_view word = next_word(rest);
    const Number number = obj::parse_number(word, x[k]);
    if (number == Number::good) continue;
    if (number == Number::missing || word.front() == '#') {
      fail("vertex has " + std::to_string(k) + " coordinates, but needs 3");
    }
    if (number == Number::not_finite) fail("vertex coordinate " + quoted(word) + " is not a finite number");
    const bool comma = word.find(',') != word.npos;
    fail("vertex coordinate " + quoted(word) + " is not a number" +
         (comma ? " (decimals are written with a point)" : ""));
  }
  rest = obj::trim(rest);
  TextList& extras = document_.vertex_extras;
  if (!rest.empty() || !extras.empty()) {
    while (extras.size() < mesh_.positions.size()) extras.push_back("");
    extras.push_back(rest);
  }
  if (mesh_.vertex_count() == kMany) fail("more vertices than can be numbered");
  mesh_.positions.push_back(x);
}

void ObjReader::read_normal(std::string_view rest) {
  Vec3 n;
  for (int k = 0; k < 3; ++k) {
    const std::string_view word = next_word(rest);
    if (obj::parse_number(word, n[k]) == Number::good) continue;
    warnings_.add(scanner_.line(), "normal",
                  "normal " + quoted(word) + " is not a finite number: it is computed anew");
    n.setZero();
    break;
  }
  document_.normals.push_back(n);
}

// The number as it is written. The caller judges 0 and numbers that int cannot hold.
long long ObjReader::read_index(std::string_view digits, std::string_view word, Kind kind) const {
  const char* const end = digits.data() + digits.size();
  const char* const begin = digits.data() + (!digits.empty() && digits.front() == '+' ? 1 : 0);
  long long value = 0;
  const auto [stop, error] = std::from_chars(begin, end, value);
  if (error == std::errc::result_out_of_range && stop == end) return kind == kVertex ? 1LL << 62 : 0;
  if (error != std::errc() || stop != end) {
    fail(quoted(word) +
         " is not a reference to a vertex: it must be v, v/vt, v//vn or v/vt/vn, in whole numbers");
  }
  return value;
}

// The numbers of a corner, from 0, and -1 where there is none. `ahead` is set when one of them refers beyond
// what has been read so far.
ObjCorner ObjReader::read_corner(std::string_view word, bool& ahead) {
  ObjCorner corner{-1};
  int* const slots[3] = {&corner.v, &corner.vt, &corner.vn};
  const std::size_t counts[3] = {mesh_.positions.size(), document_.texcoords.size(),
                                 document_.normals.size()};
  const char* const names[3] = {"vertex", "texture coordinate", "normal"};
  std::string_view rest = word;
  for (int kind = kVertex; kind <= kNormal; ++kind) {
    const std::size_t slash = rest.find('/');
    const std::string_view digits = rest.substr(0, slash);
    if (kind == kVertex || !digits.empty()) {
      const long long index = read_index(digits, word, static_cast<Kind>(kind));
      const long long count = static_cast<long long>(counts[kind]);
      if (index > 0 && index <= kMany) {
        *slots[kind] = static_cast<int>(index - 1);
        ahead = ahead || index > count;
      } else if (index < 0 && -index <= count) {
        *slots[kind] = static_cast<int>(count + index);
      } else if (kind == kVertex) {
        fail("face refers to vertex " + (index > kMany ? std::string(digits) : std::to_string(index)) +
             (index == 0 ? ", but vertices count from 1" : ", but the file has ") +
             (index == 0 ? "" : std::to_string(count) + (index < 0 ? " before it" : "")));
      } else {
        warnings_.add(scanner_.line(), names[kind],
                      std::string("face refers to ") + names[kind] + " " + std::string(digits.substr(0, 20)) +
                          ", which is not there: the reference is dropped");
      }
    }
    if (slash == rest.npos) return corner;
    rest.remove_prefix(slash + 1);
  }
  fail(quoted(word) + " has more than three parts: a corner is v, v/vt, v//vn or v/vt/vn");
}

void ObjReader::read_face(std::string_view rest) {
  std::vector<ObjCorner>& corners = document_.corners;
  const std::size_t start = corners.size(), ahead_before = ahead_.size();
  for (std::string_view word = next_word(rest); !word.empty(); word = next_word(rest)) {
    if (word.front() == '#') {
      keep({word.data(), static_cast<std::size_t>(rest.data() + rest.size() - word.data())});
      break;
    }
    bool ahead = false;
    corners.push_back(read_corner(word, ahead));
    if (ahead) ahead_.push_back({corners.size() - 1, scanner_.line()});
  }
  const std::size_t count = corners.size() - start;
  if (count < 3) {
    warnings_.add(
        scanner_.line(), "corners",
        "face of " + std::to_string(count) + (count == 1 ? " corner" : " corners") + " is passed over");
    corners.resize(start);
    ahead_.resize(ahead_before);
    return;
  }
  if (document_.face_count() >= static_cast<std::size_t>(kMany)) fail("more faces than can be numbered");
  const ObjCorner* const c = corners.data() + start;
  if (count == 3 && (c[0].v == c[1].v || c[1].v == c[2].v || c[2].v == c[0].v)) {
    warnings_.add(scanner_.line(), "triangle",
                  "triangle names a vertex twice: it is kept, but not simulated");
  } else if (count > 3) {
    face_lines_.push_back(static_cast<int>(document_.face_count()));
    face_lines_.push_back(scanner_.line());
  }
  document_.face_start.push_back(corners.size());
}

// True for 'curv' and 'surf' lines that name vertices by counting from the end: after writing these numbers
// would mean other vertices, because all vertices come first in the written file.
bool ObjReader::is_relative_curve(std::string_view keyword, std::string_view rest) const {
  int parameters = keyword == "curv" ? 2 : keyword == "surf" ? 4 : -1;
  if (parameters < 0) return false;
  for (; parameters > 0; --parameters) next_word(rest);
  return rest.find('-') != rest.npos;
}

// Reads lines and points. They are not simulated but kept, with relative numbers replaced by absolute ones.
void ObjReader::read_element(std::string_view keyword, std::string_view rest) {
  std::string text(keyword);
  Element element{document_.statements.size(), 0, 0, scanner_.line()};
  const long long v_count = mesh_.vertex_count(),
                  vt_count = static_cast<long long>(document_.texcoords.size());
  for (std::string_view word = next_word(rest); !word.empty(); word = next_word(rest)) {
    const std::size_t slash = std::min(word.find('/'), word.size());
    long long v = read_index(word.substr(0, slash), word, kVertex), vt = 0;
    if (v < 0) v += v_count + 1;
    if (v <= 0) v = kMany;  // never there: dropped at the end
    text += " " + std::to_string(v);
    if (slash + 1 < word.size()) {
      vt = read_index(word.substr(slash + 1), word, kTexcoord);
      if (vt < 0) vt += vt_count + 1;
      if (vt <= 0) vt = kMany;
      text += "/" + std::to_string(vt);
    }
    element.highest_v = static_cast<int>(std::clamp<long long>(v, element.highest_v, kMany));
    element.highest_vt = static_cast<int>(std::clamp<long long>(vt, element.highest_vt, kMany));
  }
  elements_.push_back(element);
  keep(text);
}

// Checks the references to things later in the file, when all of the file is known.
void ObjReader::check_references() {
  const int v_count = mesh_.vertex_count();
  for (const Ahead& ahead : ahead_) {
    ObjCorner& corner = document_.corners[ahead.corner];
    if (corner.v >= v_count) {
      fail_at(ahead.line, "face refers to vertex " + std::to_string(corner.v + 1) + ", but the file has " +
                              std::to_string(v_count));
    }
    const auto drop = [&](int& slot, std::size_t count, const std::string& kind) {
      if (slot < 0 || static_cast<std::size_t>(slot) < count) return;
      warnings_.add(ahead.line, kind,
                    "face refers to " + kind + " " + std::to_string(slot + 1) + ", but the file has " +
                        std::to_string(count) + ": the reference is dropped");
      slot = -1;
    };
    drop(corner.vt, document_.texcoords.size(), "texture coordinate");
    drop(corner.vn, document_.normals.size(), "normal");
  }
  if (!document_.vertex_extras.empty()) {
    while (document_.vertex_extras.size() < mesh_.positions.size()) document_.vertex_extras.push_back("");
  }
}

void ObjReader::drop_broken_elements() {
  std::vector<ObjStatement>& statements = document_.statements;
  for (auto element = elements_.rbegin(); element != elements_.rend(); ++element) {
    const bool good = element->highest_v <= mesh_.vertex_count() &&
                      static_cast<std::size_t>(element->highest_vt) <= document_.texcoords.size();
    if (good) continue;
    warnings_.add(element->line, "element",
                  "line or point element refers to what is not there: it is left out");
    statements.erase(statements.begin() + static_cast<std::ptrdiff_t>(element->statement));
  }
}

void ObjReader::cut_faces() {
  PolygonCutter cutter(mesh_.positions);
  const std::vector<std::size_t>& start = document_.face_start;
  mesh_.triangles.reserve(document_.corners.size() - 2 * document_.face_count());
  std::vector<int> polygon;
  std::size_t next_line = 0;
  for (std::size_t f = 0; f < document_.face_count(); ++f) {
    const ObjCorner* const c = document_.corners.data() + start[f];
    const std::size_t count = start[f + 1] - start[f];
    if (count == 3) {
      const Triangle t{c[0].v, c[1].v, c[2].v};
      if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) mesh_.triangles.push_back(t);
      continue;
    }
    polygon.clear();
    for (std::size_t k = 0; k < count; ++k) polygon.push_back(c[k].v);
    const PolygonCutter::Outcome outcome = cutter.cut(polygon, mesh_.triangles);
    const int line = face_lines_[next_line + 1];
    next_line += 2;
    if (outcome.repeated_corner)
      warnings_.add(line, "repeated", "polygon repeats a corner: the repetition is passed over");
    if (outcome.folded)
      warnings_.add(line, "folded", "polygon crosses or folds back on itself: it is cut as a fan");
  }
}

}  // namespace

TriangleMesh parse_obj(std::string_view text, const std::string& name, ObjNeed need) {
  if (text.empty()) throw InputError(name + ": the file is empty");
  if (text.find('\0') != text.npos) {
    const bool utf16 = text.substr(0, 2) == "\xFF\xFE" || text.substr(0, 2) == "\xFE\xFF";
    throw InputError(name + (utf16 ? ": is UTF-16 text; save it as UTF-8"
                                   : ": is a binary file; export it as Wavefront OBJ"));
  }
  return ObjReader(text, name, need).read();
}

}  // namespace drape
