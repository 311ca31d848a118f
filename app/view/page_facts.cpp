#include <cmath>

#include "app/recording/scene_record.h"
#include "app/view/page_data.h"

namespace drape::app {
namespace {

class Facts {
 public:
  void add(std::string name, std::string value) {
    if (!value.empty()) rows_.emplace_back(Json::List{std::move(name), std::move(value)});
  }
  Json rows() const { return rows_; }

 private:
  Json::List rows_;
};

// Empty where there is no such number.
std::string number(const Json& json, const std::string& unit, double scale = 1, int digits = 3) {
  const double value = scale * json.number(NAN);
  return std::isfinite(value) ? rounded(value, digits) + (unit.empty() ? "" : " " + unit) : "";
}

std::string joined(const Names& parts) {
  std::string text;
  for (const std::string& part : parts)
    if (!part.empty()) text += (text.empty() ? "" : ", ") + part;
  return text;
}

std::string named(const std::string& value, const char* name) {
  return value.empty() ? "" : value + " " + name;
}

std::string state_of(const Json& run) {
  const Json& failure = run["failure"];
  std::string state = run["state"].text();
  if (const bool* const interrupted = std::get_if<bool>(&run["interrupted"].value);
      interrupted && *interrupted)
    state += ", interrupted";
  if (failure.is_null()) return state;
  return state + " at " + number(failure["time"], "s", 1, 4) + " (step " + number(failure["step"], "", 1, 9) +
         "): " + failure["what"].text();
}

// The step used, and the one asked for where it is another.
std::string step_of(const Json& run) {
  const std::string used = number(run["time_step"], "ms", 1e3, 4),
                    asked = number(run["time_step_asked"], "ms", 1e3, 4);
  return joined({used, asked == used ? "" : named(asked, "asked for")});
}

void add_times(Facts& facts, const Json& run) {
  const Json &step = run["ms_per_step"], &phases = run["phases_ms"];
  facts.add("Time of a step", joined({named(number(step["median"], "ms"), "median"),
                                      named(number(step["p95"], "ms"), "at 95 %"),
                                      named(number(step["max"], "ms"), "at most")}));
  facts.add("Phases", joined({named(number(phases["assemble"], "s", 1e-3), "assemble"),
                              named(number(phases["solve"], "s", 1e-3), "solve"),
                              named(number(phases["collide"], "s", 1e-3), "collide"),
                              named(number(phases["write"], "s", 1e-3), "write")}));
  facts.add("Wall time", number(run["wall_seconds"], "s"));
  facts.add("Threads", number(run["threads"], "", 1, 9));
}

}  // namespace

Json page_facts(const Recording& recording) {
  const Json& run = recording.run();
  Facts facts;
  for (const RecordedShape& shape : recording.shapes())
    facts.add(shape.body ? "Body" : "Cloth", shape.name + ": " +
                                                 counted(shape.mesh.vertex_count(), "vertex") + ", " +
                                                 counted(shape.mesh.triangle_count(), "triangle"));
  for (const RecordedPlane& plane : recording.planes(0)) facts.add("Body", plane.name + ": a plane");
  facts.add("Frames", std::to_string(recording.frames()));
  facts.add("Scene", run["scene"].text());
  facts.add("State", state_of(run));
  facts.add("Integrator", run["integrator"].text());
  facts.add("Linear solver", run["linear_solver"].text());
  facts.add("Contact", run["contact"].text());
  facts.add("Time step", step_of(run));
  facts.add("Steps", joined({number(run["steps"], "", 1, 9), named(number(run["steps_cut"], "", 1, 9), "cut"),
                             named(number(run["steps_not_converged"], "", 1, 9), "not converged")}));
  facts.add("Simulated", number(run["simulated_seconds"], "s", 1, 4));
  facts.add("Iterations of a step",
            joined({named(number(run["linear_iterations"]["mean"], ""), "in the mean"),
                    named(number(run["linear_iterations"]["max"], "", 1, 9), "at most")}));
  add_times(facts, run);
  facts.add("Deepest penetration", number(run["max_penetration"], "mm", 1e3));
  for (const SceneFact& fact : scene_facts(run)) facts.add(fact.name, fact.value);
  facts.add("Made by", run["drape_version"].text().empty() ? "" : "drape " + run["drape_version"].text());
  return facts.rows();
}

}  // namespace drape::app
