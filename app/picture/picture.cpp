#include "app/picture/picture.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "app/atomic_file.h"
#include "app/picture/options.h"
#include "app/picture/sheet.h"
#include "mesh/obj.h"

namespace drape {
namespace {

using namespace drawing;

constexpr int spread = 12;  // frames of a sheet when none are named

std::filesystem::path out_path(const PictureWords& words) {
  std::filesystem::path path = words.out;
  if (path.empty()) {
    path = words.inputs.front();
    if (words.inputs.size() > 1)
      path = "picture.png";
    else if (std::filesystem::is_directory(path))
      path /= "picture.png";
    else
      path.replace_extension(".png");
  }
  if (path.extension() != ".png")
    throw InputError(path.string() + ": pictures are PNG files; give a name that ends in .png");
  return path;
}

std::vector<Subject> subjects_of(const PictureWords& words) {
  std::vector<Subject> subjects;
  subjects.reserve(words.inputs.size());
  for (const std::string& input : words.inputs) {
    if (!std::filesystem::exists(input))
      throw InputError(input + ": no such file or folder; give the output folder of a run or an OBJ file");
    subjects.emplace_back(input);
    for (const std::string& line : subjects.back().missing())
      std::fprintf(stderr, "warning: %s\n", one_line(line).c_str());
    for (const std::string& body : words.with) subjects.back().add_body(body);
  }
  return subjects;
}

std::string label_of(const Subject& subject, int frame, bool several) {
  const std::string time = subject.is_run() ? rounded(subject.time(frame), 4) + " s" : "";
  if (!several) return time;
  return subject.title() + (time.empty() ? "" : ", " + time);
}

struct Output {
  std::filesystem::path path;
  std::vector<SheetPanel> panels;
};

// One picture of everything, or one of each frame: NAME_0001.png ...
std::vector<Output> outputs_of(const PictureWords& words, const std::vector<Subject>& subjects,
                               SheetOptions& options) {
  const std::filesystem::path path = out_path(words);
  const bool sheet = words.grid || subjects.size() > 1;
  std::vector<std::vector<int>> frames;
  frames.reserve(subjects.size());
  for (const Subject& subject : subjects)
    frames.push_back(frames_named(words.frame, subject.frames(), words.grid ? spread : 1, subject.path()));
  if (!sheet && frames[0].size() == 1) return {{path, {{&subjects[0], frames[0][0], ""}}}};
  std::vector<Output> outputs;
  if (!sheet) {
    outputs.reserve(frames[0].size());
    for (int frame : frames[0]) {
      char number[16];
      std::snprintf(number, sizeof number, "_%04d", frame + 1);
      std::filesystem::path numbered = path;
      numbered.replace_filename(path.stem().string() + number + ".png");
      outputs.push_back({numbered, {{&subjects[0], frame, ""}}});
    }
    return outputs;
  }
  std::size_t longest = 0;
  for (const auto& row : frames) longest = std::max(longest, row.size());
  Output all{path, {}};
  for (std::size_t k = 0; k < subjects.size(); ++k)  // a row for each run, where there are several of both
    for (std::size_t i = 0; i < (subjects.size() > 1 ? longest : frames[k].size()); ++i)
      all.panels.push_back(i < frames[k].size()
                               ? SheetPanel{&subjects[k], frames[k][i],
                                            label_of(subjects[k], frames[k][i], subjects.size() > 1)}
                               : SheetPanel{nullptr, 0, ""});
  if (subjects.size() > 1 && longest > 1) options.columns = static_cast<int>(longest);
  outputs.push_back(std::move(all));
  return outputs;
}

void refuse_existing(const std::vector<Output>& outputs) {
  for (const Output& output : outputs)
    if (std::filesystem::exists(output.path))
      throw InputError(output.path.string() +
                       ": is there already; --force replaces it, -o gives another name");
}

}  // namespace

int picture(const PictureWords& words) {
  SheetOptions options;
  std::tie(options.width, options.height) = size_named(words.size);
  options.view = view_named(words.view);
  options.field = field_asked(words.color);
  options.edges = words.edges;
  const std::vector<Subject> subjects = subjects_of(words);
  const std::vector<Output> outputs = outputs_of(words, subjects, options);
  if (!words.force) refuse_existing(outputs);

  std::vector<SheetPanel> all;
  for (const Output& output : outputs)
    for (const SheetPanel& panel : output.panels)
      if (panel.subject) all.push_back(panel);
  const Sheet sheet(all, outputs.front().panels.size(), options);
  for (const Output& output : outputs) {
    AtomicFile file(output.path);
    file.write(png(sheet.draw(output.panels)));
    file.keep();
  }
  if (outputs.size() == 1)
    std::printf("wrote %s\n", outputs.front().path.c_str());
  else
    std::printf("wrote %s to %s (%s)\n", outputs.front().path.c_str(), outputs.back().path.c_str(),
                counted(static_cast<long>(outputs.size()), "picture").c_str());
  return 0;
}

}  // namespace drape
