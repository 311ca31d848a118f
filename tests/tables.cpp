#include "tests/tables.h"

#include <Eigen/Geometry>
#include <cstring>
#include <fstream>
#include <random>
#include <sstream>
#include <stdexcept>

#include "solver/forces/tension_spring.h"

namespace drape::test {

std::vector<std::vector<double>> reference_table(const std::string& name) {
  std::ifstream file(source_dir() + "/data/reference/" + name);
  if (!file) throw std::runtime_error("no data/reference/" + name);
  std::vector<std::vector<double>> rows;
  bool header = true;
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || line[0] == '#') continue;
    if (std::exchange(header, false)) continue;
    std::vector<double> row;
    std::istringstream cells(line);
    for (std::string cell; std::getline(cells, cell, ',');) row.push_back(std::stod(cell));
    rows.push_back(row);
  }
  return rows;
}

VecX random_vector(Eigen::Index n, double size, unsigned seed) {
  std::mt19937 engine(seed);
  std::uniform_real_distribution<double> uniform(-size, size);
  VecX v(n);
  for (Eigen::Index i = 0; i < n; ++i) v[i] = uniform(engine);
  return v;
}

Mat3 rotation(double angle, const Vec3& axis) {
  return Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix();
}

VecX moved_rigidly(const VecX& x, const Mat3& R, const Vec3& t) {
  VecX y = x;
  for (Eigen::Index i = 0; i < x.size() / 3; ++i) y.segment<3>(3 * i) = R * x.segment<3>(3 * i) + t;
  return y;
}

namespace {

std::vector<double> chain_masses(int links, double mass) {
  std::vector<double> m(static_cast<std::size_t>(links) + 1, mass / links);
  m.front() = m.back() = 0.5 * mass / links;
  return m;
}

}  // namespace

Chain::Chain(int links, double length, double mass, double stiffness, const Vec3& direction)
    : system(chain_masses(links, mass)) {
  std::vector<PairForce<TensionSpring>::Element> elements;
  for (int k = 0; k < links; ++k)
    elements.push_back({k, k + 1, {length / links, stiffness * links / length}});
  system.add(std::make_unique<PairForce<TensionSpring>>(std::move(elements)));
  state = {0, VecX(3 * (links + 1)), VecX::Zero(3 * (links + 1))};
  for (int k = 0; k <= links; ++k) state.x.segment<3>(3 * k) = direction * (length * k / links);
}

Sheet::Sheet(TriangleMesh m, const Fabric& fabric)
    : mesh(std::move(m)), system(lumped_mass(mesh, fabric.area_density)), state(at_rest(mesh)) {
  system.add(noh_jung(mesh, fabric));
  system.add(Gravity{});
}

ImplicitEuler Sheet::stepper(const StepOptions& options) {
  return {system, constraints, make_linear_solver("mpcg"), options};
}

double Sheet::energy() const {
  return system.elastic_energy(state.x) + system.kinetic_energy(state.v) + system.gravity_energy(state.x);
}

HungSheet::HungSheet(int side, double stretch, double bend)
    : Sheet(grid(side, side, 1, 1), {.area_density = 0.2, .stretch = stretch, .bend = bend}) {
  constraints.pin({0, side - 1});
}

bool same_bits(const VecX& a, const VecX& b) {
  return a.size() == b.size() &&
         std::memcmp(a.data(), b.data(), static_cast<std::size_t>(a.size()) * sizeof(double)) == 0;
}

double max_speed(const State& state) {
  double fastest = 0;
  for (int i = 0; i < state.particles(); ++i) fastest = std::max(fastest, state.v.segment<3>(3 * i).norm());
  return fastest;
}

}  // namespace drape::test
