// Forces between the function that makes them and the system that takes them.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "solver/forces/force.h"

namespace drape::app::python {

struct Forces {
  std::vector<std::unique_ptr<Force>> all;  // empty after a system has taken them
  bool given = false;

  explicit Forces(std::vector<std::unique_ptr<Force>> forces) : all(std::move(forces)) {}
  Forces(Forces&&) = default;

  std::vector<std::string> names() const {
    std::vector<std::string> names;
    for (const auto& force : all) names.emplace_back(force->name());
    return names;
  }
};

}  // namespace drape::app::python
