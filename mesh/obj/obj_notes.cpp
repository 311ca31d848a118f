#include "mesh/obj/obj_notes.h"

#include <algorithm>

#include "mesh/obj/obj_scan.h"

namespace drape::internal::obj {

void Warnings::add(int line, const std::string& kind, const std::string& what) {
  const auto [found, fresh] = warnings_.try_emplace(kind, Warning{line, what, 0});
  if (!fresh) ++found->second.more;
}

std::string Warnings::format(const Warning& warning, const std::string& file) {
  return file + ":" + std::to_string(warning.line) + ": " + warning.text;
}

std::string Warnings::first(const std::string& kind, const std::string& file) const {
  const auto found = warnings_.find(kind);
  return found == warnings_.end() ? "" : format(found->second, file);
}

std::vector<std::string> Warnings::lines(const std::string& file) const {
  std::vector<const Warning*> in_order;
  for (const auto& [kind, warning] : warnings_) in_order.push_back(&warning);
  std::stable_sort(in_order.begin(), in_order.end(),
                   [](const Warning* a, const Warning* b) { return a->line < b->line; });
  std::vector<std::string> lines;
  lines.reserve(in_order.size());
  for (const Warning* w : in_order)
    lines.push_back(format(*w, file) +
                    (w->more == 0 ? "" : " (and " + std::to_string(w->more) + " more like it)"));
  return lines;
}

int Groups::number(std::string_view name) {
  const auto [found, fresh] = numbers_.try_emplace(std::string(name), static_cast<int>(names_.size()));
  if (fresh) names_.emplace_back(name);
  return found->second;
}

void Groups::read(std::string_view keyword, std::string_view names, std::size_t faces) {
  if (keyword == "o") {  // the whole line is the name of one object
    names = trim(names);
    current_object_.clear();
    if (!names.empty()) current_object_.push_back(number(names));
    if (faces_at_group_ != faces) current_groups_.clear();
  } else {
    current_groups_.clear();
    faces_at_group_ = faces;
    if (trim(names) == no_group) names = {};
    for (std::string_view name = next_word(names); !name.empty(); name = next_word(names))
      current_groups_.push_back(number(name));
  }
  Span span{faces, current_groups_};
  span.groups.insert(span.groups.end(), current_object_.begin(), current_object_.end());
  spans_.push_back(std::move(span));
}

std::vector<VertexGroup> Groups::collect(const ObjDocument& document, const std::vector<Polyline>& lines,
                                         int vertices) const {
  std::vector<std::vector<std::size_t>> spans_of(names_.size());
  for (std::size_t s = 0; s < spans_.size(); ++s)
    for (const int group : spans_[s].groups) spans_of[group].push_back(s);
  std::map<std::string_view, std::vector<const Polyline*>> lines_of;
  for (const Polyline& line : lines) lines_of[line.name].push_back(&line);
  std::vector<VertexGroup> collected;
  std::vector<std::size_t> last_group(static_cast<std::size_t>(vertices), names_.size());
  for (std::size_t group = 0; group < names_.size(); ++group) {
    std::vector<int> members;
    const auto add = [&](int v) {
      if (last_group[v] != group) members.push_back(v);
      last_group[v] = group;
    };
    for (const std::size_t s : spans_of[group]) {
      const std::size_t end_face = s + 1 < spans_.size() ? spans_[s + 1].first_face : document.face_count();
      const std::size_t end = document.face_start[end_face];
      for (std::size_t k = document.face_start[spans_[s].first_face]; k < end; ++k)
        add(document.corners[k].v);
    }
    if (const auto found = lines_of.find(names_[group]); found != lines_of.end())
      for (const Polyline* line : found->second)
        for (const int v : line->vertices) add(v);
    std::sort(members.begin(), members.end());
    if (!members.empty()) collected.push_back({names_[group], std::move(members)});
  }
  return collected;
}

std::vector<char> Groups::faces_under(const std::string& name, std::size_t faces) const {
  std::vector<char> under(faces, 0);
  const auto group = numbers_.find(name);
  if (group == numbers_.end()) return under;
  for (std::size_t s = 0; s < spans_.size(); ++s) {
    const std::vector<int>& groups = spans_[s].groups;
    if (std::find(groups.begin(), groups.end(), group->second) == groups.end()) continue;
    const std::size_t end = s + 1 < spans_.size() ? spans_[s + 1].first_face : faces;
    for (std::size_t f = spans_[s].first_face; f < end; ++f) under[f] = 1;
  }
  return under;
}

}  // namespace drape::internal::obj
