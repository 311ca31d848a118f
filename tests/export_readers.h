// Small readings of the exported files, written from the formats' descriptions and not from the code that
// writes them. Each gives the places of all vertices, frame by frame.
#pragma once

#include <array>
#include <bit>
#include <catch2/catch.hpp>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "mesh/base/vectors.h"

namespace drape::test {

struct Bytes {
  const std::string& text;
  bool big = false;  // endian

  std::uint64_t word(std::size_t at, int size = 4) const {
    REQUIRE(at + static_cast<std::size_t>(size) <= text.size());
    std::uint64_t value = 0;
    for (int k = 0; k < size; ++k) {
      const auto byte =
          static_cast<unsigned char>(text[at + static_cast<std::size_t>(big ? k : size - 1 - k)]);
      value = value << 8 | byte;
    }
    return value;
  }
  int integer(std::size_t at) const { return static_cast<int>(word(at)); }
  float number(std::size_t at) const { return std::bit_cast<float>(static_cast<std::uint32_t>(word(at))); }
  std::vector<Vec3> vectors(std::size_t at, std::size_t count) const {
    std::vector<Vec3> found;
    for (std::size_t i = 0; i < count; ++i)
      found.emplace_back(number(at + 12 * i), number(at + 12 * i + 4), number(at + 12 * i + 8));
    return found;
  }
};

using Places = std::vector<std::vector<Vec3>>;  // of each frame

// What is behind the first `mark` in the text.
inline std::size_t behind(const std::string& text, const std::string& mark, std::size_t from = 0) {
  const std::size_t at = text.find(mark, from);
  INFO(mark);
  REQUIRE(at != text.npos);
  return at + mark.size();
}

inline int number_behind(const std::string& text, const std::string& mark) {
  return std::stoi(text.substr(behind(text, mark), 12));
}

inline Places read_mdd(const std::string& text) {
  const Bytes bytes{text, true};
  const auto frames = static_cast<std::size_t>(bytes.integer(0)),
             points = static_cast<std::size_t>(bytes.integer(4));
  REQUIRE(text.size() == 8 + 4 * frames + 12 * frames * points);
  Places places;
  for (std::size_t k = 0; k < frames; ++k)
    places.push_back(bytes.vectors(8 + 4 * frames + 12 * points * k, points));
  return places;
}

struct ReadPolygons {
  std::vector<Vec3> places;
  std::vector<std::array<float, 2>> uv;
  std::vector<std::vector<int>> faces;  // of a .vtp file without faces, its lines
  std::vector<std::array<int, 2>> edges;
};

inline ReadPolygons read_ply(const std::string& text) {
  const Bytes bytes{text};
  const bool has_uv = text.find("property float t\n") != text.npos;
  const int vertices = number_behind(text, "element vertex "), faces = number_behind(text, "element face ");
  const int edges = text.find("element edge ") == text.npos ? 0 : number_behind(text, "element edge ");
  std::size_t at = behind(text, "end_header\n");
  ReadPolygons read;
  for (int i = 0; i < vertices; ++i) {
    read.places.push_back(bytes.vectors(at, 1).front());
    at += 12;
    if (!has_uv) continue;
    read.uv.push_back({bytes.number(at), bytes.number(at + 4)});
    at += 8;
  }
  const int size = text.find("property list uint ") != text.npos ? 4 : 1;
  for (int f = 0; f < faces; ++f) {
    const auto corners = bytes.word(at, size);
    at += static_cast<std::size_t>(size);
    read.faces.emplace_back();
    for (std::uint64_t k = 0; k < corners; ++k, at += 4) read.faces.back().push_back(bytes.integer(at));
  }
  for (int e = 0; e < edges; ++e, at += 8) read.edges.push_back({bytes.integer(at), bytes.integer(at + 4)});
  CHECK(at == text.size());
  return read;
}

// Of a .vtp file.
inline ReadPolygons read_vtp(const std::string& text) {
  const Bytes bytes{text};
  const std::size_t data = behind(text, "<AppendedData encoding=\"raw\">\n_");
  const auto block = [&](const std::string& name) {
    const std::size_t element = behind(text, "Name=\"" + name + "\"");
    return data + static_cast<std::size_t>(std::stoi(text.substr(behind(text, "offset=\"", element), 12)));
  };
  ReadPolygons read;
  const std::size_t points = block("Points");
  read.places = bytes.vectors(points + 8, bytes.word(points, 8) / 12);
  const std::size_t ends = block("offsets"), corners = block("connectivity");
  int begin = 0;
  for (std::size_t f = 0; f < bytes.word(ends, 8) / 4; ++f) {
    const int end = bytes.integer(ends + 8 + 4 * f);
    read.faces.emplace_back();
    for (int k = begin; k < end; ++k)
      read.faces.back().push_back(bytes.integer(corners + 8 + 4 * static_cast<std::size_t>(k)));
    begin = end;
  }
  return read;
}

// The positions of one mesh by its morph targets. Its node does not move.
inline Places read_glb(const std::string& text, const std::string& name) {
  const Bytes bytes{text};
  REQUIRE(text.substr(0, 4) == "glTF");
  REQUIRE(bytes.word(8) == text.size());
  const std::size_t length = bytes.word(12), binary = 20 + length + 8;
  REQUIRE(text.substr(16, 4) == "JSON");
  REQUIRE(text.substr(binary - 4, 4) == std::string("BIN\0", 4));
  const auto json = nlohmann::json::parse(text.substr(20, length));
  const auto vectors = [&](const nlohmann::json& accessor_number) {
    const auto& accessor = json["accessors"][accessor_number.get<std::size_t>()];
    const auto& view = json["bufferViews"][accessor["bufferView"].get<std::size_t>()];
    return bytes.vectors(binary + view["byteOffset"].get<std::size_t>(),
                         accessor["count"].get<std::size_t>());
  };
  for (const auto& mesh : json["meshes"]) {
    if (mesh["name"] != name) continue;
    const auto& primitive = mesh["primitives"][0];
    Places places{vectors(primitive["attributes"]["POSITION"])};
    for (const auto& target : primitive.value("targets", nlohmann::json::array())) {
      std::vector<Vec3> now = vectors(target["POSITION"]);
      for (std::size_t i = 0; i < now.size(); ++i) now[i] += places.front()[i];
      places.push_back(now);
    }
    return places;
  }
  FAIL("no mesh " + name);
  return {};
}

// "(1, 2, 3), (4, 5, 6)]": up to the end of the line.
inline std::vector<Vec3> tuples_in(const std::string& line) {
  std::vector<Vec3> found;
  for (std::size_t at = line.find('('); at != line.npos; at = line.find('(', at + 1)) {
    std::istringstream numbers(line.substr(at + 1, 80));
    Vec3 x;
    char comma = 0;
    numbers >> x[0] >> comma >> x[1] >> comma >> x[2];
    REQUIRE(numbers);
    found.push_back(x);
  }
  return found;
}

// The points of the first Mesh, or other kind, with this prim name.
inline Places read_usda(const std::string& text, const std::string& prim, const std::string& kind = "Mesh") {
  std::istringstream lines(text.substr(
      behind(text, "point3f[] points.timeSamples = {\n", behind(text, "def " + kind + " \"" + prim + "\""))));
  Places places;
  for (std::string line; std::getline(lines, line) && line.find('}') == line.npos;)
    places.push_back(tuples_in(line));
  return places;
}

inline Places read_table(const std::string& text) {
  std::istringstream lines(text);
  std::string line;
  std::getline(lines, line);
  Places places;
  std::string frame;
  while (std::getline(lines, line)) {
    std::istringstream cells(line);
    std::string number, time, vertex, x, y, z;
    for (std::string* cell : {&number, &time, &vertex, &x, &y, &z}) std::getline(cells, *cell, ',');
    if (number != frame) places.emplace_back();
    frame = number;
    CHECK(std::stoul(vertex) == places.back().size());
    places.back().emplace_back(std::stod(x), std::stod(y), std::stod(z));
  }
  return places;
}

}  // namespace drape::test
