// Arrows between the rooms go one way: mesh <- constraints <- solver <- app. Read from the #include lines.
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "tests/places.h"

namespace fs = std::filesystem;

namespace {

const std::vector<std::string> rooms = {"mesh", "constraints", "solver", "app"};

// From the bottom up: a room may include those before it.
const std::vector<std::string> inner_rooms = {
    "mesh/base",      "mesh/triangles",     "mesh/obj",        "mesh/pattern",
    "mesh/distance",  "mesh/lattice",       "mesh/tetrahedra", "mesh/level_set",
    "constraints",    "solver/matrix",      "solver/forces",   "solver/linear",
    "solver/system",  "solver/integrators", "solver/assembly", "solver/stability",
    "solver",         "app/base",           "app/pattern",     "app/scene",
    "app/simulation", "app/recording",      "app/run",         "app/export",
    "app/picture",    "app/view",           "app/compare",     "app/textile",
    "app/stability",  "app/python",         "app/commands",    "app"};

std::size_t place(const std::vector<std::string>& list, const std::string& room) {
  return static_cast<std::size_t>(std::find(list.begin(), list.end(), room) - list.begin());
}
std::size_t level(const std::string& room) { return place(rooms, room); }
std::size_t inner_level(const fs::path& file) { return place(inner_rooms, file.parent_path().string()); }

// Every (file, included path) of a room.
std::vector<std::pair<std::string, std::string>> includes(const std::string& room) {
  std::vector<std::pair<std::string, std::string>> all;
  for (const auto& entry : fs::recursive_directory_iterator(fs::path(drape::test::source_dir()) / room)) {
    if (entry.path().extension() != ".h" && entry.path().extension() != ".cpp") continue;
    std::ifstream file(entry.path());
    for (std::string line; std::getline(file, line);) {
      if (line.rfind("#include", 0) != 0) continue;
      const auto first = line.find_first_of("\"<");
      const auto last = line.find_first_of("\">", first + 1);
      all.emplace_back(fs::relative(entry.path(), drape::test::source_dir()).string(),
                       line.substr(first + 1, last - first - 1));
    }
  }
  return all;
}

// The headers that a room's CMakeLists.txt installs, as "room/name.h".
std::set<std::string> installed(const std::string& room) {
  std::ostringstream text;
  text << std::ifstream(fs::path(drape::test::source_dir()) / room / "CMakeLists.txt").rdbuf();
  const std::string all = text.str();
  std::set<std::string> headers;
  const std::string call = "drape_install_headers(";
  for (std::size_t at = all.find(call); at != all.npos; at = all.find(call, at + 1)) {
    std::istringstream words(all.substr(at + call.size(), all.find(')', at) - at - call.size()));
    for (std::string word; words >> word;)
      if (word.ends_with(".h")) headers.insert(room + "/" + word);
  }
  return headers;
}

}  // namespace

TEST_CASE("no room includes one above it", "[layering]") {
  for (const std::string& room : rooms) {
    const auto found = includes(room);
    CHECK(found.size() > 10);
    for (const auto& [file, path] : found) {
      const std::string target = path.substr(0, path.find('/'));
      INFO(file << " includes " << path);
      if (level(target) < rooms.size()) CHECK(level(target) <= level(room));
      CHECK(target != "tests");
    }
  }
}

TEST_CASE("no inner room includes one above it", "[layering]") {
  for (const std::string& room : rooms)
    for (const auto& [file, path] : includes(room)) {
      INFO(file << " includes " << path);
      CHECK(inner_level(file) < inner_rooms.size());
      if (level(path.substr(0, path.find('/'))) == rooms.size()) continue;
      CHECK(inner_level(path) <= inner_level(file));
    }
}

TEST_CASE("only Eigen shows in headers; every other library is in one source file", "[layering]") {
  const std::vector<std::string> libraries = {
      "embree3",       "cholmod",         "toml",    "CLI",    "nlohmann",       "png.h", "ft2build",
      "udunits2",      "tiny_obj_loader", "kinsol",  "cvode",  "arkode",         "csv.h", "boost/math",
      "boost/numeric", "svgpp",           "pugixml", "zlib.h", "BulletCollision"};
  std::map<std::string, std::vector<std::string>> users;
  for (const std::string& room : rooms)
    for (const auto& [file, path] : includes(room))
      for (const std::string& library : libraries)
        if (path.rfind(library, 0) == 0) {
          INFO(file << " includes " << path);
          CHECK(fs::path(file).extension() == ".cpp");
          if (users[library].empty() || users[library].back() != file) users[library].push_back(file);
        }
  for (const auto& [library, files] : users) {
    INFO(library);
    CHECK(files.size() == 1);
  }
  CHECK(users.size() >= 4);
}

TEST_CASE("an installed header needs the standard library, Eigen and other installed ones only",
          "[layering]") {
  std::set<std::string> public_headers = {"solver/drape.h", "app/app.h"};  // installed one folder up
  for (const std::string& room : rooms) public_headers.merge(installed(room));
  CHECK(public_headers.size() > 15);
  CHECK_FALSE(public_headers.contains("solver/linear/sundials.h"));
  int looked_at = 0;
  for (const std::string& room : rooms)
    for (const auto& [file, path] : includes(room)) {
      if (!public_headers.contains(file)) continue;
      ++looked_at;
      INFO(file << " includes " << path);
      const bool standard = path.find('/') == path.npos && path.find('.') == path.npos;
      CHECK((standard || path.starts_with("Eigen/") || public_headers.contains(path)));
    }
  CHECK(looked_at > 50);
}

TEST_CASE("the program uses of the library what any other program can use", "[layering]") {
  std::set<std::string> public_headers;
  for (const std::string& room : rooms) public_headers.merge(installed(room));
  int looked_at = 0;
  for (const auto& [file, path] : includes("app")) {
    const std::string target = path.substr(0, path.find('/'));
    if (target == "app" || level(target) >= rooms.size()) continue;
    ++looked_at;
    INFO(file << " includes " << path);
    CHECK(public_headers.contains(path));
  }
  CHECK(looked_at > 100);
}

// Two test files may have types, templates and inline functions of one name: outside a namespace without a
// name the linker would keep one of them for both.
TEST_CASE("what a test file defines for itself stands in a namespace without a name", "[layering]") {
  const auto starts = [](const std::string& line, const std::string& word) {
    return line.rfind(word, 0) == 0;
  };
  int files = 0;
  for (const auto& entry : fs::directory_iterator(fs::path(drape::test::source_dir()) / "tests")) {
    if (entry.path().extension() != ".cpp") continue;
    ++files;
    std::ifstream file(entry.path());
    bool inside = false;
    for (std::string line; std::getline(file, line);) {
      if (starts(line, "namespace {")) inside = true;
      if (starts(line, "}  // namespace")) inside = false;
      if (inside) continue;
      INFO(entry.path().filename() << ": " << line);
      for (const char* word : {"struct ", "class ", "enum ", "template ", "template<", "inline "})
        CHECK_FALSE(starts(line, word));
    }
  }
  CHECK(files > 100);
}

TEST_CASE("Python is known in app/python only", "[layering]") {
  int bindings = 0;
  for (const std::string& room : rooms)
    for (const auto& [file, path] : includes(room)) {
      if (!path.starts_with("pybind11") && path != "Python.h") continue;
      INFO(file << " includes " << path);
      CHECK(file.starts_with("app/python/"));
      ++bindings;
    }
  CHECK(bindings > 3);
}

TEST_CASE("of the internal headers only those of SUNDIALS show a library besides Eigen", "[layering]") {
  for (const std::string& room : rooms)
    for (const auto& [file, path] : includes(room)) {
      if (!file.ends_with(".h") || file == "solver/linear/sundials.h") continue;
      INFO(file << " includes " << path);
      const std::string folder = path.substr(0, path.find('/'));
      const bool ours = level(folder) < rooms.size() || path == "immintrin.h";       // the compiler's
      const bool binding = folder == "pybind11" && file.starts_with("app/python/");  // what it is made of
      CHECK((ours || binding || path.starts_with("Eigen/") || path.find('.') == path.npos));
    }
}

// What a file may open at the left margin. A name that two files give to different types is a fault that only
// the linker could see, so what is not offered to users keeps out of the namespace of what is.
TEST_CASE(
    "public names of the library are in drape, its other names in drape::internal, the program's in "
    "drape::app",
    "[layering]") {
  std::set<std::string> public_headers = {"solver/drape.h", "app/app.h"};
  for (const std::string& room : rooms) public_headers.merge(installed(room));
  int looked_at = 0;
  for (const std::string& room : rooms)
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(drape::test::source_dir()) / room)) {
      const std::string file = fs::relative(entry.path(), drape::test::source_dir()).string();
      const bool header = file.ends_with(".h");
      if (!header && !file.ends_with(".cpp")) continue;
      std::ifstream lines(entry.path());
      for (std::string line; std::getline(lines, line);) {
        const std::string name = line.substr(0, line.find(" {"));
        if (!name.starts_with("namespace drape")) continue;
        ++looked_at;
        INFO(file << ": " << line);
        const bool internal = name.starts_with("namespace drape::internal");
        if (room == "app")
          CHECK(name.starts_with("namespace drape::app"));
        else if (header)
          CHECK(public_headers.contains(file) == (name == "namespace drape"));
        CHECK((room == "app" || internal || name == "namespace drape"));
      }
    }
  CHECK(looked_at > 300);
}
