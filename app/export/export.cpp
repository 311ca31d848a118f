#include "app/export/export.h"

#include <array>
#include <cstdio>
#include <filesystem>

#include "app/base/interrupt.h"
#include "app/export/csv.h"
#include "app/export/files.h"
#include "app/export/gltf.h"
#include "app/export/mdd.h"
#include "app/export/obj_sequence.h"
#include "app/export/ply.h"
#include "app/export/source.h"
#include "app/export/usda.h"
#include "app/export/vtk.h"
#include "app/recording/recording.h"
#include "app/recording/run_files.h"
#include "mesh/base/errors.h"

namespace drape::app {
namespace {

struct Format {
  const char* name;
  Names (*files)(const ExportSource& source);  // the names of all that write() will write
  void (*write)(const ExportSource& source, ExportFiles& files, Names& notes);
};

constexpr std::array formats{
    Format{"mdd", mdd_files, write_mdd},    Format{"obj", obj_files, write_obj_sequence},
    Format{"ply", ply_files, write_ply},    Format{"vtk", vtk_files, write_vtk},
    Format{"gltf", gltf_files, write_gltf}, Format{"usda", usda_files, write_usda},
    Format{"csv", csv_files, write_csv},
};

const Format& format_of(const std::string& name) {
  for (const Format& format : formats)
    if (name == format.name) return format;
  throw InputError("--to " + name + ": there is no such format; " + suggestion(name, export_formats()));
}

// How many files from here on are the frames of one shape; 1: it is none of a sequence.
std::size_t in_sequence(const Names& files, std::size_t first, const ExportSource& source) {
  const std::size_t count = source.frame_count(), last = first + count - 1;
  const std::string ending = std::filesystem::path(files[first]).extension().string();
  for (const RecordedShape& shape : source.recording.shapes())
    if (last < files.size() && files[first] == numbered(shape.name, 1, ending) &&
        files[last] == numbered(shape.name, count, ending))
      return count;
  return 1;
}

// Of a sequence the first and the last.
void tell(const std::filesystem::path& folder, const Names& files, const ExportSource& source) {
  for (std::size_t i = 0; i < files.size();) {
    const std::size_t count = in_sequence(files, i, source);
    std::string line = "wrote " + (folder / files[i]).string();
    if (count > 1) line += " to " + files[i + count - 1] + ", " + std::to_string(count) + " files";
    std::printf("%s\n", one_line(line).c_str());
    i += count;
  }
}

void tell_skipped(const ExportSource& source) {
  if (source.skipped == 0) return;
  std::fprintf(stderr,
               "note: %s of the time of the frame before left out: frames are asked for more often than "
               "there are steps\n",
               counted(source.skipped, "frame").c_str());
}

}  // namespace

Names export_formats() {
  Names names;
  for (const Format& format : formats) names.emplace_back(format.name);
  return names;
}

int export_folder(const ExportWords& words) {
  const Format& format = format_of(words.to);
  const Recording recording(words.folder);
  recording.require_whole();
  const ExportSource source = export_source(recording, words.every);
  const std::filesystem::path folder =
      words.out.empty() ? std::filesystem::path(words.folder) / "export" : std::filesystem::path(words.out);
  const Names names = format.files(source);
  Names notes;
  ExportFiles files(folder, names, words.force, recording.folder());
  catch_interrupts();
  try {
    format.write(source, files, notes);
  } catch (const Interrupted&) {
    std::fprintf(stderr, "interrupted: nothing was exported\n");
    return 130;
  }
  files.keep();
  tell_skipped(source);
  tell(folder, names, source);
  for (const std::string& note : notes) std::printf("%s\n", one_line(note).c_str());
  return 0;
}

}  // namespace drape::app
