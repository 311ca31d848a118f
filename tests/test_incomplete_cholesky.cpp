// Laws of block-ic0 on matrices in which parts of the cloth that are far apart in it touch each other.
#include <catch2/catch.hpp>
#include <set>

#include "mesh/base/threads.h"
#include "solver/forces/noh_jung.h"
#include "solver/forces/stencil_force.h"
#include "solver/forces/woven.h"
#include "solver/linear/elimination_order.h"
#include "solver/linear/pcg.h"
#include "tests/outside/forces.h"
#include "tests/sheets.h"
#include "tests/tables.h"

using namespace drape;
using namespace drape::internal;
using namespace drape::test;

namespace {

// Sheets that lie on each other: on every triangle presses a vertex of the sheet above, and one of the sheet
// below.
struct Pile {
  using Springs = StencilForce<PointTriangleLaw>;
  static constexpr double h = 0.01, gap = 0.001;
  int of_sheet;
  int every = 1;  // each contact of so many is there when the next matrix is assembled; 0: none
  System system;
  BlockMatrix A;
  VecX x;

  // kappa: the stiffness of a contact is kappa m/h^2, m the mass of a vertex in the middle of a sheet.
  Pile(Kind kind, int side, int sheets, bool as_woven, double kappa)
      : Pile(bent(side, kind, 0.5, [](double, double) { return 0; }), sheets, as_woven, kappa) {}

  void assemble() {
    const VecX still = VecX::Zero(x.size());
    VecX unused = still;
    system.begin_step({0, h, x, still});
    A.set_to_mass(system.masses());
    for (const auto& force : system.forces())
      force->add_linearised(x, still, still, h, Stiffness::tangent, A, unused);
  }

 private:
  Pile(const TriangleMesh& sheet, int sheets, bool as_woven, double kappa)
      : Pile(sheet, piled(sheet, sheets), sheets, as_woven, kappa) {}
  Pile(const TriangleMesh& sheet, const TriangleMesh& pile, int sheets, bool as_woven, double kappa)
      : of_sheet(sheet.vertex_count()),
        system(lumped_mass(pile, 0.2)),
        A(add_forces(pile, sheets, as_woven, kappa)),
        x(at_rest(pile).x) {
    assemble();
  }

  static TriangleMesh piled(const TriangleMesh& sheet, int sheets) {
    TriangleMesh pile;
    for (int k = 0; k < sheets; ++k) {
      for (const Vec3& p : sheet.positions) pile.positions.push_back(p + Vec3(0, k * gap, 0));
      for (auto t : sheet.triangles) {
        for (int& v : t) v += k * sheet.vertex_count();
        pile.triangles.push_back(t);
      }
    }
    return pile;
  }

  BlockMatrix add_forces(const TriangleMesh& pile, int sheets, bool as_woven, double kappa) {
    const Fabric fabric{.area_density = 0.2, .stretch = 1000, .bend = 1e-5};
    system.add(as_woven ? woven(pile, pile, fabric) : noh_jung(pile, fabric));
    const int n = of_sheet;
    const double k = kappa * 0.2 * 0.25 / n / (h * h);
    std::vector<Springs::Element> contacts;
    for (std::size_t t = 0; t < pile.triangles.size(); ++t) {
      const auto triangle = pile.triangles[t];
      for (const int towards : {1, -1}) {
        const int above = triangle[t % 3] + towards * n;
        if (kappa == 0 || above < 0 || above >= n * sheets) continue;
        contacts.push_back({{above, triangle[0], triangle[1], triangle[2]},
                            {{0.5, 0.2, 0.3}, Vec3(0.1, towards, 0.05).normalized(), 2 * gap, k}});
      }
    }
    system.add(
        std::make_unique<Springs>([this, contacts](const StepStart&, std::vector<Springs::Element>& found) {
          found.clear();
          for (std::size_t c = 0; every > 0 && c < contacts.size(); c += static_cast<std::size_t>(every))
            found.push_back(contacts[c]);
          return true;
        }));
    return system.matrix();
  }
};

// Is made of a matrix that has the diagonal of the whole, and nothing of the overlay beside it.
class WithoutFar final : public Preconditioner {
 public:
  WithoutFar(BlockMatrix base, const BlockMatrix& whole) : base_(std::move(base)) {
    std::vector<DiagonalBlock> more;
    for (int r = 0; r < base_.rows(); ++r) {
      const int slot = base_.pattern().diagonal(r);
      more.push_back({r, whole.at(slot) - base_.at(slot)});
    }
    base_.set_diagonal_additions(more);
  }
  std::string_view name() const override { return "without-far"; }
  bool prepare(const BlockMatrix&, const Filter& filter, LinearReport& report) override {
    return inner_->prepare(base_, filter, report);
  }
  bool make_safer(const BlockMatrix&, const Filter& filter, LinearReport& report) override {
    return inner_->make_safer(base_, filter, report);
  }
  void apply(const VecX& r, VecX& s) override { inner_->apply(r, s); }

 private:
  BlockMatrix base_;
  std::unique_ptr<Preconditioner> inner_ = make_block_ic0();
};

// Solves where some vertices are held, and others slide on planes.
LinearReport solved(const BlockMatrix& A, std::unique_ptr<Preconditioner> preconditioner) {
  Filter filter;
  filter.constrain(0, Mat3::Zero(), Vec3::Zero());
  for (int i = 5; i < A.rows(); i += 3) {
    const Vec3 normal = Vec3(1, 0.1 * (i % 7), -0.2).normalized();
    filter.constrain(i, Mat3::Identity() - normal * normal.transpose(), Vec3::Zero());
  }
  filter.renumber(A.pattern().row_of());
  const VecX b = random_vector(3 * A.rows(), 1, 5);
  VecX dv = VecX::Zero(b.size());
  const LinearReport report =
      make_pcg("pcg", false, std::move(preconditioner))->solve(A, b, filter, {.tolerance = 1e-6}, dv);
  REQUIRE(report.reason == StopReason::converged);
  return report;
}

}  // namespace

TEST_CASE("a factor that knows what presses layers together takes two thirds of the iterations at most",
          "[solvers]") {
  for (const Kind kind : kinds)
    for (const int side : {8, 14, 24})
      for (const bool as_woven : {false, true}) {
        const Pile alone(kind, side, 6, as_woven, 0);
        int all_with = 0, all_without = 0;
        for (const double kappa : {30.0, 300.0, 3000.0}) {
          INFO("kind " << static_cast<int>(kind) << ", " << side << (as_woven ? ", woven, " : ", ") << kappa);
          const Pile pressed(kind, side, 6, as_woven, kappa);
          REQUIRE(pressed.A.overlay().blocks() > pressed.of_sheet);
          const LinearReport with = solved(pressed.A, make_block_ic0()),
                             without = solved(pressed.A, std::make_unique<WithoutFar>(alone.A, pressed.A));
          CHECK(with.iterations < without.iterations);
          CHECK(with.shift == 0);
          all_with += with.iterations;
          all_without += without.iterations;
        }
        CHECK(3 * all_with < 2 * all_without);
      }
}

TEST_CASE("an order of elimination has every block once, and no block couples two chunks of one colour",
          "[solvers]") {
  const ThreadsRestored restored;
  EliminationOrder kept;  // uses its memory again
  for (const int sheets : {1, 2, 6, 40, 3, 1})
    for (const int side : {2, 5, 8, 20, 32}) {
      if (sheets * side > 400) continue;
      INFO(sheets << " sheets of " << side);
      const Pile pile(Kind::squares, side, sheets, false, 30);
      set_threads(7);
      kept.build(pile.A);
      set_threads(1);
      REQUIRE(kept.rows() == pile.A.rows());
      std::vector<int> place(kept.rows(), -1), colour(kept.rows(), -1), chunk(kept.rows(), -1);
      int chunks = 0;
      for (int c = 0; c < kept.colours(); ++c)
        kept.for_chunks_of(c, [&](int begin, int end) {
          for (int i = begin; i < end; ++i) {
            CHECK(place[kept.row(i)] == -1);
            place[kept.row(i)] = i;
            colour[i] = c;
            chunk[i] = chunks;
          }
          ++chunks;
        });
      CHECK(chunks <= 8);
      CHECK(kept.colours() <= 2);
      if (kept.rows() > 2000) CHECK(chunks >= 4);  // so that two threads have work in each colour
      if (sheets == 1)                             // nothing touches: rows come as in the matrix
        for (int i = 1; i < kept.rows(); ++i)
          CHECK((chunk[i] != chunk[i - 1] || kept.row(i) == kept.row(i - 1) + 1));
      std::set<int> slots;
      for (int i = 0; i < kept.rows(); ++i) {
        CHECK(colour[i] >= 0);
        CHECK(kept.blocks()[kept.start(i)].column == i);
        for (int k = kept.start(i); k < kept.start(i + 1); ++k) {
          const int j = kept.blocks()[k].column;
          CHECK(slots.insert(kept.blocks()[k].slot).second);
          CHECK((k == kept.start(i) || j > kept.blocks()[k - 1].column));
          CHECK((chunk[i] == chunk[j] || colour[i] < colour[j]));
        }
      }
      CHECK(static_cast<int>(slots.size()) == pile.A.pattern().blocks() + pile.A.overlay().blocks());
      for (int r = 0; r < pile.A.rows(); ++r)
        pile.A.each(r, [&](int c, int slot) {
          const int i = std::min(place[r], place[c]), j = std::max(place[r], place[c]);
          bool found = false;
          for (int k = kept.start(i); k < kept.start(i + 1); ++k) {
            const EliminationOrder::Block& block = kept.blocks()[k];
            found =
                found || (block.column == j && block.slot == slot && block.turned == (place[r] > place[c]));
          }
          CHECK(found);
        });
    }
}

TEST_CASE("a shift of a factor is left again, but is not tried less for every matrix", "[solvers]") {
  Pile pile(Kind::squares, 10, 3, false, 30);
  const auto ic0 = make_block_ic0();
  LinearReport report;
  REQUIRE(ic0->prepare(pile.A, Filter(), report));
  REQUIRE(report.shift == 0);
  for (int k = 0; k < 3; ++k) REQUIRE(ic0->make_safer(pile.A, Filter(), report));
  double shift = report.shift;
  REQUIRE(shift > 0.01);
  int changes = 0;
  for (int k = 1; k <= 32; ++k) {
    pile.every = k % 3;  // contacts come and go meanwhile
    pile.assemble();
    for (int round = 0; round < 3; ++round) {
      REQUIRE(ic0->prepare(pile.A, Filter(), report));
      CHECK(report.shift <= shift);
      changes += report.shift < shift;
      shift = report.shift;
    }
    if (k == 7) CHECK(changes == 0);
  }
  CHECK(shift == 0);
  CHECK(changes == 3);
}

TEST_CASE("a factor is the same whatever contacts there were before", "[solvers]") {
  Pile pile(Kind::squares, 20, 4, false, 3);
  const auto kept = make_block_ic0();
  const VecX r = random_vector(pile.x.size(), 1, 6);
  for (const int every : {1, 0, 2, 0, 1, 3}) {
    INFO("one of " << every);
    pile.every = every;
    pile.assemble();
    REQUIRE(pile.A.overlay().empty() == (every == 0));
    LinearReport report;
    const auto fresh = make_block_ic0();
    VecX s = r, expected = r;
    REQUIRE(kept->prepare(pile.A, Filter(), report));
    CHECK(report.analyses == 1);
    REQUIRE(fresh->prepare(pile.A, Filter(), report));
    REQUIRE(kept->prepare(pile.A, Filter(), report));
    CHECK(report.analyses == 2);  // one of each, and none for what is as it was
    CHECK(report.shift == 0);     // would be kept for a while
    kept->apply(r, s);
    fresh->apply(r, expected);
    CHECK(s == expected);
  }
}
