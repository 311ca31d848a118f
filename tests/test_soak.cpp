// Long searches for a way through cloth, by ./build.sh soak: hidden from the usual tests, which run some of
// the same cases. DRAPE_SOAK sets the number of cases, DRAPE_SOAK_DROPS that of garments that are dropped.
#include <Eigen/Geometry>
#include <cstdlib>
#include <random>

#include "constraints/self_contact.h"
#include "mesh/distance/triangle_crossings.h"
#include "tests/integrators.h"
#include "tests/places.h"
#include "tests/workshop.h"

using namespace drape;
using namespace drape::test;

namespace {

using Random = std::mt19937_64;

int from_environment(const char* name, int usual) {
  const char* const text = std::getenv(name);
  return text ? std::atoi(text) : usual;
}

double number(Random& random, double least, double most) {
  return std::uniform_real_distribution<double>(least, most)(random);
}
int whole(Random& random, int least, int most) {
  return std::uniform_int_distribution<int>(least, most)(random);
}

Mat3 any_rotation(Random& random) {
  const Eigen::Vector4d q(number(random, -1, 1), number(random, -1, 1), number(random, -1, 1),
                          number(random, 1e-3, 1));
  return Eigen::Quaterniond(q.normalized()).toRotationMatrix();
}

// Two to four small sheets with edges of about 2 cm near each other: turned, irregular, parallel at a hair's
// breadth, or slivers, and some of them far from the origin.
TriangleMesh any_sheets(Random& random) {
  TriangleMesh all;
  const int sheets = whole(random, 2, 4), kind = whole(random, 0, 4);
  const Vec3 place = kind == 4 ? Vec3(1000, -700, 300) : Vec3(0, 0, 0);
  for (int k = 0; k < sheets; ++k) {
    const int nx = whole(random, 2, 4), nz = whole(random, 2, 4);
    TriangleMesh one = grid(nx, nz, 0.02 * (nx - 1), 0.02 * (nz - 1));
    const Mat3 R = kind == 0 ? any_rotation(random) : Mat3(Mat3::Identity());
    const double thin = kind == 3 ? std::pow(10, number(random, -7, 0)) : 1;
    const Vec3 at(number(random, -0.02, 0.02), kind == 2 ? 2e-6 * k : 0.004 * k, number(random, -0.02, 0.02));
    const int first = all.vertex_count();
    for (Vec3 x : one.positions) {
      if (kind == 1)
        x += 0.005 * Vec3(number(random, -1, 1), number(random, -0.3, 0.3), number(random, -1, 1));
      x.z() *= thin;
      all.positions.push_back(R * x + at + place);
    }
    for (const Triangle& t : one.triangles)
      all.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  }
  return all;
}

double shortest_edge(const TriangleMesh& mesh) {  // m
  double shortest = 1;
  for (const Triangle& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k)
      shortest = std::min(shortest, (mesh.positions[static_cast<std::size_t>(t[k])] -
                                     mesh.positions[static_cast<std::size_t>(t[(k + 1) % 3])])
                                        .norm());
  return shortest;
}

int crossings(const TriangleMesh& mesh, const VecX& x, bool as_floats) {
  std::vector<Vec3> places = unstacked(x);
  if (as_floats)
    for (Vec3& p : places) p = p.cast<float>().cast<double>();
  return crossing_count(crossing_contours(places, mesh.triangles));
}

}  // namespace

TEST_CASE("a million motions: no cloth passes through cloth", "[.][soak]") {
  Random random(7);
  const int wanted = from_environment("DRAPE_SOAK", 1'000'000);
  int cases = 0, stopped = 0, as_floats = 0;
  while (cases < wanted) {
    const TriangleMesh mesh = any_sheets(random);
    StepMotion step;
    step.h = 0.01;
    step.x = stacked(mesh.positions);
    if (crossings(mesh, step.x, false) > 0) continue;
    // Far from the origin floats may cross from the start, and what lies nearer together than floats can tell
    // apart may do so wherever it moves.
    const bool floats = shortest_edge(mesh) > 1e-6 && crossings(mesh, step.x, true) == 0;
    const std::size_t n = mesh.positions.size();
    for (std::size_t i = 0; i < n; ++i) {
      step.masses.push_back(std::pow(10, number(random, -5, -3)));
      step.held.push_back(whole(random, 0, 9) == 0);
    }
    SelfContacts contacts;
    std::vector<SelfFace> faces;
    for (const Triangle& t : mesh.triangles) faces.push_back({t, number(random, 1e-4, 2e-3), 0.3});
    contacts.add(faces);
    for (int k = 0; k < 8 && cases < wanted; ++k, ++cases) {
      const double size = std::pow(10, number(random, -5, -0.7));  // m, up to ten edges
      const Vec3 common = whole(random, 0, 1) ? Vec3(0.1 * any_rotation(random).col(0)) : Vec3(0, 0, 0);
      VecX x_new = step.x;
      for (std::size_t i = 0; i < n; ++i)
        if (!step.held[i])
          for (int c = 0; c < 3; ++c)
            x_new[3 * static_cast<Eigen::Index>(i) + c] += common[c] + size * number(random, -1, 1);
      step.v = (x_new - step.x) / step.h;
      VecX v_new = step.v;
      contacts.begin_step(step, {}, 1e-3, SelfSprings{});
      stopped += contacts.guard({}, {}, true, x_new, v_new).guarded > 0;
      contacts.end_step(x_new);
      INFO("case " << cases << ", motion " << size << " m");
      REQUIRE(crossings(mesh, x_new, false) == 0);
      if (floats) {
        ++as_floats;
        REQUIRE(crossings(mesh, x_new, true) == 0);
      }
      step.x = x_new;
    }
  }
  WARN(cases << " motions, " << stopped << " of them stopped somewhere, " << as_floats
             << " looked at as floats");
  CHECK(stopped > cases / 4);
}

TEST_CASE("a thousand drops of garments: no frame has a crossing", "[.][soak]") {
  const Workshop shop;
  Random random(11);
  const std::vector<std::string> garments = {"tee", "dress", "poncho"};
  const std::vector<std::string> onto = {"plane", "sphere:0.25", "box:0.4x0.3x0.5", "capsule:0.1x0.5"};
  const std::vector<std::string> fabrics = {"cotton-broad", "polyester-plain", "polyester-elastane-plain"};
  const int wanted = from_environment("DRAPE_SOAK_DROPS", 1000);
  for (int drop = 0; drop < wanted; ++drop) {
    const auto any = [&](const std::vector<std::string>& of) {
      return of[static_cast<std::size_t>(whole(random, 0, static_cast<int>(of.size()) - 1))];
    };
    const std::string garment = any(garments), path = garment + ".obj";
    TriangleMesh mesh = read_obj(source_dir() + "/data/meshes/" + path);
    const Mat3 R = any_rotation(random);
    for (Vec3& x : mesh.positions) x = R * x;
    shop.write(path, format_obj(mesh, mesh.positions));
    const std::string words = "drop " + path + " --onto " + any(onto) + " --floor --fabric " + any(fabrics) +
                              " --duration 0.6 --set simulation.require_clean=true --out o --quiet";
    INFO("drop " << drop << ": " << words);
    const Outcome run = shop.drape(words);
    INFO(run.err);
    REQUIRE(run.exit_code == 0);
    CHECK(shop.json("o/run.json")["crossings"]["max"].get<int>() == 0);
  }
}
