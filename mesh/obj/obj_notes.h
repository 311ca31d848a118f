// What the OBJ reader notes while it reads: warnings, one of each kind, and which faces are in which group.
//   Groups: a face belongs to the names of the last 'g' (several are allowed) and of the last 'o'. An 'o'
//   ends the groups of the object before it, unless no face has come since the 'g'. 'g off' ends them, too.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "mesh/obj/obj.h"

namespace drape::internal::obj {

class Warnings {
 public:
  // Adds a warning. The first one of a kind is kept, and further ones are counted.
  void add(int line, const std::string& kind, const std::string& what);
  // The first warning of this kind as "file.obj:12: text"; empty when there is none.
  std::string first(const std::string& kind, const std::string& file) const;
  // All warnings in the order of their lines, as first() writes them, each with the number of further ones.
  std::vector<std::string> lines(const std::string& file) const;

 private:
  struct Warning {
    int line;
    std::string text;
    std::size_t more;
  };
  static std::string format(const Warning& warning, const std::string& file);
  std::map<std::string, Warning> warnings_;  // by kind
};

inline constexpr std::string_view no_group = "off";  // as Blender writes it

class Groups {
 public:
  // Takes a line 'g' or 'o' that stands after this many faces.
  void read(std::string_view keyword, std::string_view names, std::size_t faces);
  // The vertices, ascending, of each group that has any. The vertices of a line belong to the group that
  // names it.
  std::vector<VertexGroup> collect(const ObjDocument& document, const std::vector<Polyline>& lines,
                                   int vertices) const;
  // For each of this many faces whether it is in the group.
  std::vector<char> faces_under(const std::string& name, std::size_t faces) const;

 private:
  struct Span {  // from this face on, these groups hold
    std::size_t first_face;
    std::vector<int> groups;
  };
  int number(std::string_view name);

  std::map<std::string, int> numbers_;
  std::vector<std::string> names_;
  std::vector<Span> spans_;
  std::vector<int> current_groups_, current_object_;
  std::size_t faces_at_group_ = 0;
};

}  // namespace drape::internal::obj
