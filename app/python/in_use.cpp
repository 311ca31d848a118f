#include "app/python/in_use.h"

#include <set>
#include <stdexcept>
#include <utility>

namespace drape::app::python {
namespace {

std::set<const void*> marked;

}  // namespace

void require_free(const void* object) {
  if (marked.contains(object))
    throw std::runtime_error("a step that uses this is under way, in another thread or around this callback");
}

InUse::InUse(std::vector<const void*> objects) : objects_(std::move(objects)) {
  for (const void* object : objects_) require_free(object);
  marked.insert(objects_.begin(), objects_.end());
}

InUse::~InUse() {
  for (const void* object : objects_) marked.erase(object);
}

}  // namespace drape::app::python
