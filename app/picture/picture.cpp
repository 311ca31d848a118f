#include "app/picture/picture.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "app/base/atomic_file.h"
#include "app/base/interrupt.h"
#include "app/picture/options.h"
#include "app/picture/sheet.h"
#include "app/recording/run_files.h"
#include "mesh/base/errors.h"

namespace drape::app {
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

struct PictureFile {
  std::filesystem::path path;
  std::vector<SheetPanel> panels;
};

// One picture of everything, or one of each frame: NAME_0001.png ...
std::vector<PictureFile> files_of(const PictureWords& words, const std::vector<Subject>& subjects,
                                  SheetOptions& options) {
  const std::filesystem::path path = out_path(words);
  const bool sheet = words.grid || subjects.size() > 1;
  std::vector<std::vector<int>> frames;
  frames.reserve(subjects.size());
  for (const Subject& subject : subjects)
    frames.push_back(frames_named(words.frame, subject.frames(), words.grid ? spread : 1, subject.path()));
  if (!sheet && frames[0].size() == 1) return {{path, {{&subjects[0], frames[0][0], ""}}}};
  std::vector<PictureFile> files;
  if (!sheet) {
    files.reserve(frames[0].size());
    for (int frame : frames[0]) {
      const auto number = static_cast<std::size_t>(frame) + 1;
      files.push_back(
          {std::filesystem::path(path).replace_filename(numbered(path.stem().string(), number, ".png")),
           {{&subjects[0], frame, ""}}});
    }
    return files;
  }
  std::size_t longest = 0;
  for (const auto& row : frames) longest = std::max(longest, row.size());
  PictureFile all{path, {}};
  for (std::size_t k = 0; k < subjects.size(); ++k)  // a row for each run, where there are several of both
    for (std::size_t i = 0; i < (subjects.size() > 1 ? longest : frames[k].size()); ++i)
      all.panels.push_back(i < frames[k].size()
                               ? SheetPanel{&subjects[k], frames[k][i],
                                            label_of(subjects[k], frames[k][i], subjects.size() > 1)}
                               : SheetPanel{nullptr, 0, ""});
  if (subjects.size() > 1 && longest > 1) options.columns = static_cast<int>(longest);
  files.push_back(std::move(all));
  return files;
}

void refuse_taken(const std::vector<PictureFile>& files, const PictureWords& words) {
  for (const PictureFile& file : files) {
    for (const std::string& input : words.inputs)
      if (std::filesystem::is_directory(input)) spare_run(file.path, input);
    if (!words.force && std::filesystem::exists(file.path))
      throw InputError(file.path.string() + ": is there already; --force replaces it, -o gives another name");
  }
}

// Draws them one by one and counts those that are written. Throws Interrupted, with all of those whole.
void draw(const std::vector<PictureFile>& files, const SheetOptions& options, std::size_t& written) {
  std::vector<SheetPanel> all;
  for (const PictureFile& file : files)
    for (const SheetPanel& panel : file.panels)
      if (panel.subject) all.push_back(panel);
  const Sheet sheet(all, files.front().panels.size(), options);
  for (const PictureFile& file : files) {
    const std::string bytes = png(sheet.draw(file.panels));
    end_if_interrupted();
    AtomicFile out(file.path);
    out.write(bytes);
    out.keep();
    ++written;
  }
}

}  // namespace

int picture(const PictureWords& words) {
  catch_interrupts();
  SheetOptions options;
  std::tie(options.width, options.height) = size_named(words.size);
  options.view = view_named(words.view);
  options.field = field_asked(words.color);
  options.edges = words.edges;
  options.whole = words.whole;
  const std::vector<Subject> subjects = subjects_of(words);
  std::vector<PictureFile> files = files_of(words, subjects, options);
  const auto same = [](const PictureFile& a, const PictureFile& b) { return a.path == b.path; };
  files.erase(std::unique(files.begin(), files.end(), same), files.end());  // a frame that was named twice
  refuse_taken(files, words);
  std::size_t written = 0;
  try {
    draw(files, options, written);
  } catch (const Interrupted&) {
    std::fprintf(stderr, "interrupted: %zu of %s drawn\n", written,
                 counted(static_cast<long>(files.size()), "picture").c_str());
    return 130;
  }
  if (files.size() == 1)
    std::printf("wrote %s\n", files.front().path.c_str());
  else
    std::printf("wrote %s to %s (%s)\n", files.front().path.c_str(), files.back().path.c_str(),
                counted(static_cast<long>(files.size()), "picture").c_str());
  return 0;
}

}  // namespace drape::app
