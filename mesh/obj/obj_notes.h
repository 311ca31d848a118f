// What the OBJ reader notes on its way: warnings, one of each kind, and which faces are in which group.
//   Groups: a face belongs to the names of the last 'g' (several allowed) and of the last 'o'. An 'o' ends
//   the groups of the object before it, unless no face has come since the 'g'. Internal (not installed).
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "mesh/obj/obj.h"

namespace drape::internal::obj {

class Warnings {
 public:
  // The first of a kind is kept, further ones are counted.
  void add(int line, const std::string& kind, const std::string& what);
  // "file.obj:12: text" of that kind; empty when there is none.
  std::string first(const std::string& kind, const std::string& file) const;
  // All of them by line, as first() writes them, with the count of the others.
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

class Groups {
 public:
  // A line 'g' or 'o' after so many faces.
  void read(std::string_view keyword, std::string_view names, std::size_t faces);
  // The vertices of each group that has any, ascending; those of lines are of the group that names the line.
  std::vector<VertexGroup> collect(const ObjDocument& document, const std::vector<Polyline>& lines,
                                   int vertices) const;

 private:
  struct Span {  // from this face on, these groups
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
