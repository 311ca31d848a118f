// What turns goes on turning, as closed forms say, with one linear solve a step.
#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "solver/assembly/assembly.h"
#include "solver/integrators/rigid_motion.h"
#include "tests/sheets.h"

using namespace drape;
using namespace drape::test;

namespace {

constexpr double turn = 2 * 3.14159265358979323846;  // rad
const Fabric poplin{.area_density = 0.12, .stretch = 500, .bend = 8e-6};

ClothPart part(TriangleMesh mesh, ClothModel model, const Fabric& fabric = poplin) {
  return {.mesh = std::move(mesh), .fabric = fabric, .model = model, .imperfection = 0};
}

void go(Assembly& all, double h, double duration) {
  for (int k = 0; k < std::lround(duration / h); ++k) {
    const StepReport report = all.advance(h);
    INFO("step " << k << ": " << report.failure.what);
    REQUIRE(report.done);
    REQUIRE(report.converged);
  }
}

// About the centre of mass, along y.
double angular_momentum(const Assembly& all) {
  Vec3 middle = Vec3::Zero(), sum = Vec3::Zero();
  double mass = 0;
  const std::vector<double>& masses = all.system->masses();
  for (int i = 0; i < all.state.particles(); ++i) {
    middle += masses[i] * all.state.x.segment<3>(3 * i);
    mass += masses[i];
  }
  middle /= mass;
  for (int i = 0; i < all.state.particles(); ++i)
    sum += masses[i] * Vec3(all.state.x.segment<3>(3 * i) - middle).cross(all.state.v.segment<3>(3 * i));
  return sum.y();
}

// How fast it turns about y, as a rigid body of the same angular momentum would [rad/s].
double spin(const Assembly& all) {
  double inertia = 0;
  for (int i = 0; i < all.state.particles(); ++i) {
    const Vec3 x = all.state.x.segment<3>(3 * i);
    inertia += all.system->masses()[i] * (x.x() * x.x() + x.z() * x.z());
  }
  return angular_momentum(all) / inertia;
}

TriangleMesh flat(int n, Kind kind, double size, double height = 0) {
  return bent(n, kind, size, [height](double, double) { return height; });
}

std::vector<ParticlePair> chain(int first, int count) {
  std::vector<ParticlePair> pairs;
  for (int k = 1; k < count; ++k) pairs.push_back({first + k - 1, first + k});
  return pairs;
}

}  // namespace

TEST_CASE("a piece that turns as a rigid body goes on as one", "[integrators]") {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> number(-1, 1);
  const auto any = [&] { return Vec3(number(random), number(random), number(random)); };
  for (const int count : {1, 2, 3, 12})  // a point, a line, a triangle, a heap
    for (const double angle : {0.0, 0.01, 0.3, 2.0}) {
      INFO(count << " particles that turn by " << angle << " rad");
      constexpr double h = 0.01;
      std::vector<ParticlePair> pairs = chain(0, count);
      for (const ParticlePair& p : chain(count, count)) pairs.push_back(p);
      RigidMotion motion;
      motion.follow(BlockPattern(2 * count, pairs));
      const Vec3 axis = any().normalized(), centre = 100 * any(), way = any();
      // By Cayley's formula this t turns by the angle.
      const Vec3 t = std::tan(0.5 * angle) * axis;
      const Mat3 turned = Eigen::AngleAxisd(angle, axis).toRotationMatrix();
      VecX x(6 * count), v(6 * count);
      std::vector<double> mass;
      for (int i = 0; i < 2 * count; ++i) {
        const Vec3 r = any(), velocity = (2 * t.cross(r) + way) / h;
        x.segment<3>(3 * i) = centre + r;
        v.segment<3>(3 * i) = i < count ? velocity : Vec3(-velocity);  // the other piece goes the other way
        mass.push_back(0.5 + 0.4 * number(random));
      }
      const VecX before = x;
      motion.go_on(mass, std::vector<char>(mass.size(), 0), h, v, x);
      for (const int first : {0, count}) {
        Vec3 middle = Vec3::Zero(), goes = Vec3::Zero();
        double sum = 0;
        for (int i = first; i < first + count; ++i) {
          middle += mass[i] * before.segment<3>(3 * i);
          goes += mass[i] * h * v.segment<3>(3 * i);
          sum += mass[i];
        }
        middle /= sum;
        goes /= sum;
        const Mat3 R = first == 0 ? turned : Mat3(turned.transpose());
        for (int i = first; i < first + count; ++i) {
          const Vec3 expected = middle + goes + R * (before.segment<3>(3 * i) - middle);
          const Vec3 off = x.segment<3>(3 * i) - expected;
          if (count > 2 && angle > 0) CHECK(off.norm() < 1e-5 * (1 + t.norm()));
        }
        // One that does not turn may as well stay where it is: that changes nothing of its forces.
        // How fast two points turn about the line between them nobody knows, nor by which angle in all.
        const auto apart = [&](const VecX& at) {
          return (at.segment<3>(3 * first + 3 * count - 3) - at.segment<3>(3 * first)).norm();
        };
        CHECK(apart(x) == Approx(apart(before)).epsilon(1e-12));
      }
    }
}

namespace {

// A sheet of rows x columns vertices, `edge` apart along x and y, that turns about z or about x by `rate`
// [rad/s].
struct Turning {
  Turning(int rows, int columns, double edge, const Vec3& rate) : x(3 * rows * columns), v(x.size()) {
    std::vector<ParticlePair> pairs;
    for (int r = 0; r < rows; ++r)
      for (int c = 0; c < columns; ++c) {
        const int i = r * columns + c;
        x.segment<3>(3 * i) = 100 * Vec3::Ones() + edge * Vec3(c, -r, 0);
        v.segment<3>(3 * i) = rate.cross(edge * Vec3(c, -r, 0));
        if (c > 0) pairs.push_back({i - 1, i});
        if (r > 0) pairs.push_back({i - columns, i});
      }
    motion.follow(BlockPattern(rows * columns, pairs));
    held.assign(static_cast<std::size_t>(rows * columns), 0);
    mass.assign(held.size(), 1e-3);
  }
  VecX after(double h) {
    VecX to = x;
    motion.go_on(mass, held, h, v, to);
    return to;
  }

  RigidMotion motion;
  VecX x, v;
  std::vector<char> held;
  std::vector<double> mass;
};

}  // namespace

TEST_CASE("a piece goes on as what holds it lets it", "[integrators]") {
  constexpr double h = 0.01, rate = 5;  // s, rad/s
  const auto error = [](const Turning& sheet, const VecX& after, const Vec3& axis) {
    double most = 0;
    const Vec3 pivot = sheet.x.head<3>(), goes = after.head<3>() - pivot;
    for (int i = 0; i < sheet.x.size() / 3; ++i) {
      const Vec3 to = pivot + goes + Eigen::AngleAxisd(rate * h, axis) * (sheet.x.segment<3>(3 * i) - pivot);
      const double from_pivot = (sheet.x.segment<3>(3 * i) - pivot).norm();
      most = std::max(most, (after.segment<3>(3 * i) - to).norm() / (1e-3 + from_pivot));
    }
    return most;
  };
  // Cayley's turn by 2 atan(w h / 2) is that of w h but for (w h)^3 / 12.
  for (const auto& [rows, columns] : {std::pair{7, 61}, {61, 7}, {12, 12}, {3, 200}}) {
    INFO(rows << " x " << columns << " vertices");
    Turning valance(rows, columns, 0.05, {rate, 0, 0});  // about the upper edge, all of which is held
    std::fill(valance.held.begin(), valance.held.begin() + columns, 1);
    CHECK(error(valance, valance.after(h), Vec3::UnitX()) < 2e-5);
    valance.held.assign(valance.held.size(), 0);
    valance.held[0] = valance.held[columns - 1] = 1;  // or two of its corners
    CHECK(error(valance, valance.after(h), Vec3::UnitX()) < 2e-5);
    Turning flag(rows, columns, 0.05, {0, 0, rate});  // about one corner
    flag.held[0] = 1;
    CHECK(error(flag, flag.after(h), Vec3::UnitZ()) < 2e-5);
    CHECK((flag.after(h) - flag.x).head<3>().norm() < 1e-12);
    flag.held[0] = 0;
    flag.mass[0] = 0;  // what has no mass is held, too
    CHECK(error(flag, flag.after(h), Vec3::UnitZ()) < 2e-5);
    CHECK((valance.after(h) - valance.x).head<3>().norm() < 1e-12);
    // Clamped by two rows, it stands, however long it is and however its free part moves.
    Turning strip(rows, columns, 0.05, {rate, 0, 0});
    std::fill(strip.held.begin(), strip.held.begin() + 2 * columns, 1);
    strip.v.head(6 * columns).setZero();
    CHECK(strip.after(h) == strip.x);
    // What is held turns as what holds it, whatever the rest does.
    Turning driven(rows, columns, 0.05, {0, 0, rate});
    std::fill(driven.held.begin(), driven.held.begin() + 2 * columns, 1);
    for (Eigen::Index k = 6 * columns; k < driven.v.size(); ++k) driven.v[k] *= 0.8;
    CHECK(error(driven, driven.after(h), Vec3::UnitZ()) < 2e-5);
    // A sheet that falls, of which two corners have just been stopped, does not turn about these.
    Turning fallen(rows, columns, 0.05, Vec3::Zero());
    for (int i = 0; i < fallen.x.size() / 3; ++i) fallen.v[3 * i + 2] = -2;
    for (const int corner : {0, columns - 1}) {
      fallen.held[corner] = 1;
      fallen.v.segment<3>(3 * corner).setZero();
    }
    CHECK(fallen.after(h) == fallen.x);
  }
}

TEST_CASE("what turns freely loses what implicit Euler takes, and no more", "[integrators]") {
  // On a circle each step divides a speed by 1 + (w h)^2:  w = w_0 / sqrt(1 + 2 h w_0^2 t).
  for (const ClothModel model : {ClothModel::woven, ClothModel::noh_jung})
    for (const Kind kind : kinds)
      for (const int n : {5, 9, 17})
        for (const double turns : {0.5, 2.0}) {
          INFO((model == ClothModel::woven ? "woven" : "springs")
               << ", mesh " << static_cast<int>(kind) << ", " << n << " vertices along an edge, " << turns
               << " turns a second");
          Assembly all(Vec3::Zero());
          all.add(part(flat(n, kind, 0.3), model));
          all.use("implicit-euler", "auto");
          const double rate = turns * turn, h = 0.01, duration = 0.5;
          for (int i = 0; i < all.state.particles(); ++i)
            all.state.v.segment<3>(3 * i) = Vec3(0, rate, 0).cross(Vec3(all.state.x.segment<3>(3 * i)));
          const double before = angular_momentum(all);
          go(all, h, duration);
          CHECK(angular_momentum(all) / before ==
                Approx(1 / std::sqrt(1 + 2 * h * rate * rate * duration)).epsilon(0.02));
        }
}

TEST_CASE("a plate that swings about a hinge is at its lowest when theory says", "[integrators]") {
  // A quarter of the period of a thin plate that is let go level: K(sin 45 deg) / sqrt(3 g / (2 L)).
  constexpr double length = 0.3, quarter = 1.8540746773;
  const Fabric stiff{.area_density = 0.2, .stretch = 2000, .bend = 0.05};
  for (const Kind kind : kinds)
    for (const int n : {5, 9, 17})
      for (const double h : {0.01, 0.005}) {
        INFO("mesh " << static_cast<int>(kind) << ", " << n << " vertices along an edge, " << h << " s");
        Assembly all({0, -9.81, 0});
        TriangleMesh plate =
            kind == Kind::equilateral ? equilateral_sheet(n, n, length / (n - 1)) : flat(n, kind, length);
        double least = 1;  // the hinge is along the edge with the least z
        for (const Vec3& p : plate.positions) least = std::min(least, p.z());
        std::vector<int> hinge;
        for (int i = 0; i < plate.vertex_count(); ++i)
          if (plate.positions[i].z() < least + 0.3 * length / (n - 1)) hinge.push_back(i);
        double reach = 0;
        for (Vec3& p : plate.positions) {
          if (std::find(hinge.begin(), hinge.end(), &p - plate.positions.data()) != hinge.end())
            p.z() = least;
          reach = std::max(reach, p.z() - least);
        }
        all.add(part(plate, ClothModel::woven, stiff));
        all.pin(PinVertices{hinge});
        all.use("implicit-euler", "auto");
        const auto out = [&] {  // of the centre of mass, from the hinge
          double sum = 0, mass = 0;
          for (int i = 0; i < all.state.particles(); ++i) {
            sum += all.system->masses()[i] * (all.state.x[3 * i + 2] - least);
            mass += all.system->masses()[i];
          }
          return sum / mass;
        };
        double lowest = 0;
        for (double before = out(); lowest == 0 && all.state.time < 0.5; before = out()) {
          go(all, h, h);
          if (out() <= 0) lowest = all.state.time - h * out() / (out() - before);
        }
        // Irregular edges and the masses of corners move the centre of mass by a little.
        CHECK(lowest == Approx(quarter / std::sqrt(1.5 * 9.81 / reach)).epsilon(0.04));
      }
}

TEST_CASE("what lies on a table that turns comes to turn with it", "[contact]") {
  // Friction gives a disc of radius R the speed of the table within some w R / (mu g).
  const double rate = turn;
  const auto turns_with_the_table = [&](Assembly& all) {
    all.constraints->add(Obstacle{.shape = Plane{Vec3::Zero(), Vec3::UnitY()},
                                  .friction = 0.3,
                                  .motion = Motion::constant(Vec3::Zero(), {0, rate, 0}, Vec3::Zero())});
    all.use("implicit-euler", "auto");
    go(all, 0.01, 1);
    CHECK(spin(all) == Approx(rate).epsilon(0.01));
  };
  for (const ClothModel model : {ClothModel::woven, ClothModel::noh_jung})
    for (const Kind kind : kinds)
      for (const int n : {5, 9, 17}) {
        INFO((model == ClothModel::woven ? "woven" : "springs")
             << ", mesh " << static_cast<int>(kind) << ", " << n << " vertices along an edge");
        Assembly all({0, -9.81, 0});
        all.add(part(flat(n, kind, 0.2, 0.002), model));
        turns_with_the_table(all);
      }
  for (const int segments : {5, 20, 40}) {
    INFO("a rope of " << segments << " segments");
    std::vector<Vec3> points;
    for (int k = 0; k <= segments; ++k) points.emplace_back(0.4 * k / segments - 0.2, 0.007, 0);
    Assembly all({0, -9.81, 0});
    all.add(
        RopePart{.points = points, .material = {.mass_per_length = 0.05, .stretch = 1e4, .radius = 0.005}});
    turns_with_the_table(all);
  }
}
