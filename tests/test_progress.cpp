// What a run says while it goes on.
#include <unistd.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <memory>
#include <thread>

#include "app/run/progress.h"

using namespace drape::app;
using namespace std::chrono_literals;
using Catch::Contains;

namespace {

// A file that has no name and is no terminal.
struct Paper {
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file{std::tmpfile(), std::fclose};

  std::string text() const {
    std::fflush(file.get());
    std::string all(static_cast<std::size_t>(std::ftell(file.get())), ' ');
    const ssize_t read = pread(fileno(file.get()), all.data(), all.size(), 0);
    all.resize(static_cast<std::size_t>(std::max<ssize_t>(read, 0)));
    return all;
  }
  // Waits until the text has come, for a minute at most.
  bool shows(const std::string& part) const {
    for (int k = 0; k < 60000; ++k) {
      if (text().find(part) != std::string::npos) return true;
      std::this_thread::sleep_for(1ms);
    }
    return false;
  }
};

StepRow row(long step, double time) {
  StepRow row;
  row.step = step;
  row.time = time;
  return row;
}

}  // namespace

TEST_CASE("a step that takes long is told while it goes on", "[cli]") {
  const Paper paper;
  {
    Progress progress(1, false, 5ms, paper.file.get());
    CHECK(paper.shows("step 1 (from 0 s) has taken "));
    progress.show(row(1, 0.25));
    CHECK_THAT(paper.text(), Contains("25 %  0.25 of 1 s"));
    CHECK(paper.shows("step 2 (from 0.25 s) has taken "));
    progress.end();
    const std::string all = paper.text();
    std::this_thread::sleep_for(50ms);
    CHECK(paper.text() == all);
    progress.say("a message after the end");
  }
  CHECK_THAT(paper.text(), Contains("goes on\n") && Contains("\na message after the end\n"));
}

TEST_CASE("quick steps are told once in a tenth of a run, and quiet runs not at all", "[cli]") {
  for (const bool quiet : {false, true}) {
    const Paper paper;
    Progress progress(1, quiet, 1h, paper.file.get());
    for (long step = 1; step <= 100; ++step) progress.show(row(step, 0.01 * static_cast<double>(step)));
    progress.say("a message");
    const std::string all = paper.text();
    CHECK(std::count(all.begin(), all.end(), '\n') == (quiet ? 0 : 11));
  }
}
