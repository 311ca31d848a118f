// When a run steps and when it writes a frame: frame k is the state at k / rate, whatever step was asked for,
// and the last frame is the end.
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "app/recording/recording.h"
#include "app/run/run.h"
#include "app/simulation/measure.h"
#include "tests/folder.h"

using namespace drape;
using namespace drape::app;
using namespace drape::test;
using Catch::Contains;

namespace {

const std::vector<double> rates = {24, 25, 30, 50, 60};                      // 1/s
const std::vector<double> asked_steps = {0.001, 0.003, 0.005, 0.007, 0.01};  // s

struct Walk {
  std::vector<double> times, steps, frames;  // s; the first time is the start
};

Walk walked(Schedule schedule) {
  Walk walk;
  walk.times = {schedule.time()};
  if (schedule.frame()) walk.frames.push_back(schedule.time());
  while (!schedule.over()) {
    walk.steps.push_back(schedule.next_step());
    schedule.advance();
    walk.times.push_back(schedule.time());
    if (schedule.frame()) walk.frames.push_back(schedule.time());
  }
  return walk;
}

bool divides(double h, double rate) {
  const double n = 1 / (rate * h);
  return std::abs(n - std::round(n)) < 1e-9;
}

// A sheet led by a pin at 0.3 m/s, beside a ball that turns and goes at 0.7 m/s.
struct Fair : Folder {
  Fair() {
    write("sheet.obj", "v 0 0 0\nv 0 0 0.1\nv 0.1 0 0.1\nv 0.1 0 0\nf 1 2 3 4\n");
    write("s.toml", R"(
[simulation]
duration = "0.21 s"
[[cloth]]
mesh = "sheet.obj"
pins = [{ vertices = [0, 1], motion = { velocity = [0.3, 0, 0] } }]
[[obstacle]]
name = "ball"
shape = "sphere"
radius = "0.1 m"
centre = [0, -5, 0]
motion = { velocity = [0.7, 0, 0], spin = { axis = [0, 1, 0], rate = "3 rad/s" } }
)");
  }
  Scene scene(double rate, double step, const std::string& more = "simulation.threads=1") const {
    return read_scene(path / "s.toml",
                      {parse_setting("simulation.frame_rate=" + std::to_string(rate)),
                       parse_setting("simulation.time_step=" + std::to_string(step)), parse_setting(more)});
  }
};

// The state after stretches of so many seconds, each a run of its own.
std::string hash_after(const Scene& scene, const std::vector<double>& parts) {
  Simulation simulation = make_simulation(scene);
  for (const double duration : parts) {
    RunOptions options;
    options.quiet = true;
    if (duration > 0) options.duration = duration;  // else to the end of the scene
    Run part(simulation, options);
    march(part, [](const StepRow&) { return true; });
  }
  return state_hash(simulation.state);
}

}  // namespace

TEST_CASE("equal steps lead from frame to frame, and frames are at k / rate", "[frames]") {
  for (const double rate : rates)
    for (const double h : asked_steps) {
      INFO("rate " << rate << ", asked " << h);
      const StepGrid grid(h, rate);
      const Walk walk = walked(Schedule(grid, 0, 2));
      REQUIRE(walk.frames.size() == static_cast<std::size_t>(std::lround(2 * rate)) + 1);
      for (std::size_t k = 0; k < walk.frames.size(); ++k)
        CHECK(std::abs(walk.frames[k] - static_cast<double>(k) / rate) < 1e-12);
      CHECK(walk.times.back() == 2);
      CHECK(static_cast<long>(walk.steps.size()) == std::lround(2 * rate) * grid.per_frame());
      for (std::size_t i = 0; i < walk.steps.size(); ++i) {
        CHECK(walk.steps[i] == grid.step());
        CHECK(std::abs(walk.times[i + 1] - walk.times[i] - grid.step()) < 1e-14);
      }
      CHECK(grid.step() <= h * (1 + 1e-12));
      CHECK(grid.step() * static_cast<double>(grid.per_frame() + 1) > h);
      CHECK(static_cast<double>(grid.per_frame() - 1) * h < 1 / rate);  // and no shorter than they must be
      CHECK(grid.as_asked() == divides(h, rate));
      if (!divides(h, rate)) continue;
      CHECK(grid.step() == h);  // every bit
      for (std::size_t i = 0; i + 1 < walk.times.size(); ++i)
        CHECK(walk.times[i] == static_cast<double>(i) * h);
    }
}

TEST_CASE("a step longer than from frame to frame is as short as that", "[frames]") {
  const Walk walk = walked(Schedule(StepGrid(0.01, 250), 0, 0.1));
  CHECK(walk.frames.size() == 26);
  CHECK(walk.steps == std::vector<double>(25, 1.0 / 250));
}

TEST_CASE("what is left after the last frame has equal steps, too, none longer than asked", "[frames]") {
  const Walk walk = walked(Schedule(StepGrid(0.01, 25), 0, 0.055));
  CHECK(walk.times.back() == 0.055);
  REQUIRE(walk.steps.size() == 6);
  CHECK(walk.steps[4] == Approx(0.0075).epsilon(1e-12));
  CHECK(walk.steps[5] == walk.steps[4]);
  CHECK(walk.frames == std::vector<double>{0, 0.04});
  // From there on to the next frame, and then as ever.
  const Walk rest = walked(Schedule(StepGrid(0.01, 25), 0.055, 0.16));
  REQUIRE(rest.steps.size() == 3 + 8);
  CHECK(rest.steps[0] == Approx(0.025 / 3).epsilon(1e-12));
  CHECK(rest.steps[3] == 0.01);
  CHECK(rest.frames == std::vector<double>{0.08, 0.12, 0.16});
  CHECK(walked(Schedule(StepGrid(0.01, 25), 0.5, 0.5)).steps.empty());
  CHECK(walked(Schedule(StepGrid(0.01, 25), 0.5, 0.2)).steps.empty());
  // A time step and a rate of few digits.
  CHECK(StepGrid(0.033333, 30).per_frame() == 2);
  CHECK(StepGrid(0.03333333, 30).per_frame() == 1);
}

TEST_CASE("without frames the steps are those asked for, and the last is what is left", "[frames]") {
  CHECK(walked(Schedule(StepGrid(0.02), 0, 0.05)).steps.size() == 3);
  CHECK(walked(Schedule(StepGrid(0.02), 0, 0.05)).steps.back() == Approx(0.01));
  CHECK(walked(Schedule(StepGrid(0.02), 0, 0.06)).steps == std::vector<double>(3, 0.02));
  CHECK(Schedule(StepGrid(1e6), 0.4, 1e6 + 0.4).time() == 0.4);  // not the time 0, a part of a step before
  const Walk later = walked(Schedule(StepGrid(0.02), 0.06, 0.12));
  CHECK(later.times == std::vector<double>{3 * 0.02, 4 * 0.02, 5 * 0.02, 0.12});
  CHECK(walked(Schedule(StepGrid(0.02), 0.013, 0.053)).times.back() == 0.053);
}

TEST_CASE("frames of a run are at k / rate and bodies and pins where their motions say, the last at the end",
          "[frames]") {
  const Fair fair;
  for (const double rate : rates)
    for (const double h : asked_steps) {
      INFO("rate " << rate << ", asked " << h);
      const Scene scene = fair.scene(rate, h);
      Simulation simulation = make_simulation(scene);
      const Motion& motion = scene.obstacles[0].obstacle.motion;
      {
        RunOptions options;
        options.out = fair.path / "o";
        options.quiet = true;
        Run run(simulation, options);
        long frame = 0;
        march(run, [&](const StepRow& row) {
          const double next = static_cast<double>(frame + 1) / rate;
          CHECK(row.time < next + 1e-12);  // no step passes over a frame
          if (std::abs(row.time - next) > 1e-9) return true;
          ++frame;
          const Vec3 X(0.1, -5, 0.2);
          const Pose pose = simulation.constraints->bodies()[0].pose();
          CHECK((pose.to_world(X) - motion.at(next).to_world(X)).norm() < 1e-12);
          CHECK(std::abs(simulation.state.x[0] - 0.3 * next) < 1e-12);
          return true;
        });
        CHECK(frame == static_cast<long>(std::floor(0.21 * rate + 1e-9)));
        run.finish();
      }
      const Recording recording(fair.path / "o");
      REQUIRE(recording.missing().empty());
      const auto whole = static_cast<int>(std::floor(0.21 * rate + 1e-9));
      const bool ends_at_frame = std::abs(whole / rate - 0.21) < 1e-9;
      REQUIRE(recording.frames() == whole + (ends_at_frame ? 1 : 2));
      for (int k = 0; k <= whole; ++k) CHECK(std::abs(recording.time(k) - k / rate) < 1e-12);
      CHECK(recording.time(recording.frames() - 1) == 0.21);
      for (std::size_t s = 0; s < recording.shapes().size(); ++s)
        CHECK(recording.positions(s, recording.frames() - 1).front().x() ==
              Approx(recording.shapes()[s].mesh.positions.front().x()).margin(1e-6));
      const std::string json = content(fair.path / "o/run.json");
      CHECK_THAT(json, Contains("\"time_step_asked\": " + (h == 0.01 ? std::string("0.01") : "0.00")));
    }
}

TEST_CASE("the step used is told where it is not the one asked for", "[frames]") {
  const Fair fair;
  const auto said = [&](const std::string& rate) {
    return fair.drape("simulate s.toml --time-step '5 ms' --out o --set simulation.frame_rate=" + rate);
  };
  const Outcome same = said("50");
  CHECK(same.exit_code == 0);
  CHECK_THAT(same.err + same.out, !Contains("asked for") && !Contains("instead"));
  CHECK_THAT(content(fair.path / "o/run.json"),
             Contains("\"time_step\": 0.005,") && Contains("\"time_step_asked\": 0.005,"));
  const Outcome other = said("30");
  CHECK(other.exit_code == 0);
  CHECK_THAT(other.err, Contains("note: steps of 4.762 ms instead of 5 ms: 7 come to a frame at 30 Hz\n"));
  CHECK_THAT(other.out, Contains("steps of 4.762 ms between frames, 5 ms were asked for\n"));
  CHECK_THAT(content(fair.path / "o/run.json"),
             Contains("\"time_step\": 0.00476190476") && Contains("\"time_step_asked\": 0.005,"));
  CHECK_THAT(fair.drape("check s.toml").out, !Contains("instead"));
}

TEST_CASE("a run in parts is the whole, also where its steps are shortened", "[frames]") {
  const Fair fair;
  for (const double rate : {24., 25., 30., 60.}) {
    const Scene scene = fair.scene(rate, 0.005, "simulation.duration=0.5");
    const StepGrid grid(0.005, rate);
    INFO("rate " << rate);
    const std::string whole = hash_after(scene, {0});
    CHECK(hash_after(scene, {4 / rate, 3 / rate, 0}) == whole);
    CHECK(hash_after(scene, {grid.time(9), grid.time(11), 5 * grid.step(), 0}) == whole);
    CHECK(hash_after(scene, {0.0123, 0}) != whole);  // an end between two steps
  }
}

TEST_CASE("a run that ends early has its last state as its last frame", "[frames]") {
  const Fair fair;
  Simulation simulation = make_simulation(fair.scene(25, 0.01));
  RunOptions options;
  options.out = fair.path / "o";
  options.quiet = true;
  {
    Run run(simulation, options);
    march(run, [](const StepRow& row) { return row.step < 6; });
    CHECK(run.finish().interrupted);
  }
  const Recording recording(fair.path / "o");
  REQUIRE(recording.frames() == 3);
  CHECK(recording.time(1) == 0.04);
  CHECK(recording.time(2) == 0.06);
  options.duration = 0;
  Run(simulation, options).finish();
  CHECK(Recording(fair.path / "o").frames() == 1);
  CHECK(Recording(fair.path / "o").time(0) == 0.06);
}

TEST_CASE("compare takes the steps of simulate", "[frames][compare]") {
  const Fair fair;
  REQUIRE(fair.drape("simulate s.toml --out o --quiet --time-step 0.005 --set simulation.frame_rate=30")
              .exit_code == 0);
  const Outcome outcome = fair.drape(
      "compare s.toml --solvers mpcg,eigen-ldlt --steps 9 --at 9 --out c --quiet --integrators "
      "implicit-euler "
      "--time-step 0.005 --set simulation.frame_rate=30");
  INFO(outcome.err);
  REQUIRE(outcome.exit_code == 0);
  const std::string json = content(fair.path / "c/compare.json");
  CHECK_THAT(json, Contains("\"time_step\": 0.0047619047"));
  CHECK_THAT(json, Contains("\"time\": 0.042857142857"));
  CHECK_THAT(content(fair.path / "o/steps.csv"), Contains("\n9,0.04285714286,"));
}
