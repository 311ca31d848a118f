#include "app/view/view.h"

#include <cstdio>
#include <fstream>

#include "app/base/atomic_file.h"
#include "app/base/interrupt.h"
#include "app/base/markup.h"
#include "app/recording/run_files.h"
#include "app/view/page_data.h"
#include "app/view/page_template.h"
#include "mesh/base/errors.h"

namespace drape::app {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view mark = "<meta name=\"generator\" content=\"drape view\">";  // in web/page.html

// The template with its places filled; what is put in is not searched for places again.
std::string filled(std::string_view page, const std::string& title, const std::string& data) {
  std::string html;
  html.reserve(page.size() + data.size());
  while (true) {
    const std::size_t at = page.find("@@");
    if (at == std::string_view::npos) return html += page;
    html += page.substr(0, at);
    page.remove_prefix(at);
    const auto place = [&](std::string_view name, const std::string& text) {
      if (!page.starts_with(name)) return false;
      html += text;
      page.remove_prefix(name.size());
      return true;
    };
    if (place("@@TITLE@@", title) || place("@@DATA@@", data)) continue;
    html += "@@";
    page.remove_prefix(2);
  }
}

std::string page_of(const Recording& recording) {
  const PageData data = page_data(recording);
  return filled(page_template(), escaped(title_of(recording)),
                "<script type=\"application/json\" id=\"drape-head\">" + json_for_html(data.head) +
                    "</script>\n" + data.blocks.html());
}

void require_viewer() {
  if (!has_viewer()) throw InputError(missing_viewer());
}

bool is_page_of_drape(const fs::path& path) {
  std::string beginning(1000, '\0');
  std::ifstream file(path, std::ios::binary);
  file.read(beginning.data(), static_cast<std::streamsize>(beginning.size()));
  return beginning.find(mark) != std::string::npos;
}

// A page made before may be replaced, nothing else.
void require_free(const fs::path& out, const fs::path& run, bool force) {
  spare_run(out, run);
  std::error_code ignored;
  if (fs::is_directory(out, ignored))
    throw InputError(out.string() + ": is a folder; give the name of a file");
  if (!force && fs::exists(out, ignored) && !is_page_of_drape(out))
    throw InputError(out.string() + ": is there already, and is no page of drape; --force replaces it");
}

}  // namespace

bool has_viewer() { return !page_template().empty(); }

std::string view_html(const fs::path& folder) {
  require_viewer();
  return page_of(Recording(folder));
}

int view(const ViewWords& words) {
  catch_interrupts();
  require_viewer();
  const fs::path out = words.out.empty() ? fs::path(words.folder) / "view.html" : fs::path(words.out);
  const Recording recording(words.folder);
  require_free(out, recording.folder(), words.force);
  for (const std::string& line : recording.missing()) std::fprintf(stderr, "warning: %s\n", line.c_str());
  std::string html;
  try {
    html = page_of(recording);
    end_if_interrupted();
  } catch (const Interrupted&) {
    std::fprintf(stderr, "interrupted: no page was written\n");
    return 130;
  }
  AtomicFile file(out);
  file.write(html);
  file.keep();
  std::printf("wrote %s (%s, %.1f MB)\n", out.string().c_str(), counted(recording.frames(), "frame").c_str(),
              static_cast<double>(html.size()) / 1e6);
  return 0;
}

}  // namespace drape::app
